//! What a robot sees of the other.

use fuzzy_core::math::{Real, atan2, wrap_angle};

use crate::vehicle::Pose;

/// What one robot perceives at a time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation<R = f64> {
    /// δ (rad): the direction from the pursuer to the evader less the own heading, in (−π, π]
    /// (6.4). For the evader too: it flees along the line of sight.
    pub angle: R,
    /// δ̇ (rad/s): the change of δ since the last step over the time step; 0 at the first step.
    pub rate: R,
    /// The distance to the other robot (m).
    pub distance: R,
    /// The other's heading less the own (rad), not brought back into one turn.
    pub heading_difference: R,
}

/// The line of sight from pursuer to evader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight<R = f64> {
    /// The evader's position as seen from the pursuer's (m).
    pub offset: (R, R),
    /// D (m) (6.7).
    pub distance: R,
    /// δ of the pursuer (rad).
    pub pursuer_angle: R,
    /// δ of the evader (rad).
    pub evader_angle: R,
}

impl<R: Real> Sight<R> {
    /// The line of sight between two poses.
    #[inline(always)]
    pub fn between(pursuer: &Pose<R>, evader: &Pose<R>) -> Self {
        let (dx, dy) = (evader.x - pursuer.x, evader.y - pursuer.y);
        let direction = atan2(dy, dx);
        Self {
            offset: (dx, dy),
            distance: dx.mul_add(dx, dy * dy).sqrt(),
            pursuer_angle: wrap_angle(direction - pursuer.heading),
            evader_angle: wrap_angle(direction - evader.heading),
        }
    }
}

/// δ̇ when the angle was `last` one time step ago; the difference is brought back into one turn
/// before it becomes a rate.
#[inline(always)]
pub fn rate<R: Real>(angle: R, last: R, time_step: f64) -> R {
    wrap_angle(angle - last) * R::splat(1.0 / time_step)
}

/// The smallest distance (m) while the evader moves along a straight line, as seen from the
/// pursuer, from one offset to another.
#[inline(always)]
pub fn nearest_approach<R: Real>(from: (R, R), to: (R, R)) -> R {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let square = dx.mul_add(dx, dy * dy);
    let along = -(from.0.mul_add(dx, from.1 * dy)) / square;
    // 0/0 is no number, where nothing moves: `max` then gives 0.
    let share = along.max(R::splat(0.0)).min(R::splat(1.0));
    let (x, y) = (dx.mul_add(share, from.0), dy.mul_add(share, from.1));
    x.mul_add(x, y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_and_rates_do_not_jump_at_half_a_turn() {
        let pursuer = Pose { x: 0.0, y: 0.0, heading: 3.0 };
        let evader = Pose { x: -1.0, y: -0.1, heading: 0.0 };
        let sight = Sight::between(&pursuer, &evader);
        let expected = (-0.1_f64).atan2(-1.0) - 3.0 + 2.0 * std::f64::consts::PI;
        assert!((sight.pursuer_angle - expected).abs() < 1e-15);
        assert!((sight.distance - 1.01_f64.sqrt()).abs() < 1e-15);
        let rate = rate(-3.1, 3.1, 0.1);
        assert!((rate - (2.0 * std::f64::consts::PI - 6.2) / 0.1).abs() < 1e-12);
    }

    #[test]
    fn the_nearest_approach_is_within_or_at_an_end() {
        let near = |from, to| nearest_approach::<f64>(from, to);
        assert!((near((-1.0, 0.1), (1.0, 0.1)) - 0.1).abs() < 1e-15);
        assert!((near((1.0, 1.0), (2.0, 3.0)) - 2.0_f64.sqrt()).abs() < 1e-15);
        assert!((near((3.0, 4.0), (3.0, 4.0)) - 5.0).abs() < 1e-15);
        assert!(near((f64::NAN, 0.0), (1.0, 0.0)).is_nan());
    }
}
