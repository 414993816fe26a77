//! Games of many against many.

use numpy::{PyArray1, PyArrayDyn};
use pursuit_sim::rollout::seconds;
use pursuit_sim::{
    Capture, Controller, Crew, ManyOnMany, ManyStart, Trajectory, capture_times, record_coupled,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::arrays::{array, whole};
use crate::control::PyControl;
use crate::controllers::controller;
use crate::enter::{Watch, enter};
use crate::errors::{Error, Result};
use crate::games::{PyOneOnOne, PyVehicle, poses, steps_within};
use crate::outcomes::{PyTrajectory, pose_array};
use crate::pickle::rebuild;

/// As many pursuers as evaders, who play one against one.
///
/// A coupling gives each pursuer an evader of its own: entry i is the evader of pursuer i, from 0.
/// A captured pair leaves the game, which ends at the last capture or when time is up.
///
/// Parameters
/// ----------
/// pursuers, evaders : list of Vehicle
///     The robots, as many of one side as of the other. Those of a side obey one speed law.
/// capture_radius : float, optional
///     In metres, positive.
/// time_step : float, optional
///     In seconds, positive.
/// capture : {"sampled", "swept"}, optional
///     As for `OneOnOne`.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> game = fz.ManyOnMany.thesis(2)
/// >>> starts = {"pursuer_starts": [(2, 4), (-4, 5)], "evader_starts": [(0, 4), (-1, 0)]}
/// >>> game.play([0, 1], **starts).capture_time
/// 9.6
/// >>> fz.assign(game.capture_times(**starts), objective="bottleneck").tolist()
/// [0, 1]
#[pyclass(name = "ManyOnMany", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyManyOnMany(pub ManyOnMany);

#[pymethods]
impl PyManyOnMany {
    #[new]
    #[pyo3(signature = (pursuers, evaders, *, capture_radius = 0.1, time_step = 0.1,
                        capture = "sampled"))]
    fn new(
        pursuers: &Bound<'_, PyAny>,
        evaders: &Bound<'_, PyAny>,
        capture_radius: f64,
        time_step: f64,
        capture: &str,
    ) -> Result<Self> {
        let robots = |object: &Bound<'_, PyAny>, who: &str| -> Result<Vec<_>> {
            let robots: Vec<Bound<'_, PyVehicle>> = object.extract().map_err(|why: PyErr| {
                Error::WrongType(format!("{who} must be a list of Vehicle: {why}"))
            })?;
            Ok(robots.iter().map(|robot| robot.get().0).collect())
        };
        let (pursuers, evaders) = (robots(pursuers, "pursuers")?, robots(evaders, "evaders")?);
        let game = ManyOnMany::new(pursuers, evaders, capture_radius, time_step)?;
        Ok(Self(game.with_capture(Capture::from_name(capture)?)))
    }

    /// The game of section 8.5.3 of Desouky's thesis.
    ///
    /// Parameters
    /// ----------
    /// pairs : {2, 3}
    ///     The robots of Table 8.6 or of Table 8.10.
    #[staticmethod]
    fn thesis(#[pyo3(from_py_with = whole)] pairs: usize) -> Result<Self> {
        Ok(Self(ManyOnMany::thesis(pairs)?))
    }

    /// The pursuers.
    #[getter]
    fn pursuers(&self) -> Vec<PyVehicle> {
        self.0.pursuers().iter().map(|&robot| PyVehicle(robot)).collect()
    }

    /// The evaders.
    #[getter]
    fn evaders(&self) -> Vec<PyVehicle> {
        self.0.evaders().iter().map(|&robot| PyVehicle(robot)).collect()
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

    /// The number of pairs.
    fn __len__(&self) -> usize {
        self.0.size()
    }

    /// The game of one pursuer and one evader, for `train` and `play`.
    ///
    /// Parameters
    /// ----------
    /// pursuer, evader : int
    ///     Their indices, from 0.
    ///
    /// Returns
    /// -------
    /// OneOnOne
    fn pair(
        &self,
        #[pyo3(from_py_with = whole)] pursuer: usize,
        #[pyo3(from_py_with = whole)] evader: usize,
    ) -> Result<PyOneOnOne> {
        Ok(PyOneOnOne(self.0.pair(pursuer, evader)?))
    }

    /// Whether each pursuer can be sure of each evader, whatever they start from.
    ///
    /// "certain": some strategy of the pursuer catches every evader; it is faster and can be pushed
    /// sideways at least as hard, in speed**2 * tan(max_steering) / wheelbase (Cockayne 1967).
    /// "not guaranteed": the pursuer is faster, but the evader turns too tightly for the capture
    /// of a point. With a capture radius it may be caught all the same, as the condition is
    /// sufficient then but not necessary. "hopeless": the pursuer is not faster, so that an evader
    /// that flees straight away gets no nearer.
    ///
    /// Returns
    /// -------
    /// list of list of str
    ///     A row for each pursuer.
    fn prospects(&self) -> Result<Vec<Vec<&'static str>>> {
        let size = self.0.size();
        (0..size).map(|i| (0..size).map(|j| Ok(self.0.prospect(i, j)?.name())).collect()).collect()
    }

    /// The game as a dictionary of plain values.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let robots = |robots: Vec<PyVehicle>| -> PyResult<Vec<Bound<'py, PyDict>>> {
            robots.iter().map(|robot| robot.to_dict(py)).collect()
        };
        let dict = PyDict::new(py);
        dict.set_item("pursuers", robots(self.pursuers())?)?;
        dict.set_item("evaders", robots(self.evaders())?)?;
        dict.set_item("capture_radius", self.capture_radius())?;
        dict.set_item("time_step", self.time_step())?;
        dict.set_item("capture", self.capture())?;
        Ok(dict)
    }

    /// Play one game with a coupling, and record it.
    ///
    /// Parameters
    /// ----------
    /// coupling : list of int
    ///     The evader of each pursuer, each once.
    /// pursuer_starts, evader_starts : array_like of shape (n, 2) or (n, 3)
    ///     Where the robots start, in metres, and their headings in radians (0 by default).
    /// pursuers, evaders : controller or list of controller, optional
    ///     How all robots of a side steer, or each of them, as for `OneOnOne.play`; by default
    ///     "classical".
    /// max_time : float, optional
    ///     When the game is given up, in seconds, rounded to whole time steps.
    ///
    /// Returns
    /// -------
    /// ManyTrajectory
    #[pyo3(signature = (coupling, *, pursuer_starts, evader_starts, pursuers = None, evaders = None,
                        max_time = 60.0))]
    #[expect(clippy::too_many_arguments, reason = "keywords of the Python function")]
    fn play(
        &self,
        py: Python<'_>,
        coupling: &Bound<'_, PyAny>,
        pursuer_starts: &Bound<'_, PyAny>,
        evader_starts: &Bound<'_, PyAny>,
        pursuers: Option<&Bound<'_, PyAny>>,
        evaders: Option<&Bound<'_, PyAny>>,
        max_time: f64,
    ) -> Result<PyManyTrajectory> {
        let coupling = indices(coupling, "coupling")?;
        let start = start(pursuer_starts, evader_starts)?;
        let crews = [Players::new(pursuers, "pursuers")?, Players::new(evaders, "evaders")?];
        let max_steps = steps_within(max_time, self.0.time_step())?;
        let pairs = py.detach(|| {
            let crews = crews.each_ref().map(Players::crew);
            record_coupled(&self.0, &coupling, &start, crews, max_steps)
        })?;
        Ok(PyManyTrajectory { coupling, pairs, time_step: self.0.time_step() })
    }

    /// The capture time of every pair, each alone.
    ///
    /// Parameters
    /// ----------
    /// pursuer_starts, evader_starts, pursuers, evaders, max_time
    ///     As for `play`. Robots that all steer alike are played eight pairs at a time.
    /// threads : int, optional
    ///     0 for one on each core; the result does not depend on it.
    /// control : Control, optional
    ///     To stop it from another thread.
    /// progress : callable, optional
    ///     Called now and then with the number of pairs done.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of shape (n, n)
    ///     In seconds, a row for each pursuer; infinite where the evader was not caught in time, as
    ///     `assign` takes it.
    #[pyo3(signature = (*, pursuer_starts, evader_starts, pursuers = None, evaders = None,
                        max_time = 60.0, threads = 1, control = None, progress = None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of the Python function")]
    fn capture_times<'py>(
        &self,
        py: Python<'py>,
        pursuer_starts: &Bound<'_, PyAny>,
        evader_starts: &Bound<'_, PyAny>,
        pursuers: Option<&Bound<'_, PyAny>>,
        evaders: Option<&Bound<'_, PyAny>>,
        max_time: f64,
        #[pyo3(from_py_with = whole)] threads: usize,
        control: Option<&Bound<'_, PyControl>>,
        progress: Option<Py<PyAny>>,
    ) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let start = start(pursuer_starts, evader_starts)?;
        let crews = [Players::new(pursuers, "pursuers")?, Players::new(evaders, "evaders")?];
        let max_steps = steps_within(max_time, self.0.time_step())?;
        let watch = Watch::new(control, progress);
        let times = enter(py, &watch, |control| {
            let crews = crews.each_ref().map(Players::crew);
            capture_times(&self.0, &start, crews, max_steps, threads, control)
        })?;
        array(py, times, &[self.0.size(), self.0.size()])
    }

    fn __repr__(&self) -> String {
        let robots = |robots: Vec<PyVehicle>| {
            robots.iter().map(PyVehicle::__repr__).collect::<Vec<_>>().join(", ")
        };
        format!(
            "ManyOnMany([{}], [{}], capture_radius={:?}, time_step={:?}, capture={:?})",
            robots(self.pursuers()),
            robots(self.evaders()),
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
        let robots = (own.pursuers(), own.evaders()).into_pyobject(slf.py())?;
        rebuild(&slf.get_type(), robots, &keywords)
    }
}

/// Where all robots begin.
pub fn start(
    pursuer_starts: &Bound<'_, PyAny>,
    evader_starts: &Bound<'_, PyAny>,
) -> Result<ManyStart> {
    Ok(ManyStart {
        pursuers: poses(pursuer_starts, "pursuer_starts")?.all(),
        evaders: poses(evader_starts, "evader_starts")?.all(),
    })
}

/// Whole numbers from anything that Python takes for a list of them.
pub fn indices(object: &Bound<'_, PyAny>, what: &str) -> Result<Vec<usize>> {
    let items = object
        .try_iter()
        .map_err(|_| Error::WrongType(format!("{what} must be a list of whole numbers")))?;
    let index = |(place, item): (usize, PyResult<Bound<'_, PyAny>>)| -> Result<usize> {
        let (item, what) = (item?, format!("{what}[{place}]"));
        whole(&item).map_err(|error| {
            if !error.is_instance_of::<PyTypeError>(object.py()) {
                let expected = "a whole number, 0 or more".to_owned();
                let value = item.extract().unwrap_or(f64::NAN);
                return fuzzy_core::Error::OutOfRange { what, expected, value }.into();
            }
            let came = item.repr().map_or_else(|_| "something else".to_owned(), |r| r.to_string());
            Error::WrongType(format!("{what} must be a whole number, got {came}"))
        })
    };
    items.enumerate().map(index).collect()
}

/// How a side steers.
enum Players {
    Same(Controller),
    Each(Vec<Controller>),
}

impl Players {
    fn new(object: Option<&Bound<'_, PyAny>>, who: &str) -> Result<Self> {
        let Some(object) = object else { return Ok(Self::Same(Controller::Classical)) };
        if object.cast::<PyList>().is_err() && object.cast::<PyTuple>().is_err() {
            return Ok(Self::Same(controller(object, who)?));
        }
        let each = object.try_iter()?.map(|one| controller(&one?, who));
        each.collect::<Result<_>>().map(Self::Each)
    }

    fn crew(&self) -> Crew<'_> {
        match self {
            Self::Same(controller) => Crew::Same(controller),
            Self::Each(controllers) => Crew::Each(controllers),
        }
    }
}

/// The paths of a game of many against many.
#[pyclass(name = "ManyTrajectory", module = "fuzzyrs", frozen)]
pub struct PyManyTrajectory {
    coupling: Vec<usize>,
    pairs: Vec<Trajectory>,
    time_step: f64,
}

#[pymethods]
impl PyManyTrajectory {
    /// The evader of each pursuer.
    #[getter]
    fn coupling(&self) -> Vec<usize> {
        self.coupling.clone()
    }

    /// The game of each pursuer with its evader, which ends at its own capture.
    #[getter]
    fn pairs(&self) -> Vec<PyTrajectory> {
        let pair =
            |path: &Trajectory| PyTrajectory { path: path.clone(), time_step: self.time_step };
        self.pairs.iter().map(pair).collect()
    }

    /// Each pursuer's x, y (m) and heading (rad) until its pair's game ended, shapes (samples, 3).
    #[getter]
    fn pursuers<'py>(&self, py: Python<'py>) -> Result<Vec<Bound<'py, PyArrayDyn<f64>>>> {
        self.pairs.iter().map(|path| pose_array(py, &path.pursuer)).collect()
    }

    /// The same of each evader, in the evaders' order.
    #[getter]
    fn evaders<'py>(&self, py: Python<'py>) -> Result<Vec<Bound<'py, PyArrayDyn<f64>>>> {
        let mut order: Vec<usize> = (0..self.coupling.len()).collect();
        order.sort_unstable_by_key(|&pursuer| self.coupling[pursuer]);
        order.into_iter().map(|pursuer| pose_array(py, &self.pairs[pursuer].evader)).collect()
    }

    /// When each pursuer captured, in seconds, shape (n,); infinite if it did not.
    #[getter]
    fn capture_times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let time = |path: &Trajectory| path.outcome.capture_time(self.time_step);
        PyArray1::from_iter(py, self.pairs.iter().map(|path| time(path).unwrap_or(f64::INFINITY)))
    }

    /// The number of evaders that got away.
    #[getter]
    fn escaped(&self) -> usize {
        self.pairs.iter().filter(|path| !path.outcome.captured).count()
    }

    /// Whether all evaders were caught.
    #[getter]
    fn captured(&self) -> bool {
        self.escaped() == 0
    }

    /// The time of the last capture, in seconds; None if an evader got away.
    #[getter]
    fn capture_time(&self) -> Option<f64> {
        self.captured().then(|| self.duration())
    }

    /// The time played, in seconds: until the last capture, or until time was up.
    #[getter]
    fn duration(&self) -> f64 {
        let steps = self.pairs.iter().map(|path| path.outcome.steps).max();
        seconds(steps.unwrap_or(0), self.time_step)
    }

    fn __len__(&self) -> usize {
        self.pairs.len()
    }

    fn __repr__(&self) -> String {
        let size = self.pairs.len();
        let end = match self.capture_time() {
            Some(time) => format!("all {size} captured after {time:?} s"),
            None => format!("{} of {size} not captured in {:?} s", self.escaped(), self.duration()),
        };
        format!("<ManyTrajectory: {end}>")
    }
}
