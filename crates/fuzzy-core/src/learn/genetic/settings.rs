//! What a search is set to do, and when it stops.

use serde::{Deserialize, Serialize};

use super::{Crossover, Genetic, Mutation, Selection};
use crate::check;
use crate::error::{Error, Result};

/// How a [`Genetic`] algorithm breeds. A new generation has four parts: the elite, children,
/// mutants and immigrants.
///
/// | Name | Meaning | Range | Default |
/// |---|---|---|---|
/// | population | individuals in a generation | ≥ 4 | 40 |
/// | elite | the best, kept unchanged | 0 to the population | 2 |
/// | mutants | copies of one of the elite, one gene drawn anew | | 0 |
/// | immigrants | individuals drawn anew | | 0 |
/// | selection | who the children's parents are | | tournament of 2 |
/// | crossover | how numbers of parents become those of children | | BLX-0.3 |
/// | bit_crossover | the same for bits | one-point, uniform | uniform |
/// | mutation | what happens to a child's numbers then | | Gaussian, rate 0.1, scale 0.1 |
/// | bit_flip | the probability that a bit of a child flips then | \[0, 1\] | 0.02 |
///
/// Everyone who is neither of the elite nor a mutant nor an immigrant is a child. Parents come
/// from the whole population, except that neighbours in the ranking must be of the elite.
///
/// The searches of the thesis, with a fixed average of neighbours, and a modern one:
/// ```
/// use fuzzy_core::learn::genetic::{Crossover, GeneticSettings, Mutation, Selection};
///
/// let chapter_3 = GeneticSettings {
///     population: 40,
///     elite: 20,
///     immigrants: 4,
///     ..GeneticSettings::averaging()
/// };
/// assert_eq!(chapter_3.children(), 16);
/// let chapter_4 = GeneticSettings { population: 80, elite: 40, mutants: 8, ..chapter_3 };
/// let chapter_4 = GeneticSettings { immigrants: 0, ..chapter_4 };
/// assert_eq!(chapter_4.children(), 32);
/// let chapter_6 = GeneticSettings::with_shares(40, 0.2, 0.1)?;
/// assert_eq!((chapter_6.elite, chapter_6.immigrants), (28, 4));
/// let modern = GeneticSettings {
///     population: 80,
///     selection: Selection::Tournament(2),
///     crossover: Crossover::Blend { low: -0.3, high: 1.3 },
///     mutation: Mutation::Gaussian { rate: 0.1, scale: 0.1 },
///     ..GeneticSettings::default()
/// };
/// assert_eq!(modern.elite, 2);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeneticSettings {
    /// The number of individuals.
    pub population: usize,
    /// How many of the best are kept unchanged.
    pub elite: usize,
    /// How many are copies of one of the elite, drawn evenly, with one gene drawn anew.
    pub mutants: usize,
    /// How many are drawn anew.
    pub immigrants: usize,
    /// How parents are chosen.
    pub selection: Selection,
    /// How numbers are crossed.
    pub crossover: Crossover,
    /// How bits are crossed.
    pub bit_crossover: Crossover,
    /// How a child's numbers change.
    pub mutation: Mutation,
    /// The probability that a bit of a child flips.
    pub bit_flip: f64,
}

impl Default for GeneticSettings {
    fn default() -> Self {
        Self {
            population: 40,
            elite: 2,
            mutants: 0,
            immigrants: 0,
            selection: Selection::Tournament(2),
            crossover: Crossover::blx(0.3),
            bit_crossover: Crossover::Uniform,
            mutation: Mutation::Gaussian { rate: 0.1, scale: 0.1 },
            bit_flip: 0.02,
        }
    }
}

impl GeneticSettings {
    /// The search of section 3.4: the better half of 40 is kept, 16 children are averages of
    /// neighbours in the ranking, their bits crossed at one point, and 4 are drawn anew.
    pub fn averaging() -> Self {
        Self {
            population: 40,
            elite: 20,
            mutants: 0,
            immigrants: 4,
            selection: Selection::Neighbours,
            crossover: Crossover::average(0.5),
            bit_crossover: Crossover::OnePoint,
            mutation: Mutation::None,
            bit_flip: 0.0,
        }
    }

    /// The search of section 6.4.3, by the shares of a new generation that come from one-point
    /// crossover of pairs, and from "mutation", which means individuals drawn anew; the rest is
    /// kept.
    pub fn with_shares(population: usize, crossover: f64, mutation: f64) -> Result<Self> {
        check::at_least("population", population, 4)?;
        check::fraction("crossover", crossover)?;
        check::fraction("mutation", mutation)?;
        let count = |share: f64| (share * population as f64).round() as usize;
        let (children, immigrants) = (count(crossover), count(mutation));
        let elite = population.saturating_sub(children.saturating_add(immigrants));
        let needed = 2.max(Selection::Pairs.parents(children));
        if elite < needed {
            return Err(Error::OutOfRange {
                what: format!(
                    "the elite of a population of {population} with crossover {crossover} and \
                     mutation {mutation}"
                ),
                expected: format!("at least {needed}"),
                value: elite as f64,
            });
        }
        Ok(Self {
            population,
            elite,
            immigrants,
            selection: Selection::Pairs,
            crossover: Crossover::OnePoint,
            ..Self::averaging()
        })
    }

    /// How many are children.
    pub fn children(&self) -> usize {
        [self.elite, self.mutants, self.immigrants]
            .iter()
            .fold(self.population, |rest, &part| rest.saturating_sub(part))
    }

    /// Nothing, or what does not fit.
    pub fn check(&self) -> Result<()> {
        check::at_least("population", self.population, 4)?;
        let parts = self.elite.saturating_add(self.mutants).saturating_add(self.immigrants);
        let most = format!("at most the population, {}", self.population);
        check::within("elite, mutants and immigrants together", parts as f64, &most, |_| {
            parts <= self.population
        })?;
        let parents = self.selection.parents(self.children());
        let mutated = usize::from(self.mutants > 0);
        check::at_least("elite, whose members are the parents,", self.elite, parents.max(mutated))?;
        if let Selection::Tournament(size) = self.selection {
            check::at_least("size of a tournament", size, 1)?;
            let most = format!("at most the population, {}", self.population);
            check::within("size of a tournament", size as f64, &most, |_| size <= self.population)?;
        }
        self.crossover.check()?;
        if !self.bit_crossover.exchanges() {
            return Err(Error::Unsuitable {
                what: "the crossover of bits".to_owned(),
                reason: "bits cannot be mixed; use one-point or uniform crossover".to_owned(),
            });
        }
        self.mutation.check()?;
        check::fraction("bit_flip", self.bit_flip)?;
        Ok(())
    }
}

/// When a search stops: after so many generations, or earlier.
///
/// ```
/// use fuzzy_core::learn::genetic::Stop;
///
/// let stop = Stop { target: Some(1e-3), ..Stop::after(100) };
/// assert_eq!(stop.stagnation, None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The most generations, at least 1.
    pub generations: u32,
    /// Stops when the best fitness is this or smaller.
    pub target: Option<f64>,
    /// Stops when the best has not changed for so many generations, at least 1.
    pub stagnation: Option<u32>,
}

impl Stop {
    /// After so many generations.
    pub fn after(generations: u32) -> Self {
        Self { generations, target: None, stagnation: None }
    }

    /// Nothing, or what does not fit.
    pub fn check(&self) -> Result<()> {
        check::at_least("generations", self.generations as usize, 1)?;
        if let Some(target) = self.target {
            check::finite("target fitness", target)?;
        }
        if let Some(stagnation) = self.stagnation {
            check::at_least("stagnation", stagnation as usize, 1)?;
        }
        Ok(())
    }

    /// Whether the target is reached or the search stagnates.
    pub fn is_early(&self, search: &Genetic) -> bool {
        let reached = |target| search.best().is_some_and(|best| best.fitness <= target);
        let stagnates = |most: u32| search.stagnation() >= u64::from(most);
        self.target.is_some_and(reached) || self.stagnation.is_some_and(stagnates)
    }
}
