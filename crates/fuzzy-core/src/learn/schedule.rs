//! Rates that change from episode to episode.

use serde::{Deserialize, Serialize};

use crate::check;
use crate::error::Result;
use crate::math::powf;

/// A rate that falls with a count i = 1, 2, …: of episodes, or of visits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Schedule {
    /// scale/iᵖ: constant for p = 0.
    Power {
        /// The first rate.
        scale: f64,
        /// p.
        power: f64,
    },
    /// first + (last − first)·i/count up to i = count, then `last` (7.16, 7.17).
    Linear {
        /// The rate that would belong to i = 0.
        first: f64,
        /// The rate from i = count on.
        last: f64,
        /// How long it takes.
        count: u64,
    },
}

impl Schedule {
    /// scale/iᵖ; the scale lies in [0, 1], the power is not negative.
    pub fn power(what: &str, scale: f64, power: f64) -> Result<Self> {
        let schedule = Self::Power { scale, power };
        schedule.check(what, "between 0 and 1", |rate| (0.0..=1.0).contains(&rate))?;
        Ok(schedule)
    }

    /// From `first` to `last`, both in [0, 1], within `count` counts, 1 at least.
    pub fn linear(what: &str, first: f64, last: f64, count: u64) -> Result<Self> {
        let schedule = Self::Linear { first, last, count };
        schedule.check(what, "between 0 and 1", |rate| (0.0..=1.0).contains(&rate))?;
        Ok(schedule)
    }

    /// Nothing, if the schedule makes sense and the condition holds for its rates; `expected` says
    /// the condition in words.
    pub fn check(&self, what: &str, expected: &str, condition: impl Fn(f64) -> bool) -> Result<()> {
        match *self {
            Self::Power { scale, power } => {
                check::within(what, scale, expected, condition)?;
                check::within(&format!("decay of the {what}"), power, "zero or more", |p| {
                    p >= 0.0
                })?;
            }
            Self::Linear { first, last, count } => {
                check::within(&format!("first {what}"), first, expected, &condition)?;
                check::within(&format!("last {what}"), last, expected, condition)?;
                check::at_least(&format!("duration of the {what}"), count as usize, 1)?;
            }
        }
        Ok(())
    }

    /// The rate at a count, from 1 on.
    pub fn at(&self, count: u64) -> f64 {
        match *self {
            Self::Power { scale, power: 0.0 } => scale,
            Self::Power { scale, power } => scale * powf(1.0 / count.max(1) as f64, power),
            Self::Linear { last, count: end, .. } if count >= end => last,
            Self::Linear { first, last, count: end } => {
                (count as f64 / end as f64).mul_add(last - first, first)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_fall_as_a_power() {
        let rate = Schedule::power("learning rate", 1.0, 0.7).unwrap();
        assert_eq!(rate.at(1), 1.0);
        assert!((rate.at(200) - (1.0_f64 / 200.0).powf(0.7)).abs() < 1e-16);
        assert_eq!(Schedule::power("rate", 0.3, 0.0).unwrap().at(1000), 0.3);
        assert!(Schedule::power("learning rate", 1.5, 0.7).is_err());
        assert!(Schedule::power("learning rate", 0.5, -1.0).is_err());
    }

    #[test]
    fn rates_fall_along_a_line() {
        let rate = Schedule::linear("learning rate", 0.1, 0.01, 1000).unwrap();
        assert!((rate.at(1) - (0.1 - 0.09 / 1000.0)).abs() < 1e-16);
        assert!((rate.at(500) - 0.055).abs() < 1e-16);
        assert_eq!((rate.at(1000), rate.at(5000)), (0.01, 0.01));
        assert!(Schedule::linear("learning rate", 0.1, 1.1, 1000).is_err());
        assert!(Schedule::linear("learning rate", 0.1, 0.01, 0).is_err());
    }
}
