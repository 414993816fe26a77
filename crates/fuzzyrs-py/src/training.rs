//! Running a technique.

use pursuit_sim::training::{Technique, Trained};
use pursuit_sim::{OneOnOne, Pd, Regulator, TwoPursuers};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::whole;
use crate::control::PyControl;
use crate::controllers::{controller, controller_object};
use crate::enter::{Watch, enter};
use crate::errors::{Error, Result};
use crate::games::PyOneOnOne;
use crate::outcomes::history_dict;
use crate::regulators::regulator;
use crate::settings::{
    PyDaiTraining, PyIanfisTraining, PyIgbflcTraining, PyMinimaxQTraining, PyQLambdaTraining,
    PyQlbgflcTraining, PyQlfisTraining, PyRewardGaTraining, PyTwoPursuersQLambdaTraining,
    PyTwoPursuersQlbgflcTraining, PyWallIgbflcTraining,
};
use crate::two_pursuers::{PyTwoPursuers, PyTwoPursuersTrained};
use crate::wall::{PyWallFollowing, PyWallTrained};

/// What a technique learned.
#[pyclass(name = "Trained", module = "fuzzyrs", frozen)]
pub struct PyTrained(pub Trained);

#[pymethods]
impl PyTrained {
    /// The pursuer's controller.
    #[getter]
    fn controller<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        controller_object(py, self.0.controller.clone())
    }

    /// The evader's controller, if it learned too; otherwise None.
    #[getter]
    fn evader<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.0.evader.clone().map(|evader| controller_object(py, evader)).transpose()
    }

    /// The time that the robots played while learning, in simulated seconds.
    #[getter]
    fn learning_time(&self) -> f64 {
        self.0.learning_time
    }

    /// How the learning went: an array for each phase; and how often parameters were held within
    /// their bounds, if any was, for each robot that learned.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        history_dict(py, &self.0.history)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut learned = self.controller(py)?.repr()?.to_string();
        if let Some(evader) = self.evader(py)? {
            learned = format!("{learned} against {}", evader.repr()?);
        }
        Ok(format!("<Trained in {:.1} simulated seconds: {learned}>", self.0.learning_time))
    }
}

/// Let a technique learn to pursue, or to follow a wall.
///
/// Parameters
/// ----------
/// game : OneOnOne, TwoPursuers or WallFollowing
///     What is played.
/// settings : a technique's settings
///     QLambdaTraining, MinimaxQTraining, RewardGaTraining, QlbgflcTraining, QlfisTraining,
///     DaiTraining, IanfisTraining or IgbflcTraining for a OneOnOne, TwoPursuersQLambdaTraining or
///     TwoPursuersQlbgflcTraining for a TwoPursuers, whose robots all learn at once, and
///     WallIgbflcTraining for a WallFollowing.
/// seed : int, optional
///     The same seed gives the same controller, to the bit.
/// evader : controller or settings, optional
///     How the evader steers, as for `OneOnOne.play`; by default "classical". Or the settings of
///     the technique by which it learns at the same time, the same as the pursuer's; both play the
///     same games, so episodes, steps and starts must agree. For a OneOnOne.
/// expert : PD, FuzzyRegulator, System, TSK, or a list of them, optional
///     Who is learned from, by default `PD(1.2, 1.5)`. For walls.
/// begun : TwoPursuersTrained, optional
///     What TwoPursuersQlbgflcTraining learned in this game with this seed and the same settings of
///     phase 1, stage 1 and ranges: only stage 2 is done anew. For TwoPursuers.
/// control : Control, optional
///     To stop it from another thread.
/// progress : callable, optional
///     Called now and then with the number of episodes and generations done.
///
/// Returns
/// -------
/// Trained, TwoPursuersTrained or WallTrained
///
/// Raises
/// ------
/// DivergedError
///     If learning diverges; its `so_far` is what was learned before, in a OneOnOne.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> game = fz.OneOnOne()
/// >>> trained = fz.train(game, fz.QLambdaTraining(episodes=20), seed=1)
/// >>> game.play(trained.controller, evader_start=(2, 4)).captured
/// True
#[pyfunction]
#[pyo3(signature = (game, settings, *, seed = 0, evader = None, expert = None, begun = None,
                    control = None, progress = None))]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python function")]
pub fn train<'py>(
    py: Python<'py>,
    game: &Bound<'py, PyAny>,
    settings: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = whole)] seed: u64,
    evader: Option<&Bound<'py, PyAny>>,
    expert: Option<&Bound<'py, PyAny>>,
    begun: Option<&Bound<'py, PyAny>>,
    control: Option<&Bound<'py, PyControl>>,
    progress: Option<Py<PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let watch = Watch::new(control, progress);
    if let Ok(game) = game.cast::<PyOneOnOne>() {
        refuse(expert, "expert", "WallFollowing")?;
        refuse(begun, "begun", "TwoPursuers")?;
        let trained = to_pursue(py, &game.get().0, settings, seed, evader, &watch)?;
        return Ok(Bound::new(py, trained)?.into_any());
    }
    if let Ok(game) = game.cast::<PyTwoPursuers>() {
        refuse(expert, "expert", "WallFollowing")?;
        refuse(evader, "evader", "OneOnOne")?;
        let trained = all_three(py, &game.get().0, settings, seed, begun, &watch)?;
        return Ok(Bound::new(py, trained)?.into_any());
    }
    let Ok(plant) = game.cast::<PyWallFollowing>() else {
        let came = game.get_type().name()?;
        let message = format!("game must be OneOnOne, TwoPursuers or WallFollowing, got {came}");
        return Err(Error::WrongType(message));
    };
    refuse(evader, "evader", "OneOnOne")?;
    refuse(begun, "begun", "TwoPursuers")?;
    let Ok(settings) = settings.cast::<PyWallIgbflcTraining>() else {
        return Err(wrong_settings("WallIgbflcTraining for a WallFollowing", settings));
    };
    let expert = match expert {
        Some(expert) => regulator(expert, "expert")?,
        None => Regulator::Pd(Pd::new(1.2, 1.5)?),
    };
    let (plant, settings) = (&plant.get().0, &settings.get().0);
    let trained = enter(py, &watch, |control| settings.train(plant, &expert, seed, control))?;
    Ok(Bound::new(py, PyWallTrained(trained))?.into_any())
}

fn to_pursue(
    py: Python<'_>,
    game: &OneOnOne,
    settings: &Bound<'_, PyAny>,
    seed: u64,
    evader: Option<&Bound<'_, PyAny>>,
    watch: &Watch,
) -> Result<PyTrained> {
    // Both learn, if the evader's settings are of the same technique.
    macro_rules! train_both_with {
        ($($class:ty),*) => {
            $(if let (Ok(pursuer), Some(Ok(evader))) =
                (settings.cast::<$class>(), evader.map(|evader| evader.cast::<$class>()))
            {
                let (pursuer, evader) = (&pursuer.get().0, &evader.get().0);
                let trained =
                    enter(py, watch, |control| pursuer.train_both(evader, game, seed, control))?;
                return Ok(PyTrained(trained));
            })*
        };
    }
    train_both_with!(
        PyQLambdaTraining,
        PyMinimaxQTraining,
        PyRewardGaTraining,
        PyQlbgflcTraining,
        PyQlfisTraining,
        PyDaiTraining
    );
    let evader = match evader {
        Some(evader) => {
            controller(evader, "evader").map_err(|error| also_settings(error, settings))?
        }
        None => pursuit_sim::Controller::Classical,
    };
    macro_rules! train_with {
        ($($class:ty),*) => {
            $(if let Ok(settings) = settings.cast::<$class>() {
                let settings = &settings.get().0;
                let trained =
                    enter(py, watch, |control| settings.train(game, &evader, seed, control))?;
                return Ok(PyTrained(trained));
            })*
        };
    }
    train_with!(
        PyQLambdaTraining,
        PyMinimaxQTraining,
        PyRewardGaTraining,
        PyQlbgflcTraining,
        PyQlfisTraining,
        PyDaiTraining,
        PyIanfisTraining,
        PyIgbflcTraining
    );
    let fitting = "QLambdaTraining, MinimaxQTraining, RewardGaTraining, QlbgflcTraining, \
                   QlfisTraining, DaiTraining, IanfisTraining or IgbflcTraining for a OneOnOne";
    Err(wrong_settings(fitting, settings))
}

fn all_three(
    py: Python<'_>,
    game: &TwoPursuers,
    settings: &Bound<'_, PyAny>,
    seed: u64,
    begun: Option<&Bound<'_, PyAny>>,
    watch: &Watch,
) -> Result<PyTwoPursuersTrained> {
    if let Some(begun) = begun {
        let begun = begun.cast::<PyTwoPursuersTrained>().ok();
        let prepared = begun.and_then(|begun| begun.get().0.prepared.as_deref());
        let (Some(prepared), Ok(settings)) =
            (prepared, settings.cast::<PyTwoPursuersQlbgflcTraining>())
        else {
            let message = "begun must be what TwoPursuersQlbgflcTraining learned, and is for more \
                           of the same";
            return Err(Error::WrongType(message.to_owned()));
        };
        let settings = &settings.get().0;
        let train = |control: &_| settings.train_from(prepared, game, seed, control);
        return Ok(PyTwoPursuersTrained(enter(py, watch, train)?));
    }
    let trained = if let Ok(settings) = settings.cast::<PyTwoPursuersQLambdaTraining>() {
        let settings = &settings.get().0;
        enter(py, watch, |control| settings.train(game, seed, control))?
    } else if let Ok(settings) = settings.cast::<PyTwoPursuersQlbgflcTraining>() {
        let settings = &settings.get().0;
        enter(py, watch, |control| settings.train(game, seed, control))?
    } else {
        let fitting = "TwoPursuersQLambdaTraining or TwoPursuersQlbgflcTraining for a TwoPursuers";
        return Err(wrong_settings(fitting, settings));
    };
    Ok(PyTwoPursuersTrained(trained))
}

/// The error about an evader, with what else it may be.
fn also_settings(error: Error, settings: &Bound<'_, PyAny>) -> Error {
    match (error, settings.get_type().name()) {
        (Error::WrongType(message), Ok(own)) => Error::WrongType(format!(
            "{message}; for both to learn give the evader settings of the pursuer's kind, {own} \
             (not those of techniques that learn from an expert)"
        )),
        (error, _) => error,
    }
}

/// An error, if an argument was given that is for another game.
fn refuse(argument: Option<&Bound<'_, PyAny>>, name: &str, game: &str) -> Result<()> {
    match argument {
        None => Ok(()),
        Some(_) => Err(Error::WrongType(format!("{name} is for a {game}; leave it out"))),
    }
}

fn wrong_settings(fitting: &str, settings: &Bound<'_, PyAny>) -> Error {
    match settings.get_type().name() {
        Ok(came) => Error::WrongType(format!("settings must be {fitting}, got {came}")),
        Err(error) => error.into(),
    }
}
