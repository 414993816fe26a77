//! Agents whose actor is a fuzzy system.

use std::path::PathBuf;

use fuzzy_core::format::{read, write_atomically};
use fuzzy_core::learn::rl::{Agent, NeuralActorCritic, Qlfis, TdSettings, Tune};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Inference, NoRuleFires, Rng, Tsk, check};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::{Driven, Rate, WEIGHTS, constant};
use crate::arrays::whole;
use crate::errors::{Error, Result};
use crate::tsk::PyTsk;

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

/// The thesis's fall to a tenth within 1000 episodes (7.16, 7.17).
fn annealed(scale: f64) -> Rate {
    Rate(Schedule::Linear { first: scale, last: 0.1 * scale, count: 1000 })
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
