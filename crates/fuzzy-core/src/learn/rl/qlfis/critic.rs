//! Critics: what is to be had from an observation on.

use super::settings::Tune;
use super::tuned::Tuned;
use crate::error::Result;
use crate::inference::Tsk;

/// An estimate of the discounted sum of the rewards to come, that learns by steps along its
/// eligibility traces.
///
/// A step is proposed and then accepted, so that actor and critic step together or not at all.
pub trait Critic {
    /// Whether the value depends on the action.
    const USES_ACTION: bool;

    /// How many numbers an observation has.
    fn inputs(&self) -> usize;

    /// The first observation of an episode comes next.
    fn begin_episode(&mut self);

    /// The value of acting so at an observation; its derivatives are kept for the next step.
    fn differentiate(&mut self, observation: &[f64], action: &[f64]) -> f64;

    /// The value of acting so at the observation that comes next.
    fn ahead(&mut self, observation: &[f64], action: &[f64]) -> f64;

    /// Decays the traces, adds the kept derivatives, and works out a step of the parameters by
    /// `step` times the traces (2.49, 7.12). What cannot be is the error: its largest number.
    fn propose(&mut self, decay: f64, step: f64) -> Result<(), f64>;

    /// Takes the proposed step.
    fn accept(&mut self);

    /// Ends all traces.
    fn clear_traces(&mut self);

    /// How often a parameter was kept from leaving its bounds.
    fn held(&self) -> u64;
}

/// A fuzzy system as critic. It reads what the actor reads, so what it estimates is the value of
/// the observation under the actor's present policy: the Q(s, u) of Algorithm 7.3.1, which does
/// not depend on u.
#[derive(Debug, Clone)]
pub struct FuzzyCritic(pub(super) Tuned);

impl FuzzyCritic {
    /// A critic that begins from a system's parameters.
    pub(super) fn new(system: &Tsk, tune: Tune, narrowest: f64) -> Result<Self> {
        Ok(Self(Tuned::new(system, tune, narrowest)?))
    }

    /// The system with the parameters learned so far.
    pub fn system(&self) -> Result<Tsk> {
        self.0.system()
    }
}

impl Critic for FuzzyCritic {
    const USES_ACTION: bool = false;

    fn inputs(&self) -> usize {
        self.0.inputs()
    }

    fn begin_episode(&mut self) {}

    #[inline]
    fn differentiate(&mut self, observation: &[f64], _action: &[f64]) -> f64 {
        self.0.differentiate(observation)
    }

    #[inline]
    fn ahead(&mut self, observation: &[f64], _action: &[f64]) -> f64 {
        self.0.value(observation)
    }

    #[inline]
    fn propose(&mut self, decay: f64, step: f64) -> Result<(), f64> {
        self.0.propose(decay, 1.0, step)
    }

    #[inline]
    fn accept(&mut self) {
        self.0.accept();
    }

    fn clear_traces(&mut self) {
        self.0.clear_traces();
    }

    fn held(&self) -> u64 {
        self.0.held()
    }
}
