//! Systems of fuzzy rules.

use std::path::PathBuf;

use fuzzy_core::format::write_atomically;
use fuzzy_core::inference::vocabulary;
use fuzzy_core::norm::{SNorm, TNorm};
use fuzzy_core::{Inference, Logic, Output, Outside, System, Variable};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyTuple};

use crate::arrays::{Floats, array, whole};
use crate::definition::{read_hedges, read_outputs, read_rules};
use crate::errors::{Error, Result};
use crate::evaluate::{self, Options};
use crate::insight::{self, Columns, Premise, PyExplanation, PyFinding};
use crate::membership::PyVariable;
use crate::output::PyOutput;
use crate::rules::PyRule;

/// A system of fuzzy rules with outputs of any kind: Mamdani, Larsen, Takagi-Sugeno-Kang,
/// Tsukamoto.
///
/// It is immutable; threads may share it.
///
/// `system(2, 1)` or `system(service=2, food=1)` evaluates one point, `system(X)` the rows of an
/// array of shape (n, inputs), `system(xs, ys)` arrays of any shapes that broadcast. With a single
/// output the result is a number or has the points' shape; with several it has a last axis more.
/// For a batch, `out=` is a float64 array for the results (partly written if there is an error)
/// and `threads=` the number of threads, 1 by default, 0 for one on each core. `previous=` is the
/// outputs before the first point, for outputs that keep theirs where no rule fires. Arrays of
/// float64 in C order are read in place with the GIL released: don't write to them from another
/// thread meanwhile.
///
/// Parameters
/// ----------
/// inputs : Variable or sequence of Variable
///     At least one. Those called out, previous or threads can be given by their place only.
/// outputs : Output, Variable, or sequence of them
///     A Variable stands for `Output.mamdani(variable)`.
/// rules : str or Rule, or sequence of them
///     In a text each line is a rule, such as "if service is poor or food is not very fresh then
///     tip is cheap with 0.5"; what follows a # is left out.
/// conjunction : str, optional
///     What AND means: "min", "product", "lukasiewicz", "drastic", "einstein", "hamacher" or
///     "nilpotent".
/// disjunction : str, optional
///     What OR means: "max", "probabilistic_sum", "lukasiewicz", "drastic", "einstein",
///     "hamacher" or "nilpotent".
/// hedges : dict of str to str, optional
///     Hedges of your own: formulas of the degree x, such as {"rather": "x^1.5"}.
/// outside : "keep", "clamp" or "error", optional
///     What is done with inputs outside their universe: they are taken as they are, brought to
///     the nearer end, or refused.
/// name : str, optional
///     What the system is called.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> service = fz.Variable("service", (0, 10), {"poor": fz.gaussian(0, 1.5),
/// ...     "good": fz.gaussian(5, 1.5), "excellent": fz.gaussian(10, 1.5)})
/// >>> food = fz.Variable("food", (0, 10), {"rancid": fz.trapezoidal(0, 0, 1, 3),
/// ...     "delicious": fz.trapezoidal(7, 9, 10, 10)})
/// >>> tip = fz.Variable("tip", (0, 30), {"cheap": fz.triangular(0, 5, 10),
/// ...     "average": fz.triangular(10, 15, 20), "generous": fz.triangular(20, 25, 30)})
/// >>> tipper = fz.System([service, food], tip, '''
/// ...     if service is poor or food is rancid then tip is cheap
/// ...     if service is good then tip is average
/// ...     if service is excellent or food is delicious then tip is generous''')
/// >>> round(tipper(service=2, food=1), 4)
/// 7.0169
/// >>> tipper([[2, 1], [4, 5], [7, 8]]).round(4)
/// array([ 7.0169, 14.4585, 20.3414])
#[pyclass(name = "System", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PySystem(pub System);

#[pymethods]
impl PySystem {
    #[new]
    #[pyo3(signature = (inputs, outputs, rules, *, conjunction = "min", disjunction = "max", hedges = None, outside = "keep", name = "system"))]
    #[expect(clippy::too_many_arguments, reason = "keywords of the Python class")]
    fn new(
        inputs: &Bound<'_, PyAny>,
        outputs: &Bound<'_, PyAny>,
        rules: &Bound<'_, PyAny>,
        conjunction: &str,
        disjunction: &str,
        hedges: Option<&Bound<'_, PyMapping>>,
        outside: &str,
        name: &str,
    ) -> Result<Self> {
        let inputs = read_inputs(inputs)?;
        let names: Vec<&str> = inputs.iter().map(|input| input.name()).collect();
        let outputs = read_outputs(outputs, &names)?;
        let logic = Logic {
            conjunction: TNorm::from_name(conjunction)?,
            disjunction: SNorm::from_name(disjunction)?,
            hedges: read_hedges(hedges)?,
        };
        let outside = Outside::from_name(outside)?;
        let words = vocabulary(&inputs, &outputs, &logic.hedges)?;
        let rules = read_rules(rules, &words)?;
        Ok(Self(System::new(name, inputs, outputs, rules, logic)?.with_outside(outside)))
    }

    /// The system's name.
    #[getter]
    fn name(&self) -> &str {
        self.0.interface().name()
    }

    /// The input variables.
    #[getter]
    fn inputs(&self) -> Vec<PyVariable> {
        self.0.interface().inputs().iter().cloned().map(PyVariable).collect()
    }

    /// The outputs.
    #[getter]
    fn outputs(&self) -> Result<Vec<PyOutput>> {
        self.0.outputs().iter().map(PyOutput::of_system).collect()
    }

    /// The rules.
    #[getter]
    fn rules(&self) -> Vec<PyRule> {
        self.0.rules().iter().cloned().map(PyRule).collect()
    }

    /// What AND means.
    #[getter]
    fn conjunction(&self) -> &'static str {
        self.0.logic().conjunction.name()
    }

    /// What OR means.
    #[getter]
    fn disjunction(&self) -> &'static str {
        self.0.logic().disjunction.name()
    }

    /// The hedges of one's own, by name.
    #[getter]
    fn hedges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let hedges = PyDict::new(py);
        for hedge in &self.0.logic().hedges {
            hedges.set_item(hedge.name(), hedge.formula())?;
        }
        Ok(hedges)
    }

    /// What is done with inputs outside their universe.
    #[getter]
    fn outside(&self) -> &'static str {
        self.0.interface().outside().name()
    }

    /// A copy of the flat parameter vector: the inputs' terms, the outputs' terms, the weights.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.parameters())
    }

    /// What each parameter is called.
    #[getter]
    fn parameter_names(&self) -> Vec<String> {
        self.0.parameter_info().into_iter().map(|parameter| parameter.name).collect()
    }

    /// The range that a learner searches for each parameter, shape (parameters, 2); infinite for
    /// the numbers of Sugeno outputs.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let info = self.0.parameter_info();
        let numbers = info.iter().flat_map(|parameter| [parameter.low, parameter.high]).collect();
        array(py, numbers, &[info.len(), 2])
    }

    /// The same definition with another parameter vector.
    ///
    /// Parameters
    /// ----------
    /// parameters : array_like of float
    ///     As long as `parameters`; widths positive, vertices in order, weights from 0 to 1.
    ///
    /// Returns
    /// -------
    /// System
    fn with_parameters(&self, parameters: &Bound<'_, PyAny>) -> Result<Self> {
        let parameters = Floats::new(parameters, "parameters")?;
        Ok(Self(self.0.with_parameters(parameters.vector("parameters")?)?))
    }

    #[pyo3(signature = (*x, out = None, previous = None, threads = 1, **named))]
    fn __call__<'py>(
        &self,
        x: &Bound<'py, PyTuple>,
        out: Option<&Bound<'py, PyAny>>,
        previous: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = whole)] threads: usize,
        named: Option<&Bound<'py, PyDict>>,
    ) -> Result<Bound<'py, PyAny>> {
        evaluate::call(&self.0, x, &Options { out, previous, threads, named })
    }

    /// The outputs of many systems, this one with each of many parameter vectors, at many points.
    ///
    /// Parameters
    /// ----------
    /// parameters : array_like of float
    ///     Shape (p, parameters).
    /// x : array_like of float
    ///     Shape (n, inputs).
    /// out : numpy.ndarray, optional
    ///     A contiguous float64 array for the result.
    /// threads : int, optional
    ///     Threads; 0 for one on each core.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Shape (p, n), or (p, n, outputs) if there are several.
    #[pyo3(signature = (parameters, x, *, out = None, threads = 1))]
    fn population<'py>(
        &self,
        parameters: &Bound<'py, PyAny>,
        x: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = whole)] threads: usize,
    ) -> Result<Bound<'py, PyAny>> {
        evaluate::population(&self.0, parameters, x, out, threads)
    }

    /// The derivatives of the outputs to every parameter or input.
    ///
    /// At a kink of a norm or membership function the derivative is one-sided; the bisector and
    /// the maximum defuzzifiers pick samples, so theirs is zero.
    ///
    /// Parameters
    /// ----------
    /// x : array_like of float
    ///     One point, shape (inputs,), or many, shape (n, inputs).
    /// wrt : "parameters" or "inputs", optional
    ///     What the derivatives are taken to.
    /// threads : int, optional
    ///     Threads for many points; 0 for one on each core.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Shape (k,) or (n, k) for k parameters or inputs; with several outputs an axis for them
    ///     before the last. Zero where no rule fires, if that is no error.
    #[pyo3(signature = (x, *, wrt = "parameters", threads = 1))]
    fn gradient<'py>(
        &self,
        x: &Bound<'py, PyAny>,
        wrt: &str,
        #[pyo3(from_py_with = whole)] threads: usize,
    ) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        evaluate::gradient(&self.0, x, evaluate::wrt(wrt)?, threads)
    }

    /// What happens at one point: degrees, firing strengths, and what each rule has in the output.
    ///
    /// It takes a point as a call does: `system.explain(2, 1)`, `system.explain(service=2, food=1)`,
    /// `system.explain([2, 1])`. Where no rule fires it doesn't raise but says so.
    ///
    /// Parameters
    /// ----------
    /// *x, **named : float or array_like
    ///     The inputs by place or by name, or one array of them.
    ///
    /// Returns
    /// -------
    /// Explanation
    #[pyo3(signature = (*x, **named))]
    fn explain(
        &self,
        x: &Bound<'_, PyTuple>,
        named: Option<&Bound<'_, PyDict>>,
    ) -> Result<PyExplanation> {
        insight::explain(&self.0, x, named)
    }

    /// How strongly each rule fires, its weight included.
    ///
    /// Parameters
    /// ----------
    /// x : array_like of float
    ///     One point, shape (inputs,), or many, shape (n, inputs).
    /// threads : int, optional
    ///     Threads for many points; 0 for one on each core.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Shape (rules,) or (n, rules).
    #[pyo3(signature = (x, *, threads = 1))]
    fn strengths<'py>(
        &self,
        x: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = whole)] threads: usize,
    ) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        insight::strengths(&self.0, x, threads)
    }

    /// What is odd about the definition: what can never matter, what contradicts itself, and where
    /// no rule fires. What looks odd may be meant.
    ///
    /// Where no rule fires is looked for at thousands of points spread over the universes; the
    /// rest follows from the definition.
    ///
    /// Returns
    /// -------
    /// list of Finding
    ///
    /// Examples
    /// --------
    /// >>> import fuzzyrs as fz
    /// >>> x = fz.Variable.evenly("x", (0, 10), ["low", "high"])
    /// >>> y = fz.Variable.evenly("y", (0, 1), ["low", "high"])
    /// >>> rules = ["if x is low then y is low", "if x is low then y is high with 0.5"]
    /// >>> for finding in fz.System([x], y, rules).validate():
    /// ...     print(finding)
    /// no rule asks whether the input "x" is "high"; delete the term, or use it
    /// rule 2 says "y is high" under the condition under which rule 1 says "y is low"; keep one of them, or make their conditions differ
    fn validate(&self, py: Python<'_>) -> Vec<PyFinding> {
        insight::validate(py, &self.0)
    }

    /// The propositions of a rule's antecedent, such as "service is not very poor", with their
    /// degrees at points. Hedges before several propositions belong to none.
    ///
    /// Parameters
    /// ----------
    /// rule : int
    ///     The number of the rule, counted from 0.
    /// x : array_like of float
    ///     Shape (n, inputs).
    ///
    /// Returns
    /// -------
    /// list of (str, str, numpy.ndarray)
    ///     The input, what it is to be, and the degrees of that, shape (n,).
    fn premises<'py>(
        &self,
        #[pyo3(from_py_with = whole)] rule: usize,
        x: &Bound<'py, PyAny>,
    ) -> Result<Vec<Premise<'py>>> {
        insight::premises(&self.0, rule, x)
    }

    /// The fuzzy set that a rule of some strength implies about a Mamdani output.
    ///
    /// Parameters
    /// ----------
    /// rule : int
    ///     The number of the rule, counted from 0.
    /// output : str
    ///     The output.
    /// strength : float
    ///     How strongly the rule fires, from 0 to 1; at 1 the set is the whole term.
    ///
    /// Returns
    /// -------
    /// (numpy.ndarray, numpy.ndarray) or None
    ///     Numbers and degrees at the output's samples, or at 1001 points if it has none; None if
    ///     the rule concludes no set about the output.
    fn implied_set<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] rule: usize,
        output: &str,
        strength: f64,
    ) -> Result<Option<Columns<'py>>> {
        insight::implied_set(py, &self.0, rule, output, strength)
    }

    /// The system as a JSON document.
    fn to_json(&self) -> Result<String> {
        Ok(self.0.to_json()?)
    }

    /// The system that a JSON document describes.
    #[staticmethod]
    pub fn from_json(text: &str) -> Result<Self> {
        Ok(Self(System::from_json(text)?))
    }

    /// Write the system to a JSON file: the old file stays until the new one is complete.
    fn save(&self, path: PathBuf) -> Result<()> {
        Ok(write_atomically(&path, &self.0.to_json()?)?)
    }

    fn __repr__(&self) -> String {
        let inputs: Vec<String> = self
            .0
            .interface()
            .inputs()
            .iter()
            .map(|variable| {
                let terms: Vec<&str> = variable.terms().iter().map(|term| &*term.name).collect();
                format!("{} [{}]", variable.name(), terms.join(" "))
            })
            .collect();
        let outputs: Vec<&str> = self.0.outputs().iter().map(Output::name).collect();
        format!(
            "<System {:?}: {} -> {}, {} rules>",
            self.name(),
            inputs.join(", "),
            outputs.join(", "),
            self.0.rules().len()
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let text = slf.get().0.to_json().map_err(Error::from)?;
        (slf.get_type().getattr("from_json")?, (text,)).into_pyobject(slf.py())
    }
}

/// One input or several.
fn read_inputs(inputs: &Bound<'_, PyAny>) -> Result<Vec<Variable>> {
    let wrong = |object: &Bound<'_, PyAny>| {
        let came = object.get_type();
        Error::WrongType(format!("inputs must be Variable objects, got {came}"))
    };
    if let Ok(variable) = inputs.cast::<PyVariable>() {
        return Ok(vec![variable.get().0.clone()]);
    }
    let several = inputs.try_iter().map_err(|_| wrong(inputs))?;
    several
        .map(|object| {
            let object = object?;
            let variable = object.cast::<PyVariable>().map_err(|_| wrong(&object))?;
            Ok(variable.get().0.clone())
        })
        .collect()
}
