//! QLBGFLC for all three robots.

use fuzzy_core::learn::genetic::Genetic;
use fuzzy_core::{Control, Rng};

use super::{ROBOTS, SIDES, Surroundings, TwoPursuersQLambdaTraining, TwoPursuersTrained};
use crate::error::Result;
use crate::game::two_pursuers::{TwoPursuers, TwoPursuersStart};
use crate::rollout::two_pursuers::play_population;
use crate::rollout::{Entrant, Outcome};
use crate::strategy::FuzzyController;
use crate::training::chromosome::template;
use crate::training::coevolution::{Arena, Coevolution, Games};
use crate::training::duel::DURATIONS;
use crate::training::qlbgflc::{ERRORS, LONGEST, Searches, TIMES};
use crate::training::{GeneRanges, GeneticPhase, Pairing, Role, stream};

/// Settings of QLBGFLC for two pursuers and an evader at once: phase 1 learns a table for each by
/// Q(λ), stage 1 of phase 2 fits a fuzzy controller to each table, stage 2 tunes the three
/// controllers by playing each other.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | phase_1 | the Q(λ)-learning, and where games start | [`TwoPursuersQLambdaTraining`] |
/// | stage_1 | searches for the least squared error to the greedy actions | 1000 iterations of 100, crossover 0.2, mutation 0.3 (Table 8.1) |
/// | stage_2 | searches for the least capture time, of the evader for the largest | 500 iterations of 10, crossover 0.4, mutation 0.2 (Table 8.1; the population is lost in the scan and 10 in every other table) |
/// | steps | time steps after which a game of stage 2 is given up | 600 (Table 8.1) |
/// | ranges | where genes are drawn from | [`GeneRanges`] |
/// | starts_per_generation | from how many starts the individuals of a generation of stage 2 play; the mean counts | 4: the thesis has 1, but then who leads is luck, for a start decides more about the time than a controller does |
/// | fresh_mutants | whether mutants of stage 2 are drawn anew as a whole, as in stage 1; if not, they are kept ones with one gene drawn anew | false: fresh ones that were lucky replace good controllers |
/// | pairing | whom an individual of stage 2 meets | [`Pairing::Best`] |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct TwoPursuersQlbgflcTraining {
    pub phase_1: TwoPursuersQLambdaTraining,
    pub stage_1: GeneticPhase,
    pub stage_2: GeneticPhase,
    pub steps: u32,
    pub ranges: GeneRanges,
    pub starts_per_generation: u32,
    pub fresh_mutants: bool,
    pub pairing: Pairing,
}

impl Default for TwoPursuersQlbgflcTraining {
    fn default() -> Self {
        let phase = |iterations, population, crossover, mutation| GeneticPhase {
            iterations,
            population,
            crossover,
            mutation,
        };
        Self {
            phase_1: TwoPursuersQLambdaTraining::default(),
            stage_1: phase(1000, 100, 0.2, 0.3),
            stage_2: phase(500, 10, 0.4, 0.2),
            steps: 600,
            ranges: GeneRanges::default(),
            starts_per_generation: 4,
            fresh_mutants: false,
            pairing: Pairing::Best,
        }
    }
}

impl TwoPursuersQlbgflcTraining {
    /// All three robots learn, in the same games.
    pub fn train(
        &self,
        game: &TwoPursuers,
        seed: u64,
        control: &Control,
    ) -> Result<TwoPursuersTrained> {
        // Everything is checked before the first game.
        self.phase_1.check(game)?;
        let [first, second, evader] = SIDES;
        let mut searches = [
            self.searches(seed, first)?,
            self.searches(seed, second)?,
            self.searches(seed, evader)?,
        ];
        let arena = Hunt { game, around: self.phase_1.surroundings() };
        let rng = Rng::new(seed, stream::STAGE_2_STARTS);
        let games = Games { arena, starts: self.starts_per_generation, steps: self.steps, rng };
        let breeding = Coevolution { games, pairing: self.pairing };
        breeding.check(searches.each_ref().map(|searches| &searches.stage_2))?;

        let (agents, durations) = self.phase_1.school(game, seed, control)?;
        let schooling_time: f64 = durations.iter().sum();
        let mut history = vec![(DURATIONS.to_owned(), durations)];
        for ((searches, agent), name) in searches.iter_mut().zip(&agents).zip(ROBOTS) {
            let errors = searches.imitate(agent, name, control)?;
            history.push((format!("{name}: {ERRORS}"), errors));
        }
        let time_step = game.time_step();
        let bred = breeding.run(
            searches.map(|searches| searches.stage_2),
            self.stage_2.iterations,
            control,
            |outcome| outcome.duration(time_step),
        )?;
        for ((times, name), what) in
            bred.history.into_iter().zip(ROBOTS).zip([TIMES, TIMES, LONGEST])
        {
            history.push((format!("{name}: {what}"), times));
        }
        let learning_time = schooling_time + bred.learning_time;
        Ok(TwoPursuersTrained { controllers: bred.controllers, learning_time, history })
    }

    /// The searches of both stages for one robot, before they begin.
    fn searches(&self, seed: u64, side: u64) -> Result<Searches> {
        let stage_1 = self.stage_1.search(&self.ranges, Rng::new(seed, stream::STAGE_1 + side))?;
        let mut settings = self.stage_2.settings()?;
        if !self.fresh_mutants {
            std::mem::swap(&mut settings.mutants, &mut settings.immigrants);
        }
        let rng = Rng::new(seed, stream::STAGE_2 + side);
        let stage_2 = Genetic::with_rng(self.ranges.bounds()?, settings, rng)?;
        let searches = Searches { stage_1, stage_2, iterations: self.stage_1.iterations };
        searches.check()?;
        Ok(searches)
    }
}

/// Two pursuers that start around an evader.
struct Hunt<'a> {
    game: &'a TwoPursuers,
    around: Surroundings,
}

impl Arena<3> for Hunt<'_> {
    type Start = TwoPursuersStart;

    const ROLES: [Role; 3] = [Role::Pursuer, Role::Pursuer, Role::Evader];

    fn templates(&self) -> Result<[FuzzyController; 3]> {
        let [first, second, evader] = ROBOTS;
        Ok([template(first)?, template(second)?, template(evader)?])
    }

    fn check(&self) -> Result<()> {
        self.around.check()
    }

    fn draw(&self, rng: &mut Rng) -> TwoPursuersStart {
        self.around.draw(rng)
    }

    fn play(
        &self,
        entrants: [Entrant<'_>; 3],
        starts: &[TwoPursuersStart],
        steps: u32,
        control: &Control,
    ) -> Result<Vec<Outcome>> {
        play_population(self.game, entrants, starts, steps, control)
    }

    fn time_step(&self) -> f64 {
        self.game.time_step()
    }
}
