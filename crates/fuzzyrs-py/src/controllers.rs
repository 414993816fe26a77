//! What steers a robot.

use std::path::PathBuf;

use fuzzy_core::System;
use fuzzy_core::format::json::document_type;
use fuzzy_core::format::{read, write_atomically};
use numpy::{PyArray1, PyArrayDyn};
use pursuit_sim::{
    Controller, FuzzyController, FuzzyRegulator, MixedTableController, TableController,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};

use crate::arrays::{Floats, array, whole};
use crate::errors::{Error, Result};
use crate::pickle::rebuild;
use crate::q_lambda::PyDiscretiser;
use crate::regulators::PyFuzzyRegulator;
use crate::strategies::{PyEvasiveTurn, PyParallel, PyPd, strategy};
use crate::systems::PySystem;
use crate::tsk::PyTsk;

/// Steering by a fuzzy system of the angle to the other robot and its rate of change.
///
/// Where no rule fires the robot steers straight ahead, unless the system has a number for that.
///
/// Parameters
/// ----------
/// system : TSK
///     With two inputs; its output is the steering angle in radians.
/// angle_limit, rate_limit : float, optional
///     The inputs are held within plus or minus these, in rad and rad/s.
#[pyclass(name = "FuzzyController", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyFuzzyController(FuzzyController);

#[pymethods]
impl PyFuzzyController {
    #[new]
    #[pyo3(signature = (system, *, angle_limit = f64::INFINITY, rate_limit = f64::INFINITY))]
    fn new(system: &Bound<'_, PyTsk>, angle_limit: f64, rate_limit: f64) -> Result<Self> {
        Ok(Self(FuzzyController::new(system.get().0.clone(), angle_limit, rate_limit)?))
    }

    /// The fuzzy system.
    #[getter]
    fn system(&self) -> PyTsk {
        PyTsk(self.0.system().clone())
    }

    /// The limit of the angle, in radians.
    #[getter]
    fn angle_limit(&self) -> f64 {
        self.0.angle_limit()
    }

    /// The limit of its rate, in radians per second.
    #[getter]
    fn rate_limit(&self) -> f64 {
        self.0.rate_limit()
    }

    fn __repr__(&self) -> String {
        format!(
            "<FuzzyController {:?}, inputs within {:?} rad and {:?} rad/s>",
            self.0.system().name(),
            self.0.angle_limit(),
            self.0.rate_limit()
        )
    }

    /// The controller as a JSON document.
    fn to_json(&self) -> Result<String> {
        Ok(self.0.to_json()?)
    }

    /// The controller that a JSON document describes.
    #[staticmethod]
    pub fn from_json(text: &str) -> Result<Self> {
        Ok(Self(FuzzyController::from_json(text)?))
    }

    /// Write the controller to a JSON file: the old file stays until the new one is complete.
    fn save(&self, path: PathBuf) -> Result<()> {
        Ok(write_atomically(&path, &self.0.to_json()?)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        (slf.get_type().getattr("from_json")?, (slf.get().to_json()?,)).into_pyobject(slf.py())
    }
}

/// Steering by a look-up table over the angle to the other robot and its rate of change.
///
/// Parameters
/// ----------
/// states : Discretiser
///     With two coordinates.
/// angles : array_like of float
///     The steering angle of every state in radians.
#[pyclass(name = "TableController", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyTableController(TableController);

#[pymethods]
impl PyTableController {
    #[new]
    fn new(states: &Bound<'_, PyDiscretiser>, angles: &Bound<'_, PyAny>) -> Result<Self> {
        let angles = Floats::new(angles, "angles")?;
        let angles = angles.vector("angles")?.to_vec();
        Ok(Self(TableController::new(states.get().0.clone(), angles)?))
    }

    /// The grid.
    #[getter]
    fn states(&self) -> PyDiscretiser {
        PyDiscretiser(self.0.states().clone())
    }

    /// The steering angle of every state, in radians.
    #[getter]
    fn angles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.angles())
    }

    fn __repr__(&self) -> String {
        format!("<TableController of {} states>", self.0.angles().len())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let own = slf.get();
        (slf.get_type(), (own.states(), own.0.angles().to_vec())).into_pyobject(slf.py())
    }
}

/// Steering by chance: a mixed strategy, with probabilities for each state of a grid over both
/// robots' angles to the line of sight.
///
/// What is drawn depends on the seed and on what the robot sees, nothing else: the same game takes
/// the same course, alone or among many.
///
/// Parameters
/// ----------
/// states : Discretiser
///     With two coordinates, the own angle and the other robot's in radians.
/// angles : array_like of float
///     Steering angles in radians.
/// probabilities : array_like of shape (states, angles)
///     Of each angle in each state; every row has the sum 1.
/// seed : int, optional
///     For the draws.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> grid = fz.Discretiser([(-1, 1, 3), (-1, 1, 3)])
/// >>> coin = fz.MixedTableController(grid, [-1, 1], [[0.5, 0.5]] * 9, seed=1)
/// >>> fz.OneOnOne().play("classical", coin, evader_start=(2, 4)).captured
/// True
#[pyclass(name = "MixedTableController", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyMixedTableController(MixedTableController);

#[pymethods]
impl PyMixedTableController {
    #[new]
    #[pyo3(signature = (states, angles, probabilities, *, seed = 0))]
    fn new(
        states: &Bound<'_, PyDiscretiser>,
        angles: &Bound<'_, PyAny>,
        probabilities: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let states = states.get().0.clone();
        let angles = Floats::new(angles, "angles")?;
        let angles = angles.vector("angles")?.to_vec();
        let probabilities = Floats::new(probabilities, "probabilities")?;
        let probabilities = probabilities.rows("probabilities", angles.len())?.to_vec();
        Ok(Self(MixedTableController::new(states, angles, probabilities, seed)?))
    }

    /// The grid.
    #[getter]
    fn states(&self) -> PyDiscretiser {
        PyDiscretiser(self.0.states().clone())
    }

    /// The steering angles, in radians.
    #[getter]
    fn angles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.angles())
    }

    /// The probability of each angle in each state, shape (states, angles).
    #[getter]
    fn probabilities<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [self.0.states().states(), self.0.angles().len()];
        array(py, self.0.probabilities().to_vec(), &shape)
    }

    /// What the draws depend on besides what the robot sees.
    #[getter]
    fn seed(&self) -> u64 {
        self.0.seed()
    }

    fn __repr__(&self) -> String {
        let (states, angles) = (self.0.states().states(), self.0.angles().len());
        format!("<MixedTableController of {states} states and {angles} angles>")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, own) = (slf.py(), slf.get());
        let keywords = PyDict::new(py);
        keywords.set_item("seed", own.seed())?;
        let parts = (own.states(), own.0.angles().to_vec(), own.probabilities(py)?);
        rebuild(&slf.get_type(), parts.into_pyobject(py)?, &keywords)
    }
}

/// The controller that Python names.
pub fn controller(object: &Bound<'_, PyAny>, who: &str) -> Result<Controller> {
    if let Ok(name) = object.cast::<PyString>() {
        return match name.to_string().as_str() {
            CLASSICAL => Ok(Controller::Classical),
            BANG_BANG => Ok(Controller::BangBang),
            name => {
                let known = [CLASSICAL, BANG_BANG];
                Err(fuzzy_core::Error::unknown_name("strategy", name, known).into())
            }
        };
    }
    if let Ok(fuzzy) = object.cast::<PyFuzzyController>() {
        return Ok(Controller::Fuzzy(Box::new(fuzzy.get().0.clone())));
    }
    if let Ok(table) = object.cast::<PyTableController>() {
        return Ok(Controller::Table(table.get().0.clone()));
    }
    if let Ok(table) = object.cast::<PyMixedTableController>() {
        return Ok(Controller::MixedTable(table.get().0.clone()));
    }
    if let Ok(system) = object.cast::<PyTsk>() {
        let system = system.get().0.clone();
        let fuzzy = FuzzyController::new(system, f64::INFINITY, f64::INFINITY)?;
        return Ok(Controller::Fuzzy(Box::new(fuzzy)));
    }
    if let Some(strategy) = strategy(object) {
        return Ok(strategy);
    }
    Err(Error::WrongType(format!(
        "the {who} must be \"classical\", \"bang-bang\", a PD, an EvasiveTurn, a FuzzyController, a \
         TableController, a MixedTableController, a TSK or a Parallel of two of these, got {}",
        object.get_type().name()?
    )))
}

/// A controller as Python has it.
pub fn controller_object(py: Python<'_>, controller: Controller) -> PyResult<Bound<'_, PyAny>> {
    Ok(match controller {
        Controller::Classical => PyString::new(py, CLASSICAL).into_any(),
        Controller::BangBang => PyString::new(py, BANG_BANG).into_any(),
        Controller::Pd(pd) => Bound::new(py, PyPd(pd))?.into_any(),
        Controller::EvasiveTurn(turn) => Bound::new(py, PyEvasiveTurn(turn))?.into_any(),
        Controller::Fuzzy(fuzzy) => Bound::new(py, PyFuzzyController(*fuzzy))?.into_any(),
        Controller::Table(table) => Bound::new(py, PyTableController(table))?.into_any(),
        Controller::MixedTable(table) => Bound::new(py, PyMixedTableController(table))?.into_any(),
        Controller::Parallel(both) => Bound::new(py, PyParallel(both))?.into_any(),
    })
}

const CLASSICAL: &str = "classical";
const BANG_BANG: &str = "bang-bang";

/// Read a system or a controller from a JSON file.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     As written by `save`.
///
/// Returns
/// -------
/// TSK, System, FuzzyController or FuzzyRegulator
#[pyfunction]
pub fn load(py: Python<'_>, path: PathBuf) -> Result<Bound<'_, PyAny>> {
    let text = read(&path)?;
    Ok(match document_type(&text)?.as_str() {
        FuzzyController::DOCUMENT_TYPE => {
            Bound::new(py, PyFuzzyController::from_json(&text)?)?.into_any()
        }
        FuzzyRegulator::DOCUMENT_TYPE => {
            Bound::new(py, PyFuzzyRegulator::from_json(&text)?)?.into_any()
        }
        System::DOCUMENT_TYPE => Bound::new(py, PySystem::from_json(&text)?)?.into_any(),
        _ => Bound::new(py, PyTsk::from_json(&text)?)?.into_any(),
    })
}
