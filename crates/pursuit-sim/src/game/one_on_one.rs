//! One pursuer, one evader.

use fuzzy_core::check;
use fuzzy_core::math::Real;

use crate::error::Result;
use crate::observation::{Observation, Sight, nearest_approach, rate};
use crate::vehicle::{Motion, Pose, Vehicle};

/// A pursuer wants to come nearer to an evader than the capture radius, the evader to prevent it.
///
/// Time is sampled: at step k both robots see the same state, then both move. The capture is
/// tested at the samples, before the move; a capture at step k has capture time k·T. What
/// counts as near is the [`Capture`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneOnOne {
    pursuer: Vehicle,
    evader: Vehicle,
    capture_radius: f64,
    time_step: f64,
    capture: Capture,
}

/// Which distance has to be smaller than the capture radius.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Capture {
    /// That at the samples: a pursuer that dashes past between two of them misses.
    Sampled,
    /// The smallest since the last sample. Between samples both robots drive straight on.
    Swept,
}

impl Capture {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sampled => "sampled",
            Self::Swept => "swept",
        }
    }

    /// The test with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::Sampled, Self::Swept];
        Ok(check::named("test of capture", name, choices, Self::name)?)
    }
}

/// Where a game begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// The pursuer's first pose.
    pub pursuer: Pose,
    /// The evader's first pose.
    pub evader: Pose,
}

impl Start {
    /// The pursuer in the origin, the evader at (x, y), both looking along the x axis.
    pub fn evader_at(x: f64, y: f64) -> Self {
        Self { pursuer: Pose { x: 0.0, y: 0.0, heading: 0.0 }, evader: Pose { x, y, heading: 0.0 } }
    }

    /// The same start, if all its numbers are finite and the headings within 2³⁰ rad, where
    /// their sines are exact.
    pub fn checked(self) -> Result<Self> {
        check_poses(&[("pursuer", self.pursuer), ("evader", self.evader)])?;
        Ok(self)
    }
}

/// Nothing, or which number of which robot's first pose no game can begin with.
pub(crate) fn check_poses(robots: &[(&str, Pose)]) -> Result<()> {
    for (who, pose) in robots {
        for (what, value) in [("x", pose.x), ("y", pose.y), ("heading", pose.heading)] {
            if !value.is_finite() {
                // Only now: words for every start would take as long as a part of its game.
                let what = format!("starting {what} of the {who}");
                return Err(fuzzy_core::Error::NotFinite { what, value }.into());
            }
        }
    }
    for (who, Pose { heading, .. }) in robots {
        if heading.abs() > MOST_TURNED {
            let what = format!("starting heading of the {who}");
            check::within(&what, *heading, "within 2³⁰ rad", |_| false)?;
        }
    }
    Ok(())
}

/// The largest heading that trigonometry takes without losing digits (rad).
pub(crate) const MOST_TURNED: f64 = 1_073_741_824.0;

impl OneOnOne {
    /// A game with a capture radius ℓ > 0 (m) and a time step T > 0 (s).
    pub fn new(
        pursuer: Vehicle,
        evader: Vehicle,
        capture_radius: f64,
        time_step: f64,
    ) -> Result<Self> {
        check::positive("capture radius", capture_radius)?;
        check::positive("time step", time_step)?;
        check::positive("sum of the robots' speeds", pursuer.speed() + evader.speed())?;
        Ok(Self { pursuer, evader, capture_radius, time_step, capture: Capture::Sampled })
    }

    /// The same game with another test of capture; [`new`](Self::new) gives the sampled one.
    pub fn with_capture(self, capture: Capture) -> Self {
        Self { capture, ..self }
    }

    /// The game of section 6.5.2: V_p = 2, V_e = 1 m/s, L = 0.3 m, |u_p| ≤ 0.5, |u_e| ≤ 1 rad,
    /// ℓ = 0.1 m, T = 0.1 s.
    pub fn thesis() -> Result<Self> {
        Self::new(Vehicle::new(2.0, 0.3, 0.5)?, Vehicle::new(1.0, 0.3, 1.0)?, 0.1, 0.1)
    }

    /// The pursuer.
    pub fn pursuer(&self) -> &Vehicle {
        &self.pursuer
    }

    /// The evader.
    pub fn evader(&self) -> &Vehicle {
        &self.evader
    }

    /// ℓ (m).
    pub fn capture_radius(&self) -> f64 {
        self.capture_radius
    }

    /// T (s).
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// How captures are tested.
    pub fn capture(&self) -> Capture {
        self.capture
    }

    /// How the pursuer and the evader move.
    #[inline(always)]
    pub(crate) fn motions(&self) -> [Motion; 2] {
        [self.pursuer, self.evader].map(|robot| robot.motion(self.time_step))
    }

    /// The distance (m) that decides on capture at a sample, when the evader was at the offset
    /// `before` at the last sample.
    #[inline(always)]
    pub fn nearness<R: Real>(&self, before: (R, R), sight: &Sight<R>) -> R {
        match self.capture {
            Capture::Sampled => sight.distance,
            Capture::Swept => nearest_approach(before, sight.offset),
        }
    }
}

/// A game, or eight, at one time step.
#[derive(Debug, Clone, Copy)]
pub struct State<R> {
    /// The pursuer's pose.
    pub pursuer: Pose<R>,
    /// The evader's pose.
    pub evader: Pose<R>,
    last_pursuer_angle: R,
    last_evader_angle: R,
}

impl State<f64> {
    /// The state at the start, where both rates are 0.
    pub fn new(start: &Start) -> Self {
        let sight = Sight::between(&start.pursuer, &start.evader);
        Self {
            pursuer: start.pursuer,
            evader: start.evader,
            last_pursuer_angle: sight.pursuer_angle,
            last_evader_angle: sight.evader_angle,
        }
    }
}

impl<R: Real> State<R> {
    /// The same state in every lane.
    pub fn splat(state: &State<f64>) -> Self {
        Self {
            pursuer: Pose::splat(state.pursuer),
            evader: Pose::splat(state.evader),
            last_pursuer_angle: R::splat(state.last_pursuer_angle),
            last_evader_angle: R::splat(state.last_evader_angle),
        }
    }

    /// Replaces one lane.
    pub fn set_lane(&mut self, lane: usize, state: &State<f64>) {
        self.pursuer.set_lane(lane, state.pursuer);
        self.evader.set_lane(lane, state.evader);
        self.last_pursuer_angle.set_lane(lane, state.last_pursuer_angle);
        self.last_evader_angle.set_lane(lane, state.last_evader_angle);
    }

    /// The line of sight.
    #[inline(always)]
    pub fn sight(&self) -> Sight<R> {
        Sight::between(&self.pursuer, &self.evader)
    }

    /// What the pursuer perceives along this line of sight.
    #[inline(always)]
    pub fn pursuer_sees(&self, sight: &Sight<R>, game: &OneOnOne) -> Observation<R> {
        Observation {
            angle: sight.pursuer_angle,
            rate: rate(sight.pursuer_angle, self.last_pursuer_angle, game.time_step),
            distance: sight.distance,
            heading_difference: self.evader.heading - self.pursuer.heading,
        }
    }

    /// What the evader perceives along this line of sight.
    #[inline(always)]
    pub fn evader_sees(&self, sight: &Sight<R>, game: &OneOnOne) -> Observation<R> {
        Observation {
            angle: sight.evader_angle,
            rate: rate(sight.evader_angle, self.last_evader_angle, game.time_step),
            distance: sight.distance,
            heading_difference: self.pursuer.heading - self.evader.heading,
        }
    }

    /// The next state, when this line of sight was seen and both robots steer so, within their
    /// limits.
    #[inline(always)]
    pub fn advance(
        &self,
        sight: &Sight<R>,
        pursuer_steering: R,
        evader_steering: R,
        game: &OneOnOne,
    ) -> Self {
        let motions = game.motions().map(Motion::splat);
        self.moved(sight, [pursuer_steering, evader_steering], &motions)
    }

    /// The next state of robots that move so, the pursuer first.
    #[inline(always)]
    pub(crate) fn moved(
        &self,
        sight: &Sight<R>,
        steering: [R; 2],
        motions: &[Motion<R>; 2],
    ) -> Self {
        Self {
            pursuer: motions[0].advance(self.pursuer, steering[0]),
            evader: motions[1].advance(self.evader, steering[1]),
            last_pursuer_angle: sight.pursuer_angle,
            last_evader_angle: sight.evader_angle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_games_are_refused_in_words() {
        let robot = Vehicle::new(1.0, 0.3, 0.5).unwrap();
        let message =
            |radius, step| OneOnOne::new(robot, robot, radius, step).unwrap_err().to_string();
        assert_eq!(message(0.0, 0.1), "capture radius must be positive, got 0");
        assert_eq!(message(0.1, 0.0), "time step must be positive, got 0");
        assert!(message(0.1, f64::NAN).contains("must be finite"));
        let parked = Vehicle::new(0.0, 0.3, 0.5).unwrap();
        assert!(OneOnOne::new(parked, parked, 0.1, 0.1).is_err());
        let start = Start::evader_at(f64::INFINITY, 0.0).checked().unwrap_err();
        assert_eq!(start.to_string(), "starting x of the evader must be finite, got inf");
    }
}
