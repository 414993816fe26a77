//! The bound on action values of Theorem 5.1.

use crate::check;
use crate::error::Result;

/// What M, the scale of the bound, is taken from (5.7, 5.8).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// max{sup |r̄|, max |Q₀|} with the mean rewards that the steps used, over all steps so far:
    /// what the proof needs. A learner without a model uses the rewards themselves.
    Used,
    /// max{sup |r̄|, max Q₀}, as (5.7) prints it: without bars about Q₀.
    Printed,
    /// max{max |r|, max |Q₀|} with the true mean rewards of the process.
    TrueMeans,
}

impl Scale {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Used => "used",
            Self::Printed => "printed",
            Self::TrueMeans => "true_means",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let readings = [Self::Used, Self::Printed, Self::TrueMeans];
        check::named("reading of M", name, readings, Self::name)
    }

    /// Every reading.
    pub const ALL: [Self; 3] = [Self::Used, Self::Printed, Self::TrueMeans];
}

/// Watches |Qₜ| ≤ M(1 + γ + … + γᵗ) (5.5) step by step.
///
/// ```
/// use fuzzy_core::learn::rl::{Bound, Scale};
///
/// // Values begin at −5; rewards are at most 1 in size.
/// let mut bound = Bound::new(Scale::Printed, 0.5, &[-5.0, 0.0], &[1.0, -1.0])?;
/// bound.watch(1.0, 5.0);
/// assert_eq!((bound.now(), bound.violations()), (1.5, 1));
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    scale: Scale,
    discount: f64,
    /// M.
    size: f64,
    /// 1 + γ + … + γᵗ.
    sum: f64,
    violations: u64,
    closest: f64,
}

/// How far rounding may take values over the bound.
const ROUNDING: f64 = 1e-9;

impl Bound {
    /// The bound at t = 0 for a discount in [0, 1], the first values Q₀ and the true mean rewards.
    pub fn new(
        scale: Scale,
        discount: f64,
        first_values: &[f64],
        mean_rewards: &[f64],
    ) -> Result<Self> {
        check::fraction("discount", discount)?;
        check::all_finite("first values", first_values)?;
        check::all_finite("mean rewards", mean_rewards)?;
        let signed = scale == Scale::Printed;
        let first = first_values.iter().map(|value| if signed { *value } else { value.abs() });
        let mut size = first.fold(0.0, f64::max);
        if scale == Scale::TrueMeans {
            size = mean_rewards.iter().fold(size, |size, reward| size.max(reward.abs()));
        }
        Ok(Self { scale, discount, size, sum: 1.0, violations: 0, closest: 0.0 })
    }

    /// Takes note of a step: the reward or mean reward that it used, and the largest |Q| after it.
    #[inline]
    pub fn watch(&mut self, reward: f64, largest_value: f64) {
        if self.scale != Scale::TrueMeans {
            self.size = self.size.max(reward.abs());
        }
        self.sum = self.discount.mul_add(self.sum, 1.0);
        let bound = self.now();
        if largest_value > 0.0 {
            self.closest = self.closest.max(largest_value / bound);
        }
        self.violations += u64::from(largest_value > bound * (1.0 + ROUNDING));
    }

    /// The bound after the steps so far.
    pub fn now(&self) -> f64 {
        self.size * self.sum
    }

    /// The steps after which a value was beyond the bound.
    pub fn violations(&self) -> u64 {
        self.violations
    }

    /// The largest |Q| in terms of the bound of its time, over all steps; above 1 if it was broken.
    pub fn closest(&self) -> f64 {
        self.closest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_grows_as_the_geometric_series() {
        let mut bound = Bound::new(Scale::Used, 0.9, &[-2.0, 1.0], &[]).unwrap();
        assert_eq!(bound.now(), 2.0);
        bound.watch(-3.0, 1.0);
        assert!((bound.now() - 3.0 * 1.9).abs() < 1e-15);
        bound.watch(0.5, 4.0);
        assert!((bound.now() - 3.0 * (1.0 + 0.9 + 0.81)).abs() < 1e-14);
        assert!((bound.closest() - 4.0 / 8.13).abs() < 1e-14);
        assert_eq!(bound.violations(), 0);
        bound.watch(0.0, 10.4);
        assert_eq!(bound.violations(), 1);
        (0..1000).for_each(|_| bound.watch(0.0, 0.0));
        assert!((bound.now() - 30.0).abs() < 1e-12);
    }

    #[test]
    fn the_readings_differ_in_what_they_look_at() {
        let size = |scale| {
            let mut bound = Bound::new(scale, 0.0, &[-5.0, 1.0], &[2.0, -6.0]).unwrap();
            bound.watch(-3.0, 0.0);
            bound.now()
        };
        assert_eq!(Scale::ALL.map(size), [5.0, 3.0, 6.0]);
        for scale in Scale::ALL {
            assert_eq!(Scale::from_name(scale.name()), Ok(scale));
        }
        assert!(Bound::new(Scale::Used, 1.1, &[], &[]).is_err());
        assert!(Bound::new(Scale::Used, 1.0, &[f64::NAN], &[]).is_err());
    }
}
