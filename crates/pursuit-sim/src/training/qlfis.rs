//! The Q(λ)-learning fuzzy inference system (chapter 7).

use std::f64::consts::PI;

use fuzzy_core::learn::rl::{Qlfis, TdSettings, Tune};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Rng, Tsk};

use super::chromosome::{RULES, nine_rules};
use super::duel::{Apprentice, Schooling};
use super::temporal::Temporal;
use super::thesis_starts;
use crate::error::Result;
use crate::strategy::{Controller, FuzzyController};
use crate::vehicle::Vehicle;

/// Settings of QLFIS: a fuzzy critic learns the value of δ and δ̇, a fuzzy actor to steer.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | episodes | games played; after none, the controller is the first one | 1000 (7.3.1) |
/// | steps | time steps after which a game is given up | 600 (7.3.1) |
/// | discount | γ | 0.95 (7.3.1) |
/// | trace_decay | λ of the critic | 0.9 (7.3.1) |
/// | critic_rate | η before the first game and in the last, falling along a line | 0.1, 0.01 (7.16 is lost in the scan; the text says ten times ξ) |
/// | actor_rate | ξ, the same | 0.01, 0.001 (7.17) |
/// | noise, noise_decay | σₙ = noise/iᵈᵉᶜᵃʸ (rad) in game i | 0.08, 0 (7.3.1) |
/// | tune | whether Gaussians learn too, or consequents alone | [`Tune::All`] |
/// | narrowest | the least width of a Gaussian that learns, as a share of its universe, ±1; means stay within it | 0.01; both ours. With free means 94 instead of 100 of 100 seeds come within 1 s of the classical times |
/// | width | the first width of the Gaussians, whose means are −1, 0 and 1 | 0.42; Figure 7.2 is lost in the scan. From 0.25 to 0.45 the first controller doesn't catch the evader, as the text says |
/// | angle_limit, rate_limit | what δ (rad) and δ̇ (rad/s) are held within | π, which is no limit, and 1; ours |
/// | bootstrap_at_capture | whether the value of the state after a capture counts | true: the algorithm has no terminal case, and since every step on the way is rewarded, a value of zero would punish the capture |
/// | starts | positions of the evader, drawn evenly for each game | [`thesis_starts`] |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct QlfisTraining {
    pub episodes: u32,
    pub steps: u32,
    pub discount: f64,
    pub trace_decay: f64,
    pub critic_rate: (f64, f64),
    pub actor_rate: (f64, f64),
    pub noise: f64,
    pub noise_decay: f64,
    pub tune: Tune,
    pub narrowest: f64,
    pub width: f64,
    pub angle_limit: f64,
    pub rate_limit: f64,
    pub bootstrap_at_capture: bool,
    pub starts: Vec<(f64, f64)>,
}

impl Default for QlfisTraining {
    fn default() -> Self {
        Self {
            episodes: 1000,
            steps: 600,
            discount: 0.95,
            trace_decay: 0.9,
            critic_rate: (0.1, 0.01),
            actor_rate: (0.01, 0.001),
            noise: 0.08,
            noise_decay: 0.0,
            tune: Tune::All,
            narrowest: 0.01,
            width: 0.42,
            angle_limit: PI,
            rate_limit: 1.0,
            bootstrap_at_capture: true,
            starts: thesis_starts(),
        }
    }
}

/// The first consequents (Table 7.1), as shares of the steering limit.
///
/// The table is the pursuer's, whose limit is 0.5 rad. That the evader begins with the same shares
/// of its own limit, 1 rad, is our reading: where Table 7.1 has 0.25, the evader's tuned table has
/// 0.47 to 0.55 (Table 7.5).
const TABLE_7_1: [f64; RULES] = [-1.0, -0.5, 0.0, -0.5, 0.0, 0.5, 0.0, 0.5, 1.0];

impl QlfisTraining {
    pub(super) fn first_actor(&self, robot: &Vehicle, name: &str) -> Result<Tsk> {
        let consequents = TABLE_7_1.map(|share| share * robot.max_steering());
        nine_rules(name, self.width, consequents.to_vec())
    }

    /// What the learner is told.
    pub(super) fn settings(&self) -> Result<TdSettings> {
        let annealed = |what, (first, last)| {
            Schedule::linear(what, first, last, u64::from(self.episodes.max(1)))
        };
        Ok(TdSettings {
            discount: self.discount,
            critic_trace_decay: self.trace_decay,
            critic_rate: annealed("learning rate of the critic", self.critic_rate)?,
            actor_rate: annealed("learning rate of the actor", self.actor_rate)?,
            noise: Schedule::Power { scale: self.noise, power: self.noise_decay },
            tune: self.tune,
            narrowest: self.narrowest,
            ..TdSettings::qlfis()
        })
    }

    /// A learner that sees what these settings let it see.
    pub(super) fn seat<A>(&self, agent: A, [actor]: [Tsk; 1]) -> Result<Apprentice<A>> {
        // Checks the limits, before the games and not after.
        self.limited(actor)?;
        Ok(Apprentice {
            agent,
            limits: (self.angle_limit, self.rate_limit),
            bootstrap_at_capture: self.bootstrap_at_capture,
        })
    }

    /// A controller with the limits of these settings.
    pub(super) fn limited(&self, system: Tsk) -> Result<FuzzyController> {
        FuzzyController::new(system, self.angle_limit, self.rate_limit)
    }
}

impl Temporal for QlfisTraining {
    type Agent = Qlfis;

    fn schooling(&self) -> Schooling<'_> {
        Schooling { episodes: self.episodes, steps: self.steps, starts: &self.starts }
    }

    fn apprentice(&self, robot: &Vehicle, name: &str, _: &mut Rng) -> Result<Apprentice<Qlfis>> {
        let actor = [self.first_actor(robot, name)?];
        let critic = nine_rules("critic", self.width, vec![0.0; RULES])?;
        self.seat(Qlfis::fuzzy(&actor, &critic, self.settings()?)?, actor)
    }

    fn controller(&self, agent: &Qlfis) -> Result<Controller> {
        let actor = agent.actors()?.swap_remove(0);
        Ok(Controller::Fuzzy(Box::new(self.limited(actor)?)))
    }

    fn held(&self, agent: &Qlfis) -> u64 {
        agent.held()
    }
}
