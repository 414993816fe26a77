//! Learners on tables besides Q(λ).

use fuzzy_core::learn::rl::{
    ActorCritic, ActorCriticSettings, Counts, ModelBuilding, ModelBuildingSettings,
};
use fuzzy_core::{Rng, check};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use crate::arrays::{array, whole, whole_or_none};
use crate::errors::Result;
use crate::q_lambda::{below, check_step, policy};

/// Tabular actor-critic with replacing traces on the critic and a softmax actor.
///
/// Parameters
/// ----------
/// states, actions : int
///     The size of the table.
/// discount, trace_decay : float, optional
///     γ and λ, both in [0, 1].
/// temperature : float, optional
///     Of the softmax over the preferences, above zero.
/// seed : int, optional
///     For the choices.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> learner = fz.ActorCritic(1, 2, seed=0)
/// >>> for _ in range(500):
/// ...     action = learner.choose(0)
/// ...     _ = learner.learn(0, action, float(action), None, critic_rate=0.1, actor_rate=0.2)
/// >>> bool(learner.probabilities(0)[1] > 0.9)
/// True
#[pyclass(name = "ActorCritic", module = "fuzzyrs")]
pub struct PyActorCritic {
    learner: ActorCritic,
    rng: Rng,
}

#[pymethods]
impl PyActorCritic {
    #[new]
    #[pyo3(signature = (states, actions, *, discount = 0.9, trace_decay = 0.9, temperature = 1.0,
                        seed = 0))]
    fn new(
        #[pyo3(from_py_with = whole)] states: usize,
        #[pyo3(from_py_with = whole)] actions: usize,
        discount: f64,
        trace_decay: f64,
        temperature: f64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let settings = ActorCriticSettings { states, actions, discount, trace_decay, temperature };
        Ok(Self { learner: ActorCritic::new(settings)?, rng: Rng::new(seed, 0) })
    }

    /// An action of the actor.
    fn choose(&mut self, #[pyo3(from_py_with = whole)] state: usize) -> Result<usize> {
        below("state", state, self.learner.settings().states)?;
        Ok(self.learner.choose(state, &mut self.rng))
    }

    /// The probability of each action in a state, shape (actions,).
    fn probabilities<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] state: usize,
    ) -> Result<Bound<'py, PyArray1<f64>>> {
        below("state", state, self.learner.settings().states)?;
        Ok(PyArray1::from_vec(py, self.learner.probabilities(state)))
    }

    /// Learn from one step, and return the TD error of the state's value.
    ///
    /// Parameters
    /// ----------
    /// state, action : int
    ///     What was done.
    /// reward : float
    ///     What came of it.
    /// next_state : int or None
    ///     Where it led; None if the episode ended there.
    /// critic_rate, actor_rate : float
    ///     The learning rates of values and preferences, in [0, 1].
    #[allow(clippy::too_many_arguments)]
    fn learn(
        &mut self,
        #[pyo3(from_py_with = whole)] state: usize,
        #[pyo3(from_py_with = whole)] action: usize,
        reward: f64,
        #[pyo3(from_py_with = whole_or_none)] next_state: Option<usize>,
        critic_rate: f64,
        actor_rate: f64,
    ) -> Result<f64> {
        let settings = self.learner.settings();
        check_step((settings.states, settings.actions), state, action, reward, next_state)?;
        fuzzy_core::check::fraction("learning rate of the critic", critic_rate)?;
        fuzzy_core::check::fraction("learning rate of the actor", actor_rate)?;
        Ok(self.learner.learn(state, action, reward, next_state, critic_rate, actor_rate)?)
    }

    /// End all eligibility traces, as one may wish to between episodes.
    fn clear_traces(&mut self) {
        self.learner.clear_traces();
    }

    /// A copy of the critic's values V(s), shape (states,).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.learner.values())
    }

    /// A copy of the actor's preferences, shape (states, actions).
    #[getter]
    fn preferences<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let settings = self.learner.settings();
        array(py, self.learner.preferences().to_vec(), &[settings.states, settings.actions])
    }
}

/// Q-learning that builds a model of the problem as it goes, with replacing traces (chapter 5).
///
/// Each step draws every pair visited lately towards what its own model, the mean of the rewards
/// seen and how often each state followed, says it should be.
///
/// Parameters
/// ----------
/// states, actions : int
///     The size of the table; memory goes with states² × actions.
/// discount, trace_decay : float, optional
///     γ and λ, both in [0, 1].
/// counts : {"thesis", "exact"}, optional
///     As printed, where probabilities of pairs visited n times sum to n/(n + 1) and pairs never
///     visited are drawn towards zero; or relative frequencies.
/// first_value : float, optional
///     What all values begin at.
/// seed : int, optional
///     For the exploring choices.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> learner = fz.ModelBuildingQ(2, 1, discount=0.5, counts="exact")
/// >>> for _ in range(100):
/// ...     _ = learner.learn(0, 0, 1.0, 1, learning_rate=0.5)
/// ...     _ = learner.learn(1, 0, 0.0, 0, learning_rate=0.5)
/// >>> learner.values.round(3).tolist()
/// [[1.333], [0.667]]
#[pyclass(name = "ModelBuildingQ", module = "fuzzyrs")]
pub struct PyModelBuilding {
    learner: ModelBuilding,
    rng: Rng,
}

#[pymethods]
impl PyModelBuilding {
    #[new]
    #[pyo3(signature = (states, actions, *, discount = 0.9, trace_decay = 0.9, counts = "thesis",
                        first_value = 0.0, seed = 0))]
    fn new(
        #[pyo3(from_py_with = whole)] states: usize,
        #[pyo3(from_py_with = whole)] actions: usize,
        discount: f64,
        trace_decay: f64,
        counts: &str,
        first_value: f64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let counts = Counts::from_name(counts)?;
        let settings = ModelBuildingSettings { states, actions, discount, trace_decay, counts };
        let learner = ModelBuilding::new(settings)?;
        let first = check::filled("the first values", learner.values().len(), 1, first_value)?;
        Ok(Self { learner: learner.starting_from(&first)?, rng: Rng::new(seed, 0) })
    }

    /// An action for a state, as `QLambda.choose` chooses.
    #[pyo3(signature = (state, exploration = 0.0, *, temperature = None, ties = "first"))]
    fn choose(
        &mut self,
        #[pyo3(from_py_with = whole)] state: usize,
        exploration: f64,
        temperature: Option<f64>,
        ties: &str,
    ) -> Result<usize> {
        below("state", state, self.learner.settings().states)?;
        let policy = policy(exploration, temperature, ties)?;
        Ok(policy.choose(self.learner.action_values(state), &mut self.rng))
    }

    /// Learn from one step, and return by how much the pair's value missed what its model says.
    ///
    /// Parameters
    /// ----------
    /// state, action : int
    ///     What was done.
    /// reward : float
    ///     What came of it.
    /// next_state : int or None
    ///     Where it led; None if the episode ended there.
    /// learning_rate : float
    ///     α, in [0, 1].
    fn learn(
        &mut self,
        #[pyo3(from_py_with = whole)] state: usize,
        #[pyo3(from_py_with = whole)] action: usize,
        reward: f64,
        #[pyo3(from_py_with = whole_or_none)] next_state: Option<usize>,
        learning_rate: f64,
    ) -> Result<f64> {
        let settings = self.learner.settings();
        check_step((settings.states, settings.actions), state, action, reward, next_state)?;
        fuzzy_core::check::fraction("learning rate", learning_rate)?;
        Ok(self.learner.learn(state, action, reward, next_state, learning_rate)?)
    }

    /// The action of the largest value; the first of several.
    fn greedy_action(&self, #[pyo3(from_py_with = whole)] state: usize) -> Result<usize> {
        below("state", state, self.learner.settings().states)?;
        Ok(self.learner.greedy_action(state))
    }

    /// How often an action was learned from in a state.
    fn visits(
        &self,
        #[pyo3(from_py_with = whole)] state: usize,
        #[pyo3(from_py_with = whole)] action: usize,
    ) -> Result<u64> {
        below("state", state, self.learner.settings().states)?;
        below("action", action, self.learner.settings().actions)?;
        Ok(self.learner.visits().of(state, action))
    }

    /// The probability of each next state by the model, as a step uses it for a pair that is not
    /// the current one, shape (states,).
    fn transitions<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] state: usize,
        #[pyo3(from_py_with = whole)] action: usize,
    ) -> Result<Bound<'py, PyArray1<f64>>> {
        below("state", state, self.learner.settings().states)?;
        below("action", action, self.learner.settings().actions)?;
        Ok(PyArray1::from_vec(py, self.learner.transitions(state, action)))
    }

    /// A copy of the table Q(s, a), shape (states, actions).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let settings = self.learner.settings();
        array(py, self.learner.values().to_vec(), &[settings.states, settings.actions])
    }

    /// A copy of the mean rewards seen, shape (states, actions); 0 where there was none.
    #[getter]
    fn mean_rewards<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let settings = self.learner.settings();
        array(py, self.learner.mean_rewards().to_vec(), &[settings.states, settings.actions])
    }
}
