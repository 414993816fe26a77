//! Q(λ)-learning of the pursuer (Algorithm 6.4.1).

use fuzzy_core::learn::rl::{
    Cut, Discretiser, Exploring, TableAgent, TableAgentSettings, Ties, Trace,
};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Rng, check};

use super::duel::{Apprentice, Schooling};
use super::temporal::Temporal;
use super::thesis_starts;
use crate::error::Result;
use crate::strategy::{Controller, TableController};
use crate::vehicle::Vehicle;

/// Settings of Q(λ)-learning on a grid of states and actions.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | episodes | games played | 1000 (6.5.2; 200 as phase 1 of QLBGFLC) |
/// | steps | time steps after which a game is given up | 6000 (6.5.2) |
/// | discount | γ | 0.5 (6.5.2) |
/// | trace_decay | λ | 0.3 (6.5.2) |
/// | learning_rate, learning_rate_decay | α = rate/iᵈᵉᶜᵃʸ in game i | 1, 0.7 (6.16) |
/// | exploration, exploration_decay | ε = rate/iᵈᵉᶜᵃʸ in game i | 0.1, 1 (6.17 is lost in the scan; this reading gives the published capture times) |
/// | points | grid points of δ and of δ̇ on \[−1, 1\] | 11 (6.4.2) |
/// | actions | steering angles from −u_max to u_max | 11 (6.4.2) |
/// | ties | which of several greedy actions is taken while learning | the first, which costs least; where both robots learn, the values of many actions stay equal for long |
/// | bootstrap_at_capture | whether the value of the state after a capture counts | true: the algorithm has no terminal case, and since every step on the way is rewarded, a value of zero would punish the capture |
/// | starts | positions of the evader, drawn evenly for each game | [`thesis_starts`] |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct QLambdaTraining {
    pub episodes: u32,
    pub steps: u32,
    pub discount: f64,
    pub trace_decay: f64,
    pub learning_rate: f64,
    pub learning_rate_decay: f64,
    pub exploration: f64,
    pub exploration_decay: f64,
    pub points: usize,
    pub actions: usize,
    pub ties: Ties,
    pub bootstrap_at_capture: bool,
    pub starts: Vec<(f64, f64)>,
}

impl Default for QLambdaTraining {
    fn default() -> Self {
        Self {
            episodes: 1000,
            steps: 6000,
            discount: 0.5,
            trace_decay: 0.3,
            learning_rate: 1.0,
            learning_rate_decay: 0.7,
            exploration: 0.1,
            exploration_decay: 1.0,
            points: 11,
            actions: 11,
            ties: Ties::First,
            bootstrap_at_capture: true,
            starts: thesis_starts(),
        }
    }
}

impl Temporal for QLambdaTraining {
    type Agent = TableAgent;

    fn schooling(&self) -> Schooling<'_> {
        Schooling { episodes: self.episodes, steps: self.steps, starts: &self.starts }
    }

    fn apprentice(&self, robot: &Vehicle, _: &str, _: &mut Rng) -> Result<Apprentice<TableAgent>> {
        check::at_least("episodes", self.episodes as usize, 1)?;
        check::at_least("actions", self.actions, 2)?;
        let learning = TableLearning {
            points: self.points,
            discount: self.discount,
            trace_decay: self.trace_decay,
            learning_rate: (self.learning_rate, self.learning_rate_decay),
            exploring: match self.ties {
                Ties::First => Exploring::EpsilonGreedy,
                Ties::Random => Exploring::EpsilonGreedyRandomTies,
            },
            exploration: (self.exploration, self.exploration_decay),
            bootstrap_at_capture: self.bootstrap_at_capture,
        };
        learning.apprentice(even_angles(robot, self.actions))
    }

    fn controller(&self, agent: &TableAgent) -> Result<Controller> {
        Ok(Controller::Table(table(agent)?))
    }

    fn held(&self, _: &TableAgent) -> u64 {
        0
    }
}

/// So many steering angles from one limit to the other (rad), two at least.
pub(super) fn even_angles(robot: &Vehicle, count: usize) -> impl Iterator<Item = f64> {
    let most = robot.max_steering();
    let step = 2.0 * most / (count - 1) as f64;
    (0..count).map(move |index| index as f64 * step - most)
}

/// How a robot learns by Q(λ) on a grid of δ and δ̇, whatever it plays.
pub(super) struct TableLearning {
    /// Of δ and of δ̇, on \[−1, 1\].
    pub points: usize,
    pub discount: f64,
    pub trace_decay: f64,
    /// α = rate/iᵈᵉᶜᵃʸ in game i.
    pub learning_rate: (f64, f64),
    pub exploring: Exploring,
    /// The rate or the temperature in game i, likewise.
    pub exploration: (f64, f64),
    pub bootstrap_at_capture: bool,
}

impl TableLearning {
    /// A learner that steers by one of these angles (rad).
    pub fn apprentice(
        self,
        angles: impl IntoIterator<Item = f64>,
    ) -> Result<Apprentice<TableAgent>> {
        let axis = (-1.0, 1.0, self.points);
        let (rate, decay) = self.learning_rate;
        let (scale, power) = self.exploration;
        let agent = TableAgent::new(TableAgentSettings {
            states: Discretiser::new(&[axis, axis])?,
            actions: angles.into_iter().map(|angle| vec![angle]).collect(),
            discount: self.discount,
            trace_decay: self.trace_decay,
            trace: Trace::ReplacingState,
            cut: Cut::Never,
            learning_rate: Schedule::power("learning rate", rate, decay)?,
            exploring: self.exploring,
            exploration: Schedule::Power { scale, power },
        })?;
        let limits = (f64::INFINITY, f64::INFINITY);
        Ok(Apprentice { agent, limits, bootstrap_at_capture: self.bootstrap_at_capture })
    }
}

/// The greedy steering angle of every state (2.55).
pub(super) fn table(agent: &TableAgent) -> Result<TableController> {
    let angles = agent.greedy_actions().concat();
    TableController::new(agent.settings().states.clone(), angles)
}
