//! Steering by a fuzzy system.

use fuzzy_core::format::json::{self, FORMAT, TskDocument, VERSION};
use fuzzy_core::inference::TskGrid;
use fuzzy_core::math::{Numbers, Real};
use fuzzy_core::{Inference, NoRuleFires, Outside, Tsk, check};
use serde::{Deserialize, Serialize};

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

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    version: u32,
    #[serde(rename = "type")]
    kind: String,
    angle_limit: Option<f64>,
    rate_limit: Option<f64>,
    system: TskDocument,
}

impl FuzzyController {
    /// What the field "type" of its documents says.
    pub const DOCUMENT_TYPE: &str = "fuzzy_controller";

    /// A controller that holds its inputs within ±`angle_limit` (rad) and ±`rate_limit` (rad/s);
    /// infinity for no limit.
    ///
    /// Where no rule of the system fires it steers straight ahead, unless the system has a value
    /// for that. A game has no answer to an error and keeps no steering from step to step, so
    /// systems that refuse inputs outside their universe or hold their output are refused.
    pub fn new(system: Tsk, angle_limit: f64, rate_limit: f64) -> Result<Self> {
        if system.inputs().len() != 2 {
            return Err(Error::ControllerInputs {
                name: system.name().to_owned(),
                inputs: system.inputs().len(),
            });
        }
        if system.no_rule_fires() == NoRuleFires::Previous {
            return Err(unsuitable(&system, "choose a value for where no rule fires"));
        }
        if system.interface().outside() == Outside::Error {
            return Err(unsuitable(&system, "let it clamp inputs to their universe instead"));
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

    /// The controller as a JSON document; no limit is `null`.
    pub fn to_json(&self) -> Result<String> {
        let finite = |limit: f64| limit.is_finite().then_some(limit);
        Ok(json::write(&Document {
            format: FORMAT.to_owned(),
            version: VERSION,
            kind: Self::DOCUMENT_TYPE.to_owned(),
            angle_limit: finite(self.angle_limit),
            rate_limit: finite(self.rate_limit),
            system: TskDocument::from(&self.system),
        })?)
    }

    /// The controller that a JSON document describes.
    pub fn from_json(text: &str) -> Result<Self> {
        let document: Document = json::read(text, Self::DOCUMENT_TYPE)?;
        let limit = |limit: Option<f64>| limit.unwrap_or(f64::INFINITY);
        let system = Tsk::try_from(document.system)?;
        Self::new(system, limit(document.angle_limit), limit(document.rate_limit))
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
        let mut inputs = [
            seen.angle.clamp_symmetric(self.angle_limit),
            seen.rate.clamp_symmetric(self.rate_limit),
        ];
        self.system.interface().admit(&mut inputs);
        let straight = match self.system.no_rule_fires() {
            NoRuleFires::Value(value) => value,
            _ => 0.0,
        };
        grid.infer(prepared, &inputs, scratch).average(straight)
    }
}

fn unsuitable(system: &Tsk, reason: &str) -> Error {
    let what = format!("system \"{}\" of a controller", system.name());
    fuzzy_core::Error::Unsuitable { what, reason: reason.to_owned() }.into()
}

#[cfg(test)]
mod tests {
    use fuzzy_core::{Shape, Variable};

    use super::*;

    #[test]
    fn a_controller_survives_the_round_trip() {
        let inputs = ["angle", "rate"].map(|name| {
            Variable::evenly(name, (-1.0, 1.0), Shape::GaussianWidth, &["N", "P"]).unwrap()
        });
        let system = Tsk::zero_order("pursuer", inputs.to_vec(), vec![0.1, 1.0 / 3.0, -2.0, 0.0]);
        let controller = FuzzyController::new(system.unwrap(), f64::INFINITY, 0.7).unwrap();
        let text = controller.to_json().unwrap();
        assert_eq!(FuzzyController::from_json(&text).unwrap(), controller);
        let message = Tsk::from_json(&text).unwrap_err().to_string();
        assert!(message.contains("\"fuzzy_controller\" is not supported"), "{message}");
        let negative = text.replace("\"rate_limit\": 0.7", "\"rate_limit\": -0.7");
        assert!(FuzzyController::from_json(&negative).is_err());
    }
}
