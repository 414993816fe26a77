//! Proportional-derivative control.

use fuzzy_core::check;
use fuzzy_core::math::Real;

use crate::error::Result;

/// A proportional-derivative controller: u = K_p·e + K_d·ė (3.4, 4.8).
///
/// In a pursuit e is δ, the angle to the evader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pd {
    proportional: f64,
    derivative: f64,
}

impl Pd {
    /// A controller with these gains, K_p and K_d (s), any finite numbers.
    pub fn new(proportional: f64, derivative: f64) -> Result<Self> {
        Ok(Self {
            proportional: check::finite("proportional gain", proportional)?,
            derivative: check::finite("derivative gain", derivative)?,
        })
    }

    /// K_p.
    pub fn proportional(&self) -> f64 {
        self.proportional
    }

    /// K_d (s).
    pub fn derivative(&self) -> f64 {
        self.derivative
    }

    /// u for an error and its rate of change.
    #[inline(always)]
    pub fn output<R: Real>(&self, error: R, rate: R) -> R {
        let damping = R::splat(self.derivative) * rate;
        R::splat(self.proportional).mul_add(error, damping)
    }
}
