//! The Q(λ)-learning based genetic fuzzy logic controller (section 6.4).

use fuzzy_core::learn::data::DataSet;
use fuzzy_core::learn::genetic::{Elite, Genetic, SquaredError, Stop};
use fuzzy_core::{Control, Rng, check};

use super::chromosome::{decode, template};
use super::q_lambda::DURATIONS;
use super::tuning::PlayedSearch;
use super::{GeneRanges, GeneticPhase, QLambdaTraining, Trained, stream, thesis_starts};
use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::strategy::{Controller, TableController};

/// Settings of QLBGFLC: phase 1 learns a table by Q(λ), stage 1 of phase 2 fits a fuzzy
/// controller to it, stage 2 tunes the controller by playing.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | phase_1 | the Q(λ)-learning | 200 games, else as [`QLambdaTraining`] (6.5.2) |
/// | stage_1 | search for the least squared error to the greedy actions | 800 iterations of 40 (Table 6.1) |
/// | stage_2 | search for the least capture time, from the best of stage 1 | 200 iterations of 10 (Table 6.1) |
/// | prepared | whether phase 1 and stage 1 are done; if not, stage 2 begins with random controllers | true: `false` shows what they contribute |
/// | steps | time steps after which a game of stage 2 is given up | 300 (Table 6.1) |
/// | ranges | where genes are drawn from | [`GeneRanges`] |
/// | starts | positions of the evader in stage 2, one drawn for each generation | [`thesis_starts`] |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct QlbgflcTraining {
    pub phase_1: QLambdaTraining,
    pub stage_1: GeneticPhase,
    pub stage_2: GeneticPhase,
    pub prepared: bool,
    pub steps: u32,
    pub ranges: GeneRanges,
    pub starts: Vec<(f64, f64)>,
}

impl Default for QlbgflcTraining {
    fn default() -> Self {
        let phase = |iterations, population| GeneticPhase {
            iterations,
            population,
            ..GeneticPhase::default()
        };
        Self {
            phase_1: QLambdaTraining { episodes: 200, ..QLambdaTraining::default() },
            stage_1: phase(800, 40),
            stage_2: phase(200, 10),
            prepared: true,
            steps: 300,
            ranges: GeneRanges::default(),
            starts: thesis_starts(),
        }
    }
}

impl QlbgflcTraining {
    /// Learns to pursue this evader.
    pub fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        // Everything is checked before the first game, which may be hours before the last.
        let mut imitation = self.stage_1.search(&self.ranges, Rng::new(seed, stream::STAGE_1))?;
        let mut search = self.stage_2.search(&self.ranges, Rng::new(seed, stream::STAGE_2))?;
        if self.prepared {
            check::at_least(
                "individuals that stage 1 keeps for stage 2",
                imitation.settings().elite,
                self.stage_2.population,
            )?;
        }
        let games = PlayedSearch {
            game,
            evader,
            starts: &self.starts,
            steps: self.steps,
            rng: Rng::new(seed, stream::STAGE_2_STARTS),
        };
        games.check()?;

        let mut learning_time = 0.0;
        let mut history = Vec::new();
        if self.prepared {
            let (table, durations) = self.phase_1.train_table(game, evader, seed, control)?;
            let errors = self.imitate(&mut imitation, &table, control)?;
            search.start_from(imitation.elite().take(self.stage_2.population))?;
            learning_time += durations.iter().sum::<f64>();
            history.push((DURATIONS.to_owned(), durations));
            history.push(("stage 1: least mean squared error".to_owned(), errors));
        }
        let played = games.run(&mut search, self.stage_2.iterations, control, |outcome| {
            outcome.duration(game.time_step())
        })?;
        history.push(("stage 2: least capture time [s]".to_owned(), played.history));

        Ok(Trained {
            controller: Controller::Fuzzy(Box::new(played.controller)),
            learning_time: learning_time + played.learning_time,
            history,
        })
    }

    /// Stage 1: searches for controllers whose output is near the table's greedy action in every
    /// state (6.11), and returns the least error of each generation.
    fn imitate(
        &self,
        search: &mut Genetic,
        table: &TableController,
        control: &Control,
    ) -> Result<Vec<f64>> {
        let points: Vec<f64> =
            (0..table.states().states()).flat_map(|s| table.states().centre(s)).collect();
        let data = DataSet::new(2, &points, table.angles())?;
        let template = template()?;
        let decode = |genes: &[f64], parameters: &mut [f64]| {
            decode(genes, parameters);
            true
        };
        let error = SquaredError::new(template.system(), &data, decode)?;
        let stop = Stop::after(self.stage_1.iterations);
        search.run(stop, Elite::Remembered, control, |population, fitness| {
            error.evaluate(population, fitness)
        })?;
        Ok(search.history().best.clone())
    }
}
