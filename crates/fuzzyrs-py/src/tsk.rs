//! Takagi-Sugeno-Kang systems on rule grids.

use std::path::PathBuf;

use fuzzy_core::format::write_atomically;
use fuzzy_core::{Inference, Order, Outside, Tsk};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Floats, Shape, array, whole};
use crate::errors::{Error, Result};
use crate::evaluate::{self, Options};
use crate::insight::{self, PyExplanation, PyFinding};
use crate::membership::PyVariable;
use crate::output::{answer, no_rule_fires};

/// A Takagi-Sugeno-Kang system on a rule grid: one rule for each combination of terms, product as
/// AND, weighted average as output.
///
/// It is immutable; threads may share it.
///
/// `system(x, y)` evaluates one point, by place or by name, `system(X)` the rows of an array of
/// shape (n, inputs), `system(xs, ys)` arrays of any shapes that broadcast. `previous=` is the
/// output before the first point, for systems that keep theirs where no rule fires. For a batch, `out=` is a float64 array of
/// shape (n,) for the results (partly written if there is an error) and `threads=` the number of
/// threads, 1 by default, 0 for one on each core. Arrays of float64 in C order are read in place
/// with the GIL released: don't write to them from another thread meanwhile.
///
/// Parameters
/// ----------
/// inputs : sequence of Variable
///     At least one, each with at least one term.
/// consequents : array_like of float
///     For order 0 one number for each rule, shaped like the grid (terms of the first input, terms
///     of the second, ...) or flat with the last input's term changing fastest. For order 1 with a
///     last axis more: the coefficients of the inputs, then the constant.
/// order : {0, 1}, optional
///     Constants, or linear functions of the inputs.
/// name, output : str, optional
///     What the system and its output are called.
/// no_rule_fires : "error", "nan", "previous" or float, optional
///     The answer where no rule fires.
/// outside : "keep", "clamp" or "error", optional
///     What is done with inputs outside their universe: they are taken as they are, brought to
///     the nearer end, or refused.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> angle = fz.Variable.evenly("angle", (-1, 1), "NZP")
/// >>> rate = fz.Variable.evenly("rate", (-1, 1), "NZP")
/// >>> steer = fz.TSK([angle, rate], [[-0.5, -0.25, 0], [-0.25, 0, 0.25], [0, 0.25, 0.5]])
/// >>> round(steer(0.5, 0.0), 3)
/// 0.124
/// >>> steer([[0.5, 0.0], [-0.5, 0.0]]).round(3)
/// array([ 0.124, -0.124])
#[pyclass(name = "TSK", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyTsk(pub Tsk);

#[pymethods]
impl PyTsk {
    #[new]
    #[pyo3(signature = (inputs, consequents, *, order = 0, name = "system", output = "output", no_rule_fires = None, outside = "keep"))]
    fn new(
        inputs: Vec<Bound<'_, PyVariable>>,
        consequents: &Bound<'_, PyAny>,
        order: i64,
        name: &str,
        output: &str,
        no_rule_fires: Option<&Bound<'_, PyAny>>,
        outside: &str,
    ) -> Result<Self> {
        let inputs: Vec<_> = inputs.iter().map(|variable| variable.get().0.clone()).collect();
        let order = match order {
            0 => Order::Zero,
            1 => Order::One,
            other => {
                return Err(fuzzy_core::Error::OutOfRange {
                    what: "order".to_owned(),
                    expected: "0 or 1".to_owned(),
                    value: other as f64,
                }
                .into());
            }
        };
        let mut shape: Vec<usize> = inputs.iter().map(|variable| variable.terms().len()).collect();
        if order == Order::One {
            shape.push(inputs.len() + 1);
        }
        let consequents = Floats::new(consequents, "consequents")?;
        let came = consequents.shape();
        if came.len() != 1 && came != shape {
            let expected = format!("{}, the grid of the rules, or a flat array", Shape(&shape));
            let what = "consequents";
            return Err(fuzzy_core::Error::wrong_shape(what, expected, Shape(came)).into());
        }
        let system = Tsk::new(name, inputs, order, consequents.as_slice()?.to_vec())?
            .with_output(output)?
            .when_no_rule_fires(answer(no_rule_fires)?)?
            .with_outside(Outside::from_name(outside)?);
        Ok(Self(system))
    }

    /// The system's name.
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// The output's name.
    #[getter]
    fn output(&self) -> &str {
        self.0.output()
    }

    /// 0 for constants, 1 for linear consequents.
    #[getter]
    fn order(&self) -> u8 {
        match self.0.order() {
            Order::Zero => 0,
            Order::One => 1,
        }
    }

    /// The answer where no rule fires: "error", "nan", "previous" or a number.
    #[getter]
    fn no_rule_fires<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        no_rule_fires(py, self.0.no_rule_fires())
    }

    /// What is done with inputs outside their universe.
    #[getter]
    fn outside(&self) -> &'static str {
        self.0.interface().outside().name()
    }

    /// The input variables.
    #[getter]
    fn inputs(&self) -> Vec<PyVariable> {
        self.0.inputs().iter().cloned().map(PyVariable).collect()
    }

    /// The consequents, shaped like the grid of the rules.
    #[getter]
    fn consequents<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let mut shape: Vec<usize> =
            self.0.inputs().iter().map(|variable| variable.terms().len()).collect();
        if self.0.order() == Order::One {
            shape.push(self.0.grid().consequent_size());
        }
        array(py, self.0.consequents().to_vec(), &shape)
    }

    /// A copy of the flat parameter vector: the terms' parameters input by input, then the
    /// consequents.
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
    /// consequents.
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
    ///     As long as `parameters`; widths positive, vertices in order.
    ///
    /// Returns
    /// -------
    /// TSK
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
    ///     A contiguous float64 array of shape (p, n) for the result.
    /// threads : int, optional
    ///     Threads; 0 for one on each core.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Shape (p, n).
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

    /// The derivatives of the output to every parameter or input.
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
    ///     Shape (k,) or (n, k) for k parameters or inputs. Zero where no rule fires, if that is
    ///     no error.
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
    /// It takes a point as a call does: `system.explain(2, 1)`, `system.explain(angle=2, rate=1)`,
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

    /// What is odd about the definition: gaps between the terms of an input, terms outside its
    /// universe, and points where no rule fires, of thousands spread over the universes. What
    /// looks odd may be meant.
    ///
    /// Returns
    /// -------
    /// list of Finding
    fn validate(&self, py: Python<'_>) -> Vec<PyFinding> {
        insight::validate(py, &self.0)
    }

    /// The system as a JSON document.
    fn to_json(&self) -> Result<String> {
        Ok(self.0.to_json()?)
    }

    /// The system that a JSON document describes.
    #[staticmethod]
    pub fn from_json(text: &str) -> Result<Self> {
        Ok(Self(Tsk::from_json(text)?))
    }

    /// Write the system to a JSON file: the old file stays until the new one is complete.
    fn save(&self, path: PathBuf) -> Result<()> {
        Ok(write_atomically(&path, &self.0.to_json()?)?)
    }

    fn __repr__(&self) -> String {
        let inputs: Vec<String> = self
            .0
            .inputs()
            .iter()
            .map(|variable| {
                let terms: Vec<&str> = variable.terms().iter().map(|term| &*term.name).collect();
                format!("{} [{}]", variable.name(), terms.join(" "))
            })
            .collect();
        format!(
            "<TSK {:?}: {} -> {}, {} rules of order {}>",
            self.0.name(),
            inputs.join(", "),
            self.0.output(),
            self.0.grid().rules(),
            self.order()
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let text = slf.get().0.to_json().map_err(Error::from)?;
        (slf.get_type().getattr("from_json")?, (text,)).into_pyobject(slf.py())
    }
}

/// Write a text file so that it is either the old one or the new one, never half of it.
#[pyfunction]
pub fn write_text(path: PathBuf, text: &str) -> Result<()> {
    Ok(write_atomically(&path, text)?)
}
