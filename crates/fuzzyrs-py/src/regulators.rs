//! Controllers that hold an error at zero.

use std::path::PathBuf;

use fuzzy_core::format::write_atomically;
use pursuit_sim::strategy::{FuzzySystem, Gains};
use pursuit_sim::{FuzzyRegulator, Regulator};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::arrays::whole;
use crate::errors::{Error, Result};
use crate::strategies::PyPd;
use crate::systems::PySystem;
use crate::tsk::PyTsk;

/// A fuzzy system with scaling factors that makes a control action of an error and its rate of
/// change: output_gain · system(error_gain · error, rate_gain · rate).
///
/// Where no rule fires the output is 0, unless the system has a number for that.
///
/// Parameters
/// ----------
/// system : System or TSK
///     With two inputs and one output.
/// error_gain, rate_gain, output_gain : float, optional
///     The scaling factors.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> tuned = fz.FuzzyRegulator.thesis()
/// >>> round(tuned(0.1, 0.0), 3)
/// 0.246
#[pyclass(name = "FuzzyRegulator", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyFuzzyRegulator(pub FuzzyRegulator);

#[pymethods]
impl PyFuzzyRegulator {
    #[new]
    #[pyo3(signature = (system, *, error_gain = 1.0, rate_gain = 1.0, output_gain = 1.0))]
    fn new(
        system: &Bound<'_, PyAny>,
        error_gain: f64,
        rate_gain: f64,
        output_gain: f64,
    ) -> Result<Self> {
        let gains = Gains { error: error_gain, rate: rate_gain, output: output_gain };
        match fuzzy_system(system) {
            Some(system) => Ok(Self(FuzzyRegulator::new(system, gains)?)),
            None => {
                let came = system.get_type().name()?;
                Err(Error::WrongType(format!("system must be a System or a TSK, got {came}")))
            }
        }
    }

    /// The controller that follows a wall at the end of chapter 3 of Desouky's thesis: the tuned
    /// membership functions and scaling factors of its Tables 3.2 to 3.5, and all 25 rules.
    #[staticmethod]
    fn thesis() -> Result<Self> {
        Ok(Self(FuzzyRegulator::thesis()?))
    }

    /// The same with the 14 rules of Table 3.6, of which the scan lost three.
    ///
    /// Parameters
    /// ----------
    /// reading : int, optional
    ///     Which of the nine likeliest readings, from 0 to 8.
    ///
    /// Returns
    /// -------
    /// FuzzyRegulator
    #[staticmethod]
    #[pyo3(signature = (reading = 0))]
    fn thesis_pruned(#[pyo3(from_py_with = whole)] reading: usize) -> Result<Self> {
        Ok(Self(FuzzyRegulator::thesis_pruned(reading)?))
    }

    /// The fuzzy system.
    #[getter]
    fn system<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(match self.0.system() {
            FuzzySystem::Rules(system) => Bound::new(py, PySystem(system.clone()))?.into_any(),
            FuzzySystem::Tsk(system) => Bound::new(py, PyTsk(system.clone()))?.into_any(),
        })
    }

    /// What the error is multiplied by.
    #[getter]
    fn error_gain(&self) -> f64 {
        self.0.gains().error
    }

    /// What its rate of change is multiplied by.
    #[getter]
    fn rate_gain(&self) -> f64 {
        self.0.gains().rate
    }

    /// What the system's output is multiplied by.
    #[getter]
    fn output_gain(&self) -> f64 {
        self.0.gains().output
    }

    /// The number of rules whose weight is above zero.
    #[getter]
    fn rules_kept(&self) -> usize {
        self.0.rules_kept()
    }

    /// The control action for an error and its rate of change.
    fn __call__(&self, error: f64, rate: f64) -> Result<f64> {
        fuzzy_core::check::finite("error", error)?;
        fuzzy_core::check::finite("rate", rate)?;
        Ok(self.0.output(error, rate, &mut vec![0.0; self.0.scratch_count()]))
    }

    /// The controller as a JSON document.
    fn to_json(&self) -> Result<String> {
        Ok(self.0.to_json()?)
    }

    /// The controller that a JSON document describes.
    #[staticmethod]
    pub fn from_json(text: &str) -> Result<Self> {
        Ok(Self(FuzzyRegulator::from_json(text)?))
    }

    /// Write the controller to a JSON file: the old file stays until the new one is complete.
    fn save(&self, path: PathBuf) -> Result<()> {
        Ok(write_atomically(&path, &self.0.to_json()?)?)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "<FuzzyRegulator of {}, gains {:?}, {:?}, {:?}>",
            self.system(py)?.repr()?,
            self.error_gain(),
            self.rate_gain(),
            self.output_gain()
        ))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        (slf.get_type().getattr("from_json")?, (slf.get().to_json()?,)).into_pyobject(slf.py())
    }
}

/// A system of either kind.
fn fuzzy_system(object: &Bound<'_, PyAny>) -> Option<FuzzySystem> {
    if let Ok(system) = object.cast::<PySystem>() {
        return Some(FuzzySystem::Rules(system.get().0.clone()));
    }
    object.cast::<PyTsk>().ok().map(|system| FuzzySystem::Tsk(system.get().0.clone()))
}

/// The regulator that Python names: one, a plain system, or a list or tuple whose outputs add up.
pub fn regulator(object: &Bound<'_, PyAny>, who: &str) -> Result<Regulator> {
    if let Ok(pd) = object.cast::<PyPd>() {
        return Ok(Regulator::Pd(pd.get().0));
    }
    if let Ok(fuzzy) = object.cast::<PyFuzzyRegulator>() {
        return Ok(Regulator::Fuzzy(Box::new(fuzzy.get().0.clone())));
    }
    if let Some(system) = fuzzy_system(object) {
        return Ok(Regulator::Fuzzy(Box::new(FuzzyRegulator::new(system, Gains::ONE)?)));
    }
    let wrong = |object: &Bound<'_, PyAny>| -> Result<Regulator> {
        Err(Error::WrongType(format!(
            "the {who} must be a PD, a FuzzyRegulator, a System, a TSK or a list of these, got {}",
            object.get_type().name()?
        )))
    };
    let parts: Vec<Bound<'_, PyAny>> = match (object.cast::<PyList>(), object.cast::<PyTuple>()) {
        (Ok(list), _) => list.iter().collect(),
        (_, Ok(tuple)) => tuple.iter().collect(),
        _ => return wrong(object),
    };
    // Not lists in lists, which could be deep or endless.
    let single = |part: &Bound<'_, PyAny>| {
        let nested = part.cast::<PyList>().is_ok() || part.cast::<PyTuple>().is_ok();
        if nested { wrong(part) } else { regulator(part, who) }
    };
    let mut sum: Option<Regulator> = None;
    for part in &parts {
        let next = single(part)?;
        sum = Some(match sum {
            Some(sum) => Regulator::Parallel(Box::new((sum, next))),
            None => next,
        });
    }
    fuzzy_core::check::at_least(&format!("regulators of the {who}"), parts.len(), 1)?;
    sum.map_or_else(|| wrong(object), Ok)
}
