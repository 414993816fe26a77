//! Membership functions and variables.

use fuzzy_core::{Antecedent, MembershipFunction, Shape, Universe, Variable};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator, PyMapping, PyString, PyTuple};

use crate::arrays::{Floats, array};
use crate::errors::{Error, Result};
use crate::rules::PyProposition;

/// How well a number fits a term, from 0 to 1.
///
/// Made by the function of its shape, such as `gaussian`, or from the name of the shape and its
/// parameters. Immutable; call it with a number or an array. The degree of NaN is NaN.
///
/// Parameters
/// ----------
/// shape : str
///     The name of the function that makes this shape, such as "gaussian".
/// parameters : sequence of float
///     As that function takes them; for "points" x0, y0, x1, y1 and so on.
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

    /// The corners (x, degree) of a function made of straight lines, an array of shape (n, 2); None
    /// for other shapes.
    ///
    /// Between two corners the degree is on the line between them, before the first and after the
    /// last it is theirs. A vertical side has two corners at one x, where the degree is the greater
    /// of both.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyArrayDyn<f64>>>> {
        let Some(vertices) = self.0.vertices() else { return Ok(None) };
        let numbers = vertices.iter().flat_map(|&(x, degree)| [x, degree]).collect();
        array(py, numbers, &[vertices.len(), 2]).map(Some)
    }

    fn __call__<'py>(&self, x: &Bound<'py, PyAny>) -> Result<Bound<'py, PyAny>> {
        each(x, |points, degrees| self.0.degrees(points, degrees))
    }

    /// The derivative of the degree to `x`.
    ///
    /// At a kink it is that of one side; 0 where the degree jumps or its derivative is infinite.
    ///
    /// Parameters
    /// ----------
    /// x : float or array_like
    ///     Of any shape.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     The shape of `x`.
    fn slope<'py>(&self, x: &Bound<'py, PyAny>) -> Result<Bound<'py, PyAny>> {
        each(x, |points, slopes| self.0.slopes(points, slopes))
    }

    /// The derivatives of the degree to the parameters.
    ///
    /// At a kink they are those of one side; 0 where the degree jumps or its derivative is infinite.
    ///
    /// Parameters
    /// ----------
    /// x : float or array_like
    ///     Of any shape.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     The shape of `x` with the parameters as a last axis.
    fn gradient<'py>(&self, x: &Bound<'py, PyAny>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let points = Floats::new(x, "x")?;
        let (numbers, count) = (points.as_slice()?, self.0.parameters().len());
        let mut derivatives = fuzzy_core::check::zeros("the gradient", numbers.len(), count)?;
        x.py().detach(|| self.0.gradients(numbers, &mut derivatives))?;
        let shape = [points.shape(), &[count]].concat();
        array(x.py(), derivatives, &shape)
    }

    /// The smallest interval that holds every number of a universe with a degree above 0.
    ///
    /// That of a shape without end, such as a Gaussian, is the whole universe.
    ///
    /// Parameters
    /// ----------
    /// universe : (float, float)
    ///     The interval to look at.
    ///
    /// Returns
    /// -------
    /// (float, float) or None
    ///     None where all degrees are 0.
    fn support(&self, universe: [f64; 2]) -> Result<Option<(f64, f64)>> {
        Ok(self.0.support(Universe::new(universe[0], universe[1])?))
    }

    /// The smallest interval that holds every number of a universe with degree 1.
    ///
    /// A sigmoid has none, as it never reaches 1.
    ///
    /// Parameters
    /// ----------
    /// universe : (float, float)
    ///     The interval to look at.
    ///
    /// Returns
    /// -------
    /// (float, float) or None
    ///     None where no degree is 1.
    fn core(&self, universe: [f64; 2]) -> Result<Option<(f64, f64)>> {
        Ok(self.0.core(Universe::new(universe[0], universe[1])?))
    }

    /// The middle of the core, or else the place of the greatest degree.
    ///
    /// Where a function does not reach 1 within the universe, this is the end nearest to the core
    /// beyond it, or to which a sigmoid rises; the middle of the highest points; half-way between
    /// the centres of two sigmoids.
    ///
    /// Parameters
    /// ----------
    /// universe : (float, float)
    ///     The interval to look at.
    ///
    /// Returns
    /// -------
    /// float
    fn centre(&self, universe: [f64; 2]) -> Result<f64> {
        Ok(self.0.centre(Universe::new(universe[0], universe[1])?))
    }

    fn __repr__(&self) -> String {
        let (shape, parameters) = (self.0.shape(), self.0.parameters());
        let parameters = if shape == Shape::Points {
            let pairs: Vec<_> = parameters.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
            format!("{pairs:?}")
        } else {
            let numbers: Vec<_> = parameters.iter().map(|value| format!("{value:?}")).collect();
            numbers.join(", ")
        };
        format!("{}({parameters})", shape.name())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let function = &slf.get().0;
        let arguments = (function.shape().name(), function.parameters().to_vec());
        (slf.get_type(), arguments).into_pyobject(slf.py())
    }
}

/// A function of each of some numbers: a float of a single one, else an array of their shape.
fn each<'py>(
    x: &Bound<'py, PyAny>,
    function: impl Fn(&[f64], &mut [f64]) -> fuzzy_core::Result<()> + Sync + Send,
) -> Result<Bound<'py, PyAny>> {
    let py = x.py();
    let points = Floats::new(x, "x")?;
    let numbers = points.as_slice()?;
    let mut results = vec![0.0; numbers.len()];
    if points.shape().is_empty() {
        function(numbers, &mut results)?;
        return Ok(results[0].into_pyobject(py).map_err(PyErr::from)?.into_any());
    }
    py.detach(|| function(numbers, &mut results))?;
    Ok(array(py, results, points.shape())?.into_any())
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
    /// Neighbours cross at 0.5; triangular, trapezoidal, pi-shaped and cosine terms also add up to 1.
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
    ///     The shape of all terms: "gaussian", "gaussian_width", "two_sided_gaussian", "bell",
    ///     "pi_shape", "triangular", "trapezoidal", "cosine", "semi_ellipse" or "spike".
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
