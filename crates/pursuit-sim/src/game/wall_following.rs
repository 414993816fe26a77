//! A robot that follows a wall.

use fuzzy_core::check;

use super::one_on_one::MOST_TURNED;
use super::wall::Wall;
use crate::error::Result;
use crate::rollout::{MOST_RECORDED, seconds};
use crate::strategy::Regulator;
use crate::vehicle::{Pose, Vehicle};

/// A robot that is to keep a distance D_d to a wall by steering (section 3.2).
///
/// At each time step it measures its distance D, and a [`Regulator`] makes the steering angle of
/// the error e = D_d − D (3.2) and of ė, the error's change since the last step over the time
/// step (0 at the first). The robot drives in the direction of the wall's points, with the wall to
/// its right.
#[derive(Debug, Clone, PartialEq)]
pub struct WallFollowing {
    robot: Vehicle,
    wall: Wall,
    desired_distance: f64,
    sensor_range: f64,
    time_step: f64,
}

impl WallFollowing {
    /// A robot along a wall, with D_d > 0 (m), the range of its sensor (m), above D_d, and a time
    /// step T > 0 (s). A robot that has no wall in its range is lost.
    pub fn new(
        robot: Vehicle,
        wall: Wall,
        desired_distance: f64,
        sensor_range: f64,
        time_step: f64,
    ) -> Result<Self> {
        check::positive("desired distance", desired_distance)?;
        let expected = format!("above the desired distance, {desired_distance}");
        check::within("range of the sensor", sensor_range, &expected, |r| r > desired_distance)?;
        check::positive("time step", time_step)?;
        Ok(Self { robot, wall, desired_distance, sensor_range, time_step })
    }

    /// The robot of section 3.4 along this wall: V = 0.5 m/s, L = 0.1 m, D_d = 1 m.
    ///
    /// Not in the thesis: the steering limit of 1.2 rad, the time step of 0.1 s, the range of 10 m.
    pub fn thesis(wall: Wall) -> Result<Self> {
        Self::new(Vehicle::new(0.5, 0.1, 1.2)?, wall, 1.0, 10.0, 0.1)
    }

    /// The robot.
    pub fn robot(&self) -> &Vehicle {
        &self.robot
    }

    /// The wall.
    pub fn wall(&self) -> &Wall {
        &self.wall
    }

    /// D_d (m).
    pub fn desired_distance(&self) -> f64 {
        self.desired_distance
    }

    /// The range of the sensor (m).
    pub fn sensor_range(&self) -> f64 {
        self.sensor_range
    }

    /// T (s).
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// The distance that the robot measures; none if no wall is in range.
    #[inline]
    fn measure(&self, pose: &Pose) -> Option<f64> {
        // What is not a number is not in range.
        self.wall.distance(pose.x, pose.y).filter(|distance| distance.abs() <= self.sensor_range)
    }

    /// Lets the robot drive from a pose for so many steps, [`MOST_RECORDED`] at most, or until it
    /// is lost, and records it. At the start the wall must be in range.
    ///
    /// ```
    /// use pursuit_sim::game::wall::Wall;
    /// use pursuit_sim::strategy::{Pd, Regulator};
    /// use pursuit_sim::{Pose, WallFollowing};
    ///
    /// let plant = WallFollowing::thesis(Wall::straight()?)?;
    /// let expert = Regulator::Pd(Pd::new(1.2, 1.5)?);
    /// let run = plant.follow(&expert, Pose { x: 0.0, y: 1.5, heading: 0.0 }, 600)?;
    /// assert!(run.error[0] == -0.5 && run.error[600].abs() < 1e-6);
    /// # Ok::<(), pursuit_sim::Error>(())
    /// ```
    pub fn follow(&self, regulator: &Regulator, start: Pose, steps: u32) -> Result<WallRun> {
        check::at_least("number of steps", steps as usize, 1)?;
        check::within("number of steps of a recorded run", f64::from(steps), "at most 1e7", |n| {
            n <= f64::from(MOST_RECORDED)
        })?;
        let first = self.check_start(&start)?;
        let mut scratch = vec![0.0; regulator.scratch_count()];
        let mut run = WallRun {
            poses: vec![start],
            distance: vec![first],
            error: vec![self.desired_distance - first],
            rate: vec![0.0],
            wanted: Vec::new(),
            steering: Vec::new(),
            lost: false,
            time_step: self.time_step,
        };
        let (mut pose, mut error, mut rate) = (start, run.error[0], 0.0);
        for _ in 0..steps {
            let wanted = regulator.output(error, rate, &mut scratch);
            let steering = self.robot.limit(wanted);
            pose = self.robot.advance(pose, steering, self.time_step);
            let Some(distance) = self.measure(&pose) else {
                run.lost = true;
                break;
            };
            let last = error;
            error = self.desired_distance - distance;
            rate = (error - last) / self.time_step;
            run.wanted.push(wanted);
            run.steering.push(steering);
            run.poses.push(pose);
            run.distance.push(distance);
            run.error.push(error);
            run.rate.push(rate);
        }
        Ok(run)
    }

    /// The distance at the start, if a run can begin there.
    fn check_start(&self, start: &Pose) -> Result<f64> {
        check::finite("starting x", start.x)?;
        check::finite("starting y", start.y)?;
        check::within("starting heading", start.heading, "within 2³⁰ rad", |heading| {
            heading.abs() <= MOST_TURNED
        })?;
        let found = self.measure(start);
        Ok(found.ok_or_else(|| fuzzy_core::Error::Unsuitable {
            what: format!("a start at ({}, {})", start.x, start.y),
            reason: format!(
                "no wall is within {} m; start nearer, or widen the range",
                self.sensor_range
            ),
        })?)
    }
}

/// What happened along a wall: n + 1 samples of the states, n of what was done between them.
#[derive(Debug, Clone, PartialEq)]
pub struct WallRun {
    /// The robot's poses.
    pub poses: Vec<Pose>,
    /// D (m).
    pub distance: Vec<f64>,
    /// e (m).
    pub error: Vec<f64>,
    /// ė (m/s); 0 at the start.
    pub rate: Vec<f64>,
    /// What the regulator said (rad).
    pub wanted: Vec<f64>,
    /// The same within the robot's limit (rad).
    pub steering: Vec<f64>,
    /// Whether the robot had no wall in its range one step after the last sample; otherwise time
    /// was up.
    pub lost: bool,
    /// T (s).
    pub time_step: f64,
}

/// How well a robot kept its distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// ∫|e| dt, the integral of the absolute error (m·s).
    pub iae: f64,
    /// The mean of e² (m²).
    pub mse: f64,
    /// The largest |e| (m).
    pub max_error: f64,
}

impl WallRun {
    /// The time of the last sample (s).
    pub fn duration(&self) -> f64 {
        seconds(self.steering.len() as u32, self.time_step)
    }

    /// How well the robot kept its distance over the samples from the time `after` on (s), which
    /// leaves out the way from the start to the wall. Those of a robot that was lost are about the
    /// samples before; they say nothing beside another's.
    pub fn measures(&self, after: f64) -> Result<Measures> {
        let last = self.duration();
        let expected = format!("from 0 to {last}");
        check::within("time after which is measured", after, &expected, |after| {
            (0.0..=last).contains(&after)
        })?;
        let first = (after / self.time_step - 1e-9).ceil() as usize;
        let errors = &self.error[first.min(self.error.len() - 1)..];
        let sum = |each: fn(f64) -> f64| errors.iter().map(|&e| each(e)).sum::<f64>();
        Ok(Measures {
            iae: sum(f64::abs) * self.time_step,
            mse: sum(|e| e * e) / errors.len() as f64,
            max_error: errors.iter().fold(0.0, |most: f64, e| most.max(e.abs())),
        })
    }

    /// Whether the error was smaller than in another run over the same time, by its integral and
    /// by its mean square. A robot that was lost beats none.
    pub fn beats(&self, other: &Self) -> Result<bool> {
        let (own, others) = (self.measures(0.0)?, other.measures(0.0)?);
        Ok(!self.lost && (other.lost || own.iae < others.iae && own.mse < others.mse))
    }
}

#[cfg(test)]
mod tests {
    use super::super::wall::Sensing;
    use super::*;
    use crate::strategy::Pd;

    fn at(y: f64) -> Pose {
        Pose { x: 0.0, y, heading: 0.0 }
    }

    fn pd(proportional: f64, derivative: f64) -> Regulator {
        Regulator::Pd(Pd::new(proportional, derivative).unwrap())
    }

    #[test]
    fn the_expert_settles_without_overshoot() {
        let plant = WallFollowing::thesis(Wall::straight().unwrap()).unwrap();
        let run = plant.follow(&pd(1.2, 1.5), at(1.3), 600).unwrap();
        assert!(run.error.iter().all(|&e| e <= 1e-9) && !run.lost);
        assert_eq!((run.error.len(), run.steering.len()), (601, 600));
        assert_eq!(run.rate[0], 0.0);
        assert_eq!(run.rate[7], (run.error[7] - run.error[6]) / 0.1);
        let measures = run.measures(0.0).unwrap();
        assert!((measures.max_error - 0.3).abs() < 1e-15);
        let settled = run.measures(20.0).unwrap();
        assert!(settled.max_error < 1e-3 && settled.iae < 0.01 * measures.iae);
        assert!(run.measures(60.1).is_err() && run.measures(f64::NAN).is_err());
    }

    #[test]
    fn a_lost_robot_ends_its_run() {
        let wall = Wall::straight().unwrap();
        // The wrong sign: the robot turns away from the wall and back to it in circles.
        let plant =
            WallFollowing::new(Vehicle::new(0.5, 0.1, 0.02).unwrap(), wall, 1.0, 2.0, 0.1).unwrap();
        let run = plant.follow(&pd(-1.2, 0.0), at(1.1), 100_000).unwrap();
        assert!(run.lost && run.error.len() < 100_000);
        assert_eq!(run.poses.len(), run.error.len());
        assert!(run.distance.iter().all(|&d| d <= 2.0));
        let short = Wall::new(vec![(-1.0, 0.0), (3.0, 0.0)], Sensing::Vertical).unwrap();
        let plant = WallFollowing::thesis(short).unwrap();
        let run = plant.follow(&pd(1.2, 1.5), at(1.0), 1000).unwrap();
        assert!(run.lost);
        assert_eq!(run.duration(), 6.0);
        assert!(!run.beats(&run).unwrap());
    }

    #[test]
    fn numbers_that_overflow_lose_the_robot() {
        let robot = Vehicle::new(1e300, 1e-300, 1.2).unwrap();
        let wall = Wall::straight().unwrap();
        let plant = WallFollowing::new(robot, wall, 1.0, 10.0, 1e10).unwrap();
        let run = plant.follow(&pd(1e300, 1e300), at(1.5), 100).unwrap();
        assert!(run.lost);
        assert_eq!(run.error.len(), 1);
    }

    #[test]
    fn impossible_runs_are_refused_in_words() {
        let wall = || Wall::straight().unwrap();
        let robot = Vehicle::new(0.5, 0.1, 1.2).unwrap();
        let message = |distance, range, step| {
            WallFollowing::new(robot, wall(), distance, range, step).unwrap_err().to_string()
        };
        assert_eq!(message(0.0, 10.0, 0.1), "desired distance must be positive, got 0");
        assert!(message(1.0, 0.5, 0.1).contains("above the desired distance, 1"));
        assert_eq!(message(1.0, 10.0, -1.0), "time step must be positive, got -1");
        let plant = WallFollowing::thesis(wall()).unwrap();
        let message =
            |start, steps| plant.follow(&pd(1.0, 1.0), start, steps).unwrap_err().to_string();
        assert!(message(at(11.0), 10).contains("no wall is within 10 m"));
        assert!(message(at(f64::NAN), 10).contains("starting y must be finite"));
        assert!(message(at(1.0), 0).contains("at least 1"));
    }
}
