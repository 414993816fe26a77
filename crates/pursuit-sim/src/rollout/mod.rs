//! Playing games: one with its whole path, or many for their outcomes.

mod coupled;
mod entrant;
mod lanes;
mod many;
mod single;
pub mod two_pursuers;

pub(crate) use coupled::play_some;
pub use coupled::{Crew, ManyOutcome, capture_times, play_coupled, record_coupled};
pub use entrant::Entrant;
pub use many::{play_many, play_pairs, play_population};
pub(crate) use single::drive;
pub use single::{MOST_RECORDED, Trajectory, play};

/// What is no longer finite when a game diverges.
pub(crate) const DISTANCE: &str = "the distance between the robots";

/// Games are asked whether they should stop once in so many steps.
pub(crate) const STEPS_BETWEEN_CHECKS: u64 = 4096;

/// The time of so many steps (s). The product is cleared of the rounding error of decimal time
/// steps, so that 96 steps of 0.1 s are 9.6 s.
pub fn seconds(steps: u32, time_step: f64) -> f64 {
    let product = f64::from(steps) * time_step;
    let rounded = (product * 1e9).round() / 1e9;
    if (rounded - product).abs() <= 4.0 * f64::EPSILON * product { rounded } else { product }
}

/// How a game ended.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Outcome {
    /// Whether the evader was caught; otherwise time was up.
    pub captured: bool,
    /// Time steps played.
    pub steps: u32,
    /// The distance at the start (m).
    pub first_distance: f64,
    /// The distance at the end (m).
    pub last_distance: f64,
    /// The smallest distance at any sample (m); of a swept capture also between them.
    pub miss_distance: f64,
}

impl Outcome {
    /// The time played (s).
    pub fn duration(&self, time_step: f64) -> f64 {
        seconds(self.steps, time_step)
    }

    /// The time at which the evader was caught (s), if it was.
    pub fn capture_time(&self, time_step: f64) -> Option<f64> {
        self.captured.then(|| self.duration(time_step))
    }
}
