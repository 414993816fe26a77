//! Two pursuers and one evader.

use numpy::{PyArray1, PyArrayDyn};
use pursuit_sim::rollout::seconds;
use pursuit_sim::rollout::two_pursuers::{TwoPursuersTrajectory, play, play_many};
use pursuit_sim::training::TwoPursuersTrained;
use pursuit_sim::{Aim, Capture, Controller, Flight, Pose, TwoPursuers, TwoPursuersStart, Vehicle};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::arrays::{Floats, Shape, array, whole};
use crate::control::PyControl;
use crate::controllers::{controller, controller_object};
use crate::enter::{Watch, enter};
use crate::errors::{Error, Result};
use crate::games::{PyVehicle, poses, steps_within};
use crate::outcomes::{PyOutcomes, end_in_words, history_dict, pose_numbers};
use crate::pickle::rebuild;

/// Two pursuers and one evader. The defaults are the game of section 8.4 of Desouky's thesis.
///
/// One of the pursuers wants to come nearer than the capture radius. Every robot sees the angle from
/// its heading to where it wants to go and its rate of change, so that the controllers of a
/// `OneOnOne` steer here too. Captures are tested as there; the game ends with the first.
///
/// Parameters
/// ----------
/// pursuers : Vehicle or two of them, optional
///     The robots: by default 0.5 m/s, wheelbase 0.2 m, steering within 0.5 rad.
/// evader : Vehicle, optional
///     By default 0.3 m/s, wheelbase 0.2 m, steering within 0.8 rad.
/// capture_radius : float, optional
///     In metres, positive.
/// time_step : float, optional
///     In seconds, positive.
/// capture : {"sampled", "swept"}, optional
///     Whether the distance at the samples decides on capture, or the smallest since the last
///     sample too.
/// aim : {"line-of-sight", "intercept", "intercept-flight"}, optional
///     Whether pursuers steer to where the evader is (8.7), to where they would meet it if it drove
///     on along its heading (8.24), or if it drove along its direction of flight (8.22). A pursuer
///     that is not faster than the evader follows the line of sight.
/// flight : {"weighted", "weighted-units", "nearest", "sum", "sum-of-units"}, optional
///     Whither the evader flees: the sum of the vectors from the pursuers to it, of which the
///     nearer pursuer's counts more (8.10); the same of the unit vectors; away from the nearer
///     pursuer (8.8); the plain sum (8.9), of the vectors or of the unit vectors. Where the sum is
///     null, it flees from the first pursuer.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> starts = [(-4, 3), (5, -2)]
/// >>> fz.TwoPursuers().play(pursuer_starts=starts).capture_time
/// 18.7
/// >>> fz.TwoPursuers(aim="intercept").play(pursuer_starts=starts).capture_time
/// 16.2
#[pyclass(name = "TwoPursuers", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyTwoPursuers(pub TwoPursuers);

#[pymethods]
impl PyTwoPursuers {
    #[new]
    #[pyo3(signature = (pursuers = None, evader = None, *, capture_radius = None, time_step = None,
                        capture = "sampled", aim = "line-of-sight", flight = "weighted"))]
    fn new(
        pursuers: Option<&Bound<'_, PyAny>>,
        evader: Option<&Bound<'_, PyVehicle>>,
        capture_radius: Option<f64>,
        time_step: Option<f64>,
        capture: &str,
        aim: &str,
        flight: &str,
    ) -> Result<Self> {
        let thesis = TwoPursuers::thesis()?;
        let pursuers = match pursuers {
            Some(pursuers) => {
                let [first, second] = pair(pursuers, "pursuers")?;
                [vehicle(&first)?, vehicle(&second)?]
            }
            None => *thesis.pursuers(),
        };
        let game = TwoPursuers::new(
            pursuers,
            evader.map_or(*thesis.evader(), |robot| robot.get().0),
            capture_radius.unwrap_or(thesis.capture_radius()),
            time_step.unwrap_or(thesis.time_step()),
        )?;
        let game = game.with_aim(Aim::from_name(aim)?).with_flight(Flight::from_name(flight)?);
        Ok(Self(game.with_capture(Capture::from_name(capture)?)))
    }

    /// The two pursuers.
    #[getter]
    fn pursuers(&self) -> (PyVehicle, PyVehicle) {
        self.0.pursuers().map(PyVehicle).into()
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

    /// Where the pursuers steer to.
    #[getter]
    fn aim(&self) -> &'static str {
        self.0.aim().name()
    }

    /// Whither the evader flees.
    #[getter]
    fn flight(&self) -> &'static str {
        self.0.flight().name()
    }

    /// The game as a dictionary of plain values.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = self.keywords(py)?;
        let (first, second) = self.pursuers();
        dict.set_item("pursuers", [first.to_dict(py)?, second.to_dict(py)?])?;
        dict.set_item("evader", self.evader().to_dict(py)?)?;
        Ok(dict)
    }

    /// Play one game and record it.
    ///
    /// Parameters
    /// ----------
    /// pursuers : controller or two of them, optional
    ///     How the pursuers steer: "classical", "bang-bang", PD, EvasiveTurn, FuzzyController,
    ///     TableController, TSK or Parallel.
    /// evader : controller, optional
    ///     How the evader steers.
    /// pursuer_starts : array_like of shape (2, 2) or (2, 3)
    ///     Where the pursuers start, in metres, and their headings in radians (0 by default).
    /// evader_start : (float, float) or (float, float, float), optional
    ///     The same for the evader; the origin by default.
    /// max_time : float, optional
    ///     When the game is given up, in seconds, rounded to whole time steps; at most 1e7 steps.
    ///
    /// Returns
    /// -------
    /// TwoPursuersTrajectory
    #[pyo3(signature = (pursuers = None, evader = None, *, pursuer_starts, evader_start = None,
                        max_time = 60.0))]
    fn play(
        &self,
        py: Python<'_>,
        pursuers: Option<&Bound<'_, PyAny>>,
        evader: Option<&Bound<'_, PyAny>>,
        pursuer_starts: &Bound<'_, PyAny>,
        evader_start: Option<&Bound<'_, PyAny>>,
        max_time: f64,
    ) -> Result<PyTwoPursuersTrajectory> {
        let controllers = players(pursuers, evader)?;
        let pursuers = first_poses(pursuer_starts, false)?;
        let start = TwoPursuersStart { pursuers: pursuers[0], evader: evader_pose(evader_start)? };
        let steps = steps_within(max_time, self.0.time_step())?;
        let path = py.detach(|| play(&self.0, controllers.each_ref(), start, steps))?;
        Ok(PyTwoPursuersTrajectory { path, time_step: self.0.time_step() })
    }

    /// Play a game from each of many starts, eight at a time.
    ///
    /// Equal to `play` from each start, to the bit, on any number of threads.
    ///
    /// Parameters
    /// ----------
    /// pursuers : controller or two of them, optional
    ///     How the pursuers steer, as for `play`.
    /// evader : controller, optional
    ///     How the evader steers.
    /// pursuer_starts : array_like of shape (n, 2, 2) or (n, 2, 3)
    ///     Where the pursuers start, in metres, and their headings in radians (0 by default).
    /// evader_start : (float, float) or (float, float, float), optional
    ///     Where the evader starts in all games; the origin by default.
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
    ///     Distances are those of the nearer pursuer.
    #[pyo3(signature = (pursuers = None, evader = None, *, pursuer_starts, evader_start = None,
                        max_time = 60.0, threads = 1, control = None, progress = None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of the Python function")]
    fn play_many(
        &self,
        py: Python<'_>,
        pursuers: Option<&Bound<'_, PyAny>>,
        evader: Option<&Bound<'_, PyAny>>,
        pursuer_starts: &Bound<'_, PyAny>,
        evader_start: Option<&Bound<'_, PyAny>>,
        max_time: f64,
        #[pyo3(from_py_with = whole)] threads: usize,
        control: Option<&Bound<'_, PyControl>>,
        progress: Option<Py<PyAny>>,
    ) -> Result<PyOutcomes> {
        let controllers = players(pursuers, evader)?;
        let evader = evader_pose(evader_start)?;
        let starts: Vec<TwoPursuersStart> = first_poses(pursuer_starts, true)?
            .into_iter()
            .map(|pursuers| TwoPursuersStart { pursuers, evader })
            .collect();
        let steps = steps_within(max_time, self.0.time_step())?;
        let watch = Watch::new(control, progress);
        let outcomes = enter(py, &watch, |control| {
            play_many(&self.0, controllers.each_ref(), &starts, steps, threads, control)
        })?;
        Ok(PyOutcomes { outcomes, time_step: self.0.time_step() })
    }

    fn __repr__(&self) -> String {
        let [first, second] = self.0.pursuers().map(|robot| PyVehicle(robot).__repr__());
        format!(
            "TwoPursuers(({first}, {second}), {}, capture_radius={:?}, time_step={:?}, \
             capture={:?}, aim={:?}, flight={:?})",
            self.evader().__repr__(),
            self.0.capture_radius(),
            self.0.time_step(),
            self.capture(),
            self.aim(),
            self.flight()
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (own, py) = (slf.get(), slf.py());
        let robots = (own.pursuers(), own.evader()).into_pyobject(py)?;
        rebuild(&slf.get_type(), robots, &own.keywords(py)?)
    }
}

impl PyTwoPursuers {
    /// What the constructor takes by keyword.
    fn keywords<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let keywords = PyDict::new(py);
        keywords.set_item("capture_radius", self.capture_radius())?;
        keywords.set_item("time_step", self.time_step())?;
        keywords.set_item("capture", self.capture())?;
        keywords.set_item("aim", self.aim())?;
        keywords.set_item("flight", self.flight())?;
        Ok(keywords)
    }
}

/// The two things of a list or a tuple, or the same thing twice.
fn pair<'py>(object: &Bound<'py, PyAny>, what: &str) -> Result<[Bound<'py, PyAny>; 2]> {
    if !object.is_instance_of::<PyList>() && !object.is_instance_of::<PyTuple>() {
        return Ok([object.clone(), object.clone()]);
    }
    let things: Vec<Bound<'py, PyAny>> = object.extract().map_err(Error::Python)?;
    let count = things.len();
    things.try_into().map_err(|_| fuzzy_core::Error::wrong_shape(what, "one or two", count).into())
}

fn vehicle(object: &Bound<'_, PyAny>) -> Result<Vehicle> {
    match object.cast::<PyVehicle>() {
        Ok(robot) => Ok(robot.get().0),
        Err(_) => {
            let came = object.get_type().name()?;
            Err(Error::WrongType(format!("pursuers must be a Vehicle or two of them, got {came}")))
        }
    }
}

fn players(
    pursuers: Option<&Bound<'_, PyAny>>,
    evader: Option<&Bound<'_, PyAny>>,
) -> Result<[Controller; 3]> {
    let robot = |object: &Bound<'_, PyAny>, who| -> Result<Controller> {
        let chosen = controller(object, who)?;
        if chosen.reads_both_angles() {
            let why = "it reads both robots' angles to one line of sight, and here are two lines";
            return Err(Error::WrongType(format!(
                "the {who} can't be a MixedTableController: {why}"
            )));
        }
        Ok(chosen)
    };
    let evader = evader.map_or(Ok(Controller::Classical), |evader| robot(evader, "evader"))?;
    let Some(pursuers) = pursuers else {
        return Ok([Controller::Classical, Controller::Classical, evader]);
    };
    let [first, second] = pair(pursuers, "pursuers' controllers")?;
    Ok([robot(&first, "pursuer")?, robot(&second, "pursuer")?, evader])
}

fn evader_pose(start: Option<&Bound<'_, PyAny>>) -> Result<Pose> {
    match start {
        Some(start) => poses(start, "evader_start")?.one(),
        None => Ok(TwoPursuersStart::pursuers_at([(0.0, 0.0); 2]).evader),
    }
}

/// The pursuers' first poses in one game, or in many.
fn first_poses(object: &Bound<'_, PyAny>, many: bool) -> Result<Vec<[Pose; 2]>> {
    let floats = Floats::new(object, "pursuer_starts")?;
    let width = match *floats.shape() {
        [2, width @ (2 | 3)] if !many => width,
        [_, 2, width @ (2 | 3)] if many => width,
        ref shape => {
            let each = "x, y and perhaps a heading for both pursuers";
            let expected = if many { format!("{each} for each start") } else { each.to_owned() };
            let error = fuzzy_core::Error::wrong_shape("pursuer_starts", expected, Shape(shape));
            return Err(error.into());
        }
    };
    let pose =
        |row: &[f64]| Pose { x: row[0], y: row[1], heading: row.get(2).copied().unwrap_or(0.0) };
    let both = |rows: &[f64]| [pose(&rows[..width]), pose(&rows[width..])];
    Ok(floats.as_slice()?.chunks_exact(2 * width).map(both).collect())
}

/// The path of a game of two pursuers: n + 1 samples of the states, n of what was done between
/// them.
#[pyclass(name = "TwoPursuersTrajectory", module = "fuzzyrs", frozen)]
pub struct PyTwoPursuersTrajectory {
    path: TwoPursuersTrajectory,
    time_step: f64,
}

#[pymethods]
impl PyTwoPursuersTrajectory {
    /// The times of the samples in seconds, shape (n + 1,).
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let steps = 0..self.path.robots[2].len();
        PyArray1::from_iter(py, steps.map(|step| seconds(step as u32, self.time_step)))
    }

    /// The pursuers' x, y (m) and heading (rad), shape (2, n + 1, 3).
    #[getter]
    fn pursuers<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let [first, second, _] = &self.path.robots;
        let numbers = [pose_numbers(first), pose_numbers(second)].concat();
        array(py, numbers, &[2, first.len(), 3])
    }

    /// The evader's x, y (m) and heading (rad), shape (n + 1, 3).
    #[getter]
    fn evader<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let poses = &self.path.robots[2];
        array(py, pose_numbers(poses), &[poses.len(), 3])
    }

    /// The distance of each pursuer from the evader in metres, shape (2, n + 1).
    #[getter]
    fn distance<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        rows(py, &self.path.distances)
    }

    /// The pursuers' steering angles in radians, shape (2, n).
    #[getter]
    fn pursuer_steering<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        rows(py, &self.path.steering[..2])
    }

    /// The evader's steering angle in radians, shape (n,).
    #[getter]
    fn evader_steering<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.path.steering[2])
    }

    /// The pursuers' rewards, shape (2, n): the way each gained over the most that it can gain. The
    /// evader's reward is the negative sum.
    #[getter]
    fn reward<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        rows(py, &self.path.rewards[..2])
    }

    /// Whether the evader was caught; otherwise time was up.
    #[getter]
    fn captured(&self) -> bool {
        self.path.outcome.captured
    }

    /// Which pursuer caught it, 0 or 1 (the nearer, if both did); None if it was not caught.
    #[getter]
    fn captor(&self) -> Option<usize> {
        self.path.captor
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

    /// The smallest distance of a pursuer at any sample, in metres.
    #[getter]
    fn miss_distance(&self) -> f64 {
        self.path.outcome.miss_distance
    }

    fn __repr__(&self) -> String {
        format!("<TwoPursuersTrajectory: {}>", end_in_words(&self.path.outcome, self.time_step))
    }
}

/// Vectors of one length as the rows of an array.
fn rows<'py>(py: Python<'py>, vectors: &[Vec<f64>]) -> Result<Bound<'py, PyArrayDyn<f64>>> {
    array(py, vectors.concat(), &[vectors.len(), vectors[0].len()])
}

/// What two pursuers and an evader learned.
#[pyclass(name = "TwoPursuersTrained", module = "fuzzyrs", frozen)]
pub struct PyTwoPursuersTrained(pub TwoPursuersTrained);

#[pymethods]
impl PyTwoPursuersTrained {
    /// The pursuers' controllers.
    #[getter]
    fn pursuers<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let [first, second, _] = &self.0.controllers;
        Ok((controller_object(py, first.clone())?, controller_object(py, second.clone())?))
    }

    /// The evader's controller.
    #[getter]
    fn evader<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        controller_object(py, self.0.controllers[2].clone())
    }

    /// The time that the robots played while learning, in simulated seconds.
    #[getter]
    fn learning_time(&self) -> f64 {
        self.0.learning_time
    }

    /// What QLBGFLC's phase 1 learned, as TwoPursuersQLambdaTraining alone does; otherwise None.
    #[getter]
    fn tables(&self) -> Option<Self> {
        self.0.prepared.as_ref().map(|prepared| Self(prepared.tables()))
    }

    /// How the learning went: an array for each phase and robot.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        history_dict(py, &self.0.history)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (first, second) = self.pursuers(py)?;
        Ok(format!(
            "<TwoPursuersTrained in {:.1} simulated seconds: {} and {} against {}>",
            self.0.learning_time,
            first.repr()?,
            second.repr()?,
            self.evader(py)?.repr()?
        ))
    }
}
