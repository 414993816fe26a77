//! Learners that act, for the user's own environments.

use std::path::PathBuf;

use fuzzy_core::format::{read, write_atomically};
use fuzzy_core::learn::rl::{
    Agent, Cut, NeuralActorCritic, Qlfis, TableAgent, TableAgentSettings, TdSettings, Trace, Tune,
};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Inference, NoRuleFires, Rng, Tsk, check};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Floats, array, whole};
use crate::errors::{Error, Result};
use crate::q_lambda::PyDiscretiser;
use crate::schedule::schedule;
use crate::tsk::PyTsk;

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

/// [`agent!`] for those that have fuzzy systems as actor.
macro_rules! actor_critic {
    (
        $(#[$doc:meta])* $class:ident, $name:literal, $agent:ty { $($own:tt)* }
    ) => {
        agent! {
            $(#[$doc])* $class, $name, $agent {
                $($own)*

                /// The system learned so far; of several, an error.
                #[getter]
                fn actor(&self) -> Result<PyTsk> {
                    only(self.0.agent.actors()?)
                }

                /// The systems learned so far, one for each number of the action.
                #[getter]
                fn actors(&self) -> Result<Vec<PyTsk>> {
                    Ok(self.0.agent.actors()?.into_iter().map(PyTsk).collect())
                }

                /// How often a parameter of a membership function was kept from leaving its bounds.
                #[getter]
                fn held(&self) -> u64 {
                    self.0.agent.held()
                }
            }
        }
    };
}

actor_critic! {
    /// QLFIS: a fuzzy controller learns from reward with a fuzzy critic, in continuous
    /// observations and actions.
    ///
    /// The actor says u, and u plus noise is done. The critic estimates what is to be had; both
    /// move along the gradients of all their parameters, the critic with eligibility traces, after
    /// every step: Algorithm 7.3.1 of Desouky's thesis. Parameters of membership functions are held
    /// within the bounds of their kind (`held` counts how often), and a step that would diverge is
    /// a `DivergedError` that changes nothing.
    ///
    /// Parameters
    /// ----------
    /// actor : TSK or sequence of TSK
    ///     Where learning begins: one system for each number of the action. They must not refuse
    ///     inputs outside their universes; where no rule fires they say 0, unless they say otherwise.
    /// critic : TSK, optional
    ///     Where the critic begins; by default the actor's inputs with zeros as consequents.
    /// discount : float, optional
    ///     γ, in [0, 1].
    /// trace_decay : float, optional
    ///     λ of the critic, in [0, 1].
    /// actor_trace_decay : float, optional
    ///     λ of the actor, in [0, 1]; 0 in the thesis.
    /// critic_rate, actor_rate : float or Schedule, optional
    ///     Learning rates, in (0, 1]. By default the thesis's, which fall from 0.1 and 0.01 to a
    ///     tenth of that within 1000 episodes. A critic much faster than the actor is what keeps
    ///     learning stable.
    /// noise : float or Schedule, optional
    ///     The standard deviation of what is added to an action, in its unit; positive.
    /// tune : {"all", "consequents"}, optional
    ///     Which parameters of both systems learn.
    /// narrowest : float, optional
    ///     The least width of a membership function as a share of its universe.
    /// clear_traces : bool, optional
    ///     Whether traces end with their episode; in the thesis they don't.
    /// seed : int, optional
    ///     The same seed explores the same way.
    ///
    /// Examples
    /// --------
    /// A point is to go to 0; its reward is how much nearer it comes.
    ///
    /// >>> import fuzzyrs as fz, numpy as np
    /// >>> place = fz.Variable.evenly("place", (-1, 1), "NZP")
    /// >>> step = fz.TSK([place], [0, 0, 0], output="step")
    /// >>> agent = fz.QLFIS(step, actor_rate=0.1, noise=0.2, seed=1)
    /// >>> starts = np.random.default_rng(1).uniform(-1, 1, 200)
    /// >>> for x in starts:
    /// ...     agent.begin_episode()
    /// ...     for _ in range(20):
    /// ...         after = x + agent.act([x])[0]
    /// ...         _ = agent.learn(abs(x) - abs(after), [after])
    /// ...         x = after
    /// >>> bool(agent.actor(0.8) < -0.2)
    /// True
    PyQlfis, "QLFIS", Qlfis {
        #[new]
        #[pyo3(signature = (actor, critic = None, *, discount = 0.95, trace_decay = 0.9,
                            actor_trace_decay = 0.0, critic_rate = annealed(0.1),
                            actor_rate = annealed(0.01), noise = constant(0.08), tune = "all",
                            narrowest = 0.01, clear_traces = true, seed = 0))]
        #[allow(clippy::too_many_arguments)]
        fn new(
            actor: &Bound<'_, PyAny>,
            critic: Option<&Bound<'_, PyTsk>>,
            discount: f64,
            trace_decay: f64,
            actor_trace_decay: f64,
            critic_rate: Rate,
            actor_rate: Rate,
            noise: Rate,
            tune: &str,
            narrowest: f64,
            clear_traces: bool,
            #[pyo3(from_py_with = whole)] seed: u64,
        ) -> Result<Self> {
            let settings = TdSettings {
                discount,
                critic_trace_decay: trace_decay,
                actor_trace_decay,
                critic_rate: critic_rate.0,
                actor_rate: actor_rate.0,
                noise: noise.0,
                tune: Tune::from_name(tune)?,
                narrowest,
                clear_traces,
            };
            Ok(Self(fuzzy(actor, critic, settings, seed)?))
        }

        /// The critic learned so far: what is to be had from an observation on.
        #[getter]
        fn critic(&self) -> Result<PyTsk> {
            Ok(PyTsk(self.0.agent.critic().system()?))
        }
    }
}

actor_critic! {
    /// Fuzzy actor-critic: as `QLFIS`, but consequents alone are tuned, and both actor and critic
    /// have eligibility traces.
    ///
    /// Both systems are then linear in what is learned, each rule's feature being its share of the
    /// firing strength: equations 2.50-2.53 of Desouky's thesis carried over to continuous
    /// observations.
    ///
    /// Parameters
    /// ----------
    /// actor, critic, discount, trace_decay, critic_rate, actor_rate, noise, clear_traces, seed
    ///     As for `QLFIS`.
    /// actor_trace_decay : float, optional
    ///     λ of the actor, in [0, 1].
    ///
    /// Examples
    /// --------
    /// >>> import fuzzyrs as fz
    /// >>> place = fz.Variable.evenly("place", (-1, 1), "NZP")
    /// >>> agent = fz.FuzzyActorCritic(fz.TSK([place], [0, 0, 0]), seed=1)
    /// >>> step = agent.act([0.3])
    /// >>> agent.learn(1.0, [0.2])
    /// 1.0
    PyFuzzyActorCritic, "FuzzyActorCritic", Qlfis {
        #[new]
        #[pyo3(signature = (actor, critic = None, *, discount = 0.95, trace_decay = 0.9,
                            actor_trace_decay = 0.9, critic_rate = annealed(0.1),
                            actor_rate = annealed(0.01), noise = constant(0.08),
                            clear_traces = true, seed = 0))]
        #[allow(clippy::too_many_arguments)]
        fn new(
            actor: &Bound<'_, PyAny>,
            critic: Option<&Bound<'_, PyTsk>>,
            discount: f64,
            trace_decay: f64,
            actor_trace_decay: f64,
            critic_rate: Rate,
            actor_rate: Rate,
            noise: Rate,
            clear_traces: bool,
            #[pyo3(from_py_with = whole)] seed: u64,
        ) -> Result<Self> {
            let settings = TdSettings {
                discount,
                critic_trace_decay: trace_decay,
                actor_trace_decay,
                critic_rate: critic_rate.0,
                actor_rate: actor_rate.0,
                noise: noise.0,
                clear_traces,
                ..TdSettings::fuzzy_actor_critic()
            };
            Ok(Self(fuzzy(actor, critic, settings, seed)?))
        }

        /// The critic learned so far: what is to be had from an observation on.
        #[getter]
        fn critic(&self) -> Result<PyTsk> {
            Ok(PyTsk(self.0.agent.critic().system()?))
        }
    }
}

actor_critic! {
    /// A fuzzy controller that learns from reward with a neural network as critic, after Dai et
    /// al. as section 7.3.1 of Desouky's thesis compares it.
    ///
    /// The network has one hidden layer of tanh and a linear output. Its inputs are the
    /// observation and the action, both as they were one step before, and 1.
    ///
    /// Parameters
    /// ----------
    /// actor, discount, trace_decay, actor_trace_decay, actor_rate, tune, narrowest, clear_traces
    ///     As for `QLFIS`.
    /// hidden : int, optional
    ///     Hidden units.
    /// critic_rate : float or Schedule, optional
    ///     By default a tenth of `QLFIS`'s, with which the network diverges.
    /// noise : float or Schedule, optional
    ///     By default 0.1/i in episode i.
    /// seed : int, optional
    ///     For the first weights and the exploration.
    ///
    /// Examples
    /// --------
    /// >>> import fuzzyrs as fz
    /// >>> inputs = [fz.Variable.evenly(name, (-1, 1), "NZP") for name in ["angle", "rate"]]
    /// >>> agent = fz.NeuralActorCritic(fz.TSK(inputs, [0] * 9), seed=1)
    /// >>> agent.weights.shape
    /// (190,)
    PyNeuralActorCritic, "NeuralActorCritic", NeuralActorCritic {
        #[new]
        #[pyo3(signature = (actor, *, hidden = 21, discount = 0.95, trace_decay = 0.9,
                            actor_trace_decay = 0.0, critic_rate = annealed(0.01),
                            actor_rate = annealed(0.01), noise = falling(0.1), tune = "all",
                            narrowest = 0.01, clear_traces = true, seed = 0))]
        #[allow(clippy::too_many_arguments)]
        fn new(
            actor: &Bound<'_, PyAny>,
            #[pyo3(from_py_with = whole)] hidden: usize,
            discount: f64,
            trace_decay: f64,
            actor_trace_decay: f64,
            critic_rate: Rate,
            actor_rate: Rate,
            noise: Rate,
            tune: &str,
            narrowest: f64,
            clear_traces: bool,
            #[pyo3(from_py_with = whole)] seed: u64,
        ) -> Result<Self> {
            let settings = TdSettings {
                discount,
                critic_trace_decay: trace_decay,
                actor_trace_decay,
                critic_rate: critic_rate.0,
                actor_rate: actor_rate.0,
                noise: noise.0,
                tune: Tune::from_name(tune)?,
                narrowest,
                clear_traces,
            };
            let mut weights = Rng::new(seed, WEIGHTS);
            let agent =
                NeuralActorCritic::neural(&systems(actor)?, hidden, settings, &mut weights)?;
            Ok(Self(Driven::new(agent, seed)))
        }

        /// The critic's weights: input by input those to the hidden units, then these units'
        /// constants, their weights in the output, and its constant.
        #[getter]
        fn weights<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
            PyArray1::from_slice(py, self.0.agent.critic().weights())
        }
    }
}

agent! {
    /// Q(λ) for continuous observations: a grid of states and a list of actions.
    ///
    /// `QLambda` with a `Discretiser` in front, chosen from ε-greedily (Algorithm 6.4.1 of
    /// Desouky's thesis).
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
    /// exploration : float or Schedule, optional
    ///     ε, in [0, 1].
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
                            learning_rate = constant(0.2),
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

/// A schedule or a number, as an argument.
struct Rate(Schedule);

impl<'a, 'py> FromPyObject<'a, 'py> for Rate {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        schedule(&object).map(Rate)
    }
}

/// The thesis's fall to a tenth within 1000 episodes (7.16, 7.17).
fn annealed(scale: f64) -> Rate {
    Rate(Schedule::Linear { first: scale, last: 0.1 * scale, count: 1000 })
}

fn constant(scale: f64) -> Rate {
    Rate(Schedule::Power { scale, power: 0.0 })
}

/// scale/i in episode i.
fn falling(scale: f64) -> Rate {
    Rate(Schedule::Power { scale, power: 1.0 })
}

/// The actor's systems, of which there may be one.
fn systems(actor: &Bound<'_, PyAny>) -> Result<Vec<Tsk>> {
    if let Ok(system) = actor.cast::<PyTsk>() {
        return Ok(vec![system.get().0.clone()]);
    }
    let wrong = || {
        let came = actor.get_type().name().map_or_else(|_| "?".to_owned(), |n| n.to_string());
        Error::WrongType(format!("actor must be a TSK or a sequence of them, got {came}"))
    };
    let mut systems = Vec::new();
    for system in actor.try_iter().map_err(|_| wrong())? {
        systems.push(system?.cast::<PyTsk>().map_err(|_| wrong())?.get().0.clone());
    }
    Ok(systems)
}

/// An agent with a fuzzy critic, by default one that knows nothing.
fn fuzzy(
    actor: &Bound<'_, PyAny>,
    critic: Option<&Bound<'_, PyTsk>>,
    settings: TdSettings,
    seed: u64,
) -> Result<Driven<Qlfis>> {
    let actors = systems(actor)?;
    let critic = match (critic, actors.first()) {
        (Some(critic), _) => critic.get().0.clone(),
        (None, Some(actor)) => {
            let zeros = vec![0.0; actor.consequents().len()];
            Tsk::new("value", actor.inputs().to_vec(), actor.order(), zeros)?
                .with_output("value")?
                .when_no_rule_fires(NoRuleFires::Value(0.0))?
                .with_outside(actor.interface().outside())
        }
        (None, None) => {
            return Err(
                fuzzy_core::Error::wrong_shape("systems of the actor", "1 at least", 0).into()
            );
        }
    };
    Ok(Driven::new(Qlfis::fuzzy(&actors, &critic, settings)?, seed))
}

/// The one system, if there is one.
fn only(systems: Vec<Tsk>) -> Result<PyTsk> {
    let count = systems.len();
    match <[Tsk; 1]>::try_from(systems) {
        Ok([system]) => Ok(PyTsk(system)),
        Err(_) => {
            Err(fuzzy_core::Error::wrong_shape("systems of the actor (see actors)", 1, count)
                .into())
        }
    }
}
