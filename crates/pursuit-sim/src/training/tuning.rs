//! Genetic tuning of the fuzzy controller by playing.

use fuzzy_core::learn::genetic::{Elite, Genetic, GeneticSettings, Stop};
use fuzzy_core::{Control, Inference, Rng, check};

use super::check_starts;
use super::chromosome::{GeneRanges, decode, express, template};
use super::temporal::PURSUER;
use crate::error::Result;
use crate::game::one_on_one::{OneOnOne, Start};
use crate::rollout::{Entrant, Outcome, play_population};
use crate::strategy::{Controller, FuzzyController};

/// The size of a genetic search (Table 6.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeneticPhase {
    /// Generations.
    pub iterations: u32,
    /// Individuals.
    pub population: usize,
    /// The share of a new generation bred by crossover.
    pub crossover: f64,
    /// The share of a new generation drawn at random.
    pub mutation: f64,
}

impl Default for GeneticPhase {
    /// The size of the reward-based search of section 6.5.2.
    fn default() -> Self {
        Self { iterations: 1000, population: 40, crossover: 0.2, mutation: 0.1 }
    }
}

impl GeneticPhase {
    /// A search of this size for a controller, before it begins; says what does not fit.
    pub(super) fn search(&self, ranges: &GeneRanges, rng: Rng) -> Result<Genetic> {
        check::at_least("iterations", self.iterations as usize, 1)?;
        let settings =
            GeneticSettings::with_shares(self.population, self.crossover, self.mutation)?;
        Ok(Genetic::with_rng(ranges.bounds()?, settings, rng)?)
    }
}

/// A search whose individuals play: in each generation all of them from one start, drawn evenly
/// (Algorithms 6.4.3 and 6.4.4).
pub(super) struct PlayedSearch<'a> {
    pub game: &'a OneOnOne,
    pub evader: &'a Controller,
    pub starts: &'a [(f64, f64)],
    pub steps: u32,
    pub rng: Rng,
}

/// What [`PlayedSearch::run`] found.
pub(super) struct Played {
    pub controller: FuzzyController,
    pub learning_time: f64,
    pub history: Vec<f64>,
}

impl PlayedSearch<'_> {
    /// Nothing, or what does not fit.
    pub fn check(&self) -> Result<()> {
        check::at_least("steps", self.steps as usize, 1)?;
        check_starts(self.starts)
    }

    /// Runs the search; smaller `fitness` is better. The best of the last generation is returned,
    /// as in the thesis: it was best from one start.
    pub fn run(
        mut self,
        search: &mut Genetic,
        iterations: u32,
        control: &Control,
        fitness: impl Fn(&Outcome) -> f64,
    ) -> Result<Played> {
        let template = template(PURSUER)?;
        let evader = Entrant::Same(self.evader);
        let mut played: u64 = 0;
        let evaluate = |population: &[f64], results: &mut [f64]| -> Result<()> {
            let parameters = express(population);
            let (x, y) = self.starts[self.rng.below(self.starts.len())];
            let (start, pursuers) =
                (Start::evader_at(x, y), Entrant::Population(&template, &parameters));
            let outcomes =
                play_population(self.game, pursuers, evader, &[start], self.steps, control)?;
            for (result, outcome) in results.iter_mut().zip(&outcomes) {
                *result = fitness(outcome);
                played += u64::from(outcome.steps);
            }
            Ok(())
        };
        search.run(Stop::after(iterations), Elite::Reevaluated, control, evaluate)?;
        let mut parameters = template.system().parameters().to_vec();
        if let Some(leader) = search.leader() {
            decode(&leader.genes, &mut parameters);
        }
        Ok(Played {
            controller: template.with_parameters(&parameters)?,
            learning_time: played as f64 * self.game.time_step(),
            history: search.history().best.clone(),
        })
    }
}
