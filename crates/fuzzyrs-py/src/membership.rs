//! Membership functions and variables.

use fuzzy_core::{Antecedent, MembershipFunction, Shape, Variable};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator, PyMapping, PyString, PyTuple};

use crate::arrays::{Floats, array};
use crate::errors::{Error, Result};
use crate::rules::PyProposition;

/// How well a number fits a term, from 0 to 1.
///
/// Made by `gaussian`, `gaussian_width`, `triangular` and `trapezoidal`, or from the name of the
/// shape and its parameters. Immutable; call it with a number or an array. The degree of NaN is
/// NaN.
///
/// Parameters
/// ----------
/// shape : str
///     "gaussian", "gaussian_width", "triangular" or "trapezoidal".
/// parameters : sequence of float
///     As the function of that name takes them.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> warm = fz.triangular(15, 20, 25)
/// >>> warm(17.5)
/// 0.5
/// >>> warm([15, 20])
/// array([0., 1.])
#[pyclass(name = "MembershipFunction", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyMembershipFunction(pub MembershipFunction);

#[pymethods]
impl PyMembershipFunction {
    #[new]
    fn new(shape: &str, parameters: Vec<f64>) -> Result<Self> {
        Ok(Self(MembershipFunction::new(Shape::from_name(shape)?, &parameters)?))
    }

    /// The name of the shape.
    #[getter]
    fn shape(&self) -> &'static str {
        self.0.shape().name()
    }

    /// The parameters by name.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let parameters = PyDict::new(py);
        let values = self.0.parameters();
        for (name, value) in self.0.shape().parameter_names(values.len()).iter().zip(values) {
            parameters.set_item(name, value)?;
        }
        Ok(parameters)
    }

    fn __call__<'py>(&self, x: &Bound<'py, PyAny>) -> Result<Bound<'py, PyAny>> {
        let py = x.py();
        let points = Floats::new(x, "x")?;
        if points.shape().is_empty() {
            return Ok(self
                .0
                .degree(points.as_slice()?[0])
                .into_pyobject(py)
                .map_err(PyErr::from)?
                .into_any());
        }
        let mut degrees = vec![0.0; points.as_slice()?.len()];
        let numbers = points.as_slice()?;
        py.detach(|| self.0.degrees(numbers, &mut degrees))?;
        Ok(array(py, degrees, points.shape())?.into_any())
    }

    fn __repr__(&self) -> String {
        let parameters: Vec<String> =
            self.0.parameters().iter().map(|value| format!("{value:?}")).collect();
        format!("{}({})", self.0.shape().name(), parameters.join(", "))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let function = &slf.get().0;
        let arguments = (function.shape().name(), function.parameters().to_vec());
        (slf.get_type(), arguments).into_pyobject(slf.py())
    }
}

/// exp(-((x - mean)/sigma)²/2).
///
/// Parameters
/// ----------
/// mean : float
///     Where the degree is 1.
/// sigma : float
///     The standard deviation, from 1e-150 to 1e150.
///
/// Returns
/// -------
/// MembershipFunction
#[pyfunction]
pub fn gaussian(mean: f64, sigma: f64) -> Result<PyMembershipFunction> {
    Ok(PyMembershipFunction(MembershipFunction::gaussian(mean, sigma)?))
}

/// exp(-((x - mean)/width)²), the form of Desouky's thesis; width is sqrt(2) times sigma.
///
/// Parameters
/// ----------
/// mean : float
///     Where the degree is 1.
/// width : float
///     The distance at which the degree is 1/e, from 1e-150 to 1e150.
///
/// Returns
/// -------
/// MembershipFunction
#[pyfunction]
pub fn gaussian_width(mean: f64, width: f64) -> Result<PyMembershipFunction> {
    Ok(PyMembershipFunction(MembershipFunction::gaussian_width(mean, width)?))
}

/// Rises from `a` to `b` and falls to `c`.
///
/// Parameters
/// ----------
/// a, b, c : float
///     The vertices, a <= b <= c and a < c. Where two are equal the side is vertical.
///
/// Returns
/// -------
/// MembershipFunction
#[pyfunction]
pub fn triangular(a: f64, b: f64, c: f64) -> Result<PyMembershipFunction> {
    Ok(PyMembershipFunction(MembershipFunction::triangular(a, b, c)?))
}

/// Rises from `a` to `b`, stays at 1 until `c` and falls to `d`.
///
/// Parameters
/// ----------
/// a, b, c, d : float
///     The vertices, a <= b <= c <= d and a < d. Where two are equal the side is vertical.
///
/// Returns
/// -------
/// MembershipFunction
#[pyfunction]
pub fn trapezoidal(a: f64, b: f64, c: f64, d: f64) -> Result<PyMembershipFunction> {
    Ok(PyMembershipFunction(MembershipFunction::trapezoidal(a, b, c, d)?))
}

/// A named quantity: its universe of discourse and the terms that cover it.
///
/// `variable["term"]` is the proposition "variable is term", from which rules are made;
/// `variable.terms["term"]` is the membership function.
///
/// Parameters
/// ----------
/// name : str
///     Without dots.
/// universe : (float, float)
///     The interval that the quantity lives on.
/// terms : dict of str to MembershipFunction
///     In the order in which rules count them.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> angle = fz.Variable("angle", (-1, 1), {"left": fz.gaussian(-1, 0.5),
/// ...                                        "right": fz.gaussian(1, 0.5)})
/// >>> angle.terms["left"](-1.0)
/// 1.0
/// >>> angle["left"]
/// Proposition("angle is left")
#[pyclass(name = "Variable", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyVariable(pub Variable);

#[pymethods]
impl PyVariable {
    #[new]
    fn new(name: &str, universe: [f64; 2], terms: &Bound<'_, PyMapping>) -> Result<Self> {
        let mut variable = Variable::new(name, universe[0], universe[1])?;
        for item in terms.items()? {
            let (term, function): (Bound<'_, PyString>, Bound<'_, PyAny>) = item.extract()?;
            let term = term.to_string();
            let Ok(function) = function.cast::<PyMembershipFunction>() else {
                let came = function.get_type().name()?;
                return Err(Error::WrongType(format!(
                    "the term \"{term}\" must be a MembershipFunction, got {came}"
                )));
            };
            variable = variable.with_term(&term, function.get().0.clone())?;
        }
        Ok(Self(variable))
    }

    /// A variable whose terms peak at even distances from one end of the universe to the other.
    ///
    /// Triangles and trapezoids add up to 1; Gaussians cross at 0.5.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Without dots.
    /// universe : (float, float)
    ///     The interval that the quantity lives on.
    /// terms : sequence of str
    ///     The names, two at least; a string counts as its letters.
    /// shape : str, optional
    ///     The shape of all terms.
    ///
    /// Returns
    /// -------
    /// Variable
    #[staticmethod]
    #[pyo3(signature = (name, universe, terms, shape = "gaussian"))]
    fn evenly(
        name: &str,
        universe: [f64; 2],
        terms: &Bound<'_, PyAny>,
        shape: &str,
    ) -> Result<Self> {
        let mut names: Vec<String> = Vec::new();
        for term in terms.try_iter()? {
            names.push(term?.extract()?);
        }
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Ok(Self(Variable::evenly(name, universe.into(), Shape::from_name(shape)?, &names)?))
    }

    /// The variable's name.
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// The interval that it lives on.
    #[getter]
    fn universe(&self) -> (f64, f64) {
        (self.0.universe().low(), self.0.universe().high())
    }

    /// The terms by name, in their order.
    #[getter]
    pub fn terms<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let terms = PyDict::new(py);
        for term in self.0.terms() {
            terms.set_item(&term.name, PyMembershipFunction(term.function.clone()))?;
        }
        Ok(terms)
    }

    /// The degrees of all terms at a number, or at each of many. Those of NaN are NaN.
    ///
    /// Parameters
    /// ----------
    /// x : float or array_like
    ///     Of any shape.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     The shape of `x` with the terms as a last axis.
    fn degrees<'py>(&self, x: &Bound<'py, PyAny>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let points = Floats::new(x, "x")?;
        let (numbers, count) = (points.as_slice()?, self.0.terms().len());
        let mut degrees = vec![0.0; numbers.len() * count];
        x.py().detach(|| self.0.degrees(numbers, &mut degrees))?;
        let shape = [points.shape(), &[count]].concat();
        array(x.py(), degrees, &shape)
    }

    fn __len__(&self) -> usize {
        self.0.terms().len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.terms(py)?.try_iter()
    }

    fn __contains__(&self, term: &str) -> bool {
        self.0.term(term).is_ok()
    }

    fn __getitem__(&self, term: &str) -> Result<PyProposition> {
        self.0.term(term)?;
        Ok(PyProposition(Antecedent::is(self.0.name(), term)))
    }

    fn __repr__(&self) -> String {
        let terms: Vec<String> = self
            .0
            .terms()
            .iter()
            .map(|term| {
                format!(
                    "{:?}: {}",
                    term.name,
                    PyMembershipFunction(term.function.clone()).__repr__()
                )
            })
            .collect();
        let (low, high) = self.universe();
        format!("Variable({:?}, ({low:?}, {high:?}), {{{}}})", self.0.name(), terms.join(", "))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let variable = slf.get();
        let arguments = (variable.name(), variable.universe(), variable.terms(slf.py())?);
        (slf.get_type(), arguments).into_pyobject(slf.py())
    }
}
