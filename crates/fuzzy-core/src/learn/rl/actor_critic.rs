//! Actor-critic learning on tables.

use super::q_lambda::check_step;
use super::table::Table;
use super::{Trace, Traces, softmax, softmax_probabilities};
use crate::check;
use crate::error::Result;
use crate::rng::Rng;

/// What an [`ActorCritic`] learner is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActorCriticSettings {
    /// The number of states.
    pub states: usize,
    /// The number of actions.
    pub actions: usize,
    /// The discount γ, in [0, 1].
    pub discount: f64,
    /// The decay λ of the critic's traces, in [0, 1].
    pub trace_decay: f64,
    /// The temperature θ of the actor's softmax, above zero.
    pub temperature: f64,
}

/// Tabular actor-critic with replacing traces on the critic (2.50–2.53).
///
/// The TD error Δ = r + γV(s') − V(s) moves the value of every state by αΔ times its trace, and
/// the preference of the action that was taken by βΔ (Sutton and Barto 1998, 6.6). The actor
/// chooses by [`softmax`] over the preferences of a state; it learns the value of what it does,
/// exploration included.
///
/// ```
/// use fuzzy_core::Rng;
/// use fuzzy_core::learn::rl::{ActorCritic, ActorCriticSettings};
///
/// let mut learner = ActorCritic::new(ActorCriticSettings {
///     states: 1,
///     actions: 2,
///     discount: 0.9,
///     trace_decay: 0.5,
///     temperature: 1.0,
/// })?;
/// let mut rng = Rng::new(0, 0);
/// for _ in 0..500 {
///     let action = learner.choose(0, &mut rng);
///     learner.learn(0, action, action as f64, None, 0.1, 0.2)?;
/// }
/// assert!(learner.probabilities(0)[1] > 0.9);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct ActorCritic {
    settings: ActorCriticSettings,
    values: Vec<f64>,
    preferences: Vec<f64>,
    traces: Traces,
}

impl ActorCritic {
    /// A learner whose values and preferences are all zero.
    pub fn new(settings: ActorCriticSettings) -> Result<Self> {
        let table = Table::new(settings.states, settings.actions)?;
        check::fraction("discount", settings.discount)?;
        check::fraction("trace decay", settings.trace_decay)?;
        check::positive("temperature", settings.temperature)?;
        Ok(Self {
            settings,
            values: check::zeros("the values", settings.states, 1)?,
            preferences: table.filled("the preferences", 0.0)?,
            traces: Traces::new(Trace::Replacing, 1),
        })
    }

    /// What the learner is made of.
    pub fn settings(&self) -> &ActorCriticSettings {
        &self.settings
    }

    /// V(s), the critic.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The preferences p(s, a), the actor, state by state.
    pub fn preferences(&self) -> &[f64] {
        &self.preferences
    }

    #[inline]
    fn row(&self, state: usize) -> &[f64] {
        let actions = self.settings.actions;
        &self.preferences[state * actions..][..actions]
    }

    /// The probability of each action in a state (2.56).
    pub fn probabilities(&self, state: usize) -> Vec<f64> {
        softmax_probabilities(self.row(state), self.settings.temperature)
    }

    /// An action of the actor. The state must be below the number of states.
    #[inline]
    pub fn choose(&self, state: usize, rng: &mut Rng) -> usize {
        softmax(self.row(state), self.settings.temperature, rng)
    }

    /// Ends all traces, as one may wish to between episodes.
    pub fn clear_traces(&mut self) {
        self.traces.clear();
    }

    /// Learns from one step with the rates α of the critic and β of the actor, and returns the TD
    /// error Δ. `next` is the state reached, or `None` if the episode ended.
    ///
    /// A reward that is not finite, or a step beyond ±10²⁹⁰, is an error that leaves the learner as
    /// it was.
    #[inline]
    pub fn learn(
        &mut self,
        state: usize,
        action: usize,
        reward: f64,
        next: Option<usize>,
        critic_rate: f64,
        actor_rate: f64,
    ) -> Result<f64> {
        let ActorCriticSettings { actions, discount, trace_decay, .. } = self.settings;
        let ahead = next.map_or(0.0, |next| self.values[next]);
        let error = discount.mul_add(ahead, reward) - self.values[state];
        check_step(error)?;
        let (step, preferred) = (critic_rate * error, actor_rate * error);
        self.traces.visit_and_update(state, discount * trace_decay, step, &mut self.values);
        self.preferences[state * actions + action] += preferred;
        Ok(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTINGS: ActorCriticSettings = ActorCriticSettings {
        states: 4,
        actions: 3,
        discount: 0.9,
        trace_decay: 0.8,
        temperature: 0.5,
    };

    #[test]
    fn live_traces_equal_the_printed_equations() {
        let mut learner = ActorCritic::new(SETTINGS).unwrap();
        let (mut values, mut traces, mut preferences) = ([0.0; 4], [0.0; 4], [0.0; 12]);
        let mut rng = Rng::new(5, 0);
        let mut state = 0;
        for _ in 0..5000 {
            let action = learner.choose(state, &mut rng);
            let (next, reward) = (rng.below(4), rng.uniform_in(-1.0, 1.0));
            learner.learn(state, action, reward, Some(next), 0.1, 0.05).unwrap();
            let error = reward + 0.9 * values[next] - values[state];
            for s in 0..4 {
                traces[s] = if s == state { 1.0 } else { 0.9 * 0.8 * traces[s] };
                values[s] += 0.1 * error * traces[s];
            }
            preferences[state * 3 + action] += 0.05 * error;
            state = next;
        }
        let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-10);
        assert!(near(learner.values(), &values) && near(learner.preferences(), &preferences));
        assert!(values.iter().any(|value| value.abs() > 0.01));
    }

    #[test]
    fn bad_input_leaves_the_learner_as_it_was() {
        for bad in [
            ActorCriticSettings { temperature: 0.0, ..SETTINGS },
            ActorCriticSettings { discount: -0.1, ..SETTINGS },
            ActorCriticSettings { trace_decay: 1.1, ..SETTINGS },
            ActorCriticSettings { actions: 0, ..SETTINGS },
        ] {
            assert!(ActorCritic::new(bad).is_err());
        }
        let mut learner = ActorCritic::new(SETTINGS).unwrap();
        learner.learn(0, 0, 1.0, Some(1), 0.1, 0.1).unwrap();
        let before = learner.values().to_vec();
        assert!(learner.learn(0, 1, f64::NAN, None, 0.1, 0.1).is_err());
        assert_eq!(learner.values(), before);
    }
}
