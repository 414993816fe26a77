//! QLBGFLC for all three robots.

use fuzzy_core::{Control, Error, Rng};

use super::{ROBOTS, SIDES, Surroundings, TwoPursuersQLambdaTraining, TwoPursuersTrained};
use crate::error::Result;
use crate::game::two_pursuers::{TwoPursuers, TwoPursuersStart};
use crate::rollout::two_pursuers::play_population;
use crate::rollout::{Entrant, Outcome};
use crate::strategy::{Controller, FuzzyController, TableController};
use crate::training::chromosome::template;
use crate::training::coevolution::{Arena, Coevolution, Games};
use crate::training::duel::DURATIONS;
use crate::training::q_lambda::table;
use crate::training::qlbgflc::{ERRORS, Imitated, LONGEST, Searches, TIMES};
use crate::training::{GeneRanges, GeneticPhase, Pairing, Role, stream};

/// Settings of QLBGFLC for two pursuers and an evader at once: phase 1 learns a table for each by
/// Q(λ), stage 1 of phase 2 fits a fuzzy controller to each table, stage 2 tunes the three
/// controllers by playing each other.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | phase_1 | the Q(λ)-learning, and where games start | [`TwoPursuersQLambdaTraining`] |
/// | stage_1 | searches for the least squared error to the greedy actions | 1000 iterations of 100, crossover 0.2, mutation 0.3 (Table 8.1) |
/// | stage_2 | searches for the least capture time, of the evader for the largest | 500 iterations of 10, crossover 0.4, mutation 0.2 (Table 8.1; the population is lost in the scan and 10 in every other table), without fresh mutants |
/// | steps | time steps after which a game of stage 2 is given up | 600 (Table 8.1) |
/// | ranges | where genes are drawn from | [`GeneRanges`] |
/// | starts_per_generation | from how many starts the individuals of a generation of stage 2 play; the mean counts | 4: the thesis has 1, but then who leads is luck, for a start decides more about the time than a controller does |
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
    pub pairing: Pairing,
}

impl Default for TwoPursuersQlbgflcTraining {
    fn default() -> Self {
        Self {
            phase_1: TwoPursuersQLambdaTraining::default(),
            stage_1: GeneticPhase {
                iterations: 1000,
                population: 100,
                crossover: 0.2,
                mutation: 0.3,
                fresh_mutants: true,
            },
            stage_2: GeneticPhase {
                iterations: 500,
                population: 10,
                crossover: 0.4,
                mutation: 0.2,
                fresh_mutants: false,
            },
            steps: 600,
            ranges: GeneRanges::default(),
            starts_per_generation: 4,
            pairing: Pairing::Best,
        }
    }
}

/// What phase 1 and stage 1 learned, with which stage 2 begins.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoPursuersPrepared {
    game: TwoPursuers,
    seed: u64,
    phase_1: TwoPursuersQLambdaTraining,
    stage_1: GeneticPhase,
    ranges: GeneRanges,
    tables: [TableController; 3],
    durations: Vec<f64>,
    imitated: [Imitated; 3],
}

impl TwoPursuersPrepared {
    /// The tables of phase 1, as [`TwoPursuersQLambdaTraining`] alone learns them.
    pub fn tables(&self) -> TwoPursuersTrained {
        let tables = self.tables.clone().map(Controller::Table);
        TwoPursuersTrained::by_tables(tables, self.durations.clone())
    }
}

/// The searches of the robots, and the games of stage 2.
type Searching<'a> = ([Searches; 3], Coevolution<Hunt<'a>, 3>);

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
        let (mut searches, breeding) = self.searching(game, seed)?;
        let (agents, durations) = self.phase_1.school(game, seed, control)?;
        let [first, second, evader] = &agents;
        let tables = [table(first)?, table(second)?, table(evader)?];
        let [one, two, three] = &mut searches;
        let imitated = [
            one.search(&tables[0], ROBOTS[0], control)?,
            two.search(&tables[1], ROBOTS[1], control)?,
            three.search(&tables[2], ROBOTS[2], control)?,
        ];
        let prepared = TwoPursuersPrepared {
            game: *game,
            seed,
            phase_1: self.phase_1.clone(),
            stage_1: self.stage_1,
            ranges: self.ranges,
            tables,
            durations,
            imitated,
        };
        self.tune((searches, breeding), &prepared, control)
    }

    /// The same as [`train`](Self::train), where another training of the game with this seed did
    /// phase 1 and stage 1 with the same settings: they are not done again.
    ///
    /// ```
    /// use fuzzy_core::Control;
    /// use pursuit_sim::TwoPursuers;
    /// use pursuit_sim::training::{TwoPursuersQLambdaTraining, TwoPursuersQlbgflcTraining};
    ///
    /// let mut settings = TwoPursuersQlbgflcTraining::default();
    /// settings.phase_1.episodes = 20;
    /// (settings.stage_1.iterations, settings.stage_2.iterations) = (20, 5);
    /// let (game, control) = (TwoPursuers::thesis()?, Control::new());
    /// let first = settings.train(&game, 7, &control)?;
    /// settings.starts_per_generation = 1;
    /// let prepared = first.prepared.as_ref().ok_or("QLBGFLC prepares stage 2")?;
    /// let second = settings.train_from(prepared, &game, 7, &control)?;
    /// assert_eq!(second, settings.train(&game, 7, &control)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn train_from(
        &self,
        prepared: &TwoPursuersPrepared,
        game: &TwoPursuers,
        seed: u64,
        control: &Control,
    ) -> Result<TwoPursuersTrained> {
        let differs = if prepared.game != *game {
            "game"
        } else if prepared.seed != seed {
            "seed"
        } else if prepared.phase_1 != self.phase_1 {
            "phase 1"
        } else if prepared.stage_1 != self.stage_1 {
            "stage 1"
        } else if prepared.ranges != self.ranges {
            "ranges"
        } else {
            return self.tune(self.searching(game, seed)?, prepared, control);
        };
        let what = "training to begin from".to_owned();
        let reason = format!("its {differs} must be the same as this one's");
        Err(Error::Unsuitable { what, reason }.into())
    }

    /// Stage 2.
    fn tune(
        &self,
        (mut searches, breeding): Searching<'_>,
        prepared: &TwoPursuersPrepared,
        control: &Control,
    ) -> Result<TwoPursuersTrained> {
        let mut history = vec![(DURATIONS.to_owned(), prepared.durations.clone())];
        for ((searches, imitated), name) in searches.iter_mut().zip(&prepared.imitated).zip(ROBOTS)
        {
            searches.begin_from(imitated)?;
            history.push((format!("{name}: {ERRORS}"), imitated.errors.clone()));
        }
        let time_step = prepared.game.time_step();
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
        let learning_time = prepared.durations.iter().sum::<f64>() + bred.learning_time;
        Ok(TwoPursuersTrained {
            controllers: bred.controllers,
            learning_time,
            history,
            prepared: Some(Box::new(prepared.clone())),
        })
    }

    /// The searches before they begin, and the games of stage 2; says what does not fit.
    fn searching<'a>(&self, game: &'a TwoPursuers, seed: u64) -> Result<Searching<'a>> {
        let [first, second, evader] = SIDES;
        let searches = [
            self.searches(seed, first)?,
            self.searches(seed, second)?,
            self.searches(seed, evader)?,
        ];
        let arena = Hunt { game, around: self.phase_1.surroundings() };
        let rng = Rng::new(seed, stream::STAGE_2_STARTS);
        let games = Games { arena, starts: self.starts_per_generation, steps: self.steps, rng };
        let breeding = Coevolution { games, pairing: self.pairing };
        breeding.check(searches.each_ref().map(|searches| &searches.stage_2))?;
        Ok((searches, breeding))
    }

    /// The searches of both stages for one robot, before they begin.
    fn searches(&self, seed: u64, side: u64) -> Result<Searches> {
        let stage_1 = self.stage_1.search(&self.ranges, Rng::new(seed, stream::STAGE_1 + side))?;
        let stage_2 = self.stage_2.search(&self.ranges, Rng::new(seed, stream::STAGE_2 + side))?;
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
