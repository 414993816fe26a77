//! Given strategies, and two controllers side by side.

use pursuit_sim::{Controller, EvasiveTurn, Pd};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::controllers::{controller, controller_object};
use crate::errors::Result;
use crate::pickle::rebuild;

/// A proportional-derivative controller: proportional·error + derivative·rate.
///
/// In a pursuit the error is the angle to the other robot.
///
/// Parameters
/// ----------
/// proportional : float
///     The gain of the error.
/// derivative : float
///     The gain of its rate of change, in seconds.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.PD(2, 0.5)(1.0, -0.4)
/// 1.8
#[pyclass(name = "PD", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyPd(pub Pd);

#[pymethods]
impl PyPd {
    #[new]
    fn new(proportional: f64, derivative: f64) -> Result<Self> {
        Ok(Self(Pd::new(proportional, derivative)?))
    }

    /// The gain of the error.
    #[getter]
    fn proportional(&self) -> f64 {
        self.0.proportional()
    }

    /// The gain of its rate of change, in seconds.
    #[getter]
    fn derivative(&self) -> f64 {
        self.0.derivative()
    }

    /// The output for an error and its rate of change.
    fn __call__(&self, error: f64, rate: f64) -> f64 {
        self.0.output(error, rate)
    }

    fn __repr__(&self) -> String {
        format!("PD({:?}, {:?})", self.proportional(), self.derivative())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let own = slf.get();
        (slf.get_type(), (own.proportional(), own.derivative())).into_pyobject(slf.py())
    }
}

/// Fleeing in two parts: along the line of sight, and near the pursuer by a turn against its
/// heading, into the circle that it cannot follow.
///
/// Parameters
/// ----------
/// switching_distance : float
///     Where the turn begins, in metres.
/// wrapped : bool, optional
///     Whether the angle of the turn is brought back into one turn, so that the evader takes the
///     shorter side.
#[pyclass(name = "EvasiveTurn", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyEvasiveTurn(pub EvasiveTurn);

#[pymethods]
impl PyEvasiveTurn {
    #[new]
    #[pyo3(signature = (switching_distance, *, wrapped = false))]
    fn new(switching_distance: f64, wrapped: bool) -> Result<Self> {
        Ok(Self(EvasiveTurn::new(switching_distance, wrapped)?))
    }

    /// Where the turn begins, in metres.
    #[getter]
    fn switching_distance(&self) -> f64 {
        self.0.switching_distance()
    }

    /// Whether the angle of the turn is brought back into one turn.
    #[getter]
    fn wrapped(&self) -> bool {
        self.0.wrapped()
    }

    fn __repr__(&self) -> String {
        let wrapped = if self.wrapped() { "True" } else { "False" };
        format!("EvasiveTurn({:?}, wrapped={wrapped})", self.switching_distance())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let own = slf.get();
        let keywords = PyDict::new(slf.py());
        keywords.set_item("wrapped", own.wrapped())?;
        rebuild(&slf.get_type(), (own.switching_distance(),).into_pyobject(slf.py())?, &keywords)
    }
}

/// Two controllers side by side: the robot steers by the sum of what they say.
///
/// Parameters
/// ----------
/// first, second : controller
///     As for `OneOnOne.play`.
#[pyclass(name = "Parallel", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyParallel(pub Box<(Controller, Controller)>);

#[pymethods]
impl PyParallel {
    #[new]
    fn new(first: &Bound<'_, PyAny>, second: &Bound<'_, PyAny>) -> Result<Self> {
        Ok(Self(Box::new((controller(first, "first")?, controller(second, "second")?))))
    }

    /// The first of them.
    #[getter]
    fn first<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        controller_object(py, self.0.0.clone())
    }

    /// The second of them.
    #[getter]
    fn second<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        controller_object(py, self.0.1.clone())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("Parallel({}, {})", self.first(py)?.repr()?, self.second(py)?.repr()?))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, own) = (slf.py(), slf.get());
        (slf.get_type(), (own.first(py)?, own.second(py)?)).into_pyobject(py)
    }
}

/// The controller, if the object is one of the classes here.
pub fn strategy(object: &Bound<'_, PyAny>) -> Option<Controller> {
    if let Ok(pd) = object.cast::<PyPd>() {
        return Some(Controller::Pd(pd.get().0));
    }
    if let Ok(turn) = object.cast::<PyEvasiveTurn>() {
        return Some(Controller::EvasiveTurn(turn.get().0));
    }
    let both = object.cast::<PyParallel>().ok()?;
    Some(Controller::Parallel(both.get().0.clone()))
}
