//! Genetic tuning of the fuzzy controller by playing.

use fuzzy_core::learn::genetic::{Elite, Genetic, GeneticSettings, Stop};
use fuzzy_core::{Control, Inference, Rng, check};

use super::chromosome::{GeneRanges, decode, express, template};
use super::coevolution::{Arena, Games, Pursuit};
use super::temporal::PURSUER;
use crate::error::Result;
use crate::rollout::{Entrant, Outcome};
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
    /// The share of a new generation that are mutants.
    pub mutation: f64,
    /// Whether mutants are drawn anew as a whole, as section 6.4.3 has it; if not, they are kept
    /// controllers with one gene drawn anew (Figure 2.5). Where fitness is a matter of luck, fresh
    /// ones that were lucky replace good controllers.
    pub fresh_mutants: bool,
}

impl Default for GeneticPhase {
    /// The size of the reward-based search of section 6.5.2.
    fn default() -> Self {
        Self {
            iterations: 1000,
            population: 40,
            crossover: 0.2,
            mutation: 0.1,
            fresh_mutants: true,
        }
    }
}

impl GeneticPhase {
    /// A search of this size for a controller, before it begins; says what does not fit.
    pub(super) fn search(&self, ranges: &GeneRanges, rng: Rng) -> Result<Genetic> {
        Ok(Genetic::with_rng(ranges.bounds()?, self.settings()?, rng)?)
    }

    /// What a search of this size is set to; says what does not fit.
    pub(super) fn settings(&self) -> Result<GeneticSettings> {
        check::at_least("iterations", self.iterations as usize, 1)?;
        let settings =
            GeneticSettings::with_shares(self.population, self.crossover, self.mutation)?;
        if self.fresh_mutants {
            return Ok(settings);
        }
        Ok(GeneticSettings { mutants: settings.immigrants, immigrants: 0, ..settings })
    }
}

/// A search whose individuals play (Algorithms 6.4.3 and 6.4.4).
pub(super) struct PlayedSearch<'a> {
    pub games: Games<Pursuit<'a>, 2>,
    pub evader: &'a Controller,
}

/// What [`PlayedSearch::run`] found.
pub(super) struct Played {
    pub controller: FuzzyController,
    pub learning_time: f64,
    pub history: Vec<f64>,
}

impl PlayedSearch<'_> {
    /// Runs the search; smaller `fitness` is better. The best of the last generation is returned,
    /// as in the thesis: it was best from few starts.
    pub fn run(
        mut self,
        search: &mut Genetic,
        iterations: u32,
        control: &Control,
        fitness: impl Fn(&Outcome) -> f64,
    ) -> Result<Played> {
        let template = template(PURSUER)?;
        let mut played: u64 = 0;
        let evaluate = |population: &[f64], results: &mut [f64]| -> Result<()> {
            let parameters = express(population);
            let entrants =
                [Entrant::Population(&template, &parameters), Entrant::Same(self.evader)];
            let starts = self.games.draw();
            let (reached, steps) = self.games.play(entrants, &starts, control, &fitness)?;
            results.copy_from_slice(&reached);
            played += steps;
            Ok(())
        };
        search.run(Stop::after(iterations), Elite::Reevaluated, control, evaluate)?;
        let mut parameters = template.system().parameters().to_vec();
        if let Some(leader) = search.leader() {
            decode(&leader.genes, &mut parameters);
        }
        Ok(Played {
            controller: template.with_parameters(&parameters)?,
            learning_time: played as f64 * self.games.arena.time_step(),
            history: search.history().best.clone(),
        })
    }
}
