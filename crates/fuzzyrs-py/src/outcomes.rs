//! What came of playing.

use numpy::{PyArray1, PyArrayDyn};
use pursuit_sim::rollout::seconds;
use pursuit_sim::{Outcome, Pose, Trajectory};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::errors::Result;

/// The path of a game: n + 1 samples of the states, n of what was done between them.
#[pyclass(name = "Trajectory", module = "fuzzyrs", frozen)]
pub struct PyTrajectory {
    pub path: Trajectory,
    pub time_step: f64,
}

#[pymethods]
impl PyTrajectory {
    /// The times of the samples in seconds, shape (n + 1,).
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let steps = 0..self.path.pursuer.len();
        PyArray1::from_iter(py, steps.map(|step| seconds(step as u32, self.time_step)))
    }

    /// The pursuer's x, y (m) and heading (rad), shape (n + 1, 3).
    #[getter]
    fn pursuer<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        pose_array(py, &self.path.pursuer)
    }

    /// The evader's x, y (m) and heading (rad), shape (n + 1, 3).
    #[getter]
    fn evader<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        pose_array(py, &self.path.evader)
    }

    /// The distance between the robots in metres, shape (n + 1,).
    #[getter]
    fn distance<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.path.distance)
    }

    /// The pursuer's steering angle in radians, shape (n,).
    #[getter]
    fn pursuer_steering<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.path.pursuer_steering)
    }

    /// The evader's steering angle in radians, shape (n,).
    #[getter]
    fn evader_steering<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.path.evader_steering)
    }

    /// The pursuer's reward, shape (n,): the way gained over the most that can be gained.
    #[getter]
    fn reward<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.path.reward)
    }

    /// Whether the evader was caught; otherwise time was up.
    #[getter]
    fn captured(&self) -> bool {
        self.path.outcome.captured
    }

    /// When the evader was caught, in seconds; None if it was not.
    #[getter]
    fn capture_time(&self) -> Option<f64> {
        self.path.outcome.capture_time(self.time_step)
    }

    /// The time played, in seconds.
    #[getter]
    fn duration(&self) -> f64 {
        self.path.outcome.duration(self.time_step)
    }

    /// The smallest distance at any sample, in metres.
    #[getter]
    fn miss_distance(&self) -> f64 {
        self.path.outcome.miss_distance
    }

    fn __repr__(&self) -> String {
        format!("<Trajectory: {}>", end_in_words(&self.path.outcome, self.time_step))
    }
}

/// How a game ended.
pub fn end_in_words(outcome: &Outcome, time_step: f64) -> String {
    let end = match outcome.capture_time(time_step) {
        Some(time) => format!("captured after {time:?} s"),
        None => format!("not captured in {:?} s", outcome.duration(time_step)),
    };
    format!("{end}, nearest {:.3} m", outcome.miss_distance)
}

pub fn pose_array<'py>(py: Python<'py>, poses: &[Pose]) -> Result<Bound<'py, PyArrayDyn<f64>>> {
    array(py, pose_numbers(poses), &[poses.len(), 3])
}

/// The numbers of poses, one after the other.
pub fn pose_numbers(poses: &[Pose]) -> Vec<f64> {
    poses.iter().flat_map(|pose| [pose.x, pose.y, pose.heading]).collect()
}

/// How learning went, by phase.
pub fn history_dict<'py>(
    py: Python<'py>,
    history: &[(String, Vec<f64>)],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (phase, values) in history {
        dict.set_item(phase, PyArray1::from_slice(py, values))?;
    }
    Ok(dict)
}

/// How many games ended; every array has one entry for each start.
#[pyclass(name = "Outcomes", module = "fuzzyrs", frozen)]
pub struct PyOutcomes {
    pub outcomes: Vec<Outcome>,
    pub time_step: f64,
}

#[pymethods]
impl PyOutcomes {
    /// Whether the evader was caught.
    #[getter]
    fn captured<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        PyArray1::from_iter(py, self.outcomes.iter().map(|outcome| outcome.captured))
    }

    /// When it was caught, in seconds; NaN where it was not.
    #[getter]
    fn capture_time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |outcome| outcome.capture_time(self.time_step).unwrap_or(f64::NAN))
    }

    /// The time played, in seconds.
    #[getter]
    fn duration<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |outcome| outcome.duration(self.time_step))
    }

    /// The smallest distance at any sample, in metres.
    #[getter]
    fn miss_distance<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |outcome| outcome.miss_distance)
    }

    fn __len__(&self) -> usize {
        self.outcomes.len()
    }

    fn __repr__(&self) -> String {
        let captured = self.outcomes.iter().filter(|outcome| outcome.captured).count();
        format!("<Outcomes: {captured} of {} captured>", self.outcomes.len())
    }
}

impl PyOutcomes {
    fn each<'py>(
        &self,
        py: Python<'py>,
        value: impl Fn(&Outcome) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.outcomes.iter().map(value))
    }
}
