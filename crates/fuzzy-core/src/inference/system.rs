//! Rule systems of any kind: Mamdani, Larsen, Sugeno and Tsukamoto outputs under one set of rules.

use super::plan::{Plan, Prepared};
use super::{Answer, Inference, Interface, Kernel, Outside, Parameter, Parts, Rules};
use crate::check;
use crate::error::{Error, Result};
use crate::hedge::Hedge;
use crate::math::{Numbers, Real, Scalar};
use crate::norm::{SNorm, TNorm};
use crate::output::Output;
use crate::rule::{Consequent, Rule, Vocabulary};
use crate::variable::Variable;

/// The norms and hedges of a [`System`].
#[derive(Debug, Clone, PartialEq)]
pub struct Logic {
    /// What AND means.
    pub conjunction: TNorm,
    /// What OR means.
    pub disjunction: SNorm,
    /// Hedges of one's own, beside or instead of the built-in ones.
    pub hedges: Vec<Hedge>,
}

impl Default for Logic {
    /// Min, max and the built-in hedges.
    fn default() -> Self {
        Self { conjunction: TNorm::Min, disjunction: SNorm::Max, hedges: Vec::new() }
    }
}

/// A system of fuzzy rules: inputs, outputs of any [`Method`](crate::output::Method), and rules that join them.
///
/// It is immutable and may be shared between threads. Its numbers are one flat vector: the
/// parameters of the inputs' terms, those of the outputs' terms, and the rules' weights.
///
/// ```
/// use fuzzy_core::{Inference, Logic, Output, Shape, System, Variable};
///
/// let speed = Variable::evenly("speed", (0.0, 10.0), Shape::Triangular, &["slow", "fast"])?;
/// let brake = Variable::evenly("brake", (0.0, 1.0), Shape::Triangular, &["soft", "hard"])?;
/// let system = System::from_text(
///     "car",
///     vec![speed],
///     vec![Output::mamdani(brake)?],
///     "if speed is slow then brake is soft\n\
///      if speed is very fast then brake is hard with 0.5",
///     Logic::default(),
/// )?;
/// let mut brake = [0.0];
/// system.evaluate_into(&[2.0], &mut brake)?;
/// assert!(brake[0] < 0.4);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct System {
    interface: Interface,
    outputs: Vec<Output>,
    rules: Vec<Rule>,
    logic: Logic,
    parameters: Vec<f64>,
    plan: Plan,
    prepared: Prepared<f64>,
}

impl PartialEq for System {
    /// Systems are equal if they are defined equally.
    fn eq(&self, other: &Self) -> bool {
        self.interface == other.interface
            && self.outputs == other.outputs
            && self.rules == other.rules
            && self.logic == other.logic
    }
}

impl System {
    /// A system of these rules, at least one for each output. Inputs that only formulas ask for
    /// need no terms.
    ///
    /// A formula that a rule concludes becomes a term of its Sugeno output, named after the rule
    /// (`rule3`), so that its coefficients are parameters.
    pub fn new(
        name: &str,
        inputs: Vec<Variable>,
        outputs: Vec<Output>,
        rules: Vec<Rule>,
        logic: Logic,
    ) -> Result<Self> {
        let mut interface = Interface::new(name, inputs)?;
        check::at_least(&format!("outputs of \"{name}\""), outputs.len(), 1)?;
        check::at_least(&format!("rules of \"{name}\""), rules.len(), 1)?;
        for output in &outputs {
            interface.refuse_input(output.name())?;
            interface.add_output(output.name(), output.no_rule_fires())?;
        }
        interface.refuse_input(super::CONSTANT)?;
        let (outputs, rules) = name_formulas(outputs, rules)?;
        let vocabulary = vocabulary(interface.inputs(), &outputs, &logic.hedges)?;
        for (index, rule) in rules.iter().enumerate() {
            vocabulary.check(rule, index + 1)?;
        }
        let plan = Plan::new(&interface, &outputs, &rules, &logic)?;
        let mut parameters: Vec<f64> =
            interface.inputs().iter().flat_map(Variable::parameters).collect();
        parameters.extend(outputs.iter().flat_map(Output::parameters));
        parameters.extend(rules.iter().map(|rule| rule.weight));
        let prepared = plan.prepare(&parameters);
        Ok(Self { interface, outputs, rules, logic, parameters, plan, prepared })
    }

    /// A system whose rules are a text, one rule on each line.
    pub fn from_text(
        name: &str,
        inputs: Vec<Variable>,
        outputs: Vec<Output>,
        rules: &str,
        logic: Logic,
    ) -> Result<Self> {
        let rules =
            crate::rule::parse_rules(rules, &vocabulary(&inputs, &outputs, &logic.hedges)?)?;
        Self::new(name, inputs, outputs, rules, logic)
    }

    /// The same system with another treatment of inputs outside their universe.
    pub fn with_outside(mut self, outside: Outside) -> Self {
        self.interface.outside = outside;
        self
    }

    /// The outputs.
    pub fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// The rules.
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }

    /// The norms and hedges.
    pub fn logic(&self) -> &Logic {
        &self.logic
    }

    pub(super) fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The output at one point, if the system has a single output.
    pub fn evaluate(&self, x: &[f64]) -> Result<f64> {
        let mut output = [f64::NAN];
        self.evaluate_into(x, &mut output)?;
        Ok(output[0])
    }
}

/// The names that rules over these variables may use.
pub fn vocabulary(inputs: &[Variable], outputs: &[Output], hedges: &[Hedge]) -> Result<Vocabulary> {
    let terms = |variable: &Variable| {
        let names = variable.terms().iter().map(|term| term.name.clone());
        (variable.name().to_owned(), names.collect())
    };
    let concluded = |output: &Output| {
        let names = output.term_names().into_iter().map(str::to_owned);
        (output.name().to_owned(), names.collect())
    };
    check::at_least("inputs of a system", inputs.len(), 1)?;
    check::at_least("outputs of a system", outputs.len(), 1)?;
    Vocabulary::new(
        inputs.iter().map(terms).collect(),
        outputs.iter().map(concluded).collect(),
        all_hedges(hedges).iter().map(|hedge| hedge.name().to_owned()).collect(),
    )
}

/// The hedges that rules may use: one's own, then the built-in ones of other names.
pub(crate) fn all_hedges(own: &[Hedge]) -> Vec<Hedge> {
    let built_in = Hedge::built_in().into_iter();
    let others = built_in.filter(|hedge| own.iter().all(|other| other.name() != hedge.name()));
    own.iter().cloned().chain(others).collect()
}

/// Makes terms of the formulas that rules conclude.
fn name_formulas(
    mut outputs: Vec<Output>,
    mut rules: Vec<Rule>,
) -> Result<(Vec<Output>, Vec<Rule>)> {
    for (index, rule) in rules.iter_mut().enumerate() {
        for conclusion in &mut rule.conclusions {
            let Consequent::Formula(formula) = &conclusion.value else { continue };
            let Some(output) = outputs.iter_mut().find(|o| o.name() == conclusion.output) else {
                let known = outputs.iter().map(Output::name);
                return Err(Error::unknown_name("output", &conclusion.output, known));
            };
            let term = free_name(format!("rule{}", index + 1), &output.term_names());
            output.add_formula(&term, formula.clone())?;
            conclusion.value = Consequent::Term { hedges: Vec::new(), term };
        }
    }
    Ok((outputs, rules))
}

/// The name, with a number behind it if it is taken.
fn free_name(name: String, taken: &[&str]) -> String {
    let numbered = (2..).map(|number| format!("{name}_{number}"));
    let mut names = std::iter::once(name.clone()).chain(numbered);
    names.find(|name| !taken.contains(&name.as_str())).unwrap_or(name)
}

impl Inference for System {
    type Prepared<N: Real> = Prepared<N>;

    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn with_parameters(&self, parameters: &[f64]) -> Result<Self> {
        let what = format!("parameters of \"{}\"", self.interface.name());
        check::same_length(&what, self.parameters.len(), parameters.len())?;
        let (numbers, weights) = parameters.split_at(self.plan.first_weight);
        let of_inputs = self.interface.inputs().iter().map(Variable::parameter_count).sum();
        let (of_inputs, mut rest) = numbers.split_at(of_inputs);
        let inputs = self.interface.inputs_with_parameters(of_inputs)?;
        let mut outputs = Vec::with_capacity(self.outputs.len());
        for output in &self.outputs {
            let (own, others) = rest.split_at(output.parameters().len());
            outputs.push(output.with_parameters(own)?);
            rest = others;
        }
        let rules = self.rules.iter().cloned().zip(weights);
        let rules = rules.map(|(rule, &w)| rule.with_weight(w)).collect::<Result<Vec<_>>>()?;
        let system = Self::new(self.interface.name(), inputs, outputs, rules, self.logic.clone())?;
        Ok(system.with_outside(self.interface.outside))
    }

    fn accepts(&self, parameters: &[f64]) -> bool {
        self.plan.accepts(parameters)
    }

    fn prepared(&self) -> &Prepared<f64> {
        &self.prepared
    }

    fn prepare<N: Parameter>(&self, parameters: &[N]) -> Prepared<N>
    where
        [N]: Numbers<N>,
    {
        N::prepare(&self.plan, parameters)
    }

    fn scratch_count(&self) -> usize {
        self.plan.scratch_count()
    }

    fn infer<N: Scalar, R: Kernel<N>>(
        &self,
        prepared: &Prepared<N>,
        x: &[R],
        scratch: &mut [R],
        answers: &mut [Answer<R>],
    ) where
        [N]: Numbers<R>,
    {
        R::infer(&self.plan, &self.interface, prepared, x, scratch, answers);
    }
}

impl Rules for System {
    fn rule_count(&self) -> usize {
        self.rules.len()
    }

    fn fire<R: Kernel<f64>>(&self, x: &[R], scratch: &mut [R], strengths: &mut [R]) {
        R::fire(&self.plan, &self.prepared, x, scratch, strengths);
    }

    fn parts(&self, x: &[f64], strengths: &[f64]) -> Vec<Parts> {
        self.plan.parts(&self.prepared, x, strengths)
    }
}
