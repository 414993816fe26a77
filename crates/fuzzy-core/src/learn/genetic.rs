//! Genetic algorithms on vectors of real numbers.

use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::rng::Rng;

/// How a [`Genetic`] algorithm breeds.
///
/// | Name | Meaning | Range |
/// |---|---|---|
/// | population | individuals in a generation | ≥ 4 |
/// | crossover | share of a new generation bred by crossover | \[0, 1\] |
/// | mutation | share of a new generation drawn at random | \[0, 1\] |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeneticSettings {
    /// The number of individuals.
    pub population: usize,
    /// The share of each new generation that comes from crossover.
    pub crossover: f64,
    /// The share of each new generation that is drawn anew.
    pub mutation: f64,
}

/// A real-coded genetic algorithm that minimises, driven by [`ask`](Self::ask) and
/// [`tell`](Self::tell).
///
/// A new generation consists of the best of the old one, unchanged (its elite); children of
/// neighbours in the ranking by one-point crossover, two for each pair, the best pairs first;
/// and individuals drawn evenly within the bounds, which is what the thesis means by mutation
/// (sections 3.4 and 6.4.3). A fitness that is NaN ranks last.
///
/// ```
/// use fuzzy_core::learn::genetic::{Genetic, GeneticSettings};
///
/// let settings = GeneticSettings { population: 40, crossover: 0.2, mutation: 0.3 };
/// let mut search = Genetic::new(vec![(-1.0, 1.0); 2], settings, 7)?;
/// for _ in 0..60 {
///     let fitness: Vec<f64> = search.ask().map(|x| x[0] * x[0] + x[1] * x[1]).collect();
///     search.tell(&fitness)?;
/// }
/// assert!(search.best().is_some_and(|best| best.fitness < 0.01));
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Genetic {
    bounds: Vec<(f64, f64)>,
    plan: Plan,
    genes: Vec<f64>,
    next: Vec<f64>,
    elite_fitness: Vec<f64>,
    ranking: Vec<usize>,
    best: Option<Individual>,
    generation: u64,
    rng: Rng,
}

/// A vector and how good it was.
#[derive(Debug, Clone, PartialEq)]
pub struct Individual {
    /// The vector.
    pub genes: Vec<f64>,
    /// Its fitness; smaller is better.
    pub fitness: f64,
}

/// Whether the kept individuals are evaluated again in the next generation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Elite {
    /// No: fitness is a function of the vector alone.
    Remembered,
    /// Yes: fitness changes from generation to generation.
    Reevaluated,
}

/// How many of a generation are what.
#[derive(Debug, Clone, Copy)]
struct Plan {
    elite: usize,
    children: usize,
    newcomers: usize,
}

impl Plan {
    fn new(settings: GeneticSettings) -> Result<Self> {
        check::at_least("population", settings.population, 4)?;
        check::fraction("crossover", settings.crossover)?;
        check::fraction("mutation", settings.mutation)?;
        let count = |share: f64| (share * settings.population as f64).round() as usize;
        let (children, newcomers) = (count(settings.crossover), count(settings.mutation));
        let elite = settings.population.saturating_sub(children.saturating_add(newcomers));
        // Each pair of parents has two children, and parents come from the elite.
        let needed = 2.max(children.next_multiple_of(2));
        if elite < needed {
            return Err(Error::OutOfRange {
                what: format!(
                    "the elite of a population of {} with crossover {} and mutation {}",
                    settings.population, settings.crossover, settings.mutation
                ),
                expected: format!("at least {needed}"),
                value: elite as f64,
            });
        }
        Ok(Self { elite, children, newcomers })
    }

    fn population(self) -> usize {
        self.elite + self.children + self.newcomers
    }
}

impl Genetic {
    /// A search within these bounds, its first generation drawn evenly within them.
    pub fn new(bounds: Vec<(f64, f64)>, settings: GeneticSettings, seed: u64) -> Result<Self> {
        Self::with_rng(bounds, settings, Rng::new(seed, 0))
    }

    /// [`new`](Self::new) with a stream of random numbers of the caller's.
    pub fn with_rng(
        bounds: Vec<(f64, f64)>,
        settings: GeneticSettings,
        mut rng: Rng,
    ) -> Result<Self> {
        let plan = Plan::new(settings)?;
        check::at_least("genes", bounds.len(), 1)?;
        for (index, &(low, high)) in bounds.iter().enumerate() {
            if low != high {
                check::interval(&format!("the range of gene {index}"), low, high)?;
            }
            check::finite(&format!("range of gene {index}"), low)?;
        }
        let mut genes = check::zeros("the population", plan.population(), bounds.len())?;
        let next = check::zeros("the population", plan.population(), bounds.len())?;
        for individual in genes.chunks_exact_mut(bounds.len()) {
            for (gene, &(low, high)) in individual.iter_mut().zip(&bounds) {
                *gene = rng.uniform_in(low, high);
            }
        }
        Ok(Self {
            plan,
            next,
            genes,
            elite_fitness: Vec::new(),
            ranking: Vec::new(),
            best: None,
            generation: 0,
            rng,
            bounds,
        })
    }

    /// Replaces the first individuals by these, for a search that begins from known vectors.
    pub fn start_from<'a>(&mut self, vectors: impl IntoIterator<Item = &'a [f64]>) -> Result<()> {
        if self.generation > 0 {
            return Err(Error::OutOfOrder("start_from must come before the first tell"));
        }
        let population = self.plan.population();
        for (index, vector) in vectors.into_iter().enumerate() {
            check::within(
                "number of starting vectors",
                (index + 1) as f64,
                &format!("at most {population}"),
                |n| n <= population as f64,
            )?;
            check::same_length(
                &format!("genes of starting vector {index}"),
                self.bounds.len(),
                vector.len(),
            )?;
            check::all_finite(&format!("starting vector {index}"), vector)?;
            self.genes[index * self.bounds.len()..][..self.bounds.len()].copy_from_slice(vector);
        }
        Ok(())
    }

    /// The individuals whose fitness is wanted.
    pub fn ask(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.genes.chunks_exact(self.bounds.len())
    }

    /// The same as one matrix, individual by individual.
    pub fn population(&self) -> &[f64] {
        &self.genes
    }

    /// The range of each gene.
    pub fn bounds(&self) -> &[(f64, f64)] {
        &self.bounds
    }

    /// The number of genes of an individual.
    pub fn genes(&self) -> usize {
        self.bounds.len()
    }

    /// Generations told so far.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The best individual of the generation last told.
    pub fn best(&self) -> Option<&Individual> {
        self.best.as_ref()
    }

    /// The number of individuals that each generation keeps.
    pub fn elite_size(&self) -> usize {
        self.plan.elite
    }

    /// The individuals of the generation last told that were kept, best first.
    pub fn elite(&self) -> impl Iterator<Item = &[f64]> {
        self.ask().take(self.elite_fitness.len())
    }

    /// Takes the fitness of each individual, smaller is better, and breeds the next generation.
    pub fn tell(&mut self, fitness: &[f64]) -> Result<()> {
        check::same_length("fitness values", self.plan.population(), fitness.len())?;
        self.ranking.clear();
        self.ranking.extend(0..fitness.len());
        // Stable: of equals the earlier goes first, whatever the platform.
        self.ranking.sort_by(|&a, &b| {
            let (a, b) = (fitness[a], fitness[b]);
            a.is_nan().cmp(&b.is_nan()).then(a.total_cmp(&b))
        });

        let leader = self.ranking[0];
        self.best = (!fitness[leader].is_nan()).then(|| Individual {
            genes: self.individual(leader).to_vec(),
            fitness: fitness[leader],
        });
        self.elite_fitness.clear();
        self.elite_fitness.extend(self.ranking[..self.plan.elite].iter().map(|&i| fitness[i]));
        self.breed();
        self.generation += 1;
        Ok(())
    }

    /// Runs `generations` of them with a fitness function of the caller's, and returns the best
    /// fitness of each.
    ///
    /// `evaluate` gets a matrix of individuals, one after the other, and writes the fitness of
    /// each; the matrix leaves out individuals whose fitness is remembered.
    pub fn run<E: From<Error>>(
        &mut self,
        generations: u32,
        elite: Elite,
        control: &Control,
        mut evaluate: impl FnMut(&[f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<Vec<f64>, E> {
        let mut fitness = vec![0.0; self.plan.population()];
        let mut history = Vec::new();
        for _ in 0..generations {
            let known = match elite {
                Elite::Remembered => self.elite_fitness.len(),
                Elite::Reevaluated => 0,
            };
            fitness[..known].copy_from_slice(&self.elite_fitness[..known]);
            evaluate(&self.genes[known * self.bounds.len()..], &mut fitness[known..])?;
            self.tell(&fitness)?;
            history.push(self.best.as_ref().map_or(f64::NAN, |best| best.fitness));
            control.advance(1)?;
        }
        Ok(history)
    }

    fn individual(&self, index: usize) -> &[f64] {
        &self.genes[index * self.bounds.len()..][..self.bounds.len()]
    }

    fn breed(&mut self) {
        let genes = self.bounds.len();
        let Plan { elite, children, newcomers } = self.plan;
        for place in 0..elite {
            let parent = self.ranking[place];
            self.cross(parent, parent, genes, place);
        }
        for pair in 0..children.div_ceil(2) {
            let (first, second) = (self.ranking[2 * pair], self.ranking[2 * pair + 1]);
            // The cut leaves something of each parent, unless there is but one gene.
            let cut = 1 + self.rng.below(genes - 1);
            let place = elite + 2 * pair;
            self.cross(first, second, cut, place);
            if 2 * pair + 1 < children {
                self.cross(second, first, cut, place + 1);
            }
        }
        let newcomers = &mut self.next[(elite + children) * genes..][..newcomers * genes];
        for newcomer in newcomers.chunks_exact_mut(genes) {
            for (gene, &(low, high)) in newcomer.iter_mut().zip(&self.bounds) {
                *gene = self.rng.uniform_in(low, high);
            }
        }
        std::mem::swap(&mut self.genes, &mut self.next);
    }

    /// The next generation's individual at `place`: one parent's genes before the cut, the
    /// other's after it.
    fn cross(&mut self, head: usize, tail: usize, cut: usize, place: usize) {
        let genes = self.bounds.len();
        let child = &mut self.next[place * genes..][..genes];
        child[..cut].copy_from_slice(&self.genes[head * genes..][..cut]);
        child[cut..].copy_from_slice(&self.genes[tail * genes..][cut..genes]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THESIS: GeneticSettings =
        GeneticSettings { population: 40, crossover: 0.2, mutation: 0.1 };

    fn sphere(x: &[f64]) -> f64 {
        x.iter().map(|v| (v - 0.3) * (v - 0.3)).sum()
    }

    fn run(search: &mut Genetic, generations: usize) {
        for _ in 0..generations {
            let fitness: Vec<f64> = search.ask().map(sphere).collect();
            search.tell(&fitness).unwrap();
        }
    }

    #[test]
    fn the_elite_is_kept_and_its_fitness_known() {
        let mut search = Genetic::new(vec![(-1.0, 1.0); 5], THESIS, 1).unwrap();
        let fitness: Vec<f64> = search.ask().map(sphere).collect();
        search.tell(&fitness).unwrap();
        let mut sorted = fitness;
        sorted.sort_by(f64::total_cmp);
        assert_eq!(search.elite_fitness, &sorted[..28]);
        let again: Vec<f64> = search.elite().map(sphere).collect();
        assert_eq!(again, search.elite_fitness);
        assert_eq!(search.best().unwrap().fitness, sorted[0]);
    }

    #[test]
    fn remembering_the_elite_changes_nothing_but_the_work() {
        let search = || Genetic::new(vec![(-1.0, 1.0); 3], THESIS, 9).unwrap();
        let mut runs = [Elite::Remembered, Elite::Reevaluated].map(|elite| {
            let (mut search, mut evaluations) = (search(), 0);
            let evaluate = |population: &[f64], fitness: &mut [f64]| -> Result<()> {
                evaluations += fitness.len();
                let rows = population.chunks_exact(3);
                fitness.iter_mut().zip(rows).for_each(|(f, x)| *f = sphere(x));
                Ok(())
            };
            let history = search.run(50, elite, &Control::new(), evaluate).unwrap();
            (history, search.population().to_vec(), evaluations)
        });
        assert_eq!((runs[0].2, runs[1].2), (40 + 49 * 12, 50 * 40));
        runs[0].2 = runs[1].2;
        assert_eq!(runs[0], runs[1]);
    }

    #[test]
    fn a_run_stops_on_request() {
        let control = Control::new();
        control.cancel();
        let mut search = Genetic::new(vec![(-1.0, 1.0); 3], THESIS, 9).unwrap();
        let stopped = search.run(50, Elite::Remembered, &control, |_, _| Ok::<(), Error>(()));
        assert_eq!(stopped, Err(Error::Cancelled));
        assert_eq!(search.generation(), 1);
    }

    #[test]
    fn children_are_cut_from_neighbours_in_the_ranking() {
        // The i-th individual is (i, i, …): genes tell the parents.
        let mut search = Genetic::new(vec![(0.0, 40.0); 4], THESIS, 1).unwrap();
        let vectors: Vec<Vec<f64>> = (0..40).map(|i| vec![f64::from(i); 4]).collect();
        search.start_from(vectors.iter().map(Vec::as_slice)).unwrap();
        let fitness: Vec<f64> = search.ask().map(|x| x[0]).collect();
        search.tell(&fitness).unwrap();
        for (number, child) in search.ask().skip(28).take(8).enumerate() {
            let pair = f64::from((number as u32 / 2) * 2);
            let (head, tail) =
                if number % 2 == 0 { (pair, pair + 1.0) } else { (pair + 1.0, pair) };
            assert_eq!((child[0], child[3]), (head, tail));
            assert!(child.iter().all(|&gene| gene == head || gene == tail));
        }
        assert!(search.ask().skip(36).all(|x| x.iter().all(|g| (0.0..40.0).contains(g))));
    }

    #[test]
    fn the_search_improves_and_is_reproducible() {
        let mut search = Genetic::new(vec![(-1.0, 1.0); 3], THESIS, 5).unwrap();
        run(&mut search, 300);
        let best = search.best().unwrap().clone();
        assert!(best.fitness < 0.02, "{}", best.fitness);
        let mut again = Genetic::new(vec![(-1.0, 1.0); 3], THESIS, 5).unwrap();
        run(&mut again, 300);
        assert_eq!(again.best().unwrap(), &best);
        assert_eq!(again.population(), search.population());
    }

    #[test]
    fn nan_fitness_never_wins() {
        let mut search = Genetic::new(vec![(-1.0, 1.0)], THESIS, 2).unwrap();
        let mut fitness = vec![f64::NAN; 40];
        search.tell(&fitness).unwrap();
        assert!(search.best().is_none());
        fitness[17] = 1e300;
        let winner = search.ask().nth(17).unwrap().to_vec();
        search.tell(&fitness).unwrap();
        assert_eq!(search.best().unwrap().genes, winner);
    }

    #[test]
    fn impossible_populations_and_bounds_are_refused() {
        let bounds = || vec![(0.0, 1.0); 3];
        for (population, crossover, mutation) in
            [(3, 0.2, 0.1), (40, 0.6, 0.1), (40, 0.2, 0.9), (40, -0.1, 0.1), (40, f64::NAN, 0.0)]
        {
            let settings = GeneticSettings { population, crossover, mutation };
            assert!(Genetic::new(bounds(), settings, 0).is_err(), "{settings:?}");
        }
        assert!(Genetic::new(vec![(1.0, 0.0)], THESIS, 0).is_err());
        assert!(Genetic::new(vec![(0.0, f64::INFINITY)], THESIS, 0).is_err());
        assert!(Genetic::new(vec![], THESIS, 0).is_err());
        let mut search = Genetic::new(bounds(), THESIS, 0).unwrap();
        assert!(search.tell(&[0.0; 39]).is_err());
        assert!(search.start_from([[0.0; 2].as_slice()]).is_err());
        assert!(search.start_from(vec![[0.0; 3].as_slice(); 41]).is_err());
    }
}
