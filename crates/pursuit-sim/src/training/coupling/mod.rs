//! Learning who goes for whom (section 8.5): stage one, in which couplings are tried, one for each
//! game, while the robots may learn to steer.
//!
//! In stage two each pair of the coupling that was learned is trained by a
//! [`Technique`](super::Technique) on its own game of one against one.

mod pairwise;
mod robots;
mod table;

pub use pairwise::{FirstEstimate, PairExploration, PairwiseTraining};
pub use robots::{CoupledRobotsTraining, Steering};
pub use table::{CouplingReward, CouplingTraining};

use fuzzy_core::Control;

use crate::error::Result;
use crate::game::many_on_many::{ManyOnMany, ManyStart};
use crate::rollout::{ManyOutcome, seconds};

/// What all techniques that learn a coupling are told.
#[derive(Debug, Clone, Copy)]
pub struct CouplingTask<'a> {
    /// What is played.
    pub game: &'a ManyOnMany,
    /// Where every game begins.
    pub start: &'a ManyStart,
    /// The same seed gives the same bits.
    pub seed: u64,
    /// Pairs are played on so many threads (0: one for each core); the result doesn't depend on
    /// it.
    pub threads: usize,
}

/// What was learned about couplings.
#[derive(Debug, Clone, PartialEq)]
pub struct LearnedCoupling {
    /// The evader of each pursuer in the best coupling.
    pub coupling: Vec<usize>,
    /// Of a [`CouplingTraining`] Q_CF of every coupling, in lexicographic order; of a
    /// [`PairwiseTraining`] the estimated capture time of every pair (s), pursuer by pursuer.
    pub values: Vec<f64>,
    /// How often each of these was tried.
    pub visits: Vec<u64>,
    /// The games, one for each episode.
    pub games: Vec<CoupledGame>,
    /// The time of all games (s): until the last capture of each, as all play at once.
    pub learning_time: f64,
}

/// A game that was learned from.
#[derive(Debug, Clone, PartialEq)]
pub struct CoupledGame {
    /// The evader of each pursuer.
    pub coupling: Vec<usize>,
    /// The time until the last capture, or until time was up (s).
    pub duration: f64,
    /// How many evaders were caught.
    pub captured: usize,
}

/// The games so far.
#[derive(Default)]
struct Diary {
    games: Vec<CoupledGame>,
    steps: u64,
}

impl Diary {
    fn note(&mut self, outcome: ManyOutcome, time_step: f64) {
        let (steps, captured) = (outcome.steps(), outcome.captured());
        self.steps += u64::from(steps);
        let duration = seconds(steps, time_step);
        self.games.push(CoupledGame { coupling: outcome.coupling, duration, captured });
    }

    fn learned(
        self,
        coupling: Vec<usize>,
        values: &[f64],
        visits: &[u64],
        time_step: f64,
    ) -> LearnedCoupling {
        LearnedCoupling {
            coupling,
            values: values.to_vec(),
            visits: visits.to_vec(),
            games: self.games,
            learning_time: self.steps as f64 * time_step,
        }
    }
}

/// A technique that learns a coupling.
pub trait CouplingTechnique {
    /// Plays games from one start, and learns who should go for whom.
    fn learn(&self, task: &CouplingTask<'_>, control: &Control) -> Result<LearnedCoupling>;
}
