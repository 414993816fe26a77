//! The Q(λ)-learning based genetic fuzzy logic controller (section 6.4).

use fuzzy_core::learn::data::DataSet;
use fuzzy_core::learn::genetic::{Elite, Genetic, SquaredError, Stop};
use fuzzy_core::learn::rl::TableAgent;
use fuzzy_core::{Control, Rng, check};

use super::chromosome::{GENES, decode, template};
use super::coevolution::{Coevolution, Games, Pursuit};
use super::duel::Schooling;
use super::q_lambda::table;
use super::temporal::{self, EVADER, PURSUER};
use super::tuning::PlayedSearch;
use super::{
    GeneRanges, GeneticPhase, Pairing, QLambdaTraining, Technique, Trained, stream, thesis_starts,
};
use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::rollout::Outcome;
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
/// | starts | positions of the evader in stage 2 | [`thesis_starts`] |
/// | starts_per_generation | how many of them are drawn for each generation, whose individuals are judged by the mean; if both robots learn the pursuer's settings decide | 1 (section 6.4.3) |
/// | pairing | whom an individual of stage 2 meets if both robots learn; the pursuer's settings decide | [`Pairing::Best`] |
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
    pub starts_per_generation: u32,
    pub pairing: Pairing,
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
            starts_per_generation: 1,
            pairing: Pairing::Best,
        }
    }
}

impl Technique for QlbgflcTraining {
    fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        // Everything is checked before the first game, which may be hours before the last.
        let mut searches = self.searches(seed, 0)?;
        let games = self.games(game, seed);
        games.check()?;

        let (mut learning_time, mut history) = (0.0, Vec::new());
        if self.prepared {
            let (agents, played) =
                temporal::school(&self.phase_1, game, evader, seed, control)?.finished()?;
            let errors = searches.imitate(&agents, PURSUER, control)?;
            learning_time = played.time();
            history = played.histories();
            history.push((ERRORS.to_owned(), errors));
        }
        let (mut search, time_step) = (searches.stage_2, game.time_step());
        let played = PlayedSearch { games, evader }.run(
            &mut search,
            self.stage_2.iterations,
            control,
            |o| o.duration(time_step),
        )?;
        history.push((TIMES.to_owned(), played.history));

        Ok(Trained {
            controller: Controller::Fuzzy(Box::new(played.controller)),
            evader: None,
            learning_time: learning_time + played.learning_time,
            history,
        })
    }

    fn train_both(
        &self,
        evader: &Self,
        game: &OneOnOne,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        let mut searches = [self.searches(seed, 0)?, evader.searches(seed, stream::EVADERS)?];
        self.second_stage().same_as(&evader.second_stage())?;
        if self.prepared != evader.prepared {
            let what = "preparation of the evader's settings".to_owned();
            let reason = "phase 1 is done by both robots or by none".to_owned();
            return Err(fuzzy_core::Error::Unsuitable { what, reason }.into());
        }
        let breeding = Coevolution { games: self.games(game, seed), pairing: self.pairing };
        breeding.check(searches.each_ref().map(|searches| &searches.stage_2))?;

        let (mut learning_time, mut history) = (0.0, Vec::new());
        if self.prepared {
            let (agents, played) =
                temporal::school_both(&self.phase_1, &evader.phase_1, game, seed, control)?
                    .finished()?;
            let errors = searches[0].imitate(&agents.0, PURSUER, control)?;
            let others = searches[1].imitate(&agents.1, EVADER, control)?;
            learning_time = played.time();
            history = played.histories();
            history.push((ERRORS.to_owned(), errors));
            history.push((format!("evader: {ERRORS}"), others));
        }
        let searches = searches.map(|searches| searches.stage_2);
        let loss = |outcome: &Outcome| outcome.duration(game.time_step());
        let bred = breeding.run(searches, self.stage_2.iterations, control, loss)?;
        let ([controller, evader], [least, most]) = (bred.controllers, bred.history);
        history.push((TIMES.to_owned(), least));
        history.push((format!("evader: {LONGEST}"), most));

        Ok(Trained {
            controller,
            evader: Some(evader),
            learning_time: learning_time + bred.learning_time,
            history,
        })
    }
}

impl QlbgflcTraining {
    fn second_stage(&self) -> Schooling<'_> {
        Schooling { episodes: self.stage_2.iterations, steps: self.steps, starts: &self.starts }
    }

    fn games<'a>(&'a self, game: &'a OneOnOne, seed: u64) -> Games<Pursuit<'a>, 2> {
        let rng = Rng::new(seed, stream::STAGE_2_STARTS);
        let arena = Pursuit { game, starts: &self.starts };
        Games { arena, starts: self.starts_per_generation, steps: self.steps, rng }
    }

    /// The searches of both stages, before they begin.
    fn searches(&self, seed: u64, side: u64) -> Result<Searches> {
        let stage_1 = self.stage_1.search(&self.ranges, Rng::new(seed, stream::STAGE_1 + side))?;
        let stage_2 = self.stage_2.search(&self.ranges, Rng::new(seed, stream::STAGE_2 + side))?;
        let searches = Searches { stage_1, stage_2, iterations: self.stage_1.iterations };
        if self.prepared {
            searches.check()?;
        }
        Ok(searches)
    }
}

/// The genetic searches of phase 2, of which the second begins with the best of the first.
pub(super) struct Searches {
    pub stage_1: Genetic,
    pub stage_2: Genetic,
    /// Of stage 1.
    pub iterations: u32,
}

impl Searches {
    /// Nothing, or what does not fit.
    pub fn check(&self) -> Result<()> {
        check::at_least(
            "individuals that stage 1 keeps for stage 2",
            self.stage_1.settings().elite,
            self.stage_2.settings().population,
        )?;
        Ok(())
    }

    /// Stage 1 of the robot with this name: lets stage 2 begin from the best controllers, and
    /// returns the least error of each generation.
    pub fn imitate(
        &mut self,
        agent: &TableAgent,
        name: &str,
        control: &Control,
    ) -> Result<Vec<f64>> {
        let imitated = self.search(&table(agent)?, name, control)?;
        self.begin_from(&imitated)?;
        Ok(imitated.errors)
    }

    /// Searches for controllers whose output is near the table's greedy action in every state
    /// (6.11).
    pub fn search(
        &mut self,
        table: &TableController,
        name: &str,
        control: &Control,
    ) -> Result<Imitated> {
        let template = template(name)?;
        let points: Vec<f64> =
            (0..table.states().states()).flat_map(|s| table.states().centre(s)).collect();
        let data = DataSet::new(2, &points, table.angles())?;
        let decode = |genes: &[f64], parameters: &mut [f64]| {
            decode(genes, parameters);
            true
        };
        let error = SquaredError::new(template.system(), &data, decode)?;
        let (search, stop) = (&mut self.stage_1, Stop::after(self.iterations));
        search.run_below(stop, Elite::Remembered, control, |population, bar, fitness| {
            error.evaluate_below(population, bar, fitness)
        })?;
        let kept = search.elite().flatten().copied().collect();
        Ok(Imitated { errors: search.history().best.clone(), kept })
    }

    /// Lets stage 2 begin from the best of stage 1.
    pub fn begin_from(&mut self, imitated: &Imitated) -> Result<()> {
        let best = imitated.kept.chunks_exact(GENES).take(self.stage_2.settings().population);
        Ok(self.stage_2.start_from(best)?)
    }
}

/// What came of stage 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Imitated {
    /// The least error of each generation.
    pub errors: Vec<f64>,
    /// The chromosomes that were kept, best first.
    pub kept: Vec<f64>,
}

/// What the histories of phase 2 are called.
pub(super) const ERRORS: &str = "stage 1: least mean squared error";
pub(super) const TIMES: &str = "stage 2: least capture time [s]";
pub(super) const LONGEST: &str = "stage 2: largest capture time [s]";
