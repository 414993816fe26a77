//! Games in which agents of the user's learn.

use fuzzy_core::Control;
use fuzzy_core::learn::rl::Agent;
use numpy::PyArray2;
use pursuit_sim::training::{Practice, Role, thesis_starts};
use pursuit_sim::{Controller, OneOnOne, Outcome};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::agents::{Driven, PyFuzzyActorCritic, PyNeuralActorCritic, PyQLambdaAgent, PyQlfis};
use crate::arrays::{pairs, whole};
use crate::controllers::{controller, controller_object};
use crate::errors::{Error, Result};
use crate::games::PyOneOnOne;

/// Games in which an agent learns to steer one robot; an environment for `fit` that plays whole
/// episodes in Rust.
///
/// The agent observes the angle to the line of sight in radians and its rate of change in rad/s,
/// and says the steering angle. A pursuer is rewarded for the way it gains in a step, as a share of
/// the most it could (6.10), an evader for the opposite. A controller is evaluated by the duration
/// of games, which the evader wants to be long.
///
/// Parameters
/// ----------
/// game : OneOnOne
///     What is played.
/// role : {"pursuer", "evader"}, optional
///     Which robot the agent steers.
/// opponent : controller, optional
///     How the other steers, as for `OneOnOne.play`; by default "classical".
/// starts : array_like of shape (n, 2), optional
///     The evader's starting positions in metres, drawn evenly; by default 64 within 8 m.
/// steps : int, optional
///     Time steps after which a game is given up.
/// bootstrap_at_capture : bool, optional
///     Whether the value of the state after a capture counts. A pursuer that is rewarded on the
///     way would otherwise be punished for the capture.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> inputs = [fz.Variable.evenly(name, (-1, 1), "NZP") for name in ["angle", "rate"]]
/// >>> actor = fz.TSK(inputs, [-0.5, -0.5, -0.5, 0, 0, 0, 0.5, 0.5, 0.5], outside="clamp")
/// >>> game = fz.OneOnOne()
/// >>> learned = fz.fit(fz.Practice(game), fz.QLFIS(actor, seed=1), episodes=50)
/// >>> game.play(learned.controller, evader_start=(2, 4)).captured
/// True
#[pyclass(name = "Practice", module = "fuzzyrs", frozen)]
pub struct PyPractice {
    game: OneOnOne,
    role: Role,
    opponent: Controller,
    starts: Vec<(f64, f64)>,
    steps: u32,
    bootstrap_at_capture: bool,
}

#[pymethods]
impl PyPractice {
    #[new]
    #[pyo3(signature = (game, role = "pursuer", *, opponent = None, starts = None, steps = 600,
                        bootstrap_at_capture = true))]
    fn new(
        game: &Bound<'_, PyOneOnOne>,
        role: &str,
        opponent: Option<&Bound<'_, PyAny>>,
        starts: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = whole)] steps: u32,
        bootstrap_at_capture: bool,
    ) -> Result<Self> {
        let role = Role::from_name(role)?;
        let who = match role {
            Role::Pursuer => Role::Evader.name(),
            Role::Evader => Role::Pursuer.name(),
        };
        let practice = Self {
            game: game.get().0,
            role,
            opponent: opponent
                .map_or(Ok(Controller::Classical), |opponent| controller(opponent, who))?,
            starts: starts.map_or_else(|| Ok(thesis_starts()), |starts| pairs(starts, "starts"))?,
            steps,
            bootstrap_at_capture,
        };
        practice.games().check()?;
        Ok(practice)
    }

    /// What is played.
    #[getter]
    fn game(&self) -> PyOneOnOne {
        PyOneOnOne(self.game)
    }

    /// Which robot the agent steers.
    #[getter]
    fn role(&self) -> &'static str {
        self.role.name()
    }

    /// How the other robot steers.
    #[getter]
    fn opponent<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        controller_object(py, self.opponent.clone())
    }

    /// The evader's starting positions, shape (n, 2).
    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArray2<f64>>> {
        let rows: Vec<Vec<f64>> = self.starts.iter().map(|&(x, y)| vec![x, y]).collect();
        PyArray2::from_vec2(py, &rows).map_err(|error| Error::WrongType(error.to_string()))
    }

    /// Time steps after which a game is given up.
    #[getter]
    fn steps(&self) -> u32 {
        self.steps
    }

    /// Whether the value of the state after a capture counts.
    #[getter]
    fn bootstrap_at_capture(&self) -> bool {
        self.bootstrap_at_capture
    }

    /// Let an agent learn in one game.
    ///
    /// Parameters
    /// ----------
    /// agent : QLFIS, FuzzyActorCritic, NeuralActorCritic or QLambdaAgent
    ///     It is changed.
    /// episode : int
    ///     The number of the game, from 1 on; on it and the seed depends where the game starts.
    /// seed : int, optional
    ///     Of the games.
    ///
    /// Returns
    /// -------
    /// dict
    ///     "reward", the sum of the agent's rewards; "steps"; "captured"; "duration" in seconds.
    #[pyo3(signature = (agent, episode, seed = 0))]
    fn learn<'py>(
        &self,
        py: Python<'py>,
        agent: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = whole)] episode: u64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Bound<'py, PyDict>> {
        fuzzy_core::check::within("episode", episode as f64, "from 1 to 2^40", |number| {
            (1.0..=1_099_511_627_776.0).contains(&number)
        })?;
        let outcome = drive(py, agent, Learn { practice: self, episode, seed })?;
        self.told(py, &outcome)
    }

    /// Let an agent play one game without exploration; it learns nothing.
    ///
    /// Parameters
    /// ----------
    /// agent : QLFIS, FuzzyActorCritic, NeuralActorCritic or QLambdaAgent
    ///     Who plays.
    /// number : int
    ///     Of the test; on it and the seed depends where the game starts.
    /// seed : int, optional
    ///     Of the tests.
    ///
    /// Returns
    /// -------
    /// dict
    ///     As from `learn`.
    #[pyo3(signature = (agent, number, seed = 0))]
    fn test<'py>(
        &self,
        py: Python<'py>,
        agent: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = whole)] number: u64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Bound<'py, PyDict>> {
        fuzzy_core::check::within("number", number as f64, "at most 2^40", |number| {
            number <= 1_099_511_627_776.0
        })?;
        let outcome = drive(py, agent, Test { practice: self, number, seed })?;
        self.told(py, &outcome)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let opponent = self.opponent(py)?.repr()?.to_string();
        Ok(format!(
            "<Practice as {} against {opponent}, {} starts>",
            self.role(),
            self.starts.len()
        ))
    }
}

impl PyPractice {
    fn games(&self) -> Practice<'_> {
        Practice {
            game: &self.game,
            role: self.role,
            opponent: &self.opponent,
            starts: &self.starts,
            steps: self.steps,
            bootstrap_at_capture: self.bootstrap_at_capture,
        }
    }

    fn told<'py>(&self, py: Python<'py>, outcome: &Outcome) -> Result<Bound<'py, PyDict>> {
        let told = PyDict::new(py);
        told.set_item("reward", self.games().reward(outcome))?;
        told.set_item("steps", outcome.steps)?;
        told.set_item("captured", outcome.captured)?;
        told.set_item("duration", outcome.duration(self.game.time_step()))?;
        Ok(told)
    }
}

/// What an agent of any kind does.
trait Task: Sync {
    fn run<A: Agent>(&self, driven: &mut Driven<A>) -> pursuit_sim::Result<Outcome>;
}

struct Learn<'a> {
    practice: &'a PyPractice,
    episode: u64,
    seed: u64,
}

impl Task for Learn<'_> {
    fn run<A: Agent>(&self, driven: &mut Driven<A>) -> pursuit_sim::Result<Outcome> {
        let (games, one) = (self.practice.games(), self.episode..self.episode + 1);
        let Driven { agent, rng } = driven;
        let mut outcomes = games.play(agent, rng, one, self.seed, &Control::new())?;
        Ok(outcomes.swap_remove(0))
    }
}

struct Test<'a> {
    practice: &'a PyPractice,
    number: u64,
    seed: u64,
}

impl Task for Test<'_> {
    fn run<A: Agent>(&self, driven: &mut Driven<A>) -> pursuit_sim::Result<Outcome> {
        let games = self.practice.games();
        games.test(&mut driven.agent, self.number, self.seed, &Control::new())
    }
}

/// Runs a task with an agent that Python names. A game is too short to watch over it.
fn drive(py: Python<'_>, agent: &Bound<'_, PyAny>, task: impl Task) -> Result<Outcome> {
    macro_rules! as_one_of {
        ($($class:ty),*) => {
            $(if let Ok(agent) = agent.cast::<$class>() {
                let mut agent = agent.try_borrow_mut().map_err(PyErr::from)?;
                let driven = &mut agent.0;
                return Ok(py.detach(|| task.run(driven))?);
            })*
        };
    }
    as_one_of!(PyQlfis, PyFuzzyActorCritic, PyNeuralActorCritic, PyQLambdaAgent);
    let came = agent.get_type().name()?;
    Err(Error::WrongType(format!(
        "agent must be a QLFIS, FuzzyActorCritic, NeuralActorCritic or QLambdaAgent, got {came}"
    )))
}
