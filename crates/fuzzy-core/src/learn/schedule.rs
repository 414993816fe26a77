//! Rates that change from episode to episode.

use crate::check;
use crate::error::Result;
use crate::math::powf;

/// A rate as scale/iᵖ in episode i = 1, 2, …: constant for p = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    scale: f64,
    power: f64,
}

impl Schedule {
    /// scale/iᵖ; the scale lies in [0, 1], the power is not negative.
    pub fn new(what: &str, scale: f64, power: f64) -> Result<Self> {
        check::fraction(what, scale)?;
        check::within(&format!("decay of the {what}"), power, "zero or more", |p| p >= 0.0)?;
        Ok(Self { scale, power })
    }

    /// The rate in episode i, counted from 1.
    pub fn at(&self, episode: u64) -> f64 {
        if self.power == 0.0 {
            return self.scale;
        }
        self.scale * powf(1.0 / episode.max(1) as f64, self.power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_fall_as_a_power() {
        let rate = Schedule::new("learning rate", 1.0, 0.7).unwrap();
        assert_eq!(rate.at(1), 1.0);
        assert!((rate.at(200) - (1.0_f64 / 200.0).powf(0.7)).abs() < 1e-16);
        assert_eq!(Schedule::new("rate", 0.3, 0.0).unwrap().at(1000), 0.3);
        assert!(Schedule::new("learning rate", 1.5, 0.7).is_err());
        assert!(Schedule::new("learning rate", 0.5, -1.0).is_err());
    }
}
