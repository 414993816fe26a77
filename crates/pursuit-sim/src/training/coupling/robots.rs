//! The robots of stage one: each learns to steer at its own partner by Q(λ), whoever that is.

use std::collections::BTreeMap;

use fuzzy_core::learn::coupling::check_coupling;
use fuzzy_core::learn::rl::{Exploring, TableAgent};
use fuzzy_core::{Control, Rng, check, parallel};

use super::CouplingTask;
use crate::error::{Error, Result};
use crate::game::one_on_one::{OneOnOne, Start};
use crate::rollout::{Crew, ManyOutcome, Outcome, play_some};
use crate::strategy::Controller;
use crate::training::duel::{Apprentice, Duel, Seat};
use crate::training::q_lambda::TableLearning;
use crate::training::stream;
use crate::vehicle::Vehicle;

/// How robots steer while couplings are learned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Steering {
    /// They learn by Q(λ), exploring by softmax.
    Softmax,
    /// They learn by Q(λ), exploring ε-greedily.
    EpsilonGreedy,
    /// They don't learn: straight towards and away.
    Classical,
}

impl Steering {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Softmax => "softmax",
            Self::EpsilonGreedy => "epsilon-greedy",
            Self::Classical => "classical",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::Softmax, Self::EpsilonGreedy, Self::Classical];
        Ok(check::named("way to steer", name, choices, Self::name)?)
    }
}

/// Settings of the robots in stage one (Tables 8.2 to 8.4, 8.7 and 8.11).
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | steering | whether and how they explore | softmax (8.5.3) |
/// | discount | γ | 0.5; the scan has "Oi" for n = 2, which is 0.8 or 0.9, and 0.9 for n = 3 |
/// | trace_decay | λ | 0.3 (Table 8.7) |
/// | learning_rate, learning_rate_decay | α = rate/mᵈᵉᶜᵃʸ in episode m | 1, 0.7 (Table 8.7) |
/// | exploration, exploration_decay | θ or ε = rate/mᵈᵉᶜᵃʸ in episode m | 1, 1; the thesis has θ = 1 in all episodes, under which the robots stay nearly random |
/// | points | grid points of δ and of δ̇ on \[−1, 1\] | 11 (8.5.1) |
/// | action_step | distance of the steering angles (rad), from −u_max to u_max; rounded so that they are evenly spread | 0.1 (8.5.1) |
/// | bootstrap_at_capture | whether the value of the state after a capture counts | true, as in [`QLambdaTraining`](crate::training::QLambdaTraining) |
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub struct CoupledRobotsTraining {
    pub steering: Steering,
    pub discount: f64,
    pub trace_decay: f64,
    pub learning_rate: f64,
    pub learning_rate_decay: f64,
    pub exploration: f64,
    pub exploration_decay: f64,
    pub points: usize,
    pub action_step: f64,
    pub bootstrap_at_capture: bool,
}

impl Default for CoupledRobotsTraining {
    fn default() -> Self {
        Self {
            steering: Steering::Softmax,
            discount: 0.5,
            trace_decay: 0.3,
            learning_rate: 1.0,
            learning_rate_decay: 0.7,
            exploration: 1.0,
            exploration_decay: 1.0,
            points: 11,
            action_step: 0.1,
            bootstrap_at_capture: true,
        }
    }
}

impl CoupledRobotsTraining {
    fn apprentice(&self, robot: &Vehicle, exploring: Exploring) -> Result<Apprentice<TableAgent>> {
        let learning = TableLearning {
            points: self.points,
            discount: self.discount,
            trace_decay: self.trace_decay,
            learning_rate: (self.learning_rate, self.learning_rate_decay),
            exploring,
            exploration: (self.exploration, self.exploration_decay),
            bootstrap_at_capture: self.bootstrap_at_capture,
        };
        learning.apprentice(robot.steering_angles(self.action_step)?)
    }
}

/// A robot that learns; nothing while it plays on some thread.
type Learner = Option<Apprentice<TableAgent>>;

/// All robots of a game in stage one.
pub(super) enum Robots {
    /// They learn nothing, so a pair would play the same game again: how it ended, by pursuer and
    /// evader.
    Classical(BTreeMap<(usize, usize), Outcome>),
    Learning {
        pursuers: Vec<Learner>,
        evaders: Vec<Learner>,
    },
}

impl Robots {
    pub fn new(settings: &CoupledRobotsTraining, task: &CouplingTask<'_>) -> Result<Self> {
        let exploring = match settings.steering {
            Steering::Classical => return Ok(Self::Classical(BTreeMap::new())),
            Steering::Softmax => Exploring::Softmax,
            Steering::EpsilonGreedy => Exploring::EpsilonGreedy,
        };
        let crew = |robots: &[Vehicle]| -> Result<Vec<Learner>> {
            robots.iter().map(|robot| settings.apprentice(robot, exploring).map(Some)).collect()
        };
        let (pursuers, evaders) = (crew(task.game.pursuers())?, crew(task.game.evaders())?);
        Ok(Self::Learning { pursuers, evaders })
    }

    /// Lets all pairs of a coupling play the game of an episode, 1, 2, …
    pub fn play(
        &mut self,
        task: &CouplingTask<'_>,
        coupling: &[usize],
        episode: u32,
        steps: u32,
        control: &Control,
    ) -> Result<ManyOutcome> {
        let CouplingTask { game, start, seed, threads } = *task;
        check_coupling(coupling, game.size())?;
        let (pursuers, evaders) = match self {
            Self::Learning { pursuers, evaders } => (pursuers, evaders),
            Self::Classical(played) => {
                let pairs = coupling.iter().copied().enumerate();
                let new: Vec<_> = pairs.clone().filter(|pair| !played.contains_key(pair)).collect();
                let crews = [Crew::Same(&Controller::Classical); 2];
                let ends = play_some(game, &new, start, crews, steps, threads, control)?;
                control.advance((coupling.len() - new.len()) as u64)?;
                played.extend(new.into_iter().zip(ends));
                let pairs = pairs.filter_map(|pair| played.get(&pair).copied()).collect();
                return Ok(ManyOutcome { coupling: coupling.to_vec(), pairs });
            }
        };
        let mut jobs = Vec::with_capacity(coupling.len());
        for (index, &partner) in coupling.iter().enumerate() {
            jobs.push(Job {
                game: game.pair(index, partner)?,
                start: start.pair(index, partner),
                robots: (pursuers[index].take(), evaders[partner].take()),
                rngs: [2 * index, 2 * partner + 1].map(|robot| {
                    Rng::new(seed, stream::COUPLED + (u64::from(episode) << 24) + robot as u64)
                }),
            });
        }
        let played = parallel::map(threads, jobs, |job| job.play(episode, steps, control))?;
        let mut pairs = Vec::with_capacity(coupling.len());
        for (index, ((pursuer, evader), outcome)) in played.into_iter().enumerate() {
            (pursuers[index], evaders[coupling[index]]) = (pursuer, evader);
            pairs.push(outcome);
        }
        Ok(ManyOutcome { coupling: coupling.to_vec(), pairs })
    }
}

/// The game of one pair.
struct Job {
    game: OneOnOne,
    start: Start,
    robots: (Learner, Learner),
    /// Of the pursuer and of the evader: a stream for each robot and episode.
    rngs: [Rng; 2],
}

impl Job {
    fn play(
        mut self,
        episode: u32,
        steps: u32,
        control: &Control,
    ) -> Result<((Learner, Learner), Outcome)> {
        let (Some(pursuer), Some(evader)) = (&mut self.robots.0, &mut self.robots.1) else {
            return Err(Error::Core(fuzzy_core::Error::OutOfOrder("a robot plays twice at once")));
        };
        pursuer.begin(u64::from(episode));
        evader.begin(u64::from(episode));
        let duel = Duel { game: &self.game, start: self.start, steps };
        let outcome = duel.play(&mut (pursuer, evader), &mut self.rngs, control)?;
        control.advance(1)?;
        Ok((self.robots, outcome))
    }
}
