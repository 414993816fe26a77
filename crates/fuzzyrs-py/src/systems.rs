//! Fuzzy systems.

use std::path::PathBuf;

use fuzzy_core::format::write_atomically;
use fuzzy_core::{NoRuleFires, Order, Tsk};
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyReadwriteArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt, PyString, PyTuple};

use crate::arrays::{Floats, Shape, array, whole};
use crate::errors::{Error, Result};
use crate::membership::PyVariable;

/// A Takagi-Sugeno-Kang system on a rule grid: one rule for each combination of terms, product as
/// AND, weighted average as output.
///
/// It is immutable; threads may share it.
///
/// `system(x, y)` evaluates one point, `system(X)` the rows of an array of shape (n, inputs),
/// `system(xs, ys)` arrays of any shapes that broadcast. For a batch, `out=` is a float64 array of
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
/// no_rule_fires : "error", "nan" or float, optional
///     The answer where no rule fires.
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

/// The most inputs of a point that is kept on the stack.
const FEW: usize = 8;

#[pymethods]
impl PyTsk {
    #[new]
    #[pyo3(signature = (inputs, consequents, *, order = 0, name = "system", output = "output", no_rule_fires = None))]
    fn new(
        inputs: Vec<Bound<'_, PyVariable>>,
        consequents: &Bound<'_, PyAny>,
        order: i64,
        name: &str,
        output: &str,
        no_rule_fires: Option<&Bound<'_, PyAny>>,
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
            .when_no_rule_fires(answer(no_rule_fires)?)?;
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

    /// The answer where no rule fires: "error", "nan" or a number.
    #[getter]
    fn no_rule_fires<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(match self.0.no_rule_fires() {
            NoRuleFires::Error => PyString::new(py, "error").into_any(),
            NoRuleFires::Nan => PyString::new(py, "nan").into_any(),
            NoRuleFires::Value(value) => PyFloat::new(py, value).into_any(),
        })
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

    #[pyo3(signature = (*x, out = None, threads = 1))]
    fn __call__<'py>(
        &self,
        x: &Bound<'py, PyTuple>,
        out: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = whole)] threads: usize,
    ) -> Result<Bound<'py, PyAny>> {
        let inputs = self.0.inputs().len();
        if out.is_none()
            && x.len() == inputs
            && let Some(value) = self.evaluate_numbers(x)?
        {
            return Ok(PyFloat::new(x.py(), value).into_any());
        }
        self.evaluate_arrays(x, out, threads)
    }

    /// The derivatives of the output to every parameter.
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
    ///     Shape (parameters,) or (n, parameters). Zero where no rule fires, if that is no error.
    #[pyo3(signature = (x, *, threads = 1))]
    fn gradient<'py>(
        &self,
        x: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = whole)] threads: usize,
    ) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let (py, width) = (x.py(), self.0.parameters().len());
        let points = Floats::new(x, "x")?;
        if let [_] = points.shape() {
            let mut derivatives = vec![0.0; width];
            self.0.gradient(points.as_slice()?, &mut derivatives)?;
            return array(py, derivatives, &[width]);
        }
        let rows = points.rows("x", self.0.inputs().len())?;
        let count = rows.len() / self.0.inputs().len();
        let mut derivatives = vec![0.0; count * width];
        py.detach(|| self.0.gradient_batch(rows, &mut derivatives, threads))?;
        array(py, derivatives, &[count, width])
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

impl PyTsk {
    /// The output at a point given by plain numbers; nothing if an argument is something else.
    fn evaluate_numbers(&self, x: &Bound<'_, PyTuple>) -> Result<Option<f64>> {
        let mut few = [0.0; FEW];
        let mut many = Vec::new();
        let point = match few.get_mut(..x.len()) {
            Some(point) => point,
            None => {
                many.resize(x.len(), 0.0);
                &mut many
            }
        };
        for (number, object) in point.iter_mut().zip(x.iter_borrowed()) {
            if !object.is_instance_of::<PyFloat>() && !object.is_instance_of::<PyInt>() {
                return Ok(None);
            }
            // An integer too large for a float is left to NumPy, whose error says so.
            let Ok(value) = object.extract() else { return Ok(None) };
            *number = value;
        }
        Ok(Some(self.0.evaluate(point)?))
    }

    fn evaluate_arrays<'py>(
        &self,
        x: &Bound<'py, PyTuple>,
        out: Option<&Bound<'py, PyAny>>,
        threads: usize,
    ) -> Result<Bound<'py, PyAny>> {
        let (py, inputs) = (x.py(), self.0.inputs().len());
        let numpy = py.import("numpy")?;
        let (points, shape) = match x.len() {
            1 => {
                let points = Floats::new(&x.get_item(0)?, "x")?;
                let shape = match *points.shape() {
                    [n, width] if width == inputs => vec![n],
                    [width] if width == inputs && inputs > 1 => vec![],
                    [n] if inputs == 1 => vec![n],
                    [] if inputs == 1 => vec![],
                    ref shape => {
                        let what = format!("x for \"{}\"", self.0.name());
                        let expected = format!("{inputs} numbers or shape (n, {inputs})");
                        return Err(
                            fuzzy_core::Error::wrong_shape(what, expected, Shape(shape)).into()
                        );
                    }
                };
                (points, shape)
            }
            count if count == inputs => {
                let arrays = numpy.call_method1("broadcast_arrays", x).map_err(|error| {
                    let expected = "arrays that broadcast against each other";
                    fuzzy_core::Error::wrong_shape("the inputs", expected, error.value(py))
                })?;
                let stacked = numpy.call_method1("stack", (arrays, -1))?;
                let points = Floats::new(&stacked, "the inputs")?;
                let shape = points.shape()[..points.shape().len() - 1].to_vec();
                (points, shape)
            }
            count => {
                let what = format!("arguments of \"{}\"", self.0.name());
                let expected = format!("{inputs}, or one array");
                return Err(fuzzy_core::Error::wrong_shape(what, expected, count).into());
            }
        };
        let rows = points.as_slice()?;
        if let Some(out) = out {
            let mut target = writable(out, &shape)?;
            let outputs = target.as_slice_mut().map_err(PyErr::from)?;
            py.detach(|| self.0.evaluate_batch(rows, outputs, threads))?;
            return Ok(out.clone().into_any());
        }
        let mut outputs = vec![0.0; rows.len() / inputs];
        py.detach(|| self.0.evaluate_batch(rows, &mut outputs, threads))?;
        match (shape.as_slice(), outputs.as_slice()) {
            ([], &[value]) => Ok(PyFloat::new(py, value).into_any()),
            _ => Ok(array(py, outputs, &shape)?.into_any()),
        }
    }
}

/// The caller's array for the results of a batch of this shape.
fn writable<'py>(out: &Bound<'py, PyAny>, shape: &[usize]) -> Result<PyReadwriteArray1<'py, f64>> {
    let &[count] = shape else {
        let expected = "inputs of shape (n,) or one array of shape (n, inputs)";
        return Err(fuzzy_core::Error::wrong_shape("out", expected, Shape(shape)).into());
    };
    let suits =
        |array: &&Bound<'py, PyArray1<f64>>| array.len() == count && array.is_c_contiguous();
    let array = out.cast::<PyArray1<f64>>().ok();
    let Some(array) = array.filter(suits) else {
        return Err(Error::WrongType(format!(
            "out must be a contiguous float64 array of shape ({count},)"
        )));
    };
    array
        .try_readwrite()
        .map_err(|error| Error::WrongType(format!("out cannot be written: {error}")))
}

/// What the caller wants where no rule fires.
fn answer(choice: Option<&Bound<'_, PyAny>>) -> Result<NoRuleFires> {
    let Some(choice) = choice else { return Ok(NoRuleFires::Error) };
    if let Ok(name) = choice.cast::<PyString>() {
        let name = name.to_string();
        return match name.as_str() {
            "error" => Ok(NoRuleFires::Error),
            "nan" => Ok(NoRuleFires::Nan),
            _ => Err(fuzzy_core::Error::unknown_name(
                "answer where no rule fires",
                &name,
                ["error", "nan"],
            )
            .into()),
        };
    }
    choice.extract().map(NoRuleFires::Value).map_err(|_| {
        Error::WrongType("no_rule_fires must be \"error\", \"nan\" or a number".to_owned())
    })
}

/// Write a text file so that it is either the old one or the new one, never half of it.
#[pyfunction]
pub fn write_text(path: PathBuf, text: &str) -> Result<()> {
    Ok(write_atomically(&path, text)?)
}
