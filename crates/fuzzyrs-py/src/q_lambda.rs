//! Q(λ)-learning on the user's own problem.

use fuzzy_core::Rng;
use fuzzy_core::learn::rl::{Cut, Discretiser, QLambda, QLambdaSettings, Trace};
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

/// Tabular Q(λ)-learning with replacing traces and ε-greedy choices.
///
/// Parameters
/// ----------
/// states, actions : int
///     The size of the table.
/// discount, trace_decay : float, optional
///     γ and λ, both in [0, 1].
/// trace : {"replacing_state", "replacing"}, optional
///     Whether a visit also ends the traces of the state's other actions.
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
#[pyclass(name = "QLambda", module = "fuzzyrs")]
pub struct PyQLambda {
    learner: QLambda,
    rng: Rng,
}

#[pymethods]
impl PyQLambda {
    #[new]
    #[pyo3(signature = (states, actions, *, discount = 0.5, trace_decay = 0.3,
                        trace = "replacing_state", seed = 0))]
    fn new(
        #[pyo3(from_py_with = whole)] states: usize,
        #[pyo3(from_py_with = whole)] actions: usize,
        discount: f64,
        trace_decay: f64,
        trace: &str,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let trace = Trace::from_name(trace)?;
        let settings =
            QLambdaSettings { states, actions, discount, trace_decay, trace, cut: Cut::Never };
        Ok(Self { learner: QLambda::new(settings)?, rng: Rng::new(seed, 0) })
    }

    /// An action: with probability `exploration` any, otherwise the one of the largest value.
    #[pyo3(signature = (state, exploration = 0.0))]
    fn choose(
        &mut self,
        #[pyo3(from_py_with = whole)] state: usize,
        exploration: f64,
    ) -> Result<usize> {
        below("state", state, self.learner.settings().states)?;
        fuzzy_core::check::fraction("exploration rate", exploration)?;
        Ok(self.learner.choose(state, exploration, &mut self.rng))
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
        below("state", state, settings.states)?;
        below("action", action, settings.actions)?;
        if let Some(next) = next_state {
            below("next_state", next, settings.states)?;
        }
        fuzzy_core::check::finite("reward", reward)?;
        fuzzy_core::check::fraction("learning rate", learning_rate)?;
        Ok(self.learner.learn(state, action, reward, next_state, learning_rate)?)
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

/// Nothing, if an index is within the table.
fn below(what: &str, index: usize, count: usize) -> Result<()> {
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
