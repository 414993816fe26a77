//! Q(λ)-learning on a table.

use super::policy::largest;
use super::table::Table;
use super::{Trace, Traces, epsilon_greedy, greedy};
use crate::check;
use crate::error::{Error, Result};
use crate::rng::Rng;

/// When eligibility traces end besides fading away.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cut {
    /// Never (naive Q(λ)): a TD error also reaches pairs that an exploring action parts from it.
    /// With much exploration and γλ near 1 the values may grow without bound (chapter 5).
    Never,
    /// After an action that was not greedy (Watkins 1989), as what follows it says nothing about
    /// the greedy policy.
    Watkins,
}

impl Cut {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Never => "never",
            Self::Watkins => "watkins",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("cut of traces", name, [Self::Never, Self::Watkins], Self::name)
    }
}

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
    /// When they end.
    pub cut: Cut,
}

/// No learning step may be larger: tables of values would come near the largest number there is.
const LARGEST_STEP: f64 = 1e290;

/// Tabular Q(λ): Q-learning (λ = 0) with eligibility traces.
///
/// In one step with learning rate α, the TD error Δ = r + γ maxₐ Q(s', a) − Q(s, a) moves every
/// pair by αΔ times its trace (2.43–2.49).
///
/// ```
/// use fuzzy_core::Rng;
/// use fuzzy_core::learn::rl::{Cut, QLambda, QLambdaSettings, Trace};
///
/// // Two states, two actions; action 1 in state 0 is rewarded and ends the episode.
/// let mut learner = QLambda::new(QLambdaSettings {
///     states: 2,
///     actions: 2,
///     discount: 0.9,
///     trace_decay: 0.5,
///     trace: Trace::Replacing,
///     cut: Cut::Never,
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
        let table = Table::new(settings.states, settings.actions)?;
        check::fraction("discount", settings.discount)?;
        check::fraction("trace decay", settings.trace_decay)?;
        let traces = Traces::new(settings.trace, settings.actions);
        Ok(Self { settings, values: table.filled("the table", 0.0)?, traces })
    }

    /// The learner with other first values, state by state.
    pub fn starting_from(mut self, values: &[f64]) -> Result<Self> {
        check::same_length("first values", self.values.len(), values.len())?;
        check::all_finite("first values", values)?;
        self.values.copy_from_slice(values);
        Ok(self)
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

    /// The values of a state's actions, for a [`Policy`](super::Policy) of your own.
    #[inline]
    pub fn action_values(&self, state: usize) -> &[f64] {
        let actions = self.settings.actions;
        &self.values[state * actions..(state + 1) * actions]
    }

    /// An ε-greedy action (2.54). The state must be below the number of states.
    #[inline]
    pub fn choose(&self, state: usize, epsilon: f64, rng: &mut Rng) -> usize {
        epsilon_greedy(self.action_values(state), epsilon, rng)
    }

    /// The action of the largest value; the first of several.
    #[inline]
    pub fn greedy_action(&self, state: usize) -> usize {
        greedy(self.action_values(state))
    }

    /// The greedy action of every state.
    pub fn greedy_actions(&self) -> Vec<usize> {
        (0..self.settings.states).map(|state| self.greedy_action(state)).collect()
    }

    /// Learns from one step and returns the TD error Δ. `next` is the state reached, or `None`
    /// if the episode ended in one whose value is zero.
    ///
    /// A reward that is not finite, or a step to be made beyond ±10²⁹⁰, is an error that leaves the
    /// table as it was.
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
        let ahead = next.map_or(0.0, |next| largest(self.action_values(next)));
        let error = self.settings.discount.mul_add(ahead, reward) - self.values[pair];
        let step = learning_rate * error;
        check_step(step)?;
        // Where Watkins cuts: the values have not changed since the action was chosen.
        let explored = self.settings.cut == Cut::Watkins
            && self.values[pair] < largest(self.action_values(state));
        if explored {
            self.traces.clear();
        }
        let decay = self.settings.discount * self.settings.trace_decay;
        self.traces.visit_and_update(pair, decay, step, &mut self.values);
        Ok(error)
    }
}

/// Nothing, if a learning step is finite and keeps values far from overflow.
#[inline]
pub(super) fn check_step(step: f64) -> Result<()> {
    if step.abs() <= LARGEST_STEP {
        return Ok(());
    }
    // Kept apart from the learner's loop.
    #[cold]
    fn refused(step: f64) -> Error {
        if step.is_finite() {
            return Error::LearningDiverged { what: "a learning step", value: step };
        }
        Error::NotFinite { what: "reward or TD error".to_owned(), value: step }
    }
    Err(refused(step))
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATES: usize = 13;
    const ACTIONS: usize = 5;

    const SETTINGS: QLambdaSettings = QLambdaSettings {
        states: STATES,
        actions: ACTIONS,
        discount: 0.5,
        trace_decay: 0.3,
        trace: Trace::Replacing,
        cut: Cut::Never,
    };

    /// The equations 2.43–2.49 as they are printed, over the whole table.
    struct FullSweep {
        settings: QLambdaSettings,
        values: Vec<f64>,
        traces: Vec<f64>,
    }

    impl FullSweep {
        fn learn(&mut self, (s, a, r, next): (usize, usize, f64, usize), rate: f64) {
            let QLambdaSettings { discount, trace_decay, trace, cut, .. } = self.settings;
            let best = |state: usize| {
                let row = &self.values[state * ACTIONS..][..ACTIONS];
                row.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            };
            let visited = s * ACTIONS + a;
            let error = r + discount * best(next) - self.values[visited];
            if cut == Cut::Watkins && self.values[visited] != best(s) {
                self.traces.fill(0.0);
            }
            for pair in 0..self.values.len() {
                let faded = trace_decay * discount * self.traces[pair];
                self.traces[pair] = match trace {
                    Trace::Accumulating if pair == visited => faded + 1.0,
                    _ if pair == visited => 1.0,
                    Trace::ReplacingState if pair / ACTIONS == s => 0.0,
                    _ => faded,
                };
                self.values[pair] += rate * error * self.traces[pair];
            }
        }
    }

    #[test]
    fn live_traces_equal_the_full_sweep() {
        for trace in [Trace::Replacing, Trace::ReplacingState, Trace::Accumulating] {
            for (cut, trace_decay) in [(Cut::Never, 0.3), (Cut::Watkins, 0.3), (Cut::Never, 0.8)] {
                let settings = QLambdaSettings { trace, cut, trace_decay, ..SETTINGS };
                let mut learner = QLambda::new(settings).unwrap();
                let pairs = STATES * ACTIONS;
                let (values, traces) = (vec![0.0; pairs], vec![0.0; pairs]);
                let mut sweep = FullSweep { settings, values, traces };
                let mut rng = Rng::new(11, 0);
                let mut state = 0;
                let mut accumulated = 0.0_f64;
                for _ in 0..20_000 {
                    let action = learner.choose(state, 0.5, &mut rng);
                    let next = rng.below(STATES);
                    let reward = rng.uniform_in(-1.0, 1.0);
                    learner.learn(state, action, reward, Some(next), 0.2).unwrap();
                    sweep.learn((state, action, reward, next), 0.2);
                    accumulated = accumulated.max(learner.traces.live()[0].1);
                    accumulated = accumulated.max(learner.traces.live().back().unwrap().1);
                    state = next;
                }
                let worst = learner.values().iter().zip(&sweep.values).map(|(a, b)| (a - b).abs());
                assert!(worst.fold(0.0, f64::max) < 1e-11, "{settings:?}");
                // Traces fade within ln 1e-12/ln γλ steps.
                assert!(learner.traces.live().len() <= if trace_decay < 0.5 { 16 } else { 32 });
                // Revisited pairs were found: their trace goes on from what it was.
                assert_eq!(accumulated > 1.0, trace == Trace::Accumulating);
            }
        }
    }

    #[test]
    fn traces_that_never_fade_accumulate_each_visit() {
        let settings = QLambdaSettings {
            discount: 1.0,
            trace_decay: 1.0,
            trace: Trace::Accumulating,
            ..SETTINGS
        };
        let mut learner = QLambda::new(settings).unwrap();
        for _ in 0..5 {
            learner.learn(2, 3, 0.0, None, 0.1).unwrap();
            learner.learn(4, 0, 0.0, None, 0.1).unwrap();
        }
        assert_eq!(learner.traces.live(), &[(13, 5.0), (20, 5.0)]);
    }

    #[test]
    fn watkins_cuts_after_an_action_that_is_not_greedy() {
        let values = [0.0, 1.0, 0.0, 1.0, 0.0, 0.0];
        let settings = QLambdaSettings { states: 3, actions: 2, cut: Cut::Watkins, ..SETTINGS };
        let mut learner = QLambda::new(settings).unwrap().starting_from(&values).unwrap();
        learner.learn(0, 1, 0.0, Some(1), 0.0).unwrap();
        learner.learn(1, 1, 0.0, Some(2), 0.0).unwrap();
        assert_eq!(learner.traces.live().len(), 2);
        // The greedy action of a tie is not exploring.
        learner.learn(2, 1, 0.0, Some(1), 0.0).unwrap();
        assert_eq!(learner.traces.live().len(), 3);
        learner.learn(1, 0, 0.0, Some(1), 0.0).unwrap();
        assert_eq!(learner.traces.live(), &[(2, 1.0)]);
    }

    #[test]
    fn values_that_grow_without_bound_are_reported() {
        let mut learner = QLambda::new(SETTINGS).unwrap();
        let error = learner.learn(0, 0, 1e300, None, 1.0).unwrap_err();
        assert_eq!(error.kind(), "learning_diverged", "{error}");
        assert!(learner.learn(0, 0, 1e289, None, 1.0).is_ok());
        assert!(learner.values().iter().all(|value| value.is_finite()));
    }

    #[test]
    fn a_bad_reward_leaves_the_table_as_it_was() {
        let settings =
            QLambdaSettings { states: 2, actions: 2, discount: 1.0, trace_decay: 0.9, ..SETTINGS };
        let mut learner = QLambda::new(settings).unwrap();
        learner.learn(0, 0, 1.0, Some(1), 0.5).unwrap();
        let before = learner.values().to_vec();
        assert!(learner.learn(1, 0, f64::NAN, Some(0), 0.5).is_err());
        assert_eq!(learner.values(), before);
    }

    #[test]
    fn impossible_settings_are_refused() {
        for bad in [
            QLambdaSettings { states: 0, ..SETTINGS },
            QLambdaSettings { actions: 0, ..SETTINGS },
            QLambdaSettings { discount: 1.1, ..SETTINGS },
            QLambdaSettings { trace_decay: f64::NAN, ..SETTINGS },
            QLambdaSettings { states: usize::MAX, ..SETTINGS },
        ] {
            assert!(QLambda::new(bad).is_err());
        }
        let learner = || QLambda::new(SETTINGS).unwrap();
        assert!(learner().starting_from(&[0.0; 3]).is_err());
        assert!(learner().starting_from(&[f64::NAN; STATES * ACTIONS]).is_err());
    }
}
