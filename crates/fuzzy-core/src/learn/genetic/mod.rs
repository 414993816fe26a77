//! Genetic algorithms on numbers, whole numbers and bits.

mod bounds;
mod crossover;
mod fit;
mod gene;
mod mutation;
mod selection;
mod settings;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::rng::{Rng, RngState};

pub use bounds::SearchBounds;
pub use crossover::Crossover;
pub use fit::{Fit, FitSettings, SquaredError, fit_genetic};
pub use gene::Gene;
pub use mutation::Mutation;
pub use selection::Selection;
pub use settings::{GeneticSettings, Stop};

/// A genetic algorithm that minimises, driven by [`ask`](Self::ask) and [`tell`](Self::tell).
///
/// A new generation consists of the best of the old one, unchanged (its elite); children, crossed
/// and mutated; mutants; and immigrants, see [`GeneticSettings`]. A child's gene that leaves its
/// range becomes the nearer end. A fitness that is not finite ranks last and never becomes the
/// best.
///
/// The best over the whole search is never lost ([`best`](Self::best)). Where fitness is noisy,
/// the lowest ever measured was lucky: [`leader`](Self::leader) is the best of the generation
/// last told.
///
/// ```
/// use fuzzy_core::learn::genetic::{Gene, Genetic, GeneticSettings};
///
/// // A number, a whole number and a bit.
/// let genes = [Gene::from((-1.0, 1.0)), Gene::Integer { low: 1, high: 9 }, Gene::Bit];
/// let mut search = Genetic::new(genes, GeneticSettings::default(), 7)?;
/// for _ in 0..60 {
///     let fitness = |x: &[f64]| x[0] * x[0] + (x[1] - 4.0).abs() + x[2];
///     let fitness: Vec<f64> = search.ask().map(fitness).collect();
///     search.tell(&fitness)?;
/// }
/// let best = search.best().ok_or("no fitness was a number")?;
/// assert_eq!(best.genes[1..], [4.0, 0.0]);
/// assert!(best.fitness < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Genetic {
    settings: GeneticSettings,
    genes: Vec<Gene>,
    /// The places of the numbers and those of the bits.
    numbers: Vec<usize>,
    bits: Vec<usize>,
    population: Vec<f64>,
    next: Vec<f64>,
    ranking: Vec<usize>,
    progress: Progress,
    rng: Rng,
}

/// What a search knows from the generations told.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Progress {
    /// Of the kept individuals, best first; empty before the first generation.
    #[serde(deserialize_with = "crate::format::json::null_as_nan")]
    pub elite_fitness: Vec<f64>,
    pub leader: Option<Individual>,
    pub best: Option<Individual>,
    /// The generation, counted from 1, in which the best was found.
    pub best_since: u64,
    pub history: History,
}

/// A chromosome and how good it was.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Individual {
    /// The chromosome.
    pub genes: Vec<f64>,
    /// Its fitness; smaller is better.
    pub fitness: f64,
}

/// How a search went: one number for each generation told.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct History {
    /// The best fitness of the generation; NaN if it had no feasible individual.
    #[serde(deserialize_with = "crate::format::json::null_as_nan")]
    pub best: Vec<f64>,
    /// The mean fitness of the feasible individuals; NaN if there was none.
    #[serde(deserialize_with = "crate::format::json::null_as_nan")]
    pub mean: Vec<f64>,
}

/// Whether the kept individuals are evaluated again in the next generation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Elite {
    /// No: fitness is a function of the chromosome alone.
    Remembered,
    /// Yes: fitness changes from generation to generation.
    Reevaluated,
}

impl Genetic {
    /// A search for the values of these genes, the first generation drawn evenly. Pairs of
    /// numbers are the bounds of real genes.
    pub fn new(
        genes: impl IntoIterator<Item = impl Into<Gene>>,
        settings: GeneticSettings,
        seed: u64,
    ) -> Result<Self> {
        Self::with_rng(genes, settings, Rng::new(seed, 0))
    }

    /// [`new`](Self::new) with a stream of random numbers of the caller's.
    pub fn with_rng(
        genes: impl IntoIterator<Item = impl Into<Gene>>,
        settings: GeneticSettings,
        mut rng: Rng,
    ) -> Result<Self> {
        settings.check()?;
        let genes: Vec<Gene> = genes.into_iter().map(Into::into).collect();
        check::at_least("genes", genes.len(), 1)?;
        for (index, gene) in genes.iter().enumerate() {
            gene.check(&format!("the range of gene {index}"))?;
        }
        let mut population = check::zeros("the population", settings.population, genes.len())?;
        let next = check::zeros("the population", settings.population, genes.len())?;
        draw(&genes, &mut population, &mut rng);
        let (bits, numbers) = (0..genes.len()).partition(|&place| genes[place] == Gene::Bit);
        let (ranking, progress) = (Vec::new(), Progress::default());
        Ok(Self { settings, genes, numbers, bits, population, next, ranking, progress, rng })
    }

    /// The search in the state of another; everything has been checked.
    pub(crate) fn continued(self, population: Vec<f64>, progress: Progress, rng: RngState) -> Self {
        Self { population, progress, rng: Rng::from_state(rng), ..self }
    }

    pub(crate) fn progress(&self) -> &Progress {
        &self.progress
    }

    pub(crate) fn rng(&self) -> RngState {
        self.rng.state()
    }

    /// Replaces the first individuals by these, for a search that begins from known vectors.
    pub fn start_from<'a>(&mut self, vectors: impl IntoIterator<Item = &'a [f64]>) -> Result<()> {
        if self.generation() > 0 {
            return Err(Error::OutOfOrder("start_from must come before the first tell"));
        }
        let population = self.settings.population;
        for (index, vector) in vectors.into_iter().enumerate() {
            check::within(
                "number of starting vectors",
                (index + 1) as f64,
                &format!("at most {population}"),
                |n| n <= population as f64,
            )?;
            check_chromosome(&self.genes, vector)
                .map_err(|error| error.at(format!("starting vector {index}")))?;
            self.population[index * self.genes.len()..][..vector.len()].copy_from_slice(vector);
        }
        Ok(())
    }

    /// The individuals whose fitness is wanted; those kept from the last generation come first.
    pub fn ask(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.population.chunks_exact(self.genes.len())
    }

    /// The same as one matrix, individual by individual.
    pub fn population(&self) -> &[f64] {
        &self.population
    }

    /// Lets the caller mend every individual that was not kept, before its fitness is taken: to
    /// satisfy a constraint, say. What then is outside a gene's range becomes the nearest value
    /// within.
    pub fn repair(&mut self, mut mend: impl FnMut(&mut [f64])) {
        let kept = self.progress.elite_fitness.len();
        for individual in self.population.chunks_exact_mut(self.genes.len()).skip(kept) {
            mend(individual);
            contain(&self.genes, individual);
        }
    }

    /// What stands at each place of a chromosome.
    pub fn genes(&self) -> &[Gene] {
        &self.genes
    }

    /// How the search breeds.
    pub fn settings(&self) -> &GeneticSettings {
        &self.settings
    }

    /// Generations told so far.
    pub fn generation(&self) -> u64 {
        self.progress.history.best.len() as u64
    }

    /// The best individual of all generations. None before the first, and as long as no fitness
    /// of a feasible individual was finite.
    pub fn best(&self) -> Option<&Individual> {
        self.progress.best.as_ref()
    }

    /// The best individual of the generation last told; None if it had no feasible one.
    pub fn leader(&self) -> Option<&Individual> {
        self.progress.leader.as_ref()
    }

    /// The best and the mean fitness of each generation.
    pub fn history(&self) -> &History {
        &self.progress.history
    }

    /// Generations told since the best was found.
    pub fn stagnation(&self) -> u64 {
        self.generation() - self.progress.best_since
    }

    /// The individuals of the generation last told that were kept, best first.
    pub fn elite(&self) -> impl Iterator<Item = &[f64]> {
        self.ask().take(self.progress.elite_fitness.len())
    }

    /// Takes the fitness of each individual, smaller is better, and breeds the next generation.
    pub fn tell(&mut self, fitness: &[f64]) -> Result<()> {
        check::same_length("fitness values", self.settings.population, fitness.len())?;
        self.take(fitness, |_| 0.0);
        Ok(())
    }

    /// [`tell`](Self::tell) with a measure of how far each individual violates constraints: zero
    /// or less where it is feasible. By Deb's rules (2000) the feasible come first, by fitness,
    /// then the infeasible, by violation; NaN ranks last. Only feasible individuals become the
    /// best.
    pub fn tell_constrained(&mut self, fitness: &[f64], violation: &[f64]) -> Result<()> {
        check::same_length("fitness values", self.settings.population, fitness.len())?;
        check::same_length("constraint violations", self.settings.population, violation.len())?;
        self.take(fitness, |index| violation[index]);
        Ok(())
    }

    /// Runs until it is time to [stop](Stop), counted from now, with a fitness function of the
    /// caller's.
    ///
    /// `evaluate` gets a matrix of individuals, one after the other, and writes the fitness of
    /// each; the matrix leaves out individuals whose fitness is remembered. If the work is
    /// cancelled or `evaluate` fails, what was told so far remains.
    pub fn run<E: From<Error>>(
        &mut self,
        stop: Stop,
        elite: Elite,
        control: &Control,
        mut evaluate: impl FnMut(&[f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        self.run_below(stop, elite, control, |population, _, fitness| evaluate(population, fitness))
    }

    /// [`run`](Self::run) for a fitness whose evaluation can be given up: `evaluate` also gets a
    /// bar. An individual whose fitness is not below it will neither be kept nor be a parent,
    /// whatever it is exactly, and may be given +∞ instead. That changes nothing but the mean
    /// fitness in the [`history`](Self::history), which then is of the others.
    pub fn run_below<E: From<Error>>(
        &mut self,
        stop: Stop,
        elite: Elite,
        control: &Control,
        mut evaluate: impl FnMut(&[f64], f64, &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        stop.check()?;
        let mut fitness = vec![0.0; self.settings.population];
        for _ in 0..stop.generations {
            let known = match elite {
                Elite::Remembered => self.progress.elite_fitness.len(),
                Elite::Reevaluated => 0,
            };
            fitness[..known].copy_from_slice(&self.progress.elite_fitness[..known]);
            let bar = if known > 0 { self.bar() } else { f64::INFINITY };
            evaluate(&self.population[known * self.genes.len()..], bar, &mut fitness[known..])?;
            self.tell(&fitness)?;
            control.advance(1)?;
            if stop.is_early(self) {
                break;
            }
        }
        Ok(())
    }

    /// The largest fitness of the kept, if nobody else can become a parent; else +∞.
    fn bar(&self) -> f64 {
        let parents = self.settings.selection.parents(self.settings.children());
        let none_else = parents > 0 || self.settings.children() == 0;
        let last = self.progress.elite_fitness.last().copied().filter(|_| none_else);
        last.filter(|last| last.is_finite()).unwrap_or(f64::INFINITY)
    }

    fn individual(&self, index: usize) -> &[f64] {
        &self.population[index * self.genes.len()..][..self.genes.len()]
    }

    fn take(&mut self, fitness: &[f64], violation: impl Fn(usize) -> f64) {
        let rank = |index: usize| match (fitness[index], violation(index)) {
            (fitness, violation) if violation <= 0.0 && fitness.is_finite() => (0, fitness),
            (_, violation) if violation > 0.0 => (1, violation),
            _ => (2, 0.0),
        };
        self.ranking.clear();
        self.ranking.extend(0..fitness.len());
        // Stable: of equals the earlier goes first, whatever the platform.
        self.ranking.sort_by(|&a, &b| {
            let ((a, x), (b, y)) = (rank(a), rank(b));
            a.cmp(&b).then(x.total_cmp(&y))
        });

        let feasible = |&index: &usize| rank(index).0 == 0;
        let count = self.ranking.iter().take_while(|index| feasible(index)).count();
        let leader = (count > 0).then(|| Individual {
            genes: self.individual(self.ranking[0]).to_vec(),
            fitness: fitness[self.ranking[0]],
        });
        let known = |&index: &usize| if feasible(&index) { fitness[index] } else { f64::NAN };
        let progress = &mut self.progress;
        progress.elite_fitness.clear();
        progress.elite_fitness.extend(self.ranking[..self.settings.elite].iter().map(known));
        let share = 1.0 / count as f64;
        let mean = self.ranking[..count].iter().map(|&index| fitness[index] * share).sum::<f64>();
        progress.history.mean.push(if count > 0 { mean } else { f64::NAN });
        progress.history.best.push(leader.as_ref().map_or(f64::NAN, |leader| leader.fitness));
        if let Some(leader) = &leader
            && progress.best.as_ref().is_none_or(|best| leader.fitness < best.fitness)
        {
            progress.best = Some(leader.clone());
            progress.best_since = progress.history.best.len() as u64;
        }
        progress.leader = leader;
        self.breed();
    }

    fn breed(&mut self) {
        let genes = self.genes.len();
        let mut next = std::mem::take(&mut self.next);
        let (elite, rest) = next.split_at_mut(self.settings.elite * genes);
        let (children, rest) = rest.split_at_mut(self.settings.children() * genes);
        let (mutants, immigrants) = rest.split_at_mut(self.settings.mutants * genes);
        for (place, &index) in elite.chunks_exact_mut(genes).zip(&self.ranking) {
            place.copy_from_slice(self.individual(index));
        }
        self.breed_children(children);
        for mutant in mutants.chunks_exact_mut(genes) {
            let parent = self.ranking[self.rng.below(self.settings.elite)];
            mutant.copy_from_slice(self.individual(parent));
            let place = self.rng.below(genes);
            mutant[place] = self.genes[place].draw(&mut self.rng);
        }
        draw(&self.genes, immigrants, &mut self.rng);
        self.next = std::mem::replace(&mut self.population, next);
    }

    fn breed_children(&mut self, children: &mut [f64]) {
        let (genes, selection) = (self.genes.len(), self.settings.selection);
        let mut born = vec![0.0; 2 * genes];
        let families = children.chunks_mut(selection.children_per_couple() * genes);
        for (number, family) in families.enumerate() {
            let couple = selection.couple(number, self.settings.population, &mut self.rng);
            let parents =
                couple.map(|rank| &self.population[self.ranking[rank] * genes..][..genes]);
            for (places, crossover) in [
                (&self.numbers, self.settings.crossover),
                (&self.bits, self.settings.bit_crossover),
            ] {
                if !places.is_empty() {
                    let (first, second) = born.split_at_mut(genes);
                    crossover.cross(places, parents, [first, second], &mut self.rng);
                }
            }
            for (child, born) in family.chunks_exact_mut(genes).zip(born.chunks_exact(genes)) {
                child.copy_from_slice(born);
                self.mutate(child);
                contain(&self.genes, child);
            }
        }
    }

    fn mutate(&mut self, child: &mut [f64]) {
        let (mutation, rng) = (self.settings.mutation, &mut self.rng);
        for &place in &self.numbers {
            if mutation.strikes(rng) {
                child[place] = mutation.change(self.genes[place], child[place], rng);
            }
        }
        if self.settings.bit_flip > 0.0 {
            for &place in &self.bits {
                if rng.uniform() < self.settings.bit_flip {
                    child[place] = 1.0 - child[place];
                }
            }
        }
    }
}

/// Draws every gene of these individuals anew.
fn draw(genes: &[Gene], individuals: &mut [f64], rng: &mut Rng) {
    for individual in individuals.chunks_exact_mut(genes.len()) {
        individual.iter_mut().zip(genes).for_each(|(value, gene)| *value = gene.draw(rng));
    }
}

/// Brings every gene into its range.
fn contain(genes: &[Gene], individual: &mut [f64]) {
    individual.iter_mut().zip(genes).for_each(|(value, gene)| *value = gene.contain(*value));
}

/// Nothing, or what is wrong with a chromosome.
pub(crate) fn check_chromosome(genes: &[Gene], values: &[f64]) -> Result<()> {
    check::same_length("genes", genes.len(), values.len())?;
    for (index, (gene, &value)) in genes.iter().zip(values).enumerate() {
        let (low, high) = gene.range();
        let kind = if matches!(gene, Gene::Real { .. }) { "a number" } else { "a whole number" };
        let expected = format!("{kind} from {low} to {high}");
        check::within(&format!("gene {index}"), value, &expected, |value| gene.holds(value))?;
    }
    Ok(())
}
