//! Rates that change from episode to episode.

use fuzzy_core::check;
use fuzzy_core::learn::schedule::Schedule;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::whole;
use crate::errors::{Error, Result};

/// A rate that changes from episode to episode i = 1, 2, ...
///
/// What takes a schedule takes a number, too: a constant rate.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.Schedule.linear(0.1, 0.01, 1000).at(500)
/// 0.055
/// >>> fz.Schedule.power(0.1, 1.0).at(4)
/// 0.025
#[pyclass(name = "Schedule", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PySchedule(pub Schedule);

#[pymethods]
impl PySchedule {
    /// The same rate in each episode.
    #[staticmethod]
    fn constant(rate: f64) -> Result<Self> {
        Self::power(rate, 0.0)
    }

    /// scale/iᵖ in episode i.
    ///
    /// Parameters
    /// ----------
    /// scale : float
    ///     The rate in the first episode; not negative.
    /// power : float
    ///     p, zero or more.
    ///
    /// Returns
    /// -------
    /// Schedule
    #[staticmethod]
    fn power(scale: f64, power: f64) -> Result<Self> {
        Self::checked(Schedule::Power { scale, power })
    }

    /// first + (last - first)*i/episodes up to episode i = episodes, then `last`.
    ///
    /// Parameters
    /// ----------
    /// first, last : float
    ///     The rates, not negative; `first` would belong to i = 0.
    /// episodes : int
    ///     How long it takes, at least 1.
    ///
    /// Returns
    /// -------
    /// Schedule
    #[staticmethod]
    fn linear(first: f64, last: f64, #[pyo3(from_py_with = whole)] episodes: u64) -> Result<Self> {
        Self::checked(Schedule::Linear { first, last, count: episodes })
    }

    /// The rate in an episode, from 1 on.
    fn at(&self, #[pyo3(from_py_with = whole)] episode: u64) -> Result<f64> {
        let expected = "at least 1";
        check::within("episode", episode as f64, expected, |_| episode > 0)?;
        Ok(self.0.at(episode))
    }

    fn __repr__(&self) -> String {
        match self.0 {
            Schedule::Power { scale, power: 0.0 } => format!("Schedule.constant({scale:?})"),
            Schedule::Power { scale, power } => format!("Schedule.power({scale:?}, {power:?})"),
            Schedule::Linear { first, last, count } => {
                format!("Schedule.linear({first:?}, {last:?}, {count})")
            }
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let (name, arguments) = match slf.get().0 {
            Schedule::Power { scale, power } => ("power", (scale, power).into_pyobject(py)?),
            Schedule::Linear { first, last, count } => {
                ("linear", (first, last, count).into_pyobject(py)?)
            }
        };
        (slf.get_type().getattr(name)?, arguments).into_pyobject(py)
    }
}

impl PySchedule {
    fn checked(schedule: Schedule) -> Result<Self> {
        schedule.check("rate", "zero or more", |rate| rate >= 0.0)?;
        Ok(Self(schedule))
    }
}

/// A schedule, or a number for a constant rate.
pub fn schedule(object: &Bound<'_, PyAny>) -> PyResult<Schedule> {
    if let Ok(schedule) = object.cast::<PySchedule>() {
        return Ok(schedule.get().0);
    }
    match object.extract() {
        Ok(scale) => Ok(Schedule::Power { scale, power: 0.0 }),
        Err(_) => {
            let came = object.get_type().name()?;
            Err(Error::WrongType(format!("a rate must be a number or a Schedule, got {came}"))
                .into())
        }
    }
}
