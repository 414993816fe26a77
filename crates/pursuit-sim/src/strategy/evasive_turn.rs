//! Fleeing in two parts.

use std::f64::consts::PI;

use fuzzy_core::check;
use fuzzy_core::math::{Real, wrap_angle};

use crate::error::Result;
use crate::observation::Observation;

/// The evader's strategy of chapters 4 and 6: far from the pursuer it flees along the line of
/// sight; nearer than the switching distance d it turns against the pursuer's heading,
/// u = (θ_p + π) − θ_e (4.7, 6.17), into the circle that the pursuer cannot follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EvasiveTurn {
    switching_distance: f64,
    wrapped: bool,
}

impl EvasiveTurn {
    /// A strategy that switches at d ≥ 0 (m). The angle of the turn is taken as it comes, or
    /// `wrapped` into one turn, which lets the evader choose the shorter side.
    pub fn new(switching_distance: f64, wrapped: bool) -> Result<Self> {
        check::within("switching distance", switching_distance, "zero or more", |d| d >= 0.0)?;
        Ok(Self { switching_distance, wrapped })
    }

    /// d (m).
    pub fn switching_distance(&self) -> f64 {
        self.switching_distance
    }

    /// Whether the angle of the turn is brought back into one turn.
    pub fn wrapped(&self) -> bool {
        self.wrapped
    }

    #[inline(always)]
    pub(super) fn steer<R: Real>(&self, seen: &Observation<R>) -> R {
        let turn = seen.heading_difference + R::splat(PI);
        let turn = if self.wrapped { wrap_angle(turn) } else { turn };
        let near = seen.distance.lt(R::splat(self.switching_distance));
        R::select(near, turn, seen.angle)
    }
}
