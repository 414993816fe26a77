//! Takagi-Sugeno-Kang systems: rules that conclude a number.

use super::TskGrid;
use crate::check;
use crate::error::{Error, Result};
use crate::variable::{Term, Variable};

/// What a rule's consequent is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// A constant.
    Zero,
    /// A linear function of the inputs plus a constant.
    One,
}

/// What a system answers at a point where no rule fires.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoRuleFires {
    /// An error that names the point.
    Error,
    /// This value.
    Value(f64),
    /// NaN.
    Nan,
}

/// What the constant of a linear consequent is called, so that no input can be.
pub(crate) const CONSTANT: &str = "constant";

impl NoRuleFires {
    /// The number that stands for the output; NaN where an error is to be raised.
    pub fn fallback(self) -> f64 {
        match self {
            Self::Value(value) => value,
            Self::Error | Self::Nan => f64::NAN,
        }
    }
}

/// A Takagi-Sugeno-Kang system on a rule grid: one rule for each combination of terms, the
/// product as AND, the weighted average f = Σ wᵣfᵣ / Σ wᵣ as output (2.8).
///
/// It is immutable and may be shared between threads. Its numbers are one flat vector, laid out
/// as in [`TskGrid`].
///
/// ```
/// use fuzzy_core::{NoRuleFires, Order, Shape, Tsk, Variable};
///
/// let error = Variable::evenly("error", (-1.0, 1.0), Shape::Gaussian, &["N", "Z", "P"])?;
/// let rate = Variable::evenly("rate", (-1.0, 1.0), Shape::Gaussian, &["N", "Z", "P"])?;
/// let steer = Tsk::zero_order(
///     "steer",
///     vec![error, rate],
///     vec![-0.5, -0.25, 0.0, -0.25, 0.0, 0.25, 0.0, 0.25, 0.5],
/// )?;
/// assert!(steer.evaluate(&[0.0, 0.0])?.abs() < 1e-15);
/// assert!(steer.evaluate(&[0.6, 0.1])? > 0.0);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Tsk {
    name: String,
    output: String,
    inputs: Vec<Variable>,
    order: Order,
    no_rule_fires: NoRuleFires,
    pub(super) grid: TskGrid,
    pub(super) parameters: Vec<f64>,
    pub(super) prepared: Vec<f64>,
}

impl Tsk {
    /// A system whose consequents stand rule by rule, the last input's term changing fastest;
    /// for order 1 each rule has the coefficients of the inputs and then the constant.
    ///
    /// The output is called "output" and a point where no rule fires is an error; see
    /// [`with_output`](Self::with_output) and [`when_no_rule_fires`](Self::when_no_rule_fires).
    pub fn new(
        name: &str,
        inputs: Vec<Variable>,
        order: Order,
        consequents: Vec<f64>,
    ) -> Result<Self> {
        check::name("system", name)?;
        check::at_least(&format!("inputs of \"{name}\""), inputs.len(), 1)?;
        for (index, input) in inputs.iter().enumerate() {
            check::at_least(&format!("terms of \"{}\"", input.name()), input.terms().len(), 1)?;
            let taken = order == Order::One && input.name() == CONSTANT;
            if taken || inputs[..index].iter().any(|earlier| earlier.name() == input.name()) {
                return Err(Error::DuplicateName {
                    kind: "input",
                    name: input.name().to_owned(),
                    place: format!("system \"{name}\""),
                });
            }
        }
        let shape = |term: &Term| (term.function.shape(), term.function.parameters().len());
        let shapes: Vec<Vec<_>> =
            inputs.iter().map(|input| input.terms().iter().map(shape).collect()).collect();
        let grid = TskGrid::new(&shapes, order).ok_or_else(|| {
            Error::wrong_shape(format!("rules of \"{name}\""), "a countable number", "too many")
        })?;
        check::same_length(
            &format!("consequent parameters of \"{name}\""),
            grid.rules() * grid.consequent_size(),
            consequents.len(),
        )?;
        check::all_finite("consequents", &consequents)?;

        let terms = inputs.iter().flat_map(|variable| variable.terms());
        let mut parameters: Vec<f64> =
            terms.flat_map(|term| term.function.parameters().to_vec()).collect();
        parameters.extend(consequents);
        let mut prepared = vec![0.0; grid.prepared_count()];
        grid.prepare(&parameters, &mut prepared);
        Ok(Self {
            name: name.to_owned(),
            output: "output".to_owned(),
            inputs,
            order,
            no_rule_fires: NoRuleFires::Error,
            grid,
            parameters,
            prepared,
        })
    }

    /// [`new`](Self::new) with a constant for each rule.
    pub fn zero_order(name: &str, inputs: Vec<Variable>, consequents: Vec<f64>) -> Result<Self> {
        Self::new(name, inputs, Order::Zero, consequents)
    }

    /// The same system with another name for its output.
    pub fn with_output(mut self, output: &str) -> Result<Self> {
        check::name("output", output)?;
        self.output = output.to_owned();
        Ok(self)
    }

    /// The same system with another answer where no rule fires.
    pub fn when_no_rule_fires(mut self, answer: NoRuleFires) -> Result<Self> {
        if let NoRuleFires::Value(value) = answer {
            check::finite("the output when no rule fires", value)?;
        }
        self.no_rule_fires = answer;
        Ok(self)
    }

    /// The same definition with another parameter vector.
    pub fn with_parameters(&self, parameters: &[f64]) -> Result<Self> {
        check::same_length(
            &format!("parameters of \"{}\"", self.name),
            self.parameters.len(),
            parameters.len(),
        )?;
        let (mut rest, consequents) = parameters.split_at(self.grid.first_consequent());
        let mut inputs = Vec::with_capacity(self.inputs.len());
        for input in &self.inputs {
            let count = input.terms().iter().map(|term| term.function.parameters().len()).sum();
            let (own, others) = rest.split_at(count);
            inputs.push(input.with_parameters(own)?);
            rest = others;
        }
        Self::new(&self.name, inputs, self.order, consequents.to_vec())?
            .with_output(&self.output)?
            .when_no_rule_fires(self.no_rule_fires)
    }

    /// The system's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The output's name.
    pub fn output(&self) -> &str {
        &self.output
    }

    /// The input variables.
    pub fn inputs(&self) -> &[Variable] {
        &self.inputs
    }

    /// The order of the consequents.
    pub fn order(&self) -> Order {
        self.order
    }

    /// What happens where no rule fires.
    pub fn no_rule_fires(&self) -> NoRuleFires {
        self.no_rule_fires
    }

    /// The flat parameter vector.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// The consequents' part of the parameter vector.
    pub fn consequents(&self) -> &[f64] {
        &self.parameters[self.grid.first_consequent()..]
    }

    /// The layout, for evaluating other vectors under this definition.
    pub fn grid(&self) -> &TskGrid {
        &self.grid
    }

    /// The output at one point.
    pub fn evaluate(&self, x: &[f64]) -> Result<f64> {
        self.check_point(x)?;
        let fired = with_scratch(self.grid.scratch_count(), |scratch| {
            self.grid.infer(self.prepared.as_slice(), x, scratch)
        });
        self.settle(fired.average(self.no_rule_fires.fallback()), fired.strength, x)
    }

    /// The output at one point, and its derivatives to the parameters.
    ///
    /// Where no rule fires the derivatives are zero and the output is as for
    /// [`evaluate`](Self::evaluate).
    pub fn gradient(&self, x: &[f64], derivatives: &mut [f64]) -> Result<f64> {
        self.check_point(x)?;
        check::same_length("derivatives", self.parameters.len(), derivatives.len())?;
        let fired = with_scratch(self.grid.gradient_scratch_count(), |scratch| {
            let (parameters, prepared) = (self.parameters.as_slice(), self.prepared.as_slice());
            self.grid.gradient(parameters, prepared, x, scratch, derivatives)
        });
        self.settle(fired.average(self.no_rule_fires.fallback()), fired.strength, x)
    }

    fn check_point(&self, x: &[f64]) -> Result<()> {
        if x.len() != self.inputs.len() {
            let what = format!("inputs of \"{}\"", self.name);
            return Err(Error::wrong_shape(what, self.inputs.len(), x.len()));
        }
        match x.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(index) => Err(Error::NotFinite {
                what: format!("input \"{}\"", self.inputs[index].name()),
                value: x[index],
            }),
        }
    }

    #[inline]
    fn settle(&self, output: f64, strength: f64, x: &[f64]) -> Result<f64> {
        if output.is_finite() {
            return Ok(output);
        }
        self.settle_special(output, strength, || format!("{x:?}"))
    }

    /// The answer where the output is not finite: no rule fires, or the numbers overflow.
    #[cold]
    pub(super) fn settle_special(
        &self,
        output: f64,
        strength: f64,
        point: impl Fn() -> String,
    ) -> Result<f64> {
        if strength > 0.0 {
            let what = format!("output of \"{}\" at {}", self.name, point());
            return Err(Error::NotFinite { what, value: output });
        }
        match self.no_rule_fires {
            NoRuleFires::Error => {
                Err(Error::NoRuleFires { system: self.name.clone(), point: point() })
            }
            NoRuleFires::Nan | NoRuleFires::Value(_) => Ok(output),
        }
    }
}

/// Runs `work` with that many zeros of working space, on the stack if they are few.
#[inline(always)]
fn with_scratch<T>(count: usize, work: impl FnOnce(&mut [f64]) -> T) -> T {
    const FEW: usize = 32;
    if count <= FEW { work(&mut [0.0; FEW]) } else { work(&mut vec![0.0; count]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MembershipFunction, Shape};

    fn steering() -> Tsk {
        let terms = ["N", "Z", "P"];
        let angle = Variable::evenly("angle", (-1.0, 1.0), Shape::Gaussian, &terms).unwrap();
        let rate = Variable::evenly("rate", (-1.0, 1.0), Shape::Triangular, &terms).unwrap();
        Tsk::zero_order("steering", vec![angle, rate], (0..9).map(f64::from).collect()).unwrap()
    }

    #[test]
    fn a_grid_agrees_with_the_sum_over_its_rules() {
        let system = steering();
        for (x, y) in [(0.3, -0.2), (-0.9, 0.95), (0.0, 0.0), (1.4, -1.0)] {
            let degrees = |i: usize, v| {
                system.inputs()[i].terms().iter().map(|t| t.function.degree(v)).collect()
            };
            let (first, second): (Vec<f64>, Vec<f64>) = (degrees(0, x), degrees(1, y));
            let (mut weighted, mut total) = (0.0, 0.0);
            for (rule, consequent) in system.consequents().iter().enumerate() {
                let weight = first[rule / 3] * second[rule % 3];
                weighted += weight * consequent;
                total += weight;
            }
            assert!((system.evaluate(&[x, y]).unwrap() - weighted / total).abs() < 1e-13);
        }
    }

    #[test]
    fn order_one_is_a_plane_when_all_rules_agree() {
        let terms = ["low", "high"];
        let inputs = ["x", "y", "z"]
            .map(|name| Variable::evenly(name, (0.0, 1.0), Shape::Gaussian, &terms).unwrap());
        let plane = [2.0, -3.0, 0.5, 4.0].repeat(8);
        let system = Tsk::new("plane", inputs.to_vec(), Order::One, plane).unwrap();
        let output = system.evaluate(&[0.2, 0.7, 0.9]).unwrap();
        assert!((output - (2.0 * 0.2 - 3.0 * 0.7 + 0.5 * 0.9 + 4.0)).abs() < 1e-13);
    }

    #[test]
    fn where_no_rule_fires_the_choice_decides() {
        let gap = Variable::new("x", 0.0, 10.0)
            .unwrap()
            .with_term("low", MembershipFunction::triangular(0.0, 1.0, 2.0).unwrap())
            .unwrap();
        let system = Tsk::zero_order("gap", vec![gap], vec![3.0]).unwrap();
        assert_eq!(system.evaluate(&[1.5]).unwrap(), 3.0);
        let message = system.evaluate(&[5.0]).unwrap_err().to_string();
        assert!(message.starts_with("no rule of \"gap\" fires at [5.0]"), "{message}");
        let settled = |answer| system.clone().when_no_rule_fires(answer).unwrap().evaluate(&[5.0]);
        assert_eq!(settled(NoRuleFires::Value(-1.0)).unwrap(), -1.0);
        assert!(settled(NoRuleFires::Nan).unwrap().is_nan());
    }

    #[test]
    fn other_parameters_make_another_system() {
        let system = steering();
        let mut parameters = system.parameters().to_vec();
        parameters[0] = -0.8;
        let moved = system.with_parameters(&parameters).unwrap();
        assert_eq!(moved.parameters(), parameters);
        assert_eq!(moved.inputs()[0].terms()[0].function.parameters()[0], -0.8);
        assert_eq!(system.with_parameters(system.parameters()).unwrap(), system);
        parameters[1] = -0.1;
        assert!(system.with_parameters(&parameters).is_err());
        assert!(system.with_parameters(&parameters[1..]).is_err());
    }

    #[test]
    fn bad_points_and_definitions_are_refused_in_words() {
        let system = steering();
        let message = |result: Result<f64>| result.unwrap_err().to_string();
        assert_eq!(message(system.evaluate(&[1.0])), "inputs of \"steering\": expected 2, got 1");
        assert_eq!(
            message(system.evaluate(&[0.0, f64::NAN])),
            "input \"rate\" must be finite, got NaN"
        );
        let inputs = system.inputs().to_vec();
        let build = |inputs, consequents| Tsk::zero_order("s", inputs, consequents).unwrap_err();
        assert!(build(vec![], vec![]).to_string().contains("at least 1"));
        assert!(build(inputs.clone(), vec![0.0; 8]).to_string().contains("expected 9, got 8"));
        let twice = vec![inputs[0].clone(), inputs[0].clone()];
        assert!(build(twice, vec![0.0; 9]).to_string().contains("\"angle\" appears twice"));
        let mut broken = vec![0.0; 9];
        broken[4] = f64::INFINITY;
        assert!(build(inputs, broken).to_string().contains("consequents[4] must be finite"));
    }
}
