//! What every system shows to the outside: its name, inputs and outputs, and what it does at the
//! edges of their ranges.

use crate::check;
use crate::error::{Error, Result};
use crate::math::Real;
use crate::variable::Variable;

/// What a system answers at a point where no rule fires.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoRuleFires {
    /// An error that names the point.
    Error,
    /// This value.
    Value(f64),
    /// NaN.
    Nan,
    /// The output before: of the row before in a batch, or what the caller hands in.
    Previous,
}

impl NoRuleFires {
    /// The number that stands for the output; NaN where something else is to be done.
    pub fn fallback(self) -> f64 {
        match self {
            Self::Value(value) => value,
            Self::Error | Self::Nan | Self::Previous => f64::NAN,
        }
    }
}

/// What a system does with an input outside its universe of discourse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outside {
    /// Takes it as it is.
    Keep,
    /// Takes the nearer end of the universe.
    Clamp,
    /// Refuses it.
    Error,
}

impl Outside {
    /// Every choice.
    pub const ALL: [Self; 3] = [Self::Keep, Self::Clamp, Self::Error];

    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Clamp => "clamp",
            Self::Error => "error",
        }
    }

    /// The choice with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("treatment of inputs outside their universe", name, Self::ALL, Self::name)
    }
}

/// What a system shows to the outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Interface {
    pub(super) name: String,
    pub(super) inputs: Vec<Variable>,
    pub(super) outputs: Vec<(String, NoRuleFires)>,
    pub(super) outside: Outside,
}

/// An output at a point, before the choice where no rule fires is applied.
#[derive(Debug, Clone, Copy)]
pub struct Answer<R> {
    /// The output; where no rule fires, [`NoRuleFires::fallback`].
    pub value: R,
    /// How strongly the rules fire together; zero where none does.
    pub strength: R,
}

impl Interface {
    /// The interface of a system with these inputs, whose names must differ.
    pub(super) fn new(name: &str, inputs: Vec<Variable>) -> Result<Self> {
        check::name("system", name)?;
        check::at_least(&format!("inputs of \"{name}\""), inputs.len(), 1)?;
        for (index, input) in inputs.iter().enumerate() {
            if inputs[..index].iter().any(|earlier| earlier.name() == input.name()) {
                return Err(duplicate("input", input.name(), name));
            }
        }
        Ok(Self { name: name.to_owned(), inputs, outputs: Vec::new(), outside: Outside::Keep })
    }

    /// Adds an output, whose name must be new.
    pub(super) fn add_output(&mut self, output: &str, no_rule_fires: NoRuleFires) -> Result<()> {
        check::name("output", output)?;
        if self.outputs.iter().any(|(earlier, _)| earlier == output) {
            return Err(duplicate("output", output, &self.name));
        }
        self.outputs.push((output.to_owned(), NoRuleFires::Error));
        self.when_no_rule_fires(self.outputs.len() - 1, no_rule_fires)
    }

    pub(super) fn when_no_rule_fires(&mut self, output: usize, answer: NoRuleFires) -> Result<()> {
        if let NoRuleFires::Value(value) = answer {
            check::finite("the output when no rule fires", value)?;
        }
        self.outputs[output].1 = answer;
        Ok(())
    }

    /// An error, if an input carries a name that is taken otherwise.
    pub(super) fn refuse_input(&self, taken: &str) -> Result<()> {
        match self.inputs.iter().any(|input| input.name() == taken) {
            true => Err(duplicate("input", taken, &self.name)),
            false => Ok(()),
        }
    }

    /// The inputs with other parameters of their terms, one after the other.
    pub(super) fn inputs_with_parameters(&self, mut rest: &[f64]) -> Result<Vec<Variable>> {
        let mut inputs = Vec::with_capacity(self.inputs.len());
        for input in &self.inputs {
            let (own, others) = rest.split_at(input.parameter_count());
            inputs.push(input.with_parameters(own)?);
            rest = others;
        }
        Ok(inputs)
    }

    /// The system's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The input variables.
    pub fn inputs(&self) -> &[Variable] {
        &self.inputs
    }

    /// The outputs' names, and what each is where no rule fires.
    pub fn outputs(&self) -> &[(String, NoRuleFires)] {
        &self.outputs
    }

    /// What happens to inputs outside their universe.
    pub fn outside(&self) -> Outside {
        self.outside
    }

    /// Nothing, if these are finite inputs, as many as there are, and within their universes
    /// where that is asked for.
    pub(crate) fn check_point(&self, x: &[f64]) -> Result<()> {
        if x.len() != self.inputs.len() {
            let what = format!("inputs of \"{}\"", self.name);
            return Err(Error::wrong_shape(what, self.inputs.len(), x.len()));
        }
        self.check_rows(x, None)
    }

    /// Nothing, if all numbers of these rows may be inputs; otherwise an error about the first
    /// that may not. `first` is the number of the first row for the message, if there are many.
    pub(super) fn check_rows(&self, rows: &[f64], first: Option<usize>) -> Result<()> {
        // Without an early exit, so that the loop is vectorised.
        let bad = rows.iter().fold(false, |bad, value| bad | !value.is_finite());
        if bad || self.outside == Outside::Error {
            return self.check_each(rows, first);
        }
        Ok(())
    }

    #[cold]
    fn check_each(&self, rows: &[f64], first: Option<usize>) -> Result<()> {
        for (row, x) in rows.chunks(self.inputs.len()).enumerate() {
            for (input, &value) in self.inputs.iter().zip(x) {
                let universe = input.universe();
                let inside = (universe.low()..=universe.high()).contains(&value);
                if value.is_finite() && (inside || self.outside != Outside::Error) {
                    continue;
                }
                let place = first.map(|first| format!(" of point {}", first + row));
                let what = format!("input \"{}\"{}", input.name(), place.unwrap_or_default());
                check::finite(&what, value)?;
                let expected = format!("from {} to {}", universe.low(), universe.high());
                return Err(Error::OutOfRange { what, expected, value });
            }
        }
        Ok(())
    }

    /// Brings inputs into their universes, where that is asked for.
    #[inline(always)]
    pub fn admit<R: Real>(&self, x: &mut [R]) {
        if self.outside == Outside::Clamp {
            for (value, input) in x.iter_mut().zip(&self.inputs) {
                let universe = input.universe();
                *value = value.max(R::splat(universe.low())).min(R::splat(universe.high()));
            }
        }
    }

    /// Puts the answer at one point into `output`, which holds the output before.
    #[inline]
    pub(super) fn settle(
        &self,
        index: usize,
        answer: Answer<f64>,
        output: &mut f64,
        point: impl Fn() -> String,
    ) -> Result<()> {
        if answer.value.is_finite() {
            *output = answer.value;
            return Ok(());
        }
        self.settle_special(index, answer, output, point)
    }

    /// Nothing, if an output may be what it is at a point whose derivatives are asked for: they
    /// are zero where no rule fires, unless that is an error.
    #[inline]
    pub(super) fn check_answer(
        &self,
        index: usize,
        answer: Answer<f64>,
        point: impl Fn() -> String,
    ) -> Result<()> {
        if answer.strength == 0.0 && self.outputs[index].1 != NoRuleFires::Error {
            return Ok(());
        }
        let mut output = f64::NAN;
        self.settle(index, answer, &mut output, point)
    }

    /// The answer where the output is not finite: no rule fires, or the numbers overflow.
    #[cold]
    fn settle_special(
        &self,
        index: usize,
        answer: Answer<f64>,
        output: &mut f64,
        point: impl Fn() -> String,
    ) -> Result<()> {
        let (name, no_rule_fires) = &self.outputs[index];
        let system = || match self.outputs.len() {
            1 => format!("\"{}\"", self.name),
            _ => format!("\"{}\" about \"{name}\"", self.name),
        };
        if answer.strength > 0.0 {
            let what = format!("output \"{name}\" of \"{}\" at {}", self.name, point());
            return Err(Error::NotFinite { what, value: answer.value });
        }
        match no_rule_fires {
            NoRuleFires::Nan | NoRuleFires::Value(_) => *output = answer.value,
            NoRuleFires::Previous if output.is_finite() => {}
            NoRuleFires::Error | NoRuleFires::Previous => {
                return Err(Error::NoRuleFires { system: system(), point: point() });
            }
        }
        Ok(())
    }
}

fn duplicate(kind: &'static str, name: &str, system: &str) -> Error {
    Error::DuplicateName { kind, name: name.to_owned(), place: format!("system \"{system}\"") }
}
