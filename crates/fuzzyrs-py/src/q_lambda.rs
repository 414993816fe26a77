//! Q(λ)-learning on the user's own problem.

use fuzzy_core::learn::rl::{
    Cut, Discretiser, Policy, QLambda, QLambdaSettings, Ties, Trace, Visits,
};
use fuzzy_core::{Rng, check};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Floats, array, whole, whole_or_none};
use crate::errors::Result;

/// A regular grid that turns observations into the states of a table.
///
/// Parameters
/// ----------
/// axes : sequence of (float, float, int)
///     For each coordinate the ends and the number of points, 2 at least. Observations are held
///     within the ends and rounded to the nearest point.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> grid = fz.Discretiser([(-1, 1, 11), (-1, 1, 11)])
/// >>> grid.states, grid.state([0.0, 0.03])
/// (121, 60)
#[pyclass(name = "Discretiser", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyDiscretiser(pub Discretiser);

#[pymethods]
impl PyDiscretiser {
    #[new]
    fn new(axes: Vec<(f64, f64, Bound<'_, PyAny>)>) -> Result<Self> {
        let axes = axes
            .into_iter()
            .map(|(low, high, points)| Ok((low, high, whole(&points)?)))
            .collect::<PyResult<Vec<_>>>()?;
        Ok(Self(Discretiser::new(&axes)?))
    }

    /// The number of states.
    #[getter]
    fn states(&self) -> usize {
        self.0.states()
    }

    /// The state that an observation falls into.
    fn state(&self, observation: &Bound<'_, PyAny>) -> Result<usize> {
        let observation = Floats::new(observation, "observation")?;
        let numbers = observation.vector("observation")?;
        fuzzy_core::check::same_length("coordinates", self.0.coordinates(), numbers.len())?;
        fuzzy_core::check::all_finite("observation", numbers)?;
        Ok(self.0.state(numbers))
    }

    /// The observation in the middle of a state.
    fn centre<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] state: usize,
    ) -> Result<Bound<'py, PyArray1<f64>>> {
        below("state", state, self.0.states())?;
        Ok(PyArray1::from_vec(py, self.0.centre(state)))
    }

    fn __repr__(&self) -> String {
        format!("Discretiser({:?})", self.0.axes())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        (slf.get_type(), (slf.get().0.axes(),)).into_pyobject(slf.py())
    }
}

/// Tabular Q(λ)-learning: Q-learning with eligibility traces, for a problem of your own.
///
/// Parameters
/// ----------
/// states, actions : int
///     The size of the table.
/// discount, trace_decay : float, optional
///     γ and λ, both in [0, 1]; λ = 0 is one-step Q-learning.
/// trace : {"replacing_state", "replacing", "accumulating"}, optional
///     What a visit does to the trace of its pair: sets it to 1 and ends those of the state's
///     other actions; sets it to 1; or adds 1.
/// cut : {"never", "watkins"}, optional
///     Whether an action that is not greedy ends the traces before it (Watkins's Q(λ)).
/// first_value : float, optional
///     What all values begin at.
/// seed : int, optional
///     For the exploring choices.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> learner = fz.QLambda(2, 2, seed=1)
/// >>> for episode in range(50):
/// ...     action = learner.choose(0, exploration=0.3)
/// ...     _ = learner.learn(0, action, float(action == 1), None, learning_rate=0.1)
/// >>> learner.greedy_action(0)
/// 1
///
/// A learning rate that falls with the visits of each pair, and choices by softmax:
///
/// >>> action = learner.choose(0, temperature=0.5)
/// >>> rate = 1 / (1 + learner.visits(0, action)) ** 0.7
/// >>> _ = learner.learn(0, action, 1.0, 1, rate)
#[pyclass(name = "QLambda", module = "fuzzyrs")]
pub struct PyQLambda {
    learner: QLambda,
    visits: Visits,
    rng: Rng,
}

#[pymethods]
impl PyQLambda {
    #[new]
    #[pyo3(signature = (states, actions, *, discount = 0.5, trace_decay = 0.3,
                        trace = "replacing_state", cut = "never", first_value = 0.0, seed = 0))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        #[pyo3(from_py_with = whole)] states: usize,
        #[pyo3(from_py_with = whole)] actions: usize,
        discount: f64,
        trace_decay: f64,
        trace: &str,
        cut: &str,
        first_value: f64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let (trace, cut) = (Trace::from_name(trace)?, Cut::from_name(cut)?);
        let settings = QLambdaSettings { states, actions, discount, trace_decay, trace, cut };
        let learner = QLambda::new(settings)?;
        let first = check::filled("the first values", learner.values().len(), 1, first_value)?;
        let learner = learner.starting_from(&first)?;
        Ok(Self { learner, visits: Visits::new(states, actions)?, rng: Rng::new(seed, 0) })
    }

    /// An action for a state.
    ///
    /// Parameters
    /// ----------
    /// state : int
    ///     Where to act.
    /// exploration : float, optional
    ///     The probability of any action at random, in [0, 1]; otherwise it is greedy.
    /// temperature : float, optional
    ///     Choose by softmax with this temperature, above zero, instead.
    /// ties : {"first", "random"}, optional
    ///     Which of several largest values is greedy.
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

    /// How often an action was learned from in a state.
    fn visits(
        &self,
        #[pyo3(from_py_with = whole)] state: usize,
        #[pyo3(from_py_with = whole)] action: usize,
    ) -> Result<u64> {
        below("state", state, self.learner.settings().states)?;
        below("action", action, self.learner.settings().actions)?;
        Ok(self.visits.of(state, action))
    }

    /// Learn from one step, and return the TD error.
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
    #[pyo3(signature = (state, action, reward, next_state, learning_rate))]
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
        let error = self.learner.learn(state, action, reward, next_state, learning_rate)?;
        self.visits.visit(state, action);
        Ok(error)
    }

    /// End all eligibility traces, as one may wish to between episodes.
    fn clear_traces(&mut self) {
        self.learner.clear_traces();
    }

    /// The action of the largest value; the first of several.
    fn greedy_action(&self, #[pyo3(from_py_with = whole)] state: usize) -> Result<usize> {
        below("state", state, self.learner.settings().states)?;
        Ok(self.learner.greedy_action(state))
    }

    /// A copy of the table, shape (states, actions).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let settings = self.learner.settings();
        array(py, self.learner.values().to_vec(), &[settings.states, settings.actions])
    }
}

/// How to choose, from the arguments of `choose`.
pub fn policy(exploration: f64, temperature: Option<f64>, ties: &str) -> Result<Policy> {
    let ties = Ties::from_name(ties)?;
    match temperature {
        None => Ok(Policy::epsilon_greedy(exploration, ties)?),
        Some(temperature) if exploration == 0.0 => Ok(Policy::softmax(temperature)?),
        Some(_) => {
            let what = "temperature".to_owned();
            let reason = "softmax has no exploration rate; leave one of the two out".to_owned();
            Err(fuzzy_core::Error::Unsuitable { what, reason }.into())
        }
    }
}

/// Nothing, if a step is within a table of so many states and actions, and its reward finite.
pub fn check_step(
    (states, actions): (usize, usize),
    state: usize,
    action: usize,
    reward: f64,
    next_state: Option<usize>,
) -> Result<()> {
    below("state", state, states)?;
    below("action", action, actions)?;
    if let Some(next) = next_state {
        below("next_state", next, states)?;
    }
    fuzzy_core::check::finite("reward", reward)?;
    Ok(())
}

/// Nothing, if an index is within the table.
pub fn below(what: &str, index: usize, count: usize) -> Result<()> {
    if index < count {
        return Ok(());
    }
    Err(fuzzy_core::Error::OutOfRange {
        what: what.to_owned(),
        expected: format!("below {count}"),
        value: index as f64,
    }
    .into())
}
