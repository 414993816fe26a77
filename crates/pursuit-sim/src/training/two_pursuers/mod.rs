//! Two pursuers and an evader that learn at once, each from its own rewards alone (section 8.4).

mod q_lambda;
mod qlbgflc;

pub use q_lambda::TwoPursuersQLambdaTraining;
pub use qlbgflc::{TwoPursuersPrepared, TwoPursuersQlbgflcTraining};

use fuzzy_core::{Rng, check};

use super::duel::DURATIONS;
use super::stream;
use crate::error::Result;
use crate::game::two_pursuers::TwoPursuersStart;
use crate::strategy::Controller;

/// What two pursuers and an evader learned.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoPursuersTrained {
    /// The controllers of the pursuers, then the evader's.
    pub controllers: [Controller; 3],
    /// The time that the robots played while learning (s).
    pub learning_time: f64,
    /// How the learning went, by phase.
    pub history: Vec<(String, Vec<f64>)>,
    /// What QLBGFLC learned before stage 2, so that it can be done again with other settings.
    pub prepared: Option<Box<TwoPursuersPrepared>>,
}

impl TwoPursuersTrained {
    /// What was learned in games of these durations (s) and is kept in tables.
    fn by_tables(controllers: [Controller; 3], durations: Vec<f64>) -> Self {
        let learning_time = durations.iter().sum();
        let history = vec![(DURATIONS.to_owned(), durations)];
        Self { controllers, learning_time, history, prepared: None }
    }
}

/// What the robots' fuzzy systems are called.
const ROBOTS: [&str; 3] = ["first pursuer", "second pursuer", "evader"];

/// What is added to the streams of random numbers for each robot.
const SIDES: [u64; 3] = [0, stream::SECOND_PURSUERS, stream::EVADERS];

/// Where the pursuers start around the evader, which starts in the origin.
#[derive(Debug, Clone, Copy)]
struct Surroundings {
    /// Their coordinates are within ± this (m).
    spread: f64,
    /// They are no nearer than this (m).
    clearance: f64,
}

impl Surroundings {
    /// Nothing, or what does not fit.
    fn check(&self) -> Result<()> {
        check::within("spread of the starts", self.spread, "above 0 and at most 1e9", |spread| {
            spread > 0.0 && spread <= 1e9
        })?;
        let expected = format!("between 0 and the spread, {}", self.spread);
        check::within("clearance of the starts", self.clearance, &expected, |clearance| {
            (0.0..=self.spread).contains(&clearance)
        })?;
        Ok(())
    }

    /// Draws where a game begins.
    fn draw(&self, rng: &mut Rng) -> TwoPursuersStart {
        TwoPursuersStart::pursuers_at([(); 2].map(|()| self.position(rng)))
    }

    fn position(&self, rng: &mut Rng) -> (f64, f64) {
        // More than a fifth of the square lies outside any circle within it.
        loop {
            let mut coordinate = || rng.uniform_in(-self.spread, self.spread);
            let (x, y) = (coordinate(), coordinate());
            if x.mul_add(x, y * y) >= self.clearance * self.clearance {
                return (x, y);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pursuers_start_within_the_square_and_outside_the_circle() {
        let around = Surroundings { spread: 2.0, clearance: 2.0 };
        around.check().unwrap();
        let mut rng = Rng::new(1, 0);
        for _ in 0..200 {
            for pose in around.draw(&mut rng).pursuers {
                assert!(pose.x.abs() <= 2.0 && pose.y.abs() <= 2.0);
                assert!(pose.x.hypot(pose.y) >= 2.0 && pose.heading == 0.0);
            }
        }
        let crossed = Surroundings { spread: 2.0, clearance: 2.1 }.check().unwrap_err();
        assert!(crossed.to_string().contains("between 0 and the spread, 2"), "{crossed}");
        for spread in [f64::NAN, 0.0, 1e308] {
            assert!(Surroundings { spread, clearance: 0.0 }.check().is_err());
        }
    }
}
