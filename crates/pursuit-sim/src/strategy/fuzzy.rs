//! Steering by a fuzzy system.

use fuzzy_core::inference::{Numbers, TskGrid};
use fuzzy_core::math::Real;
use fuzzy_core::{NoRuleFires, Tsk, check};

use crate::error::{Error, Result};
use crate::observation::Observation;

/// A fuzzy system whose inputs are δ and δ̇ and whose output is the steering angle.
///
/// The inputs may be held within limits: one time step of full steering changes δ by a third of
/// a radian, which as a rate lies far outside the universe [−1, 1] of the thesis's controllers.
/// Where no rule fires the robot steers straight ahead, unless the system was given a value for
/// that case.
#[derive(Debug, Clone, PartialEq)]
pub struct FuzzyController {
    system: Tsk,
    angle_limit: f64,
    rate_limit: f64,
}

impl FuzzyController {
    /// A controller that holds its inputs within ±`angle_limit` (rad) and ±`rate_limit` (rad/s);
    /// infinity for no limit.
    pub fn new(system: Tsk, angle_limit: f64, rate_limit: f64) -> Result<Self> {
        if system.inputs().len() != 2 {
            return Err(Error::ControllerInputs {
                name: system.name().to_owned(),
                inputs: system.inputs().len(),
            });
        }
        for (what, limit) in [("angle limit", angle_limit), ("rate limit", rate_limit)] {
            if limit != f64::INFINITY {
                check::positive(what, limit)?;
            }
        }
        Ok(Self { system, angle_limit, rate_limit })
    }

    /// The fuzzy system.
    pub fn system(&self) -> &Tsk {
        &self.system
    }

    /// The limit of δ (rad).
    pub fn angle_limit(&self) -> f64 {
        self.angle_limit
    }

    /// The limit of δ̇ (rad/s).
    pub fn rate_limit(&self) -> f64 {
        self.rate_limit
    }

    /// The same controller with another parameter vector.
    pub fn with_parameters(&self, parameters: &[f64]) -> Result<Self> {
        Ok(Self { system: self.system.with_parameters(parameters)?, ..self.clone() })
    }

    #[inline(always)]
    pub(super) fn steer<R: Real>(
        &self,
        grid: &TskGrid,
        prepared: &[R],
        scratch: &mut [R],
        seen: &Observation<R>,
    ) -> R
    where
        [R]: Numbers<R>,
    {
        let inputs = [
            seen.angle.clamp_symmetric(self.angle_limit),
            seen.rate.clamp_symmetric(self.rate_limit),
        ];
        let straight = match self.system.no_rule_fires() {
            NoRuleFires::Value(value) => value,
            NoRuleFires::Error | NoRuleFires::Nan => 0.0,
        };
        grid.infer(prepared, &inputs, scratch).average(straight)
    }
}
