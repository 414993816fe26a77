//! Car-like robots.

use fuzzy_core::check;
use fuzzy_core::math::{Real, sin_cos, tan};

use crate::error::Result;

/// Where a robot is and which way it looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose<R = f64> {
    /// Position (m).
    pub x: R,
    /// Position (m).
    pub y: R,
    /// Heading (rad), counter-clockwise from the x axis; not brought back into one turn.
    pub heading: R,
}

impl<R: Real> Pose<R> {
    /// The same pose in every lane.
    pub(crate) fn splat(pose: Pose) -> Self {
        Self { x: R::splat(pose.x), y: R::splat(pose.y), heading: R::splat(pose.heading) }
    }

    /// Replaces one lane.
    pub(crate) fn set_lane(&mut self, lane: usize, pose: Pose) {
        self.x.set_lane(lane, pose.x);
        self.y.set_lane(lane, pose.y);
        self.heading.set_lane(lane, pose.heading);
    }
}

/// How fast a robot drives while it steers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeedLaw {
    /// Always at its largest speed: v = V (6.1).
    Constant,
    /// The slower the more it steers: v = V cos u (4.2).
    Cosine,
}

impl SpeedLaw {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Cosine => "cosine",
        }
    }

    /// The law with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::Constant, Self::Cosine];
        Ok(check::named("speed law", name, choices, Self::name)?)
    }
}

/// A robot that steers with its front wheels (4.1, 6.1):
/// ẋ = v cos θ, ẏ = v sin θ, θ̇ = (v/L) tan u, |u| ≤ u_max, with v as its [`SpeedLaw`] says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vehicle {
    speed: f64,
    wheelbase: f64,
    max_steering: f64,
    speed_law: SpeedLaw,
}

impl Vehicle {
    /// A robot with speed V ≥ 0 (m/s), wheelbase L > 0 (m) and steering limit u_max in
    /// (0, π/2) (rad).
    pub fn new(speed: f64, wheelbase: f64, max_steering: f64) -> Result<Self> {
        check::within("speed", speed, "zero or more", |v| v >= 0.0)?;
        check::positive("wheelbase", wheelbase)?;
        check::within("steering limit", max_steering, "above 0 and below π/2", |u| {
            u > 0.0 && u < std::f64::consts::FRAC_PI_2
        })?;
        Ok(Self { speed, wheelbase, max_steering, speed_law: SpeedLaw::Constant })
    }

    /// The same robot under another speed law; [`new`](Self::new) gives a constant speed.
    pub fn with_speed_law(self, speed_law: SpeedLaw) -> Self {
        Self { speed_law, ..self }
    }

    /// The law that its speed follows.
    pub fn speed_law(&self) -> SpeedLaw {
        self.speed_law
    }

    /// V, the largest speed (m/s).
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// L (m).
    pub fn wheelbase(&self) -> f64 {
        self.wheelbase
    }

    /// u_max (rad).
    pub fn max_steering(&self) -> f64 {
        self.max_steering
    }

    /// The radius of the tightest circle, L/tan u_max (6.2) (m), the same under every speed law.
    pub fn turning_radius(&self) -> f64 {
        self.wheelbase / tan(self.max_steering)
    }

    /// Steering angles (rad) about so far from each other that a learner may choose from: an odd
    /// number, evenly spread, with 0 in the middle and the limits at the ends (Tables 8.2, 8.3).
    pub fn steering_angles(&self, step: f64) -> Result<Vec<f64>> {
        let expected = "above 0 and at most twice the steering limit (rad)";
        check::within("distance of steering angles", step, expected, |step| {
            step > 0.0 && step <= 2.0 * self.max_steering
        })?;
        let half = (self.max_steering / step).round();
        check::within("number of steering angles to one side", half, "at most 1000", |n| {
            n <= 1000.0
        })?;
        let half = half as i32;
        let angle = |k: i32| f64::from(k) / f64::from(half) * self.max_steering;
        Ok((-half..=half).map(angle).collect())
    }

    /// The steering angle that the robot can follow.
    #[inline(always)]
    pub fn limit<R: Real>(&self, steering: R) -> R {
        steering.clamp_symmetric(self.max_steering)
    }

    /// How the robot moves in time steps of this length (s).
    #[inline(always)]
    pub fn motion(&self, time_step: f64) -> Motion {
        Motion {
            way: self.speed * time_step,
            turn: self.speed * time_step / self.wheelbase,
            max_steering: self.max_steering,
            speed_law: self.speed_law,
        }
    }

    /// The pose one time step later under a steering angle within the limit.
    #[inline(always)]
    pub fn advance<R: Real>(&self, pose: Pose<R>, steering: R, time_step: f64) -> Pose<R> {
        Motion::splat(self.motion(time_step)).advance(pose, steering)
    }
}

/// One time step of a robot, or of eight: what [`Vehicle::advance`] needs, worked out once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion<R = f64> {
    /// V·T (m).
    way: R,
    /// V·T/L.
    turn: R,
    max_steering: R,
    speed_law: SpeedLaw,
}

impl<R: Real> Motion<R> {
    /// The same motion in every lane.
    #[inline(always)]
    pub(crate) fn splat(motion: Motion) -> Self {
        let Motion { way, turn, max_steering, speed_law } = motion;
        let [way, turn, max_steering] = [way, turn, max_steering].map(R::splat);
        Self { way, turn, max_steering, speed_law }
    }

    /// Replaces one lane by a robot under the same speed law.
    pub(crate) fn set_lane(&mut self, lane: usize, motion: &Motion) {
        self.way.set_lane(lane, motion.way);
        self.turn.set_lane(lane, motion.turn);
        self.max_steering.set_lane(lane, motion.max_steering);
    }

    /// The steering angle that the robot can follow.
    #[inline(always)]
    pub fn limit(&self, steering: R) -> R {
        steering.clamp_within(self.max_steering)
    }

    /// The pose one time step later under a steering angle within the limit.
    ///
    /// Semi-implicit Euler: the heading first, then the position along the *new* heading. It is
    /// the only common integrator that gives the thesis's classical capture times.
    #[inline(always)]
    pub fn advance(&self, pose: Pose<R>, steering: R) -> Pose<R> {
        let (way, turned) = match self.speed_law {
            SpeedLaw::Constant => (self.way, tan(steering)),
            SpeedLaw::Cosine => {
                // cos u · tan u is the sine, which is exact near a quarter turn too.
                let (sine, cosine) = sin_cos(steering);
                (self.way * cosine, sine)
            }
        };
        let heading = turned.mul_add(self.turn, pose.heading);
        let (sine, cosine) = sin_cos(heading);
        Pose { x: cosine.mul_add(way, pose.x), y: sine.mul_add(way, pose.y), heading }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_steering_drives_the_tightest_circle() {
        let robot = Vehicle::new(2.0, 0.3, 0.5).unwrap();
        let mut pose = Pose { x: 0.0, y: 0.0, heading: 0.0 };
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for _ in 0..20_000 {
            pose = robot.advance(pose, 0.5, 1e-4);
            (low, high) = (low.min(pose.y), high.max(pose.y));
        }
        assert!((high - low - 2.0 * robot.turning_radius()).abs() < 1e-3);
    }

    #[test]
    fn the_cosine_law_slows_the_robot_on_the_same_circle() {
        let robot = Vehicle::new(2.0, 0.3, 0.5).unwrap();
        let slowed = robot.with_speed_law(SpeedLaw::Cosine);
        let origin = Pose { x: 0.0, y: 0.0, heading: 0.0 };
        let (fast, slow) = (robot.advance(origin, 0.5, 1e-3), slowed.advance(origin, 0.5, 1e-3));
        assert!((slow.heading / fast.heading - 0.5_f64.cos()).abs() < 1e-14);
        assert!((slow.x / fast.x - 0.5_f64.cos()).abs() < 1e-5);
        assert_eq!(slowed.advance(origin, 0.0, 1e-3), robot.advance(origin, 0.0, 1e-3));
        assert_eq!(slowed.turning_radius(), robot.turning_radius());
    }

    #[test]
    fn steering_angles_are_those_of_tables_8_2_and_8_3() {
        let count = |most, step| {
            let robot = Vehicle::new(1.0, 0.3, most).unwrap();
            robot.steering_angles(step).map(|angles| angles.len()).ok()
        };
        let counts = [0.4, 0.5, 0.6, 0.8, 1.0].map(|most| count(most, 0.1).unwrap());
        assert_eq!(counts, [9, 11, 13, 17, 21]);
        let angles = Vehicle::new(1.0, 0.3, 0.25).unwrap().steering_angles(0.1).unwrap();
        assert_eq!((angles[0], angles[angles.len() / 2], angles.len()), (-0.25, 0.0, 7));
        assert_eq!((count(0.5, 1.0), count(0.5, 5.7)), (Some(3), None), "degrees are refused");
        assert_eq!((count(0.5, 0.0), count(0.5, 1e-9)), (None, None));
    }

    #[test]
    fn impossible_robots_are_refused_in_words() {
        let message = |v, l, u| Vehicle::new(v, l, u).unwrap_err().to_string();
        assert_eq!(message(-1.0, 0.3, 0.5), "speed must be zero or more, got -1");
        assert_eq!(message(1.0, 0.0, 0.5), "wheelbase must be positive, got 0");
        assert!(message(1.0, 0.3, 1.6).contains("below π/2"));
        assert!(message(f64::NAN, 0.3, 0.5).contains("must be finite"));
    }
}
