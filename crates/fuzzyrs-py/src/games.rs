//! Robots and games.

use fuzzy_core::check;
use numpy::PyArray1;
use pursuit_sim::{Capture, Controller, OneOnOne, Pose, SpeedLaw, Start, Vehicle, play, play_many};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Floats, Shape, whole};
use crate::control::PyControl;
use crate::controllers::controller;
use crate::enter::{Watch, enter};
use crate::errors::Result;
use crate::outcomes::{PyOutcomes, PyTrajectory};
use crate::pickle::rebuild;

/// A car-like robot.
///
/// Parameters
/// ----------
/// speed : float
///     The largest speed in metres per second, zero or more.
/// wheelbase : float
///     Metres, positive.
/// max_steering : float
///     The steering limit in radians, below pi/2.
/// speed_law : {"constant", "cosine"}, optional
///     Whether it always drives at `speed` or at speed·cos(steering).
#[pyclass(name = "Vehicle", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyVehicle(pub Vehicle);

#[pymethods]
impl PyVehicle {
    #[new]
    #[pyo3(signature = (speed, wheelbase, max_steering, *, speed_law = "constant"))]
    fn new(speed: f64, wheelbase: f64, max_steering: f64, speed_law: &str) -> Result<Self> {
        let robot = Vehicle::new(speed, wheelbase, max_steering)?;
        Ok(Self(robot.with_speed_law(SpeedLaw::from_name(speed_law)?)))
    }

    /// Metres per second.
    #[getter]
    fn speed(&self) -> f64 {
        self.0.speed()
    }

    /// Metres.
    #[getter]
    fn wheelbase(&self) -> f64 {
        self.0.wheelbase()
    }

    /// Radians.
    #[getter]
    fn max_steering(&self) -> f64 {
        self.0.max_steering()
    }

    /// "constant" or "cosine".
    #[getter]
    fn speed_law(&self) -> &'static str {
        self.0.speed_law().name()
    }

    /// The radius of the tightest circle, in metres.
    #[getter]
    fn turning_radius(&self) -> f64 {
        self.0.turning_radius()
    }

    /// Steering angles that a learner may choose from: an odd number, evenly spread from one limit
    /// to the other.
    ///
    /// Parameters
    /// ----------
    /// step : float, optional
    ///     About how far they are from each other, in radians.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of shape (angles,)
    #[pyo3(signature = (step = 0.1))]
    fn steering_angles<'py>(
        &self,
        py: Python<'py>,
        step: f64,
    ) -> Result<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.0.steering_angles(step)?))
    }

    /// The robot as a dictionary of plain values.
    pub fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("speed", self.speed())?;
        dict.set_item("wheelbase", self.wheelbase())?;
        dict.set_item("max_steering", self.max_steering())?;
        dict.set_item("speed_law", self.speed_law())?;
        Ok(dict)
    }

    pub fn __repr__(&self) -> String {
        let robot = &self.0;
        let numbers = [robot.speed(), robot.wheelbase(), robot.max_steering()];
        let numbers = numbers.map(|number| format!("{number:?}")).join(", ");
        match robot.speed_law() {
            SpeedLaw::Constant => format!("Vehicle({numbers})"),
            law => format!("Vehicle({numbers}, speed_law={:?})", law.name()),
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let robot = &slf.get().0;
        let arguments = (robot.speed(), robot.wheelbase(), robot.max_steering());
        let keywords = PyDict::new(slf.py());
        keywords.set_item("speed_law", robot.speed_law().name())?;
        rebuild(&slf.get_type(), arguments.into_pyobject(slf.py())?, &keywords)
    }
}

/// One pursuer and one evader. The defaults are the game of section 6.5.2 of Desouky's thesis.
///
/// The pursuer wants to come nearer than the capture radius. Both robots see the line of sight,
/// then both move; a capture is tested at the samples, before the move.
///
/// Parameters
/// ----------
/// pursuer, evader : Vehicle, optional
///     The robots: by default 2 and 1 m/s, wheelbase 0.3 m, steering within 0.5 and 1 rad.
/// capture_radius : float, optional
///     In metres, positive.
/// time_step : float, optional
///     In seconds, positive.
/// capture : {"sampled", "swept"}, optional
///     Whether the distance at the samples decides on capture, or the smallest since the last
///     sample too.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> game = fz.OneOnOne()
/// >>> game.play("classical", "classical", evader_start=(-6, 7)).capture_time
/// 9.6
#[pyclass(name = "OneOnOne", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyOneOnOne(pub OneOnOne);

#[pymethods]
impl PyOneOnOne {
    #[new]
    #[pyo3(signature = (pursuer = None, evader = None, *, capture_radius = None, time_step = None,
                        capture = "sampled"))]
    fn new(
        pursuer: Option<&Bound<'_, PyVehicle>>,
        evader: Option<&Bound<'_, PyVehicle>>,
        capture_radius: Option<f64>,
        time_step: Option<f64>,
        capture: &str,
    ) -> Result<Self> {
        let thesis = OneOnOne::thesis()?;
        let game = OneOnOne::new(
            pursuer.map_or(*thesis.pursuer(), |robot| robot.get().0),
            evader.map_or(*thesis.evader(), |robot| robot.get().0),
            capture_radius.unwrap_or(thesis.capture_radius()),
            time_step.unwrap_or(thesis.time_step()),
        )?;
        Ok(Self(game.with_capture(Capture::from_name(capture)?)))
    }

    /// The pursuer.
    #[getter]
    fn pursuer(&self) -> PyVehicle {
        PyVehicle(*self.0.pursuer())
    }

    /// The evader.
    #[getter]
    fn evader(&self) -> PyVehicle {
        PyVehicle(*self.0.evader())
    }

    /// In metres.
    #[getter]
    fn capture_radius(&self) -> f64 {
        self.0.capture_radius()
    }

    /// In seconds.
    #[getter]
    fn time_step(&self) -> f64 {
        self.0.time_step()
    }

    /// "sampled" or "swept".
    #[getter]
    fn capture(&self) -> &'static str {
        self.0.capture().name()
    }

    /// The game as a dictionary of plain values.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("pursuer", self.pursuer().to_dict(py)?)?;
        dict.set_item("evader", self.evader().to_dict(py)?)?;
        dict.set_item("capture_radius", self.capture_radius())?;
        dict.set_item("time_step", self.time_step())?;
        dict.set_item("capture", self.capture())?;
        Ok(dict)
    }

    /// Play one game and record it.
    ///
    /// Parameters
    /// ----------
    /// pursuer, evader : controller, optional
    ///     How they steer: "classical", "bang-bang", PD, EvasiveTurn, FuzzyController,
    ///     TableController, TSK or Parallel.
    /// evader_start : (float, float) or (float, float, float)
    ///     Where the evader starts, in metres, and its heading in radians (0 by default).
    /// pursuer_start : optional
    ///     The same for the pursuer; the origin by default.
    /// max_time : float, optional
    ///     When the game is given up, in seconds, rounded to whole time steps; at most 1e7 steps.
    ///
    /// Returns
    /// -------
    /// Trajectory
    #[pyo3(signature = (pursuer = None, evader = None, *, evader_start, pursuer_start = None, max_time = 60.0))]
    fn play(
        &self,
        py: Python<'_>,
        pursuer: Option<&Bound<'_, PyAny>>,
        evader: Option<&Bound<'_, PyAny>>,
        evader_start: &Bound<'_, PyAny>,
        pursuer_start: Option<&Bound<'_, PyAny>>,
        max_time: f64,
    ) -> Result<PyTrajectory> {
        let (pursuer, evader) = players(pursuer, evader)?;
        let start = Start {
            pursuer: first_pose(pursuer_start)?,
            evader: poses(evader_start, "evader_start")?.one()?,
        };
        let steps = steps_within(max_time, self.0.time_step())?;
        let path = py.detach(|| play(&self.0, &pursuer, &evader, start, steps))?;
        Ok(PyTrajectory { path, time_step: self.0.time_step() })
    }

    /// Play a game from each of many starts, eight at a time.
    ///
    /// Equal to `play` from each start, to the bit, on any number of threads.
    ///
    /// Parameters
    /// ----------
    /// pursuer, evader : controller, optional
    ///     How they steer: "classical", "bang-bang", PD, EvasiveTurn, FuzzyController,
    ///     TableController, TSK or Parallel.
    /// evader_starts : array_like of shape (n, 2) or (n, 3)
    ///     Where the evader starts, in metres, and its headings in radians (0 by default).
    /// pursuer_start : (float, float) or (float, float, float), optional
    ///     Where the pursuer starts in all games; the origin by default.
    /// max_time : float, optional
    ///     When a game is given up, in seconds, rounded to whole time steps.
    /// threads : int, optional
    ///     0 for one on each core.
    /// control : Control, optional
    ///     To stop it from another thread.
    /// progress : callable, optional
    ///     Called now and then with the number of games done.
    ///
    /// Returns
    /// -------
    /// Outcomes
    #[pyo3(signature = (pursuer = None, evader = None, *, evader_starts, pursuer_start = None,
                        max_time = 60.0, threads = 1, control = None, progress = None))]
    #[allow(clippy::too_many_arguments)]
    fn play_many(
        &self,
        py: Python<'_>,
        pursuer: Option<&Bound<'_, PyAny>>,
        evader: Option<&Bound<'_, PyAny>>,
        evader_starts: &Bound<'_, PyAny>,
        pursuer_start: Option<&Bound<'_, PyAny>>,
        max_time: f64,
        #[pyo3(from_py_with = whole)] threads: usize,
        control: Option<&Bound<'_, PyControl>>,
        progress: Option<Py<PyAny>>,
    ) -> Result<PyOutcomes> {
        let (pursuer, evader) = players(pursuer, evader)?;
        let evaders = poses(evader_starts, "evader_starts")?.0;
        let pursuer_start = first_pose(pursuer_start)?;
        let starts: Vec<Start> =
            evaders.into_iter().map(|evader| Start { pursuer: pursuer_start, evader }).collect();
        let steps = steps_within(max_time, self.0.time_step())?;
        let watch = Watch::new(control, progress);
        let outcomes = enter(py, &watch, |control| {
            play_many(&self.0, &pursuer, &evader, &starts, steps, threads, control)
        })?;
        Ok(PyOutcomes { outcomes, time_step: self.0.time_step() })
    }

    fn __repr__(&self) -> String {
        format!(
            "OneOnOne({}, {}, capture_radius={:?}, time_step={:?}, capture={:?})",
            self.pursuer().__repr__(),
            self.evader().__repr__(),
            self.0.capture_radius(),
            self.0.time_step(),
            self.capture()
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let own = slf.get();
        let keywords = PyDict::new(slf.py());
        keywords.set_item("capture_radius", own.capture_radius())?;
        keywords.set_item("time_step", own.time_step())?;
        keywords.set_item("capture", own.capture())?;
        rebuild(&slf.get_type(), (own.pursuer(), own.evader()).into_pyobject(slf.py())?, &keywords)
    }
}

/// The time steps that fit into a time.
pub fn steps_within(max_time: f64, time_step: f64) -> Result<u32> {
    check::positive("max_time", max_time)?;
    let steps = (max_time / time_step).round();
    check::within("number of time steps in max_time", steps, "between 1 and 4e9", |n| {
        (1.0..=4e9).contains(&n)
    })?;
    Ok(steps as u32)
}

fn players(
    pursuer: Option<&Bound<'_, PyAny>>,
    evader: Option<&Bound<'_, PyAny>>,
) -> Result<(Controller, Controller)> {
    let player = |object: Option<&Bound<'_, PyAny>>, who| {
        object.map_or(Ok(Controller::Classical), |object| controller(object, who))
    };
    Ok((player(pursuer, "pursuer")?, player(evader, "evader")?))
}

/// Poses from rows of x, y and perhaps a heading.
pub struct Poses(Vec<Pose>);

impl Poses {
    /// All of them.
    pub fn all(self) -> Vec<Pose> {
        self.0
    }

    /// The only one.
    pub fn one(self) -> Result<Pose> {
        check::same_length("starts of one game", 1, self.0.len())?;
        Ok(self.0[0])
    }
}

/// The pursuer's first pose: the origin, if the caller says nothing else.
fn first_pose(start: Option<&Bound<'_, PyAny>>) -> Result<Pose> {
    match start {
        Some(start) => poses(start, "pursuer_start")?.one(),
        None => Ok(Start::evader_at(0.0, 0.0).pursuer),
    }
}

pub fn poses(object: &Bound<'_, PyAny>, what: &str) -> Result<Poses> {
    let floats = Floats::new(object, what)?;
    let width = match *floats.shape() {
        [width @ (2 | 3)] | [_, width @ (2 | 3)] => width,
        ref shape => {
            let expected = "x, y and perhaps a heading for each start";
            return Err(fuzzy_core::Error::wrong_shape(what, expected, Shape(shape)).into());
        }
    };
    let pose =
        |row: &[f64]| Pose { x: row[0], y: row[1], heading: row.get(2).copied().unwrap_or(0.0) };
    Ok(Poses(floats.as_slice()?.chunks_exact(width).map(pose).collect()))
}
