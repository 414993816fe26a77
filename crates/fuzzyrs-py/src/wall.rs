//! Walls and robots that follow them.

use fuzzy_core::check;
use numpy::{PyArray1, PyArrayDyn};
use pursuit_sim::rollout::seconds;
use pursuit_sim::training::{WallStage, WallTrained};
use pursuit_sim::{Pose, Sensing, Wall, WallFollowing, WallRun};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{array, pairs};
use crate::errors::Result;
use crate::games::{PyVehicle, poses};
use crate::outcomes::pose_array;
use crate::pickle::rebuild;
use crate::regulators::{PyFuzzyRegulator, regulator as read_regulator};

/// A wall: straight pieces from point to point. Made by `Wall.polyline`, or one of the walls of
/// chapter 3: `Wall.straight`, `Wall.jog`, `Wall.step`, `Wall.poly` and `Wall.sin`.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> corner = fz.Wall.polyline([(0, 0), (10, 0), (10, 10)])
/// >>> corner.distance(9, 3)
/// 1.0
#[pyclass(name = "Wall", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyWall(pub Wall);

#[pymethods]
impl PyWall {
    /// The wall through these points.
    ///
    /// Parameters
    /// ----------
    /// points : array_like of shape (n, 2)
    ///     In metres, at least two.
    /// sensing : "nearest" or "vertical", optional
    ///     Whether a robot measures the distance to the nearest point, or along the y axis, for
    ///     which x must rise from point to point.
    ///
    /// Returns
    /// -------
    /// Wall
    #[staticmethod]
    #[pyo3(signature = (points, *, sensing = "nearest"))]
    fn polyline(points: &Bound<'_, PyAny>, sensing: &str) -> Result<Self> {
        Ok(Self(Wall::new(pairs(points, "points")?, Sensing::from_name(sensing)?)?))
    }

    /// y = 0 from x = -5 to 1000 m.
    #[staticmethod]
    fn straight() -> Result<Self> {
        Ok(Self(Wall::straight()?))
    }

    /// Every 20 m the wall moves by between -0.5 and 0.3 m, over 0.3 m; measured vertically.
    #[staticmethod]
    fn jog() -> Result<Self> {
        Ok(Self(Wall::jog()?))
    }

    /// `jog` with ramps of 0.02 m: true jumps of what the robot measures.
    #[staticmethod]
    fn step() -> Result<Self> {
        Ok(Self(Wall::step()?))
    }

    /// Pieces of 25 m with corners of 30° to 90° between them.
    #[staticmethod]
    fn poly() -> Result<Self> {
        Ok(Self(Wall::poly()?))
    }

    /// y = 2 sin(2πx/25) in pieces of 1 m along x, from -5 to 400 m.
    #[staticmethod]
    fn sin() -> Result<Self> {
        Ok(Self(Wall::sine()?))
    }

    /// The points in metres, shape (n, 2).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let points = self.0.points();
        array(py, points.iter().flat_map(|&(x, y)| [x, y]).collect(), &[points.len(), 2])
    }

    /// "nearest" or "vertical".
    #[getter]
    fn sensing(&self) -> &'static str {
        self.0.sensing().name()
    }

    /// The distance from a place to the wall in metres; None where a vertical sensor is beyond
    /// the wall's ends.
    fn distance(&self, x: f64, y: f64) -> Result<Option<f64>> {
        check::finite("x", x)?;
        check::finite("y", y)?;
        Ok(self.0.distance(x, y))
    }

    fn __repr__(&self) -> String {
        format!("<Wall of {} points, {} sensing>", self.0.points().len(), self.sensing())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, own) = (slf.py(), slf.get());
        let keywords = PyDict::new(py);
        keywords.set_item("sensing", own.sensing())?;
        let points = (own.points(py)?,).into_pyobject(py)?;
        rebuild(&slf.get_type().getattr("polyline")?, points, &keywords)
    }
}

/// A robot that is to keep a distance to a wall by steering. The defaults are the robot of chapter
/// 3 of Desouky's thesis; the time step, the range and the steering limit are ours.
///
/// A regulator makes the steering angle of the error, the desired distance less the measured one,
/// and of the error's rate of change. The wall is to the robot's right.
///
/// Parameters
/// ----------
/// wall : Wall
///     The wall.
/// robot : Vehicle, optional
///     By default 0.5 m/s, wheelbase 0.1 m, steering within 1.2 rad.
/// desired_distance : float, optional
///     In metres, positive.
/// sensor_range : float, optional
///     How far the robot's sensor reaches in metres; a robot with no wall in its range is lost.
/// time_step : float, optional
///     In seconds, positive.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> plant = fz.WallFollowing(fz.Wall.sin())
/// >>> plant.play(fz.PD(1.2, 1.5), start=(0, 1.2))
/// <WallRun of 600.0 s: IAE 3.500 m s, MSE 5.247e-5 m2, at most 0.074 m>
#[pyclass(name = "WallFollowing", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyWallFollowing(pub WallFollowing);

#[pymethods]
impl PyWallFollowing {
    #[new]
    #[pyo3(signature = (wall, *, robot = None, desired_distance = None, sensor_range = None,
                        time_step = None))]
    fn new(
        wall: &Bound<'_, PyWall>,
        robot: Option<&Bound<'_, PyVehicle>>,
        desired_distance: Option<f64>,
        sensor_range: Option<f64>,
        time_step: Option<f64>,
    ) -> Result<Self> {
        let thesis = WallFollowing::thesis(wall.get().0.clone())?;
        Ok(Self(WallFollowing::new(
            robot.map_or(*thesis.robot(), |robot| robot.get().0),
            thesis.wall().clone(),
            desired_distance.unwrap_or(thesis.desired_distance()),
            sensor_range.unwrap_or(thesis.sensor_range()),
            time_step.unwrap_or(thesis.time_step()),
        )?))
    }

    /// The wall.
    #[getter]
    fn wall(&self) -> PyWall {
        PyWall(self.0.wall().clone())
    }

    /// The robot.
    #[getter]
    fn robot(&self) -> PyVehicle {
        PyVehicle(*self.0.robot())
    }

    /// In metres.
    #[getter]
    fn desired_distance(&self) -> f64 {
        self.0.desired_distance()
    }

    /// In metres.
    #[getter]
    fn sensor_range(&self) -> f64 {
        self.0.sensor_range()
    }

    /// In seconds.
    #[getter]
    fn time_step(&self) -> f64 {
        self.0.time_step()
    }

    /// The plant as a dictionary of plain values.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let points: Vec<[f64; 2]> = self.0.wall().points().iter().map(|&(x, y)| [x, y]).collect();
        dict.set_item("wall", points)?;
        dict.set_item("sensing", self.0.wall().sensing().name())?;
        dict.set_item("robot", self.robot().to_dict(py)?)?;
        dict.set_item("desired_distance", self.desired_distance())?;
        dict.set_item("sensor_range", self.sensor_range())?;
        dict.set_item("time_step", self.time_step())?;
        Ok(dict)
    }

    /// Let the robot follow the wall, until time is up or it is lost, and record it.
    ///
    /// Parameters
    /// ----------
    /// regulator : PD, FuzzyRegulator, System, TSK, or a list of them
    ///     What makes the steering angle in radians; those of a list are added.
    /// start : (float, float) or (float, float, float), optional
    ///     Where the robot starts, in metres, and its heading in radians (0 by default); by default
    ///     (0, 1.45).
    /// duration : float, optional
    ///     In seconds, rounded to whole time steps; at most 1e7 steps.
    ///
    /// Returns
    /// -------
    /// WallRun
    #[pyo3(signature = (regulator, *, start = None, duration = 600.0))]
    fn play(
        &self,
        py: Python<'_>,
        regulator: &Bound<'_, PyAny>,
        start: Option<&Bound<'_, PyAny>>,
        duration: f64,
    ) -> Result<PyWallRun> {
        let regulator = read_regulator(regulator, "regulator")?;
        check::positive("duration", duration)?;
        let steps = (duration / self.0.time_step()).round();
        let what = "number of time steps in the duration";
        check::within(what, steps, "from 1 to 1e7", |n| (1.0..=1e7).contains(&n))?;
        let start = match start {
            Some(start) => poses(start, "start")?.one()?,
            None => Pose { x: 0.0, y: 1.45, heading: 0.0 },
        };
        Ok(PyWallRun(py.detach(|| self.0.follow(&regulator, start, steps as u32))?))
    }

    fn __repr__(&self) -> String {
        format!(
            "WallFollowing({}, robot={}, desired_distance={:?}, sensor_range={:?}, time_step={:?})",
            self.wall().__repr__(),
            self.robot().__repr__(),
            self.desired_distance(),
            self.sensor_range(),
            self.time_step()
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, own) = (slf.py(), slf.get());
        let keywords = PyDict::new(py);
        keywords.set_item("robot", own.robot())?;
        keywords.set_item("desired_distance", own.desired_distance())?;
        keywords.set_item("sensor_range", own.sensor_range())?;
        keywords.set_item("time_step", own.time_step())?;
        rebuild(&slf.get_type(), (own.wall(),).into_pyobject(py)?, &keywords)
    }
}

/// What happened along a wall: n + 1 samples of the states, n of what was done between them.
#[pyclass(name = "WallRun", module = "fuzzyrs", frozen)]
pub struct PyWallRun(pub WallRun);

#[pymethods]
impl PyWallRun {
    /// The times of the samples in seconds, shape (n + 1,).
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let steps = 0..self.0.error.len();
        PyArray1::from_iter(py, steps.map(|step| seconds(step as u32, self.0.time_step)))
    }

    /// The robot's x, y (m) and heading (rad), shape (n + 1, 3).
    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        pose_array(py, &self.0.poses)
    }

    /// The measured distance in metres, shape (n + 1,).
    #[getter]
    fn distance<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.distance)
    }

    /// The desired distance less the measured one in metres, shape (n + 1,).
    #[getter]
    fn error<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.error)
    }

    /// The error's rate of change in metres per second, shape (n + 1,); 0 at the start.
    #[getter]
    fn rate<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.rate)
    }

    /// What the regulator said in radians, shape (n,).
    #[getter]
    fn wanted<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.wanted)
    }

    /// The same within the robot's limit, shape (n,).
    #[getter]
    fn steering<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.steering)
    }

    /// Whether the robot had no wall in its range after the last sample; otherwise time was up.
    #[getter]
    fn lost(&self) -> bool {
        self.0.lost
    }

    /// The time of the last sample in seconds.
    #[getter]
    fn duration(&self) -> f64 {
        self.0.duration()
    }

    /// How well the robot kept its distance.
    ///
    /// Those of a robot that was lost are about the time before; they say nothing beside another
    /// robot's.
    ///
    /// Parameters
    /// ----------
    /// after : float, optional
    ///     From when on, in seconds, to leave out the way from the start to the wall.
    ///
    /// Returns
    /// -------
    /// dict of str to float
    ///     "iae", the integral of the absolute error in m s; "mse", the mean squared error in m2;
    ///     "max_error", the largest absolute error in m.
    #[pyo3(signature = (after = 0.0))]
    fn measures<'py>(&self, py: Python<'py>, after: f64) -> Result<Bound<'py, PyDict>> {
        let measures = self.0.measures(after)?;
        let dict = PyDict::new(py);
        dict.set_item("iae", measures.iae)?;
        dict.set_item("mse", measures.mse)?;
        dict.set_item("max_error", measures.max_error)?;
        Ok(dict)
    }

    /// Whether the errors were smaller than in another run over the same time, by the integral of
    /// their absolute values and by their mean square. A robot that was lost beats none.
    fn beats(&self, other: &Bound<'_, Self>) -> Result<bool> {
        Ok(self.0.beats(&other.get().0)?)
    }

    fn __repr__(&self) -> Result<String> {
        let measures = self.0.measures(0.0)?;
        let end = if self.0.lost { ", then lost" } else { "" };
        Ok(format!(
            "<WallRun of {:?} s{end}: IAE {:.3} m s, MSE {:.3e} m2, at most {:.3} m>",
            self.duration(),
            measures.iae,
            measures.mse,
            measures.max_error
        ))
    }
}

/// What came out of stage 1 of IGBFLC, or of a repetition of stage 2.
#[pyclass(name = "WallStage", module = "fuzzyrs", frozen)]
pub struct PyWallStage(WallStage);

#[pymethods]
impl PyWallStage {
    /// The tuned controller.
    #[getter]
    fn controller(&self) -> PyFuzzyRegulator {
        PyFuzzyRegulator(self.0.controller.clone())
    }

    /// The least mean squared error of each generation in rad2.
    #[getter]
    fn fitness<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.fitness)
    }

    /// The integral of the absolute error of the controller alone in m s; None if the robot was
    /// lost.
    #[getter]
    fn iae(&self) -> Option<f64> {
        self.0.iae
    }

    /// Whether the controller alone had smaller errors than the expert.
    #[getter]
    fn beats_expert(&self) -> bool {
        self.0.beats_expert
    }
}

/// What IGBFLC learned along a wall.
#[pyclass(name = "WallTrained", module = "fuzzyrs", frozen)]
pub struct PyWallTrained(pub WallTrained);

#[pymethods]
impl PyWallTrained {
    /// The best controller: of those that beat the expert, or of all if there is none, the one
    /// with the least integral of the absolute error.
    #[getter]
    fn controller(&self) -> PyFuzzyRegulator {
        PyFuzzyRegulator(self.0.controller().clone())
    }

    /// Stage 1, then the repetitions of stage 2.
    #[getter]
    fn stages(&self) -> Vec<PyWallStage> {
        self.0.stages.iter().cloned().map(PyWallStage).collect()
    }

    /// The number of the stage that `controller` came from, 0 for stage 1.
    #[getter]
    fn best(&self) -> usize {
        self.0.best
    }

    fn __repr__(&self) -> String {
        let beats = if self.0.stages[self.0.best].beats_expert { "beats" } else { "doesn't beat" };
        format!("<WallTrained: the controller of stage {} {beats} the expert>", self.0.best)
    }
}
