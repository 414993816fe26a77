//! What the loops over games and environments drive.

use crate::error::Result;
use crate::rng::Rng;

/// A learner that acts: it observes, acts, is rewarded, and learns from that.
///
/// Whoever drives it calls [`begin_episode`](Self::begin_episode), [`act`](Self::act) at the first
/// observation, and then for each step of the world [`learn`](Self::learn) and, unless the episode
/// is over, `act` at the observation that was learned from. Observations must be finite and have
/// [`inputs`](Self::inputs) numbers; callers check that, loops have no time to.
pub trait Agent {
    /// How many numbers an observation has.
    fn inputs(&self) -> usize;

    /// How many numbers an action has.
    fn outputs(&self) -> usize;

    /// Begins episode i = 1, 2, …, on which learning and exploration rates may depend.
    fn begin_episode(&mut self, episode: u64);

    /// The action at an observation, exploration included.
    fn act(&mut self, observation: &[f64], action: &mut [f64], rng: &mut Rng);

    /// The action at an observation without exploration.
    fn exploit(&mut self, observation: &[f64], action: &mut [f64]);

    /// Learns from the last action's reward and the observation that it led to; returns the TD
    /// error. `continues` says whether the value of what was reached counts: not after an end at
    /// which nothing more can be had.
    ///
    /// An error, of a reward that is not finite or a step that would not be, leaves what was
    /// learned as it was.
    fn learn(&mut self, reward: f64, next: &[f64], continues: bool, rng: &mut Rng) -> Result<f64>;
}

impl<A: Agent> Agent for &mut A {
    fn inputs(&self) -> usize {
        A::inputs(self)
    }

    fn outputs(&self) -> usize {
        A::outputs(self)
    }

    fn begin_episode(&mut self, episode: u64) {
        A::begin_episode(self, episode);
    }

    #[inline]
    fn act(&mut self, observation: &[f64], action: &mut [f64], rng: &mut Rng) {
        A::act(self, observation, action, rng);
    }

    fn exploit(&mut self, observation: &[f64], action: &mut [f64]) {
        A::exploit(self, observation, action);
    }

    #[inline]
    fn learn(&mut self, reward: f64, next: &[f64], continues: bool, rng: &mut Rng) -> Result<f64> {
        A::learn(self, reward, next, continues, rng)
    }
}
