//! QLFIS and its rivals: fuzzy controllers that learn from reward with a critic beside them, in
//! continuous observations and actions.
//!
//! The controller, the actor, is one fuzzy system for each number of the action. Exploration adds
//! noise to what it says, u_c = u + σₙn with n drawn from the standard normal distribution. When
//! the reward r and the next observation s' have come, the TD error
//!
//! Δ = r + γQ(s', u') − Q(s, u_c)
//!
//! says whether that was better than the critic's Q had expected (2.44). The critic follows it
//! along its eligibility traces, e ← γλe + ∂Q/∂φ and φ ← φ + ηΔe (2.49, 7.12); the actor moves
//! towards what was tried if it was better, and away if it was worse,
//! φ ← φ + ξΔ·(u_c − u)/σₙ·∂u/∂φ (7.14), or along traces of this product. u' is what the actor
//! says at s', without noise.
//!
//! | learner | critic | what is tuned | traces |
//! |---|---|---|---|
//! | [QLFIS](Qlfis) (Algorithm 7.3.1) | fuzzy | memberships and consequents | critic |
//! | [fuzzy actor-critic](TdSettings::fuzzy_actor_critic) (2.50–2.53) | fuzzy | consequents | both |
//! | [after Dai et al.](NeuralActorCritic) (section 7.3.1) | network | memberships and consequents | critic |

mod critic;
mod neural;
mod settings;
mod state;
mod steps;
#[cfg(test)]
mod tests;
mod tuned;

pub use critic::{Critic, FuzzyCritic};
pub use neural::NeuralCritic;
pub use settings::{TdSettings, Tune};
pub(crate) use state::{ActorCriticState, SavedCritic};

use self::steps::LARGEST;
use self::tuned::Tuned;
use super::Agent;
use crate::check;
use crate::error::{Error, Result};
use crate::inference::Tsk;
use crate::rng::Rng;

/// A fuzzy actor with a critic, learning by temporal differences; see [the module](self).
#[derive(Debug, Clone)]
pub struct TdActorCritic<C> {
    settings: TdSettings,
    actors: Vec<Actor>,
    critic: C,
    /// The number of the episode; 0 before the first.
    episode: u64,
    rates: Rates,
    /// Q(s, u_c) of the last action, unless that was learned from.
    value: Option<f64>,
    /// Where that action was taken, and the action.
    observation: Vec<f64>,
    action: Vec<f64>,
    next_action: Vec<f64>,
}

/// The fuzzy system of one number of the action.
#[derive(Debug, Clone)]
struct Actor {
    tuned: Tuned,
    /// (u_c − u)/σₙ of the last action, as it was drawn: nothing is divided by σₙ.
    noise: f64,
}

/// The rates of the present episode.
#[derive(Debug, Clone, Copy)]
struct Rates {
    critic: f64,
    actor: f64,
    noise: f64,
}

impl Rates {
    fn at(settings: &TdSettings, episode: u64) -> Self {
        Self {
            critic: settings.critic_rate.at(episode),
            actor: settings.actor_rate.at(episode),
            noise: settings.noise.at(episode),
        }
    }
}

/// A fuzzy actor with a fuzzy critic: QLFIS, or fuzzy actor-critic, as the settings have it.
///
/// ```
/// use fuzzy_core::learn::rl::{Agent, Qlfis, TdSettings};
/// use fuzzy_core::learn::schedule::Schedule;
/// use fuzzy_core::{Rng, Shape, Tsk, Variable};
///
/// // A cart at x that ought to be at 0; the reward is how much nearer it came.
/// let x = Variable::evenly("x", (-1.0, 1.0), Shape::GaussianWidth, &["N", "Z", "P"])?;
/// let actor = Tsk::zero_order("force", vec![x.clone()], vec![0.0; 3])?;
/// let critic = Tsk::zero_order("value", vec![x], vec![0.0; 3])?;
/// let settings = TdSettings {
///     actor_rate: Schedule::power("actor's rate", 0.1, 0.0)?,
///     noise: Schedule::power("noise", 0.2, 0.0)?,
///     ..TdSettings::qlfis()
/// };
/// let mut agent = Qlfis::fuzzy(&[actor], &critic, settings)?;
/// let (mut rng, mut action) = (Rng::new(1, 0), [0.0]);
/// for episode in 1..=200 {
///     agent.begin_episode(episode);
///     let mut x = rng.uniform_in(-1.0, 1.0);
///     for _ in 0..20 {
///         agent.act(&[x], &mut action, &mut rng);
///         let next = x + action[0];
///         agent.learn(x.abs() - next.abs(), &[next], true, &mut rng)?;
///         x = next;
///     }
/// }
/// let learned = &agent.actors()?[0];
/// assert!(learned.evaluate(&[0.8])? < -0.2);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
pub type Qlfis = TdActorCritic<FuzzyCritic>;

/// A fuzzy actor with a network as critic, after Dai et al.
pub type NeuralActorCritic = TdActorCritic<NeuralCritic>;

impl Qlfis {
    /// Learning that begins from these systems: one for each number of the action, and the
    /// critic. All read the same number of inputs, and none may refuse inputs outside their
    /// universes.
    pub fn fuzzy(actors: &[Tsk], critic: &Tsk, settings: TdSettings) -> Result<Self> {
        let critic = FuzzyCritic::new(critic, settings.tune, settings.narrowest)?;
        Self::with_critic(actors, critic, settings)
    }
}

impl NeuralActorCritic {
    /// Learning that begins from these systems, one for each number of the action, and a network
    /// with so many hidden units and random weights.
    pub fn neural(
        actors: &[Tsk],
        hidden: usize,
        settings: TdSettings,
        rng: &mut Rng,
    ) -> Result<Self> {
        let inputs = actors.first().map_or(0, |actor| actor.inputs().len());
        check::at_least("systems of the actor", actors.len(), 1)?;
        let critic = NeuralCritic::new(inputs, actors.len(), hidden, rng)?;
        Self::with_critic(actors, critic, settings)
    }
}

impl<C: Critic> TdActorCritic<C> {
    fn with_critic(actors: &[Tsk], critic: C, settings: TdSettings) -> Result<Self> {
        settings.check()?;
        check::at_least("systems of the actor", actors.len(), 1)?;
        for actor in actors {
            let what = format!("inputs of \"{}\", beside those of the critic", actor.name());
            check::same_length(&what, critic.inputs(), actor.inputs().len())?;
        }
        let actor = |system: &Tsk| {
            let tuned = Tuned::new(system, settings.tune, settings.narrowest)?;
            Ok(Actor { tuned, noise: 0.0 })
        };
        Ok(Self {
            actors: actors.iter().map(actor).collect::<Result<_>>()?,
            observation: vec![0.0; critic.inputs()],
            critic,
            episode: 0,
            rates: Rates::at(&settings, 1),
            value: None,
            action: vec![0.0; actors.len()],
            next_action: vec![0.0; actors.len()],
            settings,
        })
    }

    /// The settings.
    pub fn settings(&self) -> &TdSettings {
        &self.settings
    }

    /// The number of the present episode; 0 if none was begun.
    pub fn episode(&self) -> u64 {
        self.episode
    }

    /// The systems learned so far, one for each number of the action.
    pub fn actors(&self) -> Result<Vec<Tsk>> {
        self.actors.iter().map(|actor| actor.tuned.system()).collect()
    }

    /// The critic.
    pub fn critic(&self) -> &C {
        &self.critic
    }

    /// How often a step of learning would have led a parameter of a membership function out of
    /// its [bounds](crate::membership::ParameterKind::bounds), or vertices out of order, and was
    /// cut short.
    pub fn held(&self) -> u64 {
        self.critic.held() + self.actors.iter().map(|actor| actor.tuned.held()).sum::<u64>()
    }
}

impl<C: Critic> Agent for TdActorCritic<C> {
    fn inputs(&self) -> usize {
        self.critic.inputs()
    }

    fn outputs(&self) -> usize {
        self.actors.len()
    }

    fn begin_episode(&mut self, episode: u64) {
        self.episode = episode;
        self.rates = Rates::at(&self.settings, episode);
        self.value = None;
        self.critic.begin_episode();
        if self.settings.clear_traces {
            self.critic.clear_traces();
            self.actors.iter_mut().for_each(|actor| actor.tuned.clear_traces());
        }
    }

    #[inline]
    fn act(&mut self, observation: &[f64], action: &mut [f64], rng: &mut Rng) {
        for (actor, action) in self.actors.iter_mut().zip(&mut *action) {
            actor.noise = rng.normal();
            *action = actor.noise.mul_add(self.rates.noise, actor.tuned.differentiate(observation));
        }
        self.value = Some(self.critic.differentiate(observation, action));
        self.observation.copy_from_slice(observation);
        self.action.copy_from_slice(action);
    }

    #[inline]
    fn exploit(&mut self, observation: &[f64], action: &mut [f64]) {
        exploit(&mut self.actors, observation, action);
    }

    #[inline]
    fn learn(&mut self, reward: f64, next: &[f64], continues: bool, _: &mut Rng) -> Result<f64> {
        check::finite("reward", reward)?;
        let value = self.value.ok_or(Error::OutOfOrder(
            "there is no action to learn from: act (with exploration) comes before learn",
        ))?;
        let ahead = if continues {
            if C::USES_ACTION {
                exploit(&mut self.actors, next, &mut self.next_action);
            }
            self.critic.ahead(next, &self.next_action)
        } else {
            0.0
        };
        let TdSettings { discount, critic_trace_decay, actor_trace_decay, .. } = self.settings;
        let error = discount.mul_add(ahead, reward) - value;
        if error.is_nan() || error.abs() > LARGEST {
            return Err(diverged("the TD error")(error));
        }
        self.critic
            .propose(discount * critic_trace_decay, self.rates.critic * error)
            .map_err(diverged("a number of the critic"))?;
        for Actor { tuned, noise } in &mut self.actors {
            tuned
                .propose(discount * actor_trace_decay, *noise, self.rates.actor * error)
                .map_err(diverged("a number of the actor"))?;
        }
        self.critic.accept();
        self.actors.iter_mut().for_each(|actor| actor.tuned.accept());
        self.value = None;
        Ok(error)
    }
}

/// What the actor says.
#[inline]
fn exploit(actors: &mut [Actor], observation: &[f64], action: &mut [f64]) {
    for (actor, action) in actors.iter_mut().zip(action) {
        *action = actor.tuned.value(observation);
    }
}

fn diverged(what: &'static str) -> impl Fn(f64) -> Error {
    move |value| Error::LearningDiverged { what, value }
}
