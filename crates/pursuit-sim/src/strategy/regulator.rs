//! Controllers that hold an error at zero.

use fuzzy_core::format::json::{self, FORMAT, SystemDocument, TskDocument, VERSION};
use fuzzy_core::inference::{Answer, Kernel};
use fuzzy_core::{Inference, NoRuleFires, Outside, System, Tsk, check};
use serde::{Deserialize, Serialize};

use super::Pd;
use crate::error::Result;

/// What makes a control action u of an error e and its rate of change ė.
#[derive(Debug, Clone, PartialEq)]
pub enum Regulator {
    /// In proportion to both.
    Pd(Pd),
    /// As a fuzzy system says.
    Fuzzy(Box<FuzzyRegulator>),
    /// The sum of what two say.
    Parallel(Box<(Regulator, Regulator)>),
}

impl Regulator {
    /// The numbers of working space that [`output`](Self::output) needs.
    pub fn scratch_count(&self) -> usize {
        match self {
            Self::Pd(_) => 0,
            Self::Fuzzy(fuzzy) => fuzzy.scratch_count(),
            Self::Parallel(both) => both.0.scratch_count().max(both.1.scratch_count()),
        }
    }

    /// u for an error and its rate of change.
    #[inline]
    pub fn output(&self, error: f64, rate: f64, scratch: &mut [f64]) -> f64 {
        match self {
            Self::Pd(pd) => pd.output(error, rate),
            Self::Fuzzy(fuzzy) => fuzzy.output(error, rate, scratch),
            Self::Parallel(both) => {
                both.0.output(error, rate, scratch) + both.1.output(error, rate, scratch)
            }
        }
    }
}

/// A fuzzy system with scaling factors: u = k_u · FIS(k_e·e, k_ė·ė) (section 3.2.3).
///
/// Where no rule fires u is 0, unless the system has a value for that case.
///
/// ```
/// use pursuit_sim::strategy::FuzzyRegulator;
///
/// let tuned = FuzzyRegulator::thesis()?;
/// let mut scratch = vec![0.0; tuned.scratch_count()];
/// // Near the set point it is a PD controller of larger gains than the one that taught it.
/// assert!(tuned.output(0.02, 0.0, &mut scratch) > 1.2 * 0.02);
/// # Ok::<(), pursuit_sim::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FuzzyRegulator {
    system: FuzzySystem,
    gains: Gains,
}

/// The scaling factors of a [`FuzzyRegulator`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains {
    /// k_e, which the error is multiplied by.
    pub error: f64,
    /// k_ė, which its rate of change is multiplied by.
    pub rate: f64,
    /// k_u, which the system's output is multiplied by.
    pub output: f64,
}

impl Gains {
    /// No scaling.
    pub const ONE: Self = Self { error: 1.0, rate: 1.0, output: 1.0 };
}

/// A fuzzy system of either kind.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "one or the other, never many of them")]
pub enum FuzzySystem {
    /// Rules with Mamdani, Sugeno or Tsukamoto outputs.
    Rules(System),
    /// A grid of rules with numbers as consequents.
    Tsk(Tsk),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    version: u32,
    #[serde(rename = "type")]
    kind: String,
    error_gain: f64,
    rate_gain: f64,
    output_gain: f64,
    system: EitherDocument,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum EitherDocument {
    Rules(SystemDocument),
    Tsk(TskDocument),
}

impl FuzzyRegulator {
    /// What the field "type" of its documents says.
    pub const DOCUMENT_TYPE: &str = "fuzzy_regulator";

    /// A controller of a system with two inputs and one output. The scaling factors are finite.
    ///
    /// A simulation has no answer to an error and keeps no output from step to step, so systems
    /// that refuse inputs outside their universe or hold their output are refused.
    pub fn new(system: FuzzySystem, gains: Gains) -> Result<Self> {
        for (what, gain) in
            [("error gain", gains.error), ("rate gain", gains.rate), ("output gain", gains.output)]
        {
            check::finite(what, gain)?;
        }
        let interface = match &system {
            FuzzySystem::Rules(system) => system.interface(),
            FuzzySystem::Tsk(system) => system.interface(),
        };
        let what = || format!("system \"{}\" of a regulator", interface.name());
        let unsuitable = |reason: &str| {
            let reason = reason.to_owned();
            Err(fuzzy_core::Error::Unsuitable { what: what(), reason }.into())
        };
        check::same_length(&format!("inputs of {}", what()), 2, interface.inputs().len())?;
        check::same_length(&format!("outputs of {}", what()), 1, interface.outputs().len())?;
        if interface.outputs()[0].1 == NoRuleFires::Previous {
            return unsuitable("choose a value for where no rule fires");
        }
        if interface.outside() == Outside::Error {
            return unsuitable("let it clamp inputs to their universe instead");
        }
        Ok(Self { system, gains })
    }

    /// The controller that the thesis ended with: Tables 3.2–3.5 and the 25 rules of Table 3.1.
    ///
    /// The thesis doesn't name the operators. These are the product as AND and as implication, the
    /// maximum, and the centroid of 61 samples from −1.2 to 1.2, with scaled inputs held within
    /// ±1; under the minimum the same tables make a controller that leaves an offset.
    pub fn thesis() -> Result<Self> {
        Self::new(FuzzySystem::Rules(thesis_system()?), THESIS_GAINS)
    }

    /// [`thesis`](Self::thesis) with the 14 rules of Table 3.6, of which the scan lost three: one
    /// of the [nine likeliest readings](THESIS_READINGS).
    pub fn thesis_pruned(reading: usize) -> Result<Self> {
        check::within("reading of Table 3.6", reading as f64, "from 0 to 8", |reading| {
            reading < THESIS_READINGS as f64
        })?;
        let all = thesis_system()?;
        let kept = table_3_6(reading);
        let mut parameters = all.parameters().to_vec();
        let first = parameters.len() - kept.len();
        for (weight, kept) in parameters[first..].iter_mut().zip(kept) {
            *weight = f64::from(u8::from(kept));
        }
        Self::new(FuzzySystem::Rules(all.with_parameters(&parameters)?), THESIS_GAINS)
    }

    /// The fuzzy system.
    pub fn system(&self) -> &FuzzySystem {
        &self.system
    }

    /// The scaling factors.
    pub fn gains(&self) -> Gains {
        self.gains
    }

    /// The numbers of working space that [`output`](Self::output) needs.
    pub fn scratch_count(&self) -> usize {
        match &self.system {
            FuzzySystem::Rules(system) => system.scratch_count(),
            FuzzySystem::Tsk(system) => system.scratch_count(),
        }
    }

    /// The number of rules whose weight is above zero.
    pub fn rules_kept(&self) -> usize {
        match &self.system {
            FuzzySystem::Rules(system) => {
                system.rules().iter().filter(|rule| rule.weight > 0.0).count()
            }
            FuzzySystem::Tsk(system) => system.grid().rules(),
        }
    }

    /// u for an error and its rate of change, both finite.
    #[inline]
    pub fn output(&self, error: f64, rate: f64, scratch: &mut [f64]) -> f64 {
        let seen = [error, rate];
        match &self.system {
            FuzzySystem::Rules(system) => {
                scaled_output(system, system.prepared(), self.gains, seen, scratch)
            }
            FuzzySystem::Tsk(system) => {
                scaled_output(system, system.prepared(), self.gains, seen, scratch)
            }
        }
    }

    /// The controller as a JSON document.
    pub fn to_json(&self) -> Result<String> {
        Ok(json::write(&Document {
            format: FORMAT.to_owned(),
            version: VERSION,
            kind: Self::DOCUMENT_TYPE.to_owned(),
            error_gain: self.gains.error,
            rate_gain: self.gains.rate,
            output_gain: self.gains.output,
            system: match &self.system {
                FuzzySystem::Rules(system) => EitherDocument::Rules(system.into()),
                FuzzySystem::Tsk(system) => EitherDocument::Tsk(system.into()),
            },
        })?)
    }

    /// The controller that a JSON document describes.
    pub fn from_json(text: &str) -> Result<Self> {
        let document: Document = json::read(text, Self::DOCUMENT_TYPE)?;
        let system = match document.system {
            EitherDocument::Rules(system) => FuzzySystem::Rules(system.try_into()?),
            EitherDocument::Tsk(system) => FuzzySystem::Tsk(system.try_into()?),
        };
        let gains = Gains {
            error: document.error_gain,
            rate: document.rate_gain,
            output: document.output_gain,
        };
        Self::new(system, gains)
    }
}

/// Table 3.5.
const THESIS_GAINS: Gains = Gains { error: 1.2858, rate: 1.6465, output: 1.6206 };

/// Tables 3.2–3.4 and 3.1, with the operators of [`FuzzyRegulator::thesis`].
pub(crate) fn thesis_system() -> Result<System> {
    Ok(System::from_json(include_str!("thesis_wall.json"))?)
}

/// The number of readings of [`FuzzyRegulator::thesis_pruned`].
pub const THESIS_READINGS: usize = 9;

/// Which rules Table 3.6 keeps, rule by rule as in Table 3.1: the terms of e, and under each those
/// of ė.
///
/// Legible are eleven: under LN all, under Z all but HP, under LP the last two. Of three more under
/// HP two are there; and one of the last three places.
fn table_3_6(reading: usize) -> [bool; 25] {
    const LEGIBLE: [(usize, usize); 11] =
        [(1, 0), (1, 1), (1, 2), (1, 3), (1, 4), (2, 0), (2, 1), (2, 2), (2, 3), (3, 3), (3, 4)];
    const TWO_OF: [[(usize, usize); 2]; 3] = [[(4, 2), (4, 3)], [(4, 2), (4, 4)], [(4, 3), (4, 4)]];
    const ONE_OF: [(usize, usize); 3] = [(0, 4), (3, 1), (4, 0)];
    let mut kept = [false; 25];
    let lost = TWO_OF[reading / ONE_OF.len()].into_iter().chain([ONE_OF[reading % ONE_OF.len()]]);
    for (error, rate) in LEGIBLE.into_iter().chain(lost) {
        kept[5 * error + rate] = true;
    }
    kept
}

/// k_u · FIS(k_e·e, k_ė·ė); 0 where no rule fires, unless the system has a value for that.
#[inline(always)]
pub(crate) fn scaled_output<S: Inference, R: Kernel<f64>>(
    system: &S,
    prepared: &S::Prepared<f64>,
    gains: Gains,
    [error, rate]: [R; 2],
    scratch: &mut [R],
) -> R {
    let zero = R::splat(0.0);
    let mut point = [R::splat(gains.error) * error, R::splat(gains.rate) * rate];
    system.interface().admit(&mut point);
    let mut answers = [Answer { value: zero, strength: zero }];
    system.infer(prepared, &point, scratch, &mut answers);
    let [Answer { value, strength }] = answers;
    let silent = match system.interface().outputs()[0].1 {
        NoRuleFires::Value(value) => value,
        _ => 0.0,
    };
    R::splat(gains.output) * R::select(zero.lt(strength), value, R::splat(silent))
}

#[cfg(test)]
mod tests {
    use fuzzy_core::{Shape, Variable};

    use super::*;

    fn grid() -> Tsk {
        let inputs = ["e", "rate"].map(|name| {
            Variable::evenly(name, (-1.0, 1.0), Shape::Triangular, &["N", "P"]).unwrap()
        });
        Tsk::zero_order("plane", inputs.to_vec(), vec![-2.0, 0.0, 0.0, 2.0]).unwrap()
    }

    #[test]
    fn gains_scale_and_regulators_add_up() {
        let gains = Gains { error: 0.5, rate: 0.25, output: 3.0 };
        let fuzzy = FuzzyRegulator::new(FuzzySystem::Tsk(grid()), gains).unwrap();
        let mut scratch = vec![0.0; fuzzy.scratch_count()];
        // The system is the plane x + y within its universe.
        let expected = 3.0 * (0.5 * 0.4 + 0.25 * -0.8);
        assert!((fuzzy.output(0.4, -0.8, &mut scratch) - expected).abs() < 1e-15);
        let one = fuzzy.output(0.3, 0.1, &mut scratch);
        let pd = Pd::new(1.2, 1.5).unwrap();
        let both = Regulator::Parallel(Box::new((
            Regulator::Pd(pd),
            Regulator::Fuzzy(Box::new(fuzzy.clone())),
        )));
        assert_eq!(both.output(0.3, 0.1, &mut scratch), pd.output(0.3, 0.1) + one);
    }

    #[test]
    fn the_thesis_controller_is_the_one_of_its_tables() {
        let tuned = FuzzyRegulator::thesis().unwrap();
        let FuzzySystem::Rules(system) = tuned.system() else { panic!("a rule system") };
        assert_eq!(system.rules().len(), 25);
        assert_eq!(system.parameters().len(), 60 + 25);
        assert_eq!(system.parameters()[..4], [-1.1277, -0.7744, -0.4998, -0.2049]);
        assert_eq!(system.parameters()[56..60], [0.3242, 0.6034, 0.8046, 1.1057]);
        let mut scratch = vec![0.0; tuned.scratch_count()];
        assert!(tuned.output(0.0, 0.0, &mut scratch).abs() < 2e-3);
        for reading in 0..THESIS_READINGS {
            let kept = table_3_6(reading);
            assert_eq!(kept.into_iter().filter(|&kept| kept).count(), 14);
            assert!(!(0..reading).any(|earlier| table_3_6(earlier) == kept));
            let pruned = FuzzyRegulator::thesis_pruned(reading).unwrap();
            assert_ne!(pruned, tuned);
        }
        assert!(FuzzyRegulator::thesis_pruned(9).is_err());
    }

    #[test]
    fn regulators_survive_the_round_trip() {
        let tsk = FuzzyRegulator::new(FuzzySystem::Tsk(grid()), Gains::ONE).unwrap();
        for regulator in [tsk, FuzzyRegulator::thesis_pruned(4).unwrap()] {
            let text = regulator.to_json().unwrap();
            assert_eq!(FuzzyRegulator::from_json(&text).unwrap(), regulator);
        }
    }

    #[test]
    fn unsuitable_systems_are_refused_in_words() {
        let message = |system, gains| {
            FuzzyRegulator::new(FuzzySystem::Tsk(system), gains).unwrap_err().to_string()
        };
        let held = grid().when_no_rule_fires(NoRuleFires::Previous).unwrap();
        assert!(message(held, Gains::ONE).contains("choose a value"));
        let strict = grid().with_outside(Outside::Error);
        assert!(message(strict, Gains::ONE).contains("clamp"));
        let gains = Gains { rate: f64::NAN, ..Gains::ONE };
        assert_eq!(message(grid(), gains), "rate gain must be finite, got NaN");
        let x = Variable::evenly("x", (0.0, 1.0), Shape::Triangular, &["a", "b"]).unwrap();
        let one = Tsk::zero_order("one", vec![x], vec![0.0, 1.0]).unwrap();
        assert!(message(one, Gains::ONE).contains("inputs of system \"one\""));
    }
}
