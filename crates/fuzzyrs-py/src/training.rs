//! Running a technique.

use numpy::PyArray1;
use pursuit_sim::training::Trained;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::whole;
use crate::control::PyControl;
use crate::controllers::{controller, controller_object};
use crate::enter::{Watch, enter};
use crate::errors::{Error, Result};
use crate::games::PyOneOnOne;
use crate::settings::{
    PyIanfisTraining, PyIgbflcTraining, PyQLambdaTraining, PyQlbgflcTraining, PyRewardGaTraining,
};

/// What a technique learned.
#[pyclass(name = "Trained", module = "fuzzyrs", frozen)]
pub struct PyTrained(Trained);

#[pymethods]
impl PyTrained {
    /// The pursuer's controller.
    #[getter]
    fn controller<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        controller_object(py, self.0.controller.clone())
    }

    /// The time that the robots played while learning, in simulated seconds.
    #[getter]
    fn learning_time(&self) -> f64 {
        self.0.learning_time
    }

    /// How the learning went: an array for each phase.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let history = PyDict::new(py);
        for (phase, values) in &self.0.history {
            history.set_item(phase, PyArray1::from_slice(py, values))?;
        }
        Ok(history)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let controller = self.controller(py)?.repr()?.to_string();
        Ok(format!("<Trained in {:.1} simulated seconds: {controller}>", self.0.learning_time))
    }
}

/// Let a technique learn to pursue.
///
/// Parameters
/// ----------
/// game : OneOnOne
///     The game.
/// settings : QLambdaTraining, RewardGaTraining, QlbgflcTraining, IanfisTraining, IgbflcTraining
///     The technique and its parameters.
/// seed : int, optional
///     The same seed gives the same controller, to the bit.
/// evader : controller, optional
///     How the evader steers, as for `OneOnOne.play`.
/// control : Control, optional
///     To stop it from another thread.
/// progress : callable, optional
///     Called now and then with the number of episodes and generations done.
///
/// Returns
/// -------
/// Trained
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> game = fz.OneOnOne()
/// >>> trained = fz.train(game, fz.QLambdaTraining(episodes=20), seed=1)
/// >>> game.play(trained.controller, evader_start=(2, 4)).captured
/// True
#[pyfunction]
#[pyo3(signature = (game, settings, *, seed = 0, evader = None, control = None, progress = None))]
pub fn train(
    py: Python<'_>,
    game: &Bound<'_, PyOneOnOne>,
    settings: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = whole)] seed: u64,
    evader: Option<&Bound<'_, PyAny>>,
    control: Option<&Bound<'_, PyControl>>,
    progress: Option<Py<PyAny>>,
) -> Result<PyTrained> {
    let game = game.get().0;
    let evader = match evader {
        Some(evader) => controller(evader, "evader")?,
        None => pursuit_sim::Controller::Classical,
    };
    let watch = Watch::new(control, progress);
    macro_rules! train_with {
        ($($class:ty),*) => {
            $(if let Ok(settings) = settings.cast::<$class>() {
                let settings = &settings.get().0;
                let trained =
                    enter(py, &watch, |control| settings.train(&game, &evader, seed, control))?;
                return Ok(PyTrained(trained));
            })*
        };
    }
    train_with!(
        PyQLambdaTraining,
        PyRewardGaTraining,
        PyQlbgflcTraining,
        PyIanfisTraining,
        PyIgbflcTraining
    );
    Err(Error::WrongType(format!(
        "settings must be QLambdaTraining, RewardGaTraining, QlbgflcTraining, IanfisTraining or \
         IgbflcTraining, got {}",
        settings.get_type().name()?
    )))
}
