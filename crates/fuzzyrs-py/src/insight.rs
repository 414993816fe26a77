//! Explanations, findings, and how strongly rules fire.

use fuzzy_core::check::{fraction, zeros};
use fuzzy_core::insight::{ExplainedOutput, ExplainedRule, Explanation, Finding, Insight};
use fuzzy_core::{Error, Inference, Output, System};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Floats, array, whole};
use crate::errors::Result;
use crate::evaluate::point;

/// What happens in a fuzzy system at one point: why it answers what it answers.
///
/// Made by `system.explain(...)`. It is printed as a table, and shown as one in a notebook.
/// Arrays have one number for each rule, in the order of the rules.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> x = fz.Variable.evenly("x", (0, 10), ["low", "high"], "triangular")
/// >>> rules = ["if x is low then y = 2*x", "if x is high then y = 5"]
/// >>> fz.System([x], fz.Output.sugeno("y"), rules).explain(4)
/// system
/// <BLANKLINE>
/// input  value  degrees
/// x          4  low 0.6, high 0.4
/// <BLANKLINE>
/// rule  strength  share  concludes  adds
///    1       0.6    0.6          8   4.8  if x is low then y = 2*x
///    2       0.4    0.4          5     2  if x is high then y = 5
/// <BLANKLINE>
/// output  value
/// y       6.8
#[pyclass(name = "Explanation", module = "fuzzyrs", frozen)]
pub struct PyExplanation(pub Explanation);

#[pymethods]
impl PyExplanation {
    /// The name of the system.
    #[getter]
    fn system(&self) -> &str {
        &self.0.system
    }

    /// The inputs as they came, by name.
    #[getter]
    fn given<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        by_name(py, self.0.inputs.iter().map(|input| (&input.name, input.given)))
    }

    /// The inputs as the system takes them, by name: brought into their universes if it does
    /// that.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        by_name(py, self.0.inputs.iter().map(|input| (&input.name, input.value)))
    }

    /// The degrees of the terms of each input, by name.
    #[getter]
    fn degrees<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let inputs = self.0.inputs.iter().map(|input| {
            let degrees = input.degrees.iter().map(|(term, degree)| (term, *degree));
            Ok((&input.name, by_name(py, degrees)?))
        });
        by_name(py, inputs.collect::<PyResult<Vec<_>>>()?)
    }

    /// The rules in words. A formula that a rule concludes stands in it with its present numbers.
    #[getter]
    fn rules(&self) -> Vec<&str> {
        self.0.rules.iter().map(|rule| &*rule.words.text).collect()
    }

    /// What each rule concludes, by output: such as {"tip": "tip is cheap"}.
    #[getter]
    fn conclusions<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let of_rule = |rule: &ExplainedRule| {
            let named = PyDict::new(py);
            for (output, text) in &rule.words.conclusions {
                let before: Option<String> =
                    named.get_item(output)?.map(|text| text.extract()).transpose()?;
                let whole = before.map(|before| format!("{before} and {text}"));
                named.set_item(output, whole.as_ref().unwrap_or(text))?;
            }
            Ok(named)
        };
        self.0.rules.iter().map(of_rule).collect()
    }

    /// How strongly each rule fires, its weight included.
    #[getter]
    fn strengths<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.0.rules.iter().map(|rule| rule.strength))
    }

    /// The outputs by name, as evaluation has them to the last bit. Where no rule fires, the
    /// number that stands for the output then, or NaN.
    #[getter]
    fn outputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.of_outputs(py, |output| output.value)
    }

    /// Whether any rule about an output fires, by name.
    #[getter]
    fn fires<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.of_outputs(py, |output| output.fires)
    }

    /// The share of each rule in each output: of the firing strengths, or of the area of the
    /// aggregated set.
    ///
    /// They add up to 1, or are all 0 where no rule fires. Where strengths or sets are joined by
    /// max, what is joined belongs to the rules that reach it, evenly if there are several;
    /// otherwise it is divided in proportion to what each rule brings. A set is divided at each
    /// sample of its own; one without samples everywhere.
    #[getter]
    fn shares<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.of_outputs(py, |output| PyArray1::from_slice(py, &output.parts.shares))
    }

    /// What each rule adds to each output. They add up to it, but for rounding, where rules fire.
    ///
    /// In a weighted average its share times what it concludes, in a weighted sum its strength
    /// times that, in a centroid its share times the centroid of its part of the aggregated set.
    /// The bisector and the maximum defuzzifiers pick a point, which is no sum: there they are
    /// NaN.
    #[getter]
    fn contributions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.of_outputs(py, |output| PyArray1::from_slice(py, &output.parts.contributions))
    }

    /// The number that each rule concludes about each output that weighs numbers; NaN where it
    /// concludes a fuzzy set or nothing.
    #[getter]
    fn concluded<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.of_outputs(py, |output| PyArray1::from_slice(py, &output.parts.concluded))
    }

    /// The aggregated set of each output that has one: numbers in their order and their degrees,
    /// at the output's samples or, without samples, at the corners of the set.
    #[getter]
    fn sets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let with_set = self.0.outputs.iter().filter(|output| !output.parts.set.is_empty());
        by_name(py, with_set.map(|output| (&output.name, columns(py, &output.parts.set))))
    }

    /// The numbers of the strongest rules, counted from 0, in the order of the rules; of equally
    /// strong ones the first.
    ///
    /// Parameters
    /// ----------
    /// most : int
    ///     How many, if there are as many.
    ///
    /// Returns
    /// -------
    /// list of int
    fn strongest(&self, #[pyo3(from_py_with = whole)] most: usize) -> Vec<usize> {
        self.0.strongest(most)
    }

    /// The tables as HTML.
    fn to_html(&self) -> String {
        self.0.to_html()
    }

    fn _repr_html_(&self) -> String {
        self.0.to_html()
    }

    fn __repr__(&self) -> String {
        self.0.to_string().trim_end().to_owned()
    }
}

impl PyExplanation {
    fn of_outputs<'a, 'py, T: IntoPyObject<'py>>(
        &'a self,
        py: Python<'py>,
        what: impl Fn(&'a ExplainedOutput) -> T,
    ) -> PyResult<Bound<'py, PyDict>> {
        by_name(py, self.0.outputs.iter().map(|output| (&output.name, what(output))))
    }
}

/// A dictionary of things that have names.
fn by_name<'a, 'py>(
    py: Python<'py>,
    things: impl IntoIterator<Item = (&'a String, impl IntoPyObject<'py>)>,
) -> PyResult<Bound<'py, PyDict>> {
    let named = PyDict::new(py);
    things.into_iter().try_for_each(|(name, thing)| named.set_item(name, thing))?;
    Ok(named)
}

/// An array of places and one of degrees.
pub type Columns<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

fn columns<'py>(py: Python<'py>, set: &[(f64, f64)]) -> Columns<'py> {
    let places = PyArray1::from_iter(py, set.iter().map(|point| point.0));
    (places, PyArray1::from_iter(py, set.iter().map(|point| point.1)))
}

/// An input, what it is to be, and the degrees of that.
pub type Premise<'py> = (String, String, Bound<'py, PyArray1<f64>>);

/// Something odd about a fuzzy system: what, where, and what can be done.
///
/// Found by `system.validate()`. Its text is the message.
///
/// Parameters
/// ----------
/// kind : str
///     "gap", "no_rule_fires", "unused_input", "unused_term", "outside_universe", "unseen_term",
///     "duplicate_rule", "contradiction", "zero_weight", "never_fires" or "unreachable_term".
/// message : str
///     What it is in words.
#[pyclass(name = "Finding", module = "fuzzyrs", frozen, eq)]
#[derive(PartialEq)]
pub struct PyFinding {
    /// What sort of thing it is.
    #[pyo3(get)]
    kind: String,
    /// What it is in words.
    #[pyo3(get)]
    message: String,
}

impl From<Finding> for PyFinding {
    fn from(finding: Finding) -> Self {
        Self { kind: finding.kind.name().to_owned(), message: finding.message }
    }
}

#[pymethods]
impl PyFinding {
    #[new]
    fn new(kind: String, message: String) -> Self {
        Self { kind, message }
    }

    fn __str__(&self) -> &str {
        &self.message
    }

    fn __repr__(&self) -> String {
        format!("Finding({:?}, {:?})", self.kind, self.message)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let finding = slf.get();
        (slf.get_type(), (&finding.kind, &finding.message)).into_pyobject(slf.py())
    }
}

/// What happens at the point that the arguments of a call stand for.
pub fn explain<S: Insight>(
    system: &S,
    x: &Bound<'_, PyTuple>,
    named: Option<&Bound<'_, PyDict>>,
) -> Result<PyExplanation> {
    let point = point(system, x, named)?;
    Ok(PyExplanation(x.py().detach(|| system.explain(&point))?))
}

/// What is odd about a system.
pub fn validate<S: Insight>(py: Python<'_>, system: &S) -> Vec<PyFinding> {
    py.detach(|| system.validate()).into_iter().map(PyFinding::from).collect()
}

/// The firing strength of every rule at one point or at many.
pub fn strengths<'py, S: Insight>(
    system: &S,
    x: &Bound<'py, PyAny>,
    threads: usize,
) -> Result<Bound<'py, PyArrayDyn<f64>>> {
    let (py, rules) = (x.py(), system.rule_count());
    let points = Floats::new(x, "x")?;
    if points.shape().len() == 1 {
        return array(py, system.firing_strengths(points.as_slice()?)?, &[rules]);
    }
    let inputs = system.interface().inputs().len();
    let rows = points.rows("x", inputs)?;
    let count = rows.len() / inputs;
    let mut strengths = zeros("the firing strengths", count, rules)?;
    py.detach(|| system.firing_strengths_batch(rows, &mut strengths, threads))?;
    array(py, strengths, &[count, rules])
}

/// The propositions of a rule's antecedent, with their degrees at points.
pub fn premises<'py>(
    system: &System,
    rule: usize,
    x: &Bound<'py, PyAny>,
) -> Result<Vec<Premise<'py>>> {
    let (inputs, points) = (system.interface().inputs(), Floats::new(x, "x")?);
    let rows = points.rows("x", inputs.len())?;
    let with_degrees = system.premises(rule)?.into_iter().map(|premise| {
        let column = rows.iter().skip(premise.input).step_by(inputs.len());
        let degrees = PyArray1::from_iter(x.py(), column.map(|&x| premise.degree(x)));
        (inputs[premise.input].name().to_owned(), premise.words(), degrees)
    });
    Ok(with_degrees.collect())
}

/// The set that a rule of some strength implies about an output.
pub fn implied_set<'py>(
    py: Python<'py>,
    system: &System,
    rule: usize,
    output: &str,
    strength: f64,
) -> Result<Option<Columns<'py>>> {
    let strength = fraction("the strength", strength)?;
    let names = system.outputs().iter().map(Output::name);
    let found = names.clone().position(|name| name == output);
    let index = found.ok_or_else(|| Error::unknown_name("output", output, names))?;
    let set = system.implied_set(rule, index, strength)?;
    Ok(set.map(|set| columns(py, &set)))
}
