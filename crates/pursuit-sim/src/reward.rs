//! What a pursuer is rewarded for.

use crate::game::one_on_one::OneOnOne;
use crate::vehicle::Vehicle;

/// r = (D(t) − D(t+1))/ΔD_max with ΔD_max = (V_p + V_e)·T (6.8–6.10): the way gained in one time
/// step, at most 1. The evader's reward is −r.
///
/// The sum over a game telescopes to (D(0) − D(end))/ΔD_max: it says whether the evader was
/// caught, not how fast. The *mean* over the steps does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closing {
    per_metre: f64,
}

impl Closing {
    /// The reward of this game.
    pub fn new(game: &OneOnOne) -> Self {
        Self::between(game.pursuer(), game.evader(), game.time_step())
    }

    /// The reward of this pursuer of this evader in a game with this time step (s).
    pub fn between(pursuer: &Vehicle, evader: &Vehicle, time_step: f64) -> Self {
        let most = (pursuer.speed() + evader.speed()) * time_step;
        Self { per_metre: 1.0 / most }
    }

    /// The reward of one step between these distances; the sum of many between the first and the
    /// last.
    #[inline(always)]
    pub fn reward(&self, before: f64, after: f64) -> f64 {
        (before - after) * self.per_metre
    }
}
