//! Agents whose values stand in a table.

use std::path::PathBuf;

use fuzzy_core::check;
use fuzzy_core::format::{read, write_atomically};
use fuzzy_core::learn::rl::{Agent, Cut, Exploring, TableAgent, TableAgentSettings, Trace};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::{Driven, Rate, constant};
use crate::arrays::{Floats, array, whole};
use crate::errors::Result;
use crate::q_lambda::PyDiscretiser;

agent! {
    /// Q(λ) for continuous observations: a grid of states and a list of actions.
    ///
    /// `QLambda` with a `Discretiser` in front, chosen from ε-greedily (Algorithm 6.4.1 of
    /// Desouky's thesis) or by softmax (2.56).
    ///
    /// Parameters
    /// ----------
    /// states : Discretiser
    ///     The states.
    /// actions : array_like of shape (actions,) or (actions, outputs)
    ///     The actions, two at least.
    /// discount, trace_decay : float, optional
    ///     γ and λ, in [0, 1].
    /// trace, cut : str, optional
    ///     What a visit does to the traces, and when they end, as for `QLambda`.
    /// learning_rate : float or Schedule, optional
    ///     α, in (0, 1].
    /// exploring : {"epsilon-greedy", "softmax"}, optional
    ///     How actions are explored.
    /// exploration : float or Schedule, optional
    ///     ε, in [0, 1], or the temperature of softmax, above zero.
    /// seed : int, optional
    ///     The same seed explores the same way.
    ///
    /// Examples
    /// --------
    /// >>> import fuzzyrs as fz
    /// >>> agent = fz.QLambdaAgent(fz.Discretiser([(-1, 1, 5)]), [-0.5, 0.0, 0.5], seed=1)
    /// >>> for episode in range(100):
    /// ...     agent.begin_episode()
    /// ...     x = 1.0
    /// ...     for _ in range(10):
    /// ...         x = min(max(x + agent.act([x])[0], -1), 1)
    /// ...         _ = agent.learn(-abs(x), [x])
    /// >>> float(agent.act([1.0], explore=False)[0])
    /// -0.5
    PyQLambdaAgent, "QLambdaAgent", TableAgent {
        #[new]
        #[pyo3(signature = (states, actions, *, discount = 0.95, trace_decay = 0.7,
                            trace = "replacing_state", cut = "never",
                            learning_rate = constant(0.2), exploring = "epsilon-greedy",
                            exploration = constant(0.1), seed = 0))]
        #[allow(clippy::too_many_arguments)]
        fn new(
            states: &Bound<'_, PyDiscretiser>,
            actions: &Bound<'_, PyAny>,
            discount: f64,
            trace_decay: f64,
            trace: &str,
            cut: &str,
            learning_rate: Rate,
            exploring: &str,
            exploration: Rate,
            #[pyo3(from_py_with = whole)] seed: u64,
        ) -> Result<Self> {
            let actions = Floats::new(actions, "actions")?;
            let outputs = match *actions.shape() {
                [_, outputs] => outputs.max(1),
                _ => {
                    actions.vector("actions")?;
                    1
                }
            };
            let agent = TableAgent::new(TableAgentSettings {
                states: states.get().0.clone(),
                actions: actions.as_slice()?.chunks(outputs).map(<[f64]>::to_vec).collect(),
                discount,
                trace_decay,
                trace: Trace::from_name(trace)?,
                cut: Cut::from_name(cut)?,
                learning_rate: learning_rate.0,
                exploring: Exploring::from_name(exploring)?,
                exploration: exploration.0,
            })?;
            Ok(Self(Driven::new(agent, seed)))
        }

        /// The grid.
        #[getter]
        fn states(&self) -> PyDiscretiser {
            PyDiscretiser(self.0.agent.settings().states.clone())
        }

        /// The actions, shape (actions, outputs).
        #[getter]
        fn actions<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
            let actions = &self.0.agent.settings().actions;
            array(py, actions.concat(), &[actions.len(), self.0.agent.outputs()])
        }

        /// A copy of the table, shape (states, actions).
        #[getter]
        fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
            let learner = self.0.agent.learner();
            let shape = [learner.settings().states, learner.settings().actions];
            array(py, learner.values().to_vec(), &shape)
        }

        /// The greedy action of every state, shape (states, outputs).
        #[getter]
        fn greedy_actions<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
            let actions = self.0.agent.greedy_actions();
            let shape = [actions.len(), self.0.agent.outputs()];
            array(py, actions.concat(), &shape)
        }
    }
}
