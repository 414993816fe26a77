//! Where an actor-critic learner stands, so that it can be continued elsewhere.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::critic::{Critic, FuzzyCritic};
use super::neural::{NetworkState, NeuralCritic};
use super::settings::TdSettings;
use super::tuned::{Tuned, TunedState};
use super::{Actor, Rates, TdActorCritic};
use crate::check;
use crate::error::{Error, Result};
use crate::format::json::TskDocument;
use crate::inference::Tsk;

/// A critic that can be saved.
pub trait SavedCritic: Critic + Sized {
    /// What documents call a learner with such a critic.
    const KIND: &'static str;
    /// What it is made of.
    type Made: Serialize + DeserializeOwned;
    /// What it has learned.
    type Learned: Serialize + DeserializeOwned;

    /// What it is made of, and what it has learned.
    fn saved(&self) -> (Self::Made, Self::Learned);

    /// The critic that was saved; a step that has not been learned from is to be repeated.
    fn restored(made: Self::Made, learned: Self::Learned, settings: &TdSettings) -> Result<Self>;
}

impl SavedCritic for FuzzyCritic {
    const KIND: &'static str = "fuzzy_actor_critic";
    type Made = TskDocument;
    type Learned = TunedState;

    fn saved(&self) -> (TskDocument, TunedState) {
        (self.0.initial().into(), self.0.state())
    }

    fn restored(made: TskDocument, learned: TunedState, settings: &TdSettings) -> Result<Self> {
        let critic = Self::new(&made.try_into()?, settings.tune, settings.narrowest)?;
        Ok(Self(critic.0.restored(learned)?))
    }
}

/// The size of a network.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NetworkSize {
    observations: usize,
    actions: usize,
    hidden: usize,
}

impl SavedCritic for NeuralCritic {
    const KIND: &'static str = "neural_actor_critic";
    type Made = NetworkSize;
    type Learned = NetworkState;

    fn saved(&self) -> (NetworkSize, NetworkState) {
        let (observations, actions, hidden) = self.size();
        (NetworkSize { observations, actions, hidden }, self.state())
    }

    fn restored(made: NetworkSize, learned: NetworkState, _: &TdSettings) -> Result<Self> {
        Self::restored(made.observations, made.actions, made.hidden, learned)
    }
}

/// Where a [`TdActorCritic`] stands.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ActorCriticState<Made, Learned> {
    /// What must be the same for learning to continue.
    configuration: Configuration<Made>,
    episode: u64,
    actors: Vec<TunedState>,
    critic: Learned,
    /// The step that has not been learned from.
    last: Option<LastStep>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Configuration<Made> {
    settings: TdSettings,
    /// The systems as they were before anything was learned.
    actors: Vec<TskDocument>,
    critic: Made,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LastStep {
    observation: Vec<f64>,
    action: Vec<f64>,
    noise: Vec<f64>,
}

impl<C: SavedCritic> TdActorCritic<C> {
    pub(crate) fn state(&self) -> ActorCriticState<C::Made, C::Learned> {
        let (made, critic) = self.critic.saved();
        let last = self.value.map(|_| LastStep {
            observation: self.observation.clone(),
            action: self.action.clone(),
            noise: self.actors.iter().map(|actor| actor.noise).collect(),
        });
        ActorCriticState {
            configuration: Configuration {
                settings: self.settings,
                actors: self.actors.iter().map(|actor| actor.tuned.initial().into()).collect(),
                critic: made,
            },
            episode: self.episode,
            actors: self.actors.iter().map(|actor| actor.tuned.state()).collect(),
            critic,
            last,
        }
    }

    pub(crate) fn restored(state: ActorCriticState<C::Made, C::Learned>) -> Result<Self> {
        let Configuration { settings, actors, critic } = state.configuration;
        settings.check()?;
        let critic = C::restored(critic, state.critic, &settings)?;
        let systems = actors.into_iter().map(Tsk::try_from).collect::<Result<Vec<_>>>()?;
        check::same_length("states of the actors", systems.len(), state.actors.len())?;
        let mut agent = Self::with_critic(&systems, critic, settings)?;
        for (actor, (system, saved)) in
            agent.actors.iter_mut().zip(systems.iter().zip(state.actors))
        {
            let tuned = Tuned::new(system, settings.tune, settings.narrowest)?.restored(saved)?;
            *actor = Actor { tuned, noise: 0.0 };
        }
        agent.episode = state.episode;
        agent.rates = Rates::at(&settings, state.episode.max(1));
        if let Some(last) = state.last {
            agent.repeat(&last)?;
        }
        Ok(agent)
    }

    /// Takes the last step again, for the derivatives.
    fn repeat(&mut self, last: &LastStep) -> Result<()> {
        let LastStep { observation, action, noise } = last;
        for (what, numbers, expected) in [
            ("last observation", observation, self.observation.len()),
            ("last action", action, self.action.len()),
            ("last noise", noise, self.actors.len()),
        ] {
            check::same_length(what, expected, numbers.len())?;
            check::all_finite(what, numbers)?;
        }
        for (actor, &noise) in self.actors.iter_mut().zip(noise) {
            actor.noise = noise;
            actor.tuned.differentiate(observation);
        }
        let value = self.critic.differentiate(observation, action);
        if !value.is_finite() {
            return Err(Error::NotFinite { what: "value of the last action".to_owned(), value });
        }
        self.value = Some(value);
        self.observation.copy_from_slice(observation);
        self.action.copy_from_slice(action);
        Ok(())
    }
}
