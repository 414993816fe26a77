//! Settings of the techniques. Their defaults live in Rust; a parameter left out has its default.

use fuzzy_core::learn::rl::{Play, Ties, Tune};
use pursuit_sim::training::{
    DaiTraining, GeneRanges, GeneticPhase, IanfisTraining, IgbflcTraining, Lessons,
    MinimaxQTraining, Operators, Pairing, QLambdaTraining, QlbgflcTraining, QlfisTraining,
    RewardGaTraining, Target, WallGeneRanges, WallIgbflcTraining,
};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::pairs;
use crate::errors::{Error, Result};
use crate::pickle::rebuild;

/// A value of a setting on its way between the languages.
trait Setting: Sized {
    fn from_object(object: &Bound<'_, PyAny>, name: &str) -> Result<Self>;
    fn to_object<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>>;
    /// As JSON has it: settings within settings become dictionaries, tuples lists.
    fn to_plain<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.to_object(py)
    }
    /// For people to read.
    fn to_text(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.to_object(py)?.repr()?.to_string())
    }
}

macro_rules! plain_setting {
    ($($type:ty: $words:literal),*) => {$(
        impl Setting for $type {
            fn from_object(object: &Bound<'_, PyAny>, name: &str) -> Result<Self> {
                object.extract().map_err(|error: PyErr| {
                    // A number that is too large or negative is of the right type.
                    if error.is_instance_of::<PyOverflowError>(object.py()) {
                        let value = object.extract().unwrap_or(f64::INFINITY);
                        let (what, expected) = (name.to_owned(), $words.to_owned());
                        return fuzzy_core::Error::OutOfRange { what, expected, value }.into();
                    }
                    let came = object.repr().map_or_else(|_| "?".to_owned(), |r| r.to_string());
                    Error::WrongType(format!("{name} must be {}, got {came}", $words))
                })
            }
            fn to_object<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                self.into_bound_py_any(py)
            }
        }
    )*};
}
plain_setting!(
    bool: "True or False",
    f64: "a number",
    u32: "a whole number from 0 to 2^32 - 1",
    usize: "a whole number from 0 to 2^64 - 1"
);

/// A range.
impl Setting for (f64, f64) {
    fn from_object(object: &Bound<'_, PyAny>, name: &str) -> Result<Self> {
        let pair: PyResult<[f64; 2]> = object.extract();
        pair.map(Into::into)
            .map_err(|_| Error::WrongType(format!("{name} must be a pair of numbers")))
    }
    fn to_object<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.into_bound_py_any(py)
    }
    fn to_plain<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        [self.0, self.1].into_bound_py_any(py)
    }
}

/// Positions.
impl Setting for Vec<(f64, f64)> {
    fn from_object(object: &Bound<'_, PyAny>, name: &str) -> Result<Self> {
        pairs(object, name)
    }
    fn to_object<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.into_bound_py_any(py)
    }
    fn to_plain<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows: Vec<[f64; 2]> = self.iter().map(|&(x, y)| [x, y]).collect();
        rows.into_bound_py_any(py)
    }
    fn to_text(&self, _py: Python<'_>) -> PyResult<String> {
        Ok(match self.as_slice() {
            [first, _, _, .., last] => {
                format!("[{first:?}, ... {} positions ..., {last:?}]", self.len())
            }
            few => format!("{few:?}"),
        })
    }
}

/// Choices that go by names.
macro_rules! named_setting {
    ($($type:ty),*) => {$(
        impl Setting for $type {
            fn from_object(object: &Bound<'_, PyAny>, name: &str) -> Result<Self> {
                let chosen: String = object
                    .extract()
                    .map_err(|_| Error::WrongType(format!("{name} must be the name of a choice")))?;
                Ok(Self::from_name(&chosen)?)
            }
            fn to_object<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                self.name().into_bound_py_any(py)
            }
        }
    )*};
}
named_setting!(Target, Operators, Pairing, Play, Ties, Tune);

/// Defines the Python class of a struct of settings: a constructor by keywords, getters, equality,
/// `to_dict` and a readable representation.
macro_rules! settings {
    ($(#[$doc:meta])* $class:ident, $name:literal, $rust:ty { $($field:ident),* $(,)? }) => {
        $(#[$doc])*
        #[pyclass(name = $name, module = "fuzzyrs", frozen, eq)]
        #[derive(Clone, PartialEq)]
        pub struct $class(pub $rust);

        #[pymethods]
        impl $class {
            #[new]
            #[pyo3(signature = (*, $($field = None),*))]
            #[allow(clippy::too_many_arguments)]
            fn new($($field: Option<&Bound<'_, PyAny>>),*) -> Result<Self> {
                let mut settings = <$rust>::default();
                $(if let Some(value) = $field {
                    settings.$field = Setting::from_object(value, stringify!($field))?;
                })*
                Ok(Self(settings))
            }

            /// The settings as a dictionary of plain values.
            fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
                let dict = PyDict::new(py);
                $(dict.set_item(stringify!($field), self.0.$field.to_plain(py)?)?;)*
                Ok(dict)
            }

            $(
                #[getter]
                fn $field<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                    self.0.$field.to_object(py)
                }
            )*

            fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
                let mut parts: Vec<String> = Vec::new();
                $(parts.push(format!(
                    "{}={}", stringify!($field), self.0.$field.to_text(py)?
                ));)*
                Ok(format!("{}({})", $name, parts.join(", ")))
            }

            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
                let keywords = PyDict::new(slf.py());
                $(keywords.set_item(stringify!($field), slf.get().0.$field.to_object(slf.py())?)?;)*
                rebuild(&slf.get_type(), PyTuple::empty(slf.py()), &keywords)
            }
        }

        impl Setting for $rust {
            fn from_object(object: &Bound<'_, PyAny>, name: &str) -> Result<Self> {
                // A dictionary too, so that what `to_dict` gives can be read back.
                if let Ok(fields) = object.cast::<PyDict>() {
                    let class = object.py().get_type::<$class>();
                    return Self::from_object(&class.call((), Some(fields))?, name);
                }
                let Ok(settings) = object.cast::<$class>() else {
                    let came = object.get_type().name()?;
                    return Err(Error::WrongType(format!("{name} must be {}, got {came}", $name)));
                };
                Ok(settings.get().0.clone())
            }
            fn to_object<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                Ok(Bound::new(py, $class(self.clone()))?.into_any())
            }
            fn to_plain<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                Ok($class(self.clone()).to_dict(py)?.into_any())
            }
            fn to_text(&self, py: Python<'_>) -> PyResult<String> {
                $class(self.clone()).__repr__(py)
            }
        }
    };
}

mod couplings;
mod two_pursuers;

pub use couplings::{PyCoupledRobotsTraining, PyCouplingTraining, PyPairwiseTraining};
pub use two_pursuers::{PyTwoPursuersQLambdaTraining, PyTwoPursuersQlbgflcTraining};

settings! {
    /// The size of a genetic search.
    ///
    /// Parameters
    /// ----------
    /// iterations : int, optional
    ///     Generations.
    /// population : int, optional
    ///     Individuals, at least 4.
    /// crossover, mutation : float, optional
    ///     The shares of a new generation that are children and that are mutants.
    /// fresh_mutants : bool, optional
    ///     Whether mutants are drawn anew as a whole; if not, they are kept individuals with one
    ///     gene drawn anew.
    PyGeneticPhase, "GeneticPhase", GeneticPhase {
        iterations, population, crossover, mutation, fresh_mutants,
    }
}

settings! {
    /// The ranges that the genes of a fuzzy controller are drawn from.
    ///
    /// Parameters
    /// ----------
    /// width, mean : (float, float), optional
    ///     Of the Gaussians.
    /// consequent : (float, float), optional
    ///     Of the rules, in radians.
    PyGeneRanges, "GeneRanges", GeneRanges { width, mean, consequent }
}

settings! {
    /// Q(λ)-learning of the pursuer on a grid of states and actions. Defaults: Desouky's thesis,
    /// section 6.5.2; `repr(fz.QLambdaTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// episodes, steps : int, optional
    ///     Games played, and time steps after which one is given up.
    /// discount, trace_decay : float, optional
    ///     γ and λ.
    /// learning_rate, learning_rate_decay : float, optional
    ///     α = learning_rate / i**learning_rate_decay in game i.
    /// exploration, exploration_decay : float, optional
    ///     ε = exploration / i**exploration_decay in game i.
    /// points, actions : int, optional
    ///     Grid points of each input, and steering angles.
    /// ties : {"first", "random"}, optional
    ///     Which of several equally good actions is taken while learning.
    /// bootstrap_at_capture : bool, optional
    ///     Whether the value of the state after a capture counts.
    /// starts : array_like of shape (n, 2), optional
    ///     The evader's starting positions in metres, drawn evenly.
    PyQLambdaTraining, "QLambdaTraining", QLambdaTraining {
        episodes, steps, discount, trace_decay, learning_rate, learning_rate_decay, exploration,
        exploration_decay, points, actions, ties, bootstrap_at_capture, starts,
    }
}

settings! {
    /// Minimax-Q(λ) on a grid of both robots' angles: one table of their joint actions. Defaults:
    /// Desouky's thesis, section 8.3; `repr(fz.MinimaxQTraining())` shows them.
    ///
    /// Give the same settings as `evader` to `train`, and the table steers both robots while it
    /// learns; otherwise it learns from what the given evader does.
    ///
    /// Parameters
    /// ----------
    /// episodes, steps : int, optional
    ///     Games played, and time steps after which one is given up.
    /// discount, trace_decay : float, optional
    ///     γ and λ.
    /// learning_rate, learning_rate_decay : float, optional
    ///     α = learning_rate / i**learning_rate_decay in game i.
    /// exploration, exploration_decay : float, optional
    ///     ε = exploration / i**exploration_decay in game i, for each robot by itself.
    /// points : int, optional
    ///     Grid points of each robot's angle.
    /// actions, evader_actions : int, optional
    ///     Steering angles of the pursuer and of the evader.
    /// play : {"answer", "security", "mixed"}, optional
    ///     How both choose: the pursuer by its largest minimum, which the evader answers; both by
    ///     their own largest minimum; or both by the mixed strategies of the matrix game.
    /// ties : {"random", "first"}, optional
    ///     Which of several equally good actions.
    /// bootstrap_at_capture : bool, optional
    ///     Whether the value of the state after a capture counts.
    /// starts : array_like of shape (n, 2), optional
    ///     The evader's starting positions in metres, drawn evenly.
    PyMinimaxQTraining, "MinimaxQTraining", MinimaxQTraining {
        episodes, steps, discount, trace_decay, learning_rate, learning_rate_decay, exploration,
        exploration_decay, points, actions, evader_actions, play, ties, bootstrap_at_capture,
        starts,
    }
}

settings! {
    /// Genetic search for the fuzzy controller with the largest mean reward. Defaults: Desouky's
    /// thesis, section 6.5.2; `repr(fz.RewardGaTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// genetic : GeneticPhase, optional
    ///     The size of the search.
    /// steps : int, optional
    ///     Time steps after which a game is given up.
    /// ranges : GeneRanges, optional
    ///     Where genes are drawn from.
    /// starts : array_like of shape (n, 2), optional
    ///     The evader's starting positions in metres, one drawn for each generation.
    /// pairing : {"best", "place"}, optional
    ///     Whom an individual meets if both robots learn: the best of the other robot's last
    ///     generation, or the individual in the same place.
    PyRewardGaTraining, "RewardGaTraining", RewardGaTraining {
        genetic, steps, ranges, starts, pairing,
    }
}

settings! {
    /// The Q(λ)-learning based genetic fuzzy logic controller. Defaults: Desouky's thesis, section
    /// 6.5.2 and Table 6.1; `repr(fz.QlbgflcTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// phase_1 : QLambdaTraining, optional
    ///     Learns a table.
    /// stage_1 : GeneticPhase, optional
    ///     Fits a fuzzy controller to the table.
    /// stage_2 : GeneticPhase, optional
    ///     Tunes it for the least capture time.
    /// prepared : bool, optional
    ///     Whether phase 1 and stage 1 are done; if not, stage 2 begins with random controllers.
    /// steps : int, optional
    ///     Time steps after which a game of stage 2 is given up.
    /// ranges : GeneRanges, optional
    ///     Where genes are drawn from.
    /// starts : array_like of shape (n, 2), optional
    ///     The evader's starting positions in stage 2 in metres.
    /// starts_per_generation : int, optional
    ///     How many of them are drawn for each generation; the mean capture time counts.
    /// pairing : {"best", "place"}, optional
    ///     Whom an individual of stage 2 meets if both robots learn, as in `RewardGaTraining`.
    PyQlbgflcTraining, "QlbgflcTraining", QlbgflcTraining {
        phase_1, stage_1, stage_2, prepared, steps, ranges, starts, starts_per_generation,
        pairing,
    }
}

settings! {
    /// QLFIS: a fuzzy critic learns what can be had, a fuzzy controller to steer. Defaults: Desouky's
    /// thesis, section 7.3.1; `repr(fz.QlfisTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// episodes, steps : int, optional
    ///     Games played, and time steps after which one is given up.
    /// discount, trace_decay : float, optional
    ///     γ and λ.
    /// critic_rate, actor_rate : (float, float), optional
    ///     Learning rates, from before the first game to the last.
    /// noise, noise_decay : float, optional
    ///     The noise on the steering angle has a standard deviation of noise / i**noise_decay
    ///     radians in game i.
    /// tune : {"all", "consequents"}, optional
    ///     Which parameters learn.
    /// narrowest : float, optional
    ///     The least width of a Gaussian that learns, as a share of its universe.
    /// width : float, optional
    ///     The first width of the Gaussians.
    /// angle_limit, rate_limit : float, optional
    ///     What the inputs are held within, in rad and rad/s; no angle is larger than pi.
    /// bootstrap_at_capture : bool, optional
    ///     Whether the value of the state after a capture counts.
    /// starts : array_like of shape (n, 2), optional
    ///     The evader's starting positions in metres, drawn evenly.
    PyQlfisTraining, "QlfisTraining", QlfisTraining {
        episodes, steps, discount, trace_decay, critic_rate, actor_rate, noise, noise_decay, tune,
        narrowest, width, angle_limit, rate_limit, bootstrap_at_capture, starts,
    }
}

settings! {
    /// A fuzzy controller learns to steer from a neural critic, after Dai et al. Defaults: Desouky's
    /// thesis, section 7.3.1; `repr(fz.DaiTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// hidden : int, optional
    ///     Units of the network's hidden layer.
    /// learning : QlfisTraining, optional
    ///     Everything else. Give a dictionary made from `DaiTraining().learning.to_dict()` to change
    ///     single settings: the defaults differ from those of `QlfisTraining`.
    PyDaiTraining, "DaiTraining", DaiTraining { hidden, learning }
}

settings! {
    /// What a PD controller teaches a fuzzy controller, and where. Defaults: Desouky's thesis,
    /// chapter 4; `repr(fz.Lessons())` shows them.
    ///
    /// Parameters
    /// ----------
    /// expert : (float, float), optional
    ///     The gains of the PD controller; the second in seconds.
    /// starts : array_like of shape (n, 2), optional
    ///     The evader's starting positions in metres, one game each.
    /// steps : int, optional
    ///     Time steps after which a game is given up.
    /// repetitions : int, optional
    ///     How often stage 2 is done, in which both steer in parallel; 0 for the expert alone.
    /// target : {"sum", "expert"}, optional
    ///     What is learned in stage 2: what both did, or what the expert did.
    PyLessons, "Lessons", Lessons { expert, starts, steps, repetitions, target }
}

settings! {
    /// Iterative ANFIS: learn what a PD controller does, then what both do in parallel. Defaults:
    /// Desouky's thesis, section 4.3; `repr(fz.IanfisTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// lessons : Lessons, optional
    ///     What is taught, and where.
    /// epochs : int, optional
    ///     Epochs in each stage.
    /// rate : float, optional
    ///     The learning rate of the Gaussians.
    /// ridge : float, optional
    ///     What keeps least squares regular where rules never fire.
    /// jitter : float, optional
    ///     How far the first means and widths are from even ones, in widths; below 1.
    PyIanfisTraining, "IanfisTraining", IanfisTraining { lessons, epochs, rate, ridge, jitter }
}

settings! {
    /// Iterative genetic tuning of a fuzzy controller: learn what a PD controller does, then what
    /// both do in parallel. Defaults: Desouky's thesis, section 4.4, but for the operators;
    /// `repr(fz.IgbflcTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// lessons : Lessons, optional
    ///     What is taught, and where.
    /// iterations, population : int, optional
    ///     The size of the search in each stage.
    /// operators : {"modern", "averaging", "single-gene"}, optional
    ///     How individuals breed: tournaments with blend crossover, or the thesis's two readings.
    PyIgbflcTraining, "IgbflcTraining", IgbflcTraining { lessons, iterations, population, operators }
}

settings! {
    /// The ranges that the genes of a wall-following controller are drawn from. A trapezoid's
    /// vertices lie at a = x0 + p1, b = a + p2, c = b + p3 and d = c + p4.
    ///
    /// Parameters
    /// ----------
    /// shift : (float, float), optional
    ///     Of p1.
    /// width : (float, float), optional
    ///     Of p2, p3 and p4; zero or more.
    /// gain : (float, float), optional
    ///     Of the three scaling factors.
    PyWallGeneRanges, "WallGeneRanges", WallGeneRanges { shift, width, gain }
}

settings! {
    /// The iterative genetic based fuzzy logic controller along a wall: a fuzzy controller is tuned
    /// to what an expert did; then both steer together, the controller is tuned to their sum, and
    /// so on. Defaults: Desouky's thesis, sections 3.4 and 3.5; `repr(fz.WallIgbflcTraining())`
    /// shows them.
    ///
    /// Parameters
    /// ----------
    /// population, iterations : int, optional
    ///     Individuals and generations of each genetic search.
    /// operators : "averaging", "single-gene" or "modern", optional
    ///     How it breeds: as in the thesis (the better half is kept, 40 % are averages of
    ///     neighbours, 10 % are drawn anew), the same with single genes drawn anew, or by
    ///     tournaments, BLX-0.3 and Gaussian mutation.
    /// repetitions : int, optional
    ///     How often the controller and the expert steer together, at most; 0 for stage 1 alone.
    /// until_better : bool, optional
    ///     Whether to stop once the controller alone beats the expert.
    /// duration : float, optional
    ///     Of each run, in seconds.
    /// start : (float, float), optional
    ///     Where the robot starts, in metres.
    /// ranges : WallGeneRanges, optional
    ///     Where genes are drawn from.
    PyWallIgbflcTraining, "WallIgbflcTraining", WallIgbflcTraining {
        population, iterations, operators, repetitions, until_better, duration, start, ranges,
    }
}
