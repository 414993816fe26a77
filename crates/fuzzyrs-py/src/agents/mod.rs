//! Learners that act, for the user's own environments.

use fuzzy_core::learn::rl::Agent;
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Rng, check};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays::Floats;
use crate::errors::Result;
use crate::schedule::schedule;

/// Draws of an agent's first weights, and of its exploration.
const WEIGHTS: u64 = 0;
const EXPLORATION: u64 = 1;

/// An agent and the random numbers it explores by.
pub struct Driven<A> {
    pub agent: A,
    pub rng: Rng,
}

impl<A: Agent> Driven<A> {
    fn new(agent: A, seed: u64) -> Self {
        Self { agent, rng: Rng::new(seed, EXPLORATION) }
    }

    fn act<'py>(
        &mut self,
        py: Python<'py>,
        observation: &Bound<'py, PyAny>,
        explore: bool,
    ) -> Result<Bound<'py, PyArray1<f64>>> {
        let observation = Floats::new(observation, "observation")?;
        let observation = self.checked(&observation, "observation")?;
        let mut action = vec![0.0; self.agent.outputs()];
        if explore {
            self.agent.act(observation, &mut action, &mut self.rng);
        } else {
            self.agent.exploit(observation, &mut action);
        }
        Ok(PyArray1::from_vec(py, action))
    }

    fn learn(
        &mut self,
        reward: f64,
        next_observation: &Bound<'_, PyAny>,
        terminated: bool,
    ) -> Result<f64> {
        let next = Floats::new(next_observation, "next observation")?;
        let next = self.checked(&next, "next observation")?;
        check::finite("reward", reward)?;
        Ok(self.agent.learn(reward, next, !terminated, &mut self.rng)?)
    }

    fn checked<'a>(&self, observation: &'a Floats<'_>, what: &str) -> Result<&'a [f64]> {
        let numbers = observation.vector(what)?;
        check::same_length(&format!("numbers of the {what}"), self.agent.inputs(), numbers.len())?;
        check::all_finite(what, numbers)?;
        Ok(numbers)
    }
}

/// Defines the Python class of an agent: what all have in common, and its own methods.
macro_rules! agent {
    (
        $(#[$doc:meta])* $class:ident, $name:literal, $agent:ty { $($own:tt)* }
    ) => {
        $(#[$doc])*
        #[pyclass(name = $name, module = "fuzzyrs")]
        pub struct $class(pub Driven<$agent>);

        #[pymethods]
        impl $class {
            $($own)*

            /// How many numbers an observation has.
            #[getter]
            fn inputs(&self) -> usize {
                self.0.agent.inputs()
            }

            /// How many numbers an action has.
            #[getter]
            fn outputs(&self) -> usize {
                self.0.agent.outputs()
            }

            /// The number of the present episode; 0 if none was begun.
            #[getter]
            fn episode(&self) -> u64 {
                self.0.agent.episode()
            }

            /// Begin an episode, on whose number the rates depend.
            ///
            /// Parameters
            /// ----------
            /// episode : int, optional
            ///     Its number, from 1 on; by default the next.
            #[pyo3(signature = (episode = None))]
            fn begin_episode(&mut self, episode: Option<&Bound<'_, PyAny>>) -> Result<()> {
                let episode = match episode {
                    Some(episode) => whole(episode)?,
                    None => self.0.agent.episode().saturating_add(1),
                };
                check::within("episode", episode as f64, "at least 1", |_| episode > 0)?;
                self.0.agent.begin_episode(episode);
                Ok(())
            }

            /// The action at an observation.
            ///
            /// Parameters
            /// ----------
            /// observation : array_like of shape (inputs,)
            ///     What is seen.
            /// explore : bool, optional
            ///     Whether the action explores, and is to be learned from.
            ///
            /// Returns
            /// -------
            /// numpy.ndarray of shape (outputs,)
            #[pyo3(signature = (observation, explore = true))]
            fn act<'py>(
                &mut self,
                py: Python<'py>,
                observation: &Bound<'py, PyAny>,
                explore: bool,
            ) -> Result<Bound<'py, PyArray1<f64>>> {
                self.0.act(py, observation, explore)
            }

            /// Learn from what came of the last action that explored.
            ///
            /// An error leaves everything as it was.
            ///
            /// Parameters
            /// ----------
            /// reward : float
            ///     The reward of the action.
            /// next_observation : array_like of shape (inputs,)
            ///     What is seen then.
            /// terminated : bool, optional
            ///     Whether nothing more is to be had. Not when a time limit cuts the episode off.
            ///
            /// Returns
            /// -------
            /// float
            ///     The TD error.
            #[pyo3(signature = (reward, next_observation, terminated = false))]
            fn learn(
                &mut self,
                reward: f64,
                next_observation: &Bound<'_, PyAny>,
                terminated: bool,
            ) -> Result<f64> {
                self.0.learn(reward, next_observation, terminated)
            }

            /// The whole state of learning as a JSON document, from which it continues with the
            /// same numbers.
            fn to_json(&self) -> Result<String> {
                Ok(self.0.agent.to_json(&self.0.rng)?)
            }

            /// The agent whose state a JSON document holds.
            #[staticmethod]
            fn from_json(text: &str) -> Result<Self> {
                let (agent, rng) = <$agent>::from_json(text)?;
                Ok(Self(Driven { agent, rng }))
            }

            /// Write the state of learning to a JSON file: the old file stays until the new one
            /// is complete.
            fn save(&self, path: PathBuf) -> Result<()> {
                Ok(write_atomically(&path, &self.to_json()?)?)
            }

            /// Read an agent from a file that `save` wrote.
            #[staticmethod]
            fn load(path: PathBuf) -> Result<Self> {
                Self::from_json(&read(&path)?)
            }

            fn __repr__(&self) -> String {
                let agent = &self.0.agent;
                format!(
                    "<{}: {} inputs, {} outputs, episode {}>",
                    $name, agent.inputs(), agent.outputs(), agent.episode()
                )
            }

            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
                let text = slf.borrow().to_json()?;
                (slf.get_type().getattr("from_json")?, (text,)).into_pyobject(slf.py())
            }
        }
    };
}

/// A schedule or a number, as an argument.
struct Rate(Schedule);

impl<'a, 'py> FromPyObject<'a, 'py> for Rate {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        schedule(&object).map(Rate)
    }
}

fn constant(scale: f64) -> Rate {
    Rate(Schedule::Power { scale, power: 0.0 })
}

mod actor_critics;
mod table;

pub use actor_critics::{PyFuzzyActorCritic, PyNeuralActorCritic, PyQlfis};
pub use table::PyQLambdaAgent;
