//! What actor-critic learners have to be told.

use serde::{Deserialize, Serialize};

use crate::check;
use crate::error::Result;
use crate::learn::schedule::Schedule;

/// Which parameters of fuzzy systems are tuned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tune {
    /// Those of the membership functions and the consequents.
    All,
    /// The consequents.
    Consequents,
}

impl Tune {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Consequents => "consequents",
        }
    }

    /// The choice with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("choice of what is tuned", name, [Self::All, Self::Consequents], Self::name)
    }
}

/// The settings of a [`TdActorCritic`](super::TdActorCritic).
///
/// Rates and noise follow the number of the episode.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TdSettings {
    /// The discount γ, in [0, 1].
    pub discount: f64,
    /// The decay λ of the critic's traces, in [0, 1].
    pub critic_trace_decay: f64,
    /// The decay of the actor's traces, in [0, 1]; at 0 it learns from the last step alone (7.14).
    pub actor_trace_decay: f64,
    /// The critic's learning rate η, in (0, 1].
    pub critic_rate: Schedule,
    /// The actor's learning rate ξ, in (0, 1].
    pub actor_rate: Schedule,
    /// The standard deviation σₙ of what exploration adds to an action, positive, in its unit.
    pub noise: Schedule,
    /// Which parameters of the fuzzy systems are tuned.
    pub tune: Tune,
    /// The least width of a tuned membership function as a share of its universe, in (0, 1].
    pub narrowest: f64,
    /// Whether traces end with their episode. The thesis ends them before the first one only.
    pub clear_traces: bool,
}

/// The thesis's rates (7.16, 7.17) for so many episodes.
fn annealed(scale: f64) -> Schedule {
    Schedule::Linear { first: scale, last: 0.1 * scale, count: 1000 }
}

impl TdSettings {
    /// QLFIS (section 7.3.1): inputs and outputs of both systems are tuned, the traces are the
    /// critic's.
    pub fn qlfis() -> Self {
        Self {
            discount: 0.95,
            critic_trace_decay: 0.9,
            actor_trace_decay: 0.0,
            critic_rate: annealed(0.1),
            actor_rate: annealed(0.01),
            noise: Schedule::Power { scale: 0.08, power: 0.0 },
            tune: Tune::All,
            narrowest: 0.01,
            clear_traces: false,
        }
    }

    /// Fuzzy actor-critic: linear in the rules' shares of the firing strength, so consequents
    /// alone are tuned, with traces of both actor and critic (2.50–2.53 carried over).
    pub fn fuzzy_actor_critic() -> Self {
        Self { actor_trace_decay: 0.9, tune: Tune::Consequents, ..Self::qlfis() }
    }

    /// The neural critic of Dai et al. as section 7.3.1 compares it: the settings of QLFIS, but
    /// noise of 0.1/i in episode i. With QLFIS's rate of the critic the network diverges; this one
    /// is a tenth.
    pub fn neural() -> Self {
        Self {
            critic_rate: annealed(0.01),
            noise: Schedule::Power { scale: 0.1, power: 1.0 },
            ..Self::qlfis()
        }
    }

    /// Nothing, if all settings are within their ranges.
    pub fn check(&self) -> Result<()> {
        check::fraction("discount", self.discount)?;
        check::fraction("trace decay of the critic", self.critic_trace_decay)?;
        check::fraction("trace decay of the actor", self.actor_trace_decay)?;
        let (expected, rate) = ("above 0 and at most 1", |rate| rate > 0.0 && rate <= 1.0);
        self.critic_rate.check("learning rate of the critic", expected, rate)?;
        self.actor_rate.check("learning rate of the actor", expected, rate)?;
        self.noise.check("noise", "positive", |noise| noise > 0.0)?;
        check::within("narrowest width", self.narrowest, expected, rate)?;
        Ok(())
    }
}
