//! Q(λ)-learning on a table.

use super::policy::largest;
use super::{Trace, Traces, epsilon_greedy, greedy};
use crate::check;
use crate::error::{Error, Result};
use crate::rng::Rng;

/// What a [`QLambda`] learner is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QLambdaSettings {
    /// The number of states.
    pub states: usize,
    /// The number of actions.
    pub actions: usize,
    /// The discount γ, in [0, 1].
    pub discount: f64,
    /// The trace decay λ, in [0, 1].
    pub trace_decay: f64,
    /// What a visit does to the traces.
    pub trace: Trace,
}

/// Tabular Q(λ) with eligibility traces that are not cut after exploring actions (naive Q(λ)).
///
/// In one step with learning rate α, the TD error Δ = r + γ maxₐ Q(s', a) − Q(s, a) moves every
/// pair by αΔ times its trace (2.43–2.48).
///
/// ```
/// use fuzzy_core::Rng;
/// use fuzzy_core::learn::rl::{QLambda, QLambdaSettings, Trace};
///
/// // Two states, two actions; action 1 in state 0 is rewarded and ends the episode.
/// let mut learner = QLambda::new(QLambdaSettings {
///     states: 2,
///     actions: 2,
///     discount: 0.9,
///     trace_decay: 0.5,
///     trace: Trace::Replacing,
/// })?;
/// let mut rng = Rng::new(0, 0);
/// for _ in 0..100 {
///     let action = learner.choose(0, 0.3, &mut rng);
///     let reward = if action == 1 { 1.0 } else { 0.0 };
///     learner.learn(0, action, reward, None, 0.1)?;
/// }
/// assert_eq!(learner.greedy_action(0), 1);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct QLambda {
    settings: QLambdaSettings,
    values: Vec<f64>,
    traces: Traces,
}

impl QLambda {
    /// A learner whose values are all zero.
    pub fn new(settings: QLambdaSettings) -> Result<Self> {
        check::at_least("number of states", settings.states, 1)?;
        check::at_least("number of actions", settings.actions, 1)?;
        check::fraction("discount", settings.discount)?;
        check::fraction("trace decay", settings.trace_decay)?;
        let pairs = settings.states.checked_mul(settings.actions);
        if pairs.is_none_or(|pairs| u32::try_from(pairs).is_err()) {
            let actual = format!("{} states × {} actions", settings.states, settings.actions);
            return Err(Error::wrong_shape("size of the table", "fewer than 2³² pairs", actual));
        }
        Ok(Self {
            settings,
            values: check::zeros("the table", settings.states, settings.actions)?,
            traces: Traces::new(settings.trace, settings.actions),
        })
    }

    /// What the learner is made of.
    pub fn settings(&self) -> &QLambdaSettings {
        &self.settings
    }

    /// The table Q(s, a), state by state.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The traces.
    pub fn traces(&self) -> &Traces {
        &self.traces
    }

    /// The learner with other values and live traces.
    pub(crate) fn restored(mut self, values: Vec<f64>, live: &[(u32, f64)]) -> Result<Self> {
        check::same_length("values of the table", self.values.len(), values.len())?;
        check::all_finite("values of the table", &values)?;
        for &(pair, trace) in live {
            check::within("trace", trace, "positive", |trace| trace > 0.0)?;
            let what = "pair of state and action with a trace";
            let expected = format!("below {}", values.len());
            check::within(what, pair.into(), &expected, |_| (pair as usize) < values.len())?;
        }
        self.traces = self.traces.with_live(live.iter().copied());
        self.values = values;
        Ok(self)
    }

    /// Ends all eligibility traces, as one may wish to between episodes.
    pub fn clear_traces(&mut self) {
        self.traces.clear();
    }

    /// The values of a state's actions.
    #[inline]
    fn row(&self, state: usize) -> &[f64] {
        let actions = self.settings.actions;
        &self.values[state * actions..(state + 1) * actions]
    }

    /// An ε-greedy action (2.54). The state must be below the number of states.
    #[inline]
    pub fn choose(&self, state: usize, epsilon: f64, rng: &mut Rng) -> usize {
        epsilon_greedy(self.row(state), epsilon, rng)
    }

    /// The action of the largest value; the first of several.
    #[inline]
    pub fn greedy_action(&self, state: usize) -> usize {
        greedy(self.row(state))
    }

    /// The greedy action of every state.
    pub fn greedy_actions(&self) -> Vec<usize> {
        (0..self.settings.states).map(|state| self.greedy_action(state)).collect()
    }

    /// Learns from one step and returns the TD error Δ. `next` is the state reached, or `None`
    /// if the episode ended in one whose value is zero.
    ///
    /// A reward that is not finite, or so large that the step to be made is not, is an error that
    /// leaves the table as it was.
    #[inline]
    pub fn learn(
        &mut self,
        state: usize,
        action: usize,
        reward: f64,
        next: Option<usize>,
        learning_rate: f64,
    ) -> Result<f64> {
        let pair = state * self.settings.actions + action;
        let ahead = next.map_or(0.0, |next| largest(self.row(next)));
        let error = self.settings.discount.mul_add(ahead, reward) - self.values[pair];
        let step = learning_rate * error;
        if !step.is_finite() {
            return Err(Error::NotFinite { what: "reward or TD error".to_owned(), value: step });
        }
        let decay = self.settings.discount * self.settings.trace_decay;
        self.traces.visit_and_update(pair, decay, step, &mut self.values);
        Ok(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATES: usize = 13;
    const ACTIONS: usize = 5;

    /// The equations 2.43–2.48 as they are printed, over the whole table.
    struct FullSweep {
        values: Vec<f64>,
        traces: Vec<f64>,
    }

    impl FullSweep {
        fn learn(&mut self, kind: Trace, (s, a, r, next): (usize, usize, f64, usize), rate: f64) {
            let best = (0..ACTIONS)
                .map(|b| self.values[next * ACTIONS + b])
                .fold(f64::NEG_INFINITY, f64::max);
            let error = r + 0.5 * best - self.values[s * ACTIONS + a];
            for pair in 0..self.values.len() {
                self.traces[pair] = if pair == s * ACTIONS + a {
                    1.0
                } else if kind == Trace::ReplacingState && pair / ACTIONS == s {
                    0.0
                } else {
                    0.3 * 0.5 * self.traces[pair]
                };
                self.values[pair] += rate * error * self.traces[pair];
            }
        }
    }

    #[test]
    fn live_traces_equal_the_full_sweep() {
        for trace in [Trace::Replacing, Trace::ReplacingState] {
            let settings = QLambdaSettings {
                states: STATES,
                actions: ACTIONS,
                discount: 0.5,
                trace_decay: 0.3,
                trace,
            };
            let mut learner = QLambda::new(settings).unwrap();
            let pairs = STATES * ACTIONS;
            let mut sweep = FullSweep { values: vec![0.0; pairs], traces: vec![0.0; pairs] };
            let mut rng = Rng::new(11, 0);
            let mut state = 0;
            for _ in 0..20_000 {
                let action = learner.choose(state, 0.5, &mut rng);
                let next = rng.below(STATES);
                let reward = rng.uniform_in(-1.0, 1.0);
                learner.learn(state, action, reward, Some(next), 0.2).unwrap();
                sweep.learn(trace, (state, action, reward, next), 0.2);
                state = next;
            }
            let worst = learner.values().iter().zip(&sweep.values).map(|(a, b)| (a - b).abs());
            assert!(worst.fold(0.0, f64::max) < 1e-11);
            assert!(learner.traces.live().len() <= 16);
        }
    }

    #[test]
    fn a_bad_reward_leaves_the_table_as_it_was() {
        let settings = QLambdaSettings {
            states: 2,
            actions: 2,
            discount: 1.0,
            trace_decay: 0.9,
            trace: Trace::Replacing,
        };
        let mut learner = QLambda::new(settings).unwrap();
        learner.learn(0, 0, 1.0, Some(1), 0.5).unwrap();
        let before = learner.values().to_vec();
        assert!(learner.learn(1, 0, f64::NAN, Some(0), 0.5).is_err());
        assert_eq!(learner.values(), before);
    }

    #[test]
    fn impossible_settings_are_refused() {
        let good = QLambdaSettings {
            states: 2,
            actions: 2,
            discount: 0.5,
            trace_decay: 0.3,
            trace: Trace::Replacing,
        };
        for bad in [
            QLambdaSettings { states: 0, ..good },
            QLambdaSettings { actions: 0, ..good },
            QLambdaSettings { discount: 1.1, ..good },
            QLambdaSettings { trace_decay: f64::NAN, ..good },
            QLambdaSettings { states: usize::MAX, ..good },
        ] {
            assert!(QLambda::new(bad).is_err());
        }
    }
}
