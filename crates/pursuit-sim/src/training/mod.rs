//! The techniques of the thesis, one file each: a learner put to work on a game.
//!
//! Defaults are the thesis's values; what the scan lost or the text leaves open is marked where
//! it is set. Every random choice belongs to a numbered stream of the run's seed.

mod chromosome;
mod coevolution;
mod coupling;
mod dai;
mod duel;
mod ianfis;
mod igbflc;
mod imitation;
mod minimax;
mod operators;
mod practice;
mod q_lambda;
mod qlbgflc;
mod qlfis;
mod reward_ga;
mod temporal;
mod tuning;
mod two_pursuers;
mod wall_igbflc;

pub use chromosome::GeneRanges;
pub use coevolution::Pairing;
pub use coupling::{
    CoupledGame, CoupledRobotsTraining, CouplingReward, CouplingTask, CouplingTechnique,
    CouplingTraining, FirstEstimate, LearnedCoupling, PairExploration, PairwiseTraining, Steering,
};
pub use dai::DaiTraining;
pub use ianfis::IanfisTraining;
pub use igbflc::IgbflcTraining;
pub use imitation::{Lessons, Target};
pub use minimax::MinimaxQTraining;
pub use operators::Operators;
pub use practice::{Practice, Role};
pub use q_lambda::QLambdaTraining;
pub use qlbgflc::QlbgflcTraining;
pub use qlfis::QlfisTraining;
pub use reward_ga::RewardGaTraining;
pub use tuning::GeneticPhase;
pub use two_pursuers::{
    TwoPursuersPrepared, TwoPursuersQLambdaTraining, TwoPursuersQlbgflcTraining, TwoPursuersTrained,
};
pub use wall_igbflc::{WallGeneRanges, WallIgbflcTraining, WallStage, WallTrained};

use fuzzy_core::Control;

use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::strategy::Controller;

/// A technique by which robots learn from playing.
pub trait Technique {
    /// The pursuer learns, against this evader.
    fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained>;

    /// Both robots learn at once, each from its own rewards alone (6.5.4, 7.3.3): the pursuer by
    /// these settings, the evader by others. They play the same games.
    fn train_both(
        &self,
        evader: &Self,
        game: &OneOnOne,
        seed: u64,
        control: &Control,
    ) -> Result<Trained>;
}

/// What a technique learned.
#[derive(Debug, Clone, PartialEq)]
pub struct Trained {
    /// The pursuer's controller.
    pub controller: Controller,
    /// The evader's, if it learned too.
    pub evader: Option<Controller>,
    /// The time that the robots played while learning (s): equations 6.13–6.15 with k = 1.
    pub learning_time: f64,
    /// How the learning went, by phase.
    pub history: Vec<(String, Vec<f64>)>,
}

impl Trained {
    /// The games that were learned from step by step.
    pub(crate) fn games(&self) -> usize {
        self.history.iter().find(|(phase, _)| phase == duel::DURATIONS).map_or(0, |p| p.1.len())
    }
}

/// The streams of a run's seed.
mod stream {
    /// Exploration of the pursuer, and where the games start that both learn from step by step.
    pub const PURSUER: u64 = 1;
    pub const STAGE_1: u64 = 2;
    pub const STAGE_2: u64 = 3;
    pub const STAGE_2_STARTS: u64 = 4;
    pub const REWARD_GA: u64 = 5;
    pub const REWARD_GA_STARTS: u64 = 6;
    pub const IGBFLC: u64 = 7;
    pub const IANFIS: u64 = 8;
    /// What networks begin with.
    pub const FIRST_WEIGHTS: u64 = 9;
    /// Where games of two pursuers start while tables learn.
    pub const TWO_PURSUERS_STARTS: u64 = 10;
    /// What a mixed strategy draws by.
    pub const STRATEGY: u64 = 11;
    /// What is added for the evader's learning.
    pub const EVADERS: u64 = 16;
    /// And for that of a second pursuer.
    pub const SECOND_PURSUERS: u64 = 32;
    /// Which couplings are tried.
    pub const COUPLINGS: u64 = 64;
    /// Exploration of robots that are coupled; each has its own in every episode.
    pub const COUPLED: u64 = 1 << 56;
    /// Where the games start that an agent practises in; each episode has its own.
    pub const PRACTICE: u64 = 1 << 40;
    pub const PRACTICE_TESTS: u64 = 1 << 48;
    /// Of stage 1; each repetition of stage 2 has the next.
    pub const WALL_IGBFLC: u64 = 1 << 32;
}

/// The 64 positions from which the evader starts while learning: both coordinates −8, −6, −4,
/// −2, 2, 4, 6 or 8 m. The thesis says "64 different positions" (6.5) without listing them.
pub fn thesis_starts() -> Vec<(f64, f64)> {
    const COORDINATES: [f64; 8] = [-8.0, -6.0, -4.0, -2.0, 2.0, 4.0, 6.0, 8.0];
    COORDINATES.into_iter().flat_map(|x| COORDINATES.map(|y| (x, y))).collect()
}

/// Checks positions given by a caller.
fn check_starts(starts: &[(f64, f64)]) -> Result<()> {
    fuzzy_core::check::at_least("number of starting positions", starts.len(), 1)?;
    for &(x, y) in starts {
        crate::game::one_on_one::Start::evader_at(x, y).checked()?;
    }
    Ok(())
}
