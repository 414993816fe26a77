//! Finite Markov decision processes, and learners compared on them.

use fuzzy_core::learn::rl::{
    Bound as ValueBound, Counts, Cut, Learner, Mdp, Per, Scale, Trace, Trial, TrialSettings,
};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Rng, check};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Floats, Shape, array, whole};
use crate::control::PyControl;
use crate::enter::{Watch, enter};
use crate::errors::Result;
use crate::pickle::rebuild;
use crate::q_lambda::{below, policy};

/// A finite Markov decision process: where each action leads from each state, and what it earns.
///
/// Parameters
/// ----------
/// transitions : array_like of shape (states, actions, states)
///     The probability of each next state; each row sums to 1.
/// rewards : array_like of shape (states, actions)
///     The mean reward.
/// reward_noise : float, optional
///     Rewards are spread evenly over the mean plus or minus this.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> mdp = fz.MDP([[[1, 0], [0, 1]], [[0, 1], [1, 0]]], [[0, 1], [0, 0]])
/// >>> values, error = mdp.q_star(0.5)
/// >>> values.round(3).tolist()
/// [[0.667, 1.333], [0.333, 0.667]]
#[pyclass(name = "MDP", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyMdp(pub Mdp);

#[pymethods]
impl PyMdp {
    #[new]
    #[pyo3(signature = (transitions, rewards, *, reward_noise = 0.0))]
    fn new(
        transitions: &Bound<'_, PyAny>,
        rewards: &Bound<'_, PyAny>,
        reward_noise: f64,
    ) -> Result<Self> {
        let (own, rewards) =
            (Floats::new(transitions, "transitions")?, Floats::new(rewards, "rewards")?);
        let wrong = |what: &str, expected: String, shape: &[usize]| {
            fuzzy_core::Error::wrong_shape(what, expected, Shape(shape))
        };
        let &[states, actions, next] = own.shape() else {
            let expected = "an array of shape (states, actions, states)".to_owned();
            return Err(wrong("transitions", expected, own.shape()).into());
        };
        if next != states {
            let expected = format!("an array of shape ({states}, {actions}, {states})");
            return Err(wrong("transitions", expected, own.shape()).into());
        }
        if rewards.shape() != [states, actions] {
            let expected = format!("an array of shape ({states}, {actions})");
            return Err(wrong("rewards", expected, rewards.shape()).into());
        }
        let mdp = Mdp::new(states, actions, own.as_slice()?, rewards.as_slice()?)?;
        Ok(Self(mdp.with_reward_noise(reward_noise)?))
    }

    /// A random process (Garnet): each action leads to `branching` states with random
    /// probabilities; mean rewards lie in [-1, 1].
    #[staticmethod]
    #[pyo3(signature = (states, actions, branching, *, reward_noise = 0.0, seed = 0))]
    fn garnet(
        #[pyo3(from_py_with = whole)] states: usize,
        #[pyo3(from_py_with = whole)] actions: usize,
        #[pyo3(from_py_with = whole)] branching: usize,
        reward_noise: f64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let mdp = Mdp::garnet(states, actions, branching, seed)?;
        Ok(Self(mdp.with_reward_noise(reward_noise)?))
    }

    /// The 5 × 5 gridworld of Sutton and Barto (1998), example 3.8: actions go north, south, east
    /// and west; with probability `slip` the move is any of the four.
    #[staticmethod]
    #[pyo3(signature = (*, slip = 0.0, reward_noise = 0.0))]
    fn gridworld(slip: f64, reward_noise: f64) -> Result<Self> {
        Ok(Self(Mdp::gridworld(slip)?.with_reward_noise(reward_noise)?))
    }

    /// The number of states.
    #[getter]
    fn states(&self) -> usize {
        self.0.states()
    }

    /// The number of actions in each state.
    #[getter]
    fn actions(&self) -> usize {
        self.0.actions()
    }

    /// The probabilities, shape (states, actions, states).
    #[getter]
    fn transitions<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [self.0.states(), self.0.actions(), self.0.states()];
        array(py, self.0.transitions().to_vec(), &shape)
    }

    /// The mean rewards, shape (states, actions).
    #[getter]
    fn rewards<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        array(py, self.0.rewards().to_vec(), &[self.0.states(), self.0.actions()])
    }

    /// How far a reward may be from its mean.
    #[getter]
    fn reward_noise(&self) -> f64 {
        self.0.reward_noise()
    }

    /// The optimal action values Q*, by value iteration.
    ///
    /// Parameters
    /// ----------
    /// discount : float
    ///     γ, from 0 to below 1.
    /// tolerance : float, optional
    ///     How far the values may be off, as a share of the largest.
    /// control : Control, optional
    ///     To stop it from another thread.
    ///
    /// Returns
    /// -------
    /// values : numpy.ndarray of shape (states, actions)
    ///     Q*.
    /// error : float
    ///     No value is further off than this.
    #[pyo3(signature = (discount, *, tolerance = 1e-10, control = None))]
    fn q_star<'py>(
        &self,
        py: Python<'py>,
        discount: f64,
        tolerance: f64,
        control: Option<&Bound<'py, PyControl>>,
    ) -> Result<(Bound<'py, PyArrayDyn<f64>>, f64)> {
        let watch = Watch::new(control, None);
        let optimum =
            enter(py, &watch, |control| self.0.value_iteration(discount, tolerance, control))?;
        Ok((array(py, optimum.values, &[self.0.states(), self.0.actions()])?, optimum.error))
    }

    /// Begin a walk through the process.
    #[pyo3(signature = (state = 0, *, seed = 0))]
    fn walk(
        slf: Bound<'_, Self>,
        #[pyo3(from_py_with = whole)] state: usize,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<PyMdpWalk> {
        below("state", state, slf.get().0.states())?;
        Ok(PyMdpWalk { mdp: slf.unbind(), state, rng: Rng::new(seed, 0) })
    }

    fn __repr__(&self) -> String {
        let noise = self.0.reward_noise();
        format!("<MDP: {} states, {} actions, rewards ± {noise:?}>", self.states(), self.actions())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> Result<Bound<'py, PyTuple>> {
        let (py, own) = (slf.py(), slf.get());
        let keywords = PyDict::new(py);
        keywords.set_item("reward_noise", own.reward_noise())?;
        let arguments = (own.transitions(py)?, own.rewards(py)?).into_pyobject(py)?;
        Ok(rebuild(&slf.get_type(), arguments, &keywords)?)
    }
}

/// A walk through an MDP, which `MDP.walk` begins.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> walk = fz.MDP.gridworld().walk(1)
/// >>> walk.step(0), walk.state
/// ((10.0, 21), 21)
#[pyclass(name = "MDPWalk", module = "fuzzyrs")]
pub struct PyMdpWalk {
    mdp: Py<PyMdp>,
    state: usize,
    rng: Rng,
}

#[pymethods]
impl PyMdpWalk {
    /// Where the walk is.
    #[getter]
    fn state(&self) -> usize {
        self.state
    }

    /// Do an action; return the reward and the next state.
    fn step(&mut self, #[pyo3(from_py_with = whole)] action: usize) -> Result<(f64, usize)> {
        let mdp = &self.mdp.get().0;
        below("action", action, mdp.actions())?;
        let (reward, next) = mdp.step(self.state, action, &mut self.rng);
        self.state = next;
        Ok((reward, next))
    }
}

/// Let a learner learn on an MDP, and compare it with the optimum as it goes.
///
/// Parameters
/// ----------
/// mdp : MDP
///     What to learn.
/// learner : {"model_building", "q_lambda"}, optional
///     As `ModelBuildingQ` and `QLambda`.
/// discount, trace_decay : float, optional
///     γ, from 0 to below 1, and λ, in [0, 1].
/// counts : {"thesis", "exact"}, optional
///     Of model building.
/// trace : {"replacing", "replacing_state", "accumulating"}, optional
///     Of Q(λ).
/// cut : {"never", "watkins"}, optional
///     Of Q(λ).
/// learning_rate, learning_rate_decay : float, optional
///     α = learning_rate/iᵈᵉᶜᵃʸ.
/// per : {"visit", "step", "episode"}, optional
///     What i counts: visits of the pair, all steps, or episodes.
/// episode : int, optional
///     The steps of an episode; nothing else begins anew with it.
/// exploration, temperature, ties : optional
///     How to act, as `QLambda.choose` has it. By default any action, each equally likely; softmax
///     if a temperature is given.
/// first_values : (float, float), optional
///     The range that the first values are drawn from; by default they are 0.
/// checkpoints : sequence of int, optional
///     The steps after which the values are looked at, rising; the last is the end. By default
///     1000, 3000, 10 000 and 30 000.
/// seed : int, optional
///     The same seed gives the same numbers.
/// control : Control, optional
///     To stop it from another thread.
/// progress : callable, optional
///     Called now and then with the number of steps done.
///
/// Returns
/// -------
/// MDPTrial
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> mdp = fz.MDP.garnet(20, 3, 5, seed=0)
/// >>> trial = fz.learn_mdp(mdp, counts="exact", checkpoints=[1000, 10_000])
/// >>> bool(trial.errors[1] < 0.3 * trial.errors[0])
/// True
#[pyfunction]
#[pyo3(signature = (
    mdp, learner = "model_building", *, discount = 0.9, trace_decay = 0.9, counts = "thesis",
    trace = "replacing", cut = "never", learning_rate = 1.0, learning_rate_decay = 0.7,
    per = "visit", episode = 1000, exploration = None, temperature = None, ties = "first",
    first_values = None, checkpoints = None, seed = 0, control = None, progress = None,
))]
#[allow(clippy::too_many_arguments)]
pub fn learn_mdp(
    py: Python<'_>,
    mdp: &Bound<'_, PyMdp>,
    learner: &str,
    discount: f64,
    trace_decay: f64,
    counts: &str,
    trace: &str,
    cut: &str,
    learning_rate: f64,
    learning_rate_decay: f64,
    per: &str,
    #[pyo3(from_py_with = whole)] episode: u64,
    exploration: Option<f64>,
    temperature: Option<f64>,
    ties: &str,
    first_values: Option<(f64, f64)>,
    checkpoints: Option<Vec<Bound<'_, PyAny>>>,
    #[pyo3(from_py_with = whole)] seed: u64,
    control: Option<&Bound<'_, PyControl>>,
    progress: Option<Py<PyAny>>,
) -> Result<PyMdpTrial> {
    let (counts, trace, cut) =
        (Counts::from_name(counts)?, Trace::from_name(trace)?, Cut::from_name(cut)?);
    let free = Learner::QLambda { trace_decay, trace, cut };
    let learners =
        [("model_building", Learner::ModelBuilding { trace_decay, counts }), ("q_lambda", free)];
    let counted =
        [("visit", Per::Visit), ("step", Per::Step), ("episode", Per::Episode { steps: episode })];
    let checkpoints = match checkpoints {
        None => vec![1000, 3000, 10_000, 30_000],
        Some(steps) => steps.iter().map(whole).collect::<PyResult<_>>()?,
    };
    let anything = if temperature.is_some() { 0.0 } else { 1.0 };
    let settings = TrialSettings {
        learner: choice("learner", learner, learners)?,
        discount,
        learning_rate: Schedule::power("learning rate", learning_rate, learning_rate_decay)?,
        per: choice("count of the learning rate", per, counted)?,
        policy: policy(exploration.unwrap_or(anything), temperature, ties)?,
        first_values: first_values.unwrap_or_default(),
        checkpoints,
    };
    let process = &mdp.get().0;
    let watch = Watch::new(control, progress);
    let trial = enter(py, &watch, |control| Trial::run(process, &settings, seed, control))?;
    let shape = [process.states(), process.actions()];
    Ok(PyMdpTrial { trial, checkpoints: settings.checkpoints, shape })
}

/// What goes by a name.
fn choice<T: Copy, const N: usize>(
    kind: &'static str,
    name: &str,
    choices: [(&'static str, T); N],
) -> Result<T> {
    Ok(check::named(kind, name, choices, |(name, _)| name)?.1)
}

/// What came of a learner on an MDP.
#[pyclass(name = "MDPTrial", module = "fuzzyrs", frozen)]
pub struct PyMdpTrial {
    trial: Trial,
    checkpoints: Vec<u64>,
    shape: [usize; 2],
}

#[pymethods]
impl PyMdpTrial {
    /// The steps after which the values were looked at.
    #[getter]
    fn checkpoints(&self) -> Vec<u64> {
        self.checkpoints.clone()
    }

    /// The largest |Q - Q*| at each checkpoint; infinite once the values grew without bound.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.trial.errors)
    }

    /// The largest |Q| at each checkpoint; infinite once the values grew without bound.
    #[getter]
    fn largest<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.trial.largest)
    }

    /// M (1 + γ + … + γᵗ) at each checkpoint, with M the largest of the first values and of the
    /// rewards (of a model: mean rewards) used so far.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.trial.bounds)
    }

    /// The last values, shape (states, actions).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        array(py, self.trial.values.clone(), &self.shape)
    }

    /// Q*, shape (states, actions).
    #[getter]
    fn optimum<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        array(py, self.trial.optimum.values.clone(), &self.shape)
    }

    /// After how many steps a value was beyond the bound, for each reading of M: "used" as in
    /// `bounds`, "printed" without bars about the first values, "true_means" with the true mean
    /// rewards.
    #[getter]
    fn violations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.by_reading(py, ValueBound::violations)
    }

    /// The largest |Q| in terms of the bound of its time, over all steps, for each reading of M.
    #[getter]
    fn closest<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.by_reading(py, ValueBound::closest)
    }

    /// The step that would have taken values beyond what numbers hold, which ended the trial; or
    /// None.
    #[getter]
    fn diverged_at(&self) -> Option<u64> {
        self.trial.diverged_at
    }
}

impl PyMdpTrial {
    fn by_reading<'py, T: IntoPyObject<'py>>(
        &self,
        py: Python<'py>,
        number: impl Fn(&ValueBound) -> T,
    ) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (scale, bound) in Scale::ALL.into_iter().zip(&self.trial.watched) {
            dict.set_item(scale.name(), number(bound))?;
        }
        Ok(dict)
    }
}
