//! Takagi-Sugeno-Kang systems: rules that conclude a number.

use super::evaluate::with_scratch;
use super::parts::{Collected, Whole};
use super::rows::{for_each_eight, in_blocks};
use super::{Answer, Fired, Inference, Interface, NoRuleFires, Outside, TskGrid, Wrt, jacobian};
use super::{Kernel, Parameter, Parts, Rules};
use crate::check;
use crate::error::{Error, Result};
use crate::math::{Lanes, Numbers, Real, Scalar};
use crate::variable::{Term, Variable};

/// What a rule's consequent is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// A constant.
    Zero,
    /// A linear function of the inputs plus a constant.
    One,
}

/// What the constant of a linear consequent is called, so that no input can be.
pub(crate) const CONSTANT: &str = "constant";

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
    interface: Interface,
    order: Order,
    grid: TskGrid,
    parameters: Vec<f64>,
    prepared: Vec<f64>,
}

impl Tsk {
    /// A system whose consequents stand rule by rule, the last input's term changing fastest;
    /// for order 1 each rule has the coefficients of the inputs and then the constant.
    ///
    /// The output is called "output" and a point where no rule fires is an error; see
    /// [`with_output`](Self::with_output), [`when_no_rule_fires`](Self::when_no_rule_fires) and
    /// [`with_outside`](Self::with_outside).
    pub fn new(
        name: &str,
        inputs: Vec<Variable>,
        order: Order,
        consequents: Vec<f64>,
    ) -> Result<Self> {
        for input in &inputs {
            check::at_least(&format!("terms of \"{}\"", input.name()), input.terms().len(), 1)?;
        }
        let shape = |term: &Term| (term.function.shape(), term.function.parameters().len());
        let shapes: Vec<Vec<_>> =
            inputs.iter().map(|input| input.terms().iter().map(shape).collect()).collect();
        let mut interface = Interface::new(name, inputs)?;
        interface.add_output("output", NoRuleFires::Error)?;
        if order == Order::One {
            interface.refuse_input(CONSTANT)?;
        }
        let grid = TskGrid::new(&shapes, order).ok_or_else(|| {
            Error::wrong_shape(format!("rules of \"{name}\""), "a countable number", "too many")
        })?;
        check::same_length(
            &format!("consequent parameters of \"{name}\""),
            grid.rules() * grid.consequent_size(),
            consequents.len(),
        )?;
        check::all_finite("consequents", &consequents)?;

        let terms = interface.inputs().iter().flat_map(|variable| variable.terms());
        let mut parameters: Vec<f64> =
            terms.flat_map(|term| term.function.parameters().to_vec()).collect();
        parameters.extend(consequents);
        let mut prepared = vec![0.0; grid.prepared_count()];
        grid.prepare(&parameters, &mut prepared);
        Ok(Self { interface, order, grid, parameters, prepared })
    }

    /// [`new`](Self::new) with a constant for each rule.
    pub fn zero_order(name: &str, inputs: Vec<Variable>, consequents: Vec<f64>) -> Result<Self> {
        Self::new(name, inputs, Order::Zero, consequents)
    }

    /// The same system with another name for its output.
    pub fn with_output(mut self, output: &str) -> Result<Self> {
        check::name("output", output)?;
        output.clone_into(&mut self.interface.outputs[0].0);
        Ok(self)
    }

    /// The same system with another answer where no rule fires.
    pub fn when_no_rule_fires(mut self, answer: NoRuleFires) -> Result<Self> {
        self.interface.when_no_rule_fires(0, answer)?;
        Ok(self)
    }

    /// The same system with another treatment of inputs outside their universe.
    pub fn with_outside(mut self, outside: Outside) -> Self {
        self.interface.outside = outside;
        self
    }

    /// The system's name.
    pub fn name(&self) -> &str {
        self.interface.name()
    }

    /// The output's name.
    pub fn output(&self) -> &str {
        &self.interface.outputs[0].0
    }

    /// The input variables.
    pub fn inputs(&self) -> &[Variable] {
        self.interface.inputs()
    }

    /// The order of the consequents.
    pub fn order(&self) -> Order {
        self.order
    }

    /// What happens where no rule fires.
    pub fn no_rule_fires(&self) -> NoRuleFires {
        self.interface.outputs[0].1
    }

    /// The consequents' part of the parameter vector.
    pub fn consequents(&self) -> &[f64] {
        &self.parameters[self.grid.first_consequent()..]
    }

    /// The layout, for evaluating other vectors under this definition.
    pub fn grid(&self) -> &TskGrid {
        &self.grid
    }

    /// The output at one point, where none before is needed.
    pub fn evaluate(&self, x: &[f64]) -> Result<f64> {
        let mut output = [f64::NAN];
        self.evaluate_into(x, &mut output)?;
        Ok(output[0])
    }

    /// The output at one point, and its derivatives to the parameters.
    ///
    /// Where no rule fires the derivatives are zero, unless that is an error, and the output is
    /// the value for that or NaN.
    pub fn gradient(&self, x: &[f64], derivatives: &mut [f64]) -> Result<f64> {
        self.interface.check_point(x)?;
        check::same_length("derivatives", self.parameters.len(), derivatives.len())?;
        let inputs = x.len();
        with_scratch(inputs + self.grid.gradient_scratch_count(), |scratch| {
            let (admitted, scratch) = scratch.split_at_mut(inputs);
            admitted.copy_from_slice(x);
            self.interface.admit(admitted);
            let (parameters, prepared) = (self.parameters.as_slice(), self.prepared.as_slice());
            let fired = self.grid.gradient(parameters, prepared, admitted, scratch, derivatives);
            let answer = self.answer(fired);
            self.interface.check_answer(0, answer, || format!("{x:?}"))?;
            Ok(answer.value)
        })
    }

    /// The derivatives of the output to the parameters at the rows of `points`; row-major, one
    /// row for each point, equal to [`gradient`](Self::gradient) to the bit.
    pub fn gradient_batch(
        &self,
        points: &[f64],
        derivatives: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        let width = self.parameters.len();
        in_blocks(&self.interface, points, derivatives, width, threads, |rows, results, first| {
            self.gradient_rows(rows, results, first)
        })
    }

    fn gradient_rows(&self, points: &[f64], derivatives: &mut [f64], first: usize) -> Result<()> {
        let (inputs, width) = (self.inputs().len(), self.parameters.len());
        let zero = Lanes::splat(0.0);
        let mut scratch = vec![zero; self.grid.gradient_scratch_count()];
        let mut lanes = vec![zero; width];
        for_each_eight(&self.interface, points, first, |row, x| {
            let (parameters, prepared) = (self.parameters.as_slice(), self.prepared.as_slice());
            let fired = self.grid.gradient(parameters, prepared, x, &mut scratch, &mut lanes);
            let Answer { value, strength } = self.answer(fired);
            let each = value.to_array().into_iter().zip(strength.to_array());
            let rows = derivatives[row * width..].chunks_exact_mut(width);
            let points = points[row * inputs..].chunks_exact(inputs);
            for (lane, ((target, point), (value, strength))) in
                rows.zip(points).zip(each).enumerate()
            {
                let place = || format!("point {} {point:?}", first + row + lane);
                let answer = Answer { value, strength };
                self.interface.check_answer(0, answer, place)?;
                for (derivative, lanes) in target.iter_mut().zip(&lanes) {
                    *derivative = lanes.to_array()[lane];
                }
            }
            Ok(())
        })
    }

    #[inline(always)]
    pub(super) fn answer<R: Real>(&self, fired: Fired<R>) -> Answer<R> {
        let value = fired.average(self.no_rule_fires().fallback());
        Answer { value, strength: fired.strength }
    }
}

impl Inference for Tsk {
    type Prepared<N: Real> = Vec<N>;

    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn with_parameters(&self, parameters: &[f64]) -> Result<Self> {
        check::same_length(
            &format!("parameters of \"{}\"", self.name()),
            self.parameters.len(),
            parameters.len(),
        )?;
        let (terms, consequents) = parameters.split_at(self.grid.first_consequent());
        let inputs = self.interface.inputs_with_parameters(terms)?;
        let system = Self::new(self.name(), inputs, self.order, consequents.to_vec())?
            .with_output(self.output())?
            .when_no_rule_fires(self.no_rule_fires())?
            .with_outside(self.interface.outside);
        Ok(system)
    }

    fn accepts(&self, parameters: &[f64]) -> bool {
        self.grid.is_valid(parameters)
    }

    fn prepared(&self) -> &Vec<f64> {
        &self.prepared
    }

    fn prepare<N: Parameter>(&self, parameters: &[N]) -> Vec<N>
    where
        [N]: Numbers<N>,
    {
        let mut prepared = vec![N::splat(0.0); self.grid.prepared_count()];
        self.grid.prepare(parameters, &mut prepared);
        prepared
    }

    fn scratch_count(&self) -> usize {
        self.grid.scratch_count()
    }

    fn jacobian_batch(
        &self,
        wrt: Wrt,
        points: &[f64],
        derivatives: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        match wrt {
            Wrt::Inputs => jacobian::with_duals(self, wrt, points, derivatives, threads),
            Wrt::Parameters => self.gradient_batch(points, derivatives, threads),
        }
    }

    #[inline]
    fn infer<N: Scalar, R: Kernel<N>>(
        &self,
        prepared: &Vec<N>,
        x: &[R],
        scratch: &mut [R],
        answers: &mut [Answer<R>],
    ) where
        [N]: Numbers<R>,
    {
        answers[0] = self.answer(self.grid.infer(prepared.as_slice(), x, scratch));
    }
}

impl Rules for Tsk {
    fn rule_count(&self) -> usize {
        self.grid.rules()
    }

    fn fire<R: Kernel<f64>>(&self, x: &[R], scratch: &mut [R], strengths: &mut [R]) {
        self.grid.infer(self.prepared.as_slice(), x, scratch);
        self.grid.strengths(scratch, strengths);
    }

    fn parts(&self, x: &[f64], strengths: &[f64]) -> Vec<Parts> {
        let mut parts = Collected::new(strengths.len());
        for (rule, &w) in strengths.iter().enumerate() {
            let value = self.grid.consequent(self.prepared.as_slice(), x, rule);
            parts.conclude(rule, value);
            parts.give(rule, w, w * value);
        }
        vec![parts.finish(Whole::Average)]
    }
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
