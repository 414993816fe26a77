//! Model-building Q(λ)-learning (chapter 5).

use super::policy::largest;
use super::q_lambda::check_step;
use super::table::Table;
use super::{Trace, Traces, Visits, epsilon_greedy, greedy};
use crate::check;
use crate::error::Result;
use crate::math::{LANES, Lanes, Real};
use crate::rng::Rng;

/// How a model counts visits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Counts {
    /// As steps 1 to 11 print it: the count of visits V begins at 1 and is raised after the
    /// probabilities W/V of all pairs are taken. Those of the current pair sum to 1, those of a
    /// pair visited n times before to n/(n + 1); a pair that was never visited has an empty model
    /// and is drawn towards zero by its trace of 1 at the start.
    Thesis,
    /// Relative frequencies: probabilities sum to 1, and a pair that was never visited keeps its
    /// value.
    Exact,
}

impl Counts {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Thesis => "thesis",
            Self::Exact => "exact",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("way to count", name, [Self::Thesis, Self::Exact], Self::name)
    }
}

/// What a [`ModelBuilding`] learner is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelBuildingSettings {
    /// The number of states.
    pub states: usize,
    /// The number of actions.
    pub actions: usize,
    /// The discount γ, in [0, 1].
    pub discount: f64,
    /// The trace decay λ, in [0, 1].
    pub trace_decay: f64,
    /// How visits are counted.
    pub counts: Counts,
}

/// Q-learning that builds a model of the process as it goes, with replacing traces.
///
/// Each step corrects the model of the current pair, its mean reward r̄ and the probabilities P of
/// the states after it, and then draws every pair towards what *its own* model says (5.2):
///
/// Q(s, a) ← (1 − αe(s, a))·Q(s, a) + αe(s, a)·[r̄(s, a) + γ Σⱼ P(s, a, j) max_b Q(j, b)]
///
/// with e = (γλ)^τ, τ steps after the last visit (5.3, 5.4), and the values before the step on the
/// right. No TD error travels along the traces: they are smaller steps at pairs visited lately.
/// Traces below 10⁻¹² are dropped.
///
/// ```
/// use fuzzy_core::learn::rl::{Counts, ModelBuilding, ModelBuildingSettings};
///
/// let mut learner = ModelBuilding::new(ModelBuildingSettings {
///     states: 2,
///     actions: 1,
///     discount: 0.5,
///     trace_decay: 0.9,
///     counts: Counts::Exact,
/// })?;
/// // State 0 earns 1 and leads to state 1, which earns nothing and leads back.
/// for _ in 0..100 {
///     learner.learn(0, 0, 1.0, Some(1), 0.5)?;
///     learner.learn(1, 0, 0.0, Some(0), 0.5)?;
/// }
/// assert!((learner.values()[0] - 4.0 / 3.0).abs() < 1e-9);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
/// The model takes memory for states² × actions numbers.
#[derive(Debug, Clone)]
pub struct ModelBuilding {
    settings: ModelBuildingSettings,
    values: Vec<f64>,
    visits: Visits,
    /// r̄(s, a).
    mean_rewards: Vec<f64>,
    /// γ/V(s, a) of each pair that is not the current one.
    shares: Vec<f64>,
    /// W(s, a, j), a row for each pair, padded with zeros to groups of eight.
    reached: Vec<[f64; LANES]>,
    /// max_b Q(j, b), padded as the rows of `reached`.
    best: Vec<[f64; LANES]>,
    traces: Traces,
    /// The step at which each number of `best` was last renewed.
    renewed: Vec<u64>,
    steps: u64,
}

impl ModelBuilding {
    /// A learner whose values are all zero.
    pub fn new(settings: ModelBuildingSettings) -> Result<Self> {
        let table = Table::new(settings.states, settings.actions)?;
        check::fraction("discount", settings.discount)?;
        check::fraction("trace decay", settings.trace_decay)?;
        let groups = settings.states.div_ceil(LANES);
        let zeros = [0.0; LANES];
        // What needs most memory comes first.
        let reached = check::filled("the model", table.pairs(), groups, zeros)?;
        let mut traces = Traces::new(Trace::Replacing, settings.actions);
        if settings.counts == Counts::Thesis {
            traces.fill(table.pairs())?;
        }
        Ok(Self {
            settings,
            values: table.filled("the table", 0.0)?,
            visits: Visits::new(settings.states, settings.actions)?,
            mean_rewards: table.filled("the mean rewards", 0.0)?,
            shares: table.filled("the visits", settings.discount)?,
            reached,
            best: check::filled("the states' values", groups, 1, zeros)?,
            traces,
            renewed: check::filled("the states' values", settings.states, 1, 0)?,
            steps: 0,
        })
    }

    /// The learner with other first values, state by state.
    pub fn starting_from(mut self, values: &[f64]) -> Result<Self> {
        check::same_length("first values", self.values.len(), values.len())?;
        check::all_finite("first values", values)?;
        self.values.copy_from_slice(values);
        let best = self.best.as_flattened_mut().iter_mut();
        best.zip(values.chunks_exact(self.settings.actions)).for_each(|(b, row)| *b = largest(row));
        Ok(self)
    }

    /// What the learner is made of.
    pub fn settings(&self) -> &ModelBuildingSettings {
        &self.settings
    }

    /// The table Q(s, a), state by state.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The values of a state's actions, for a [`Policy`](super::Policy) of your own.
    #[inline]
    pub fn action_values(&self, state: usize) -> &[f64] {
        let actions = self.settings.actions;
        &self.values[state * actions..][..actions]
    }

    /// An ε-greedy action (2.54). The state must be below the number of states.
    #[inline]
    pub fn choose(&self, state: usize, epsilon: f64, rng: &mut Rng) -> usize {
        epsilon_greedy(self.action_values(state), epsilon, rng)
    }

    /// The action of the largest value; the first of several.
    pub fn greedy_action(&self, state: usize) -> usize {
        greedy(self.action_values(state))
    }

    /// How often each pair was visited.
    pub fn visits(&self) -> &Visits {
        &self.visits
    }

    /// r̄(s, a), the mean of the rewards seen, state by state; 0 where there was none.
    pub fn mean_rewards(&self) -> &[f64] {
        &self.mean_rewards
    }

    /// P(s, a, j) as a step uses it for a pair that is not the current one: what it sums to is
    /// said at [`Counts`]. For the pair of the step itself it sums to 1.
    pub fn transitions(&self, state: usize, action: usize) -> Vec<f64> {
        let visits = self.divisor(self.visits.of(state, action));
        let (pair, groups) = (state * self.settings.actions + action, self.best.len());
        let row = self.reached[pair * groups..][..groups].as_flattened();
        row[..self.settings.states].iter().map(|count| count / visits).collect()
    }

    /// V of a pair with so many visits that is not the current one.
    fn divisor(&self, visits: u64) -> f64 {
        match self.settings.counts {
            Counts::Thesis => (visits + 1) as f64,
            Counts::Exact => visits.max(1) as f64,
        }
    }

    /// Takes note of a step in the model; returns γ/V of its pair.
    #[inline]
    fn observe(&mut self, state: usize, action: usize, reward: f64, next: Option<usize>) -> f64 {
        let pair = state * self.settings.actions + action;
        let visits = self.visits.visit(state, action);
        let mean = &mut self.mean_rewards[pair];
        *mean += (reward - *mean) / visits as f64;
        if let Some(next) = next {
            self.reached[pair * self.best.len() + next / LANES][next % LANES] += 1.0;
        }
        self.shares[pair] = self.settings.discount / self.divisor(visits);
        self.settings.discount / visits as f64
    }

    /// Learns from one step with rate α in [0, 1]; returns by how much the pair's value missed what
    /// its model says. `next` is the state reached, or `None` if the episode ended in one whose
    /// value is zero.
    ///
    /// A reward that is not finite or beyond ±10²⁹⁰ is an error that leaves the learner as it was.
    pub fn learn(
        &mut self,
        state: usize,
        action: usize,
        reward: f64,
        next: Option<usize>,
        learning_rate: f64,
    ) -> Result<f64> {
        let ModelBuildingSettings { actions, discount, trace_decay, .. } = self.settings;
        check_step(reward)?;
        let current = state * actions + action;
        let share = self.observe(state, action, reward, next);
        self.traces.visit(current, discount * trace_decay);
        let mut missed = 0.0;
        for &(pair, trace) in self.traces.live() {
            let pair = pair as usize;
            let share = if pair == current { share } else { self.shares[pair] };
            let reached = &self.reached[pair * self.best.len()..][..self.best.len()];
            // r̄ + (γ/V) Σⱼ Wⱼ max_b Q(j, b), the bracket of (5.2).
            let target = share.mul_add(product(reached, &self.best), self.mean_rewards[pair]);
            // The current pair is the last.
            missed = target - self.values[pair];
            self.values[pair] = (learning_rate * trace).mul_add(missed, self.values[pair]);
        }
        // Only now: (5.2) has the values before the step on its right side.
        self.steps += 1;
        for &(pair, _) in self.traces.live() {
            let state = pair as usize / actions;
            if self.renewed[state] != self.steps {
                self.renewed[state] = self.steps;
                let values = &self.values[state * actions..][..actions];
                self.best[state / LANES][state % LANES] = largest(values);
            }
        }
        Ok(missed)
    }
}

/// Σⱼ aⱼ·bⱼ, in the same order on every machine.
#[inline]
fn product(a: &[[f64; LANES]], b: &[[f64; LANES]]) -> f64 {
    let sum = a
        .iter()
        .zip(b)
        .fold(Lanes::splat(0.0), |sum, (a, b)| Lanes::new(*a).mul_add(Lanes::new(*b), sum));
    let [a, b, c, d, e, f, g, h] = sum.to_array();
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

#[cfg(test)]
mod tests {
    use super::super::Mdp;
    use super::*;

    const SETTINGS: ModelBuildingSettings = ModelBuildingSettings {
        states: 6,
        actions: 2,
        discount: 0.9,
        trace_decay: 0.9,
        counts: Counts::Thesis,
    };

    /// Steps 1 to 11 as they are printed, over whole tables; or with V from 0, raised before use.
    struct Printed {
        settings: ModelBuildingSettings,
        q: Vec<f64>,
        e: Vec<f64>,
        r: Vec<f64>,
        v: Vec<f64>,
        w: Vec<f64>,
    }

    impl Printed {
        fn new(settings: ModelBuildingSettings, q: Vec<f64>) -> Self {
            let pairs = q.len();
            let first = if settings.counts == Counts::Thesis { 1.0 } else { 0.0 };
            let w = vec![0.0; pairs * settings.states];
            let (e, v) = (vec![first; pairs], vec![first; pairs]);
            Self { settings, q, e, r: vec![0.0; pairs], v, w }
        }

        fn learn(&mut self, s: usize, a: usize, reward: f64, next: usize, rate: f64) {
            let ModelBuildingSettings { states, actions, discount, trace_decay, counts } =
                self.settings;
            let pair = s * actions + a;
            if counts == Counts::Exact {
                self.v[pair] += 1.0;
            }
            self.r[pair] += (reward - self.r[pair]) / self.v[pair];
            self.w[pair * states + next] += 1.0;
            let pairs = self.q.len();
            let p: Vec<f64> =
                (0..pairs * states).map(|i| self.w[i] / self.v[i / states].max(1.0)).collect();
            if counts == Counts::Thesis {
                self.v[pair] += 1.0;
            }
            let before = self.q.clone();
            let best = |j: usize| {
                before[j * actions..][..actions].iter().copied().fold(f64::NEG_INFINITY, f64::max)
            };
            for other in 0..pairs {
                self.e[other] =
                    if other == pair { 1.0 } else { discount * trace_decay * self.e[other] };
                let ahead: f64 = (0..states).map(|j| p[other * states + j] * best(j)).sum();
                let step = rate * self.e[other];
                self.q[other] =
                    (1.0 - step) * self.q[other] + step * (self.r[other] + discount * ahead);
            }
        }
    }

    /// Lets a learner and the printed algorithm wander together, and returns both.
    fn wander(
        settings: ModelBuildingSettings,
        first: f64,
        steps: usize,
    ) -> (ModelBuilding, Printed) {
        let mdp = Mdp::garnet(settings.states, settings.actions, 3, 8).unwrap();
        let mdp = mdp.with_reward_noise(2.0).unwrap();
        let q = vec![first; settings.states * settings.actions];
        let mut learner = ModelBuilding::new(settings).unwrap().starting_from(&q).unwrap();
        let mut printed = Printed::new(settings, q);
        let mut rng = Rng::new(3, 0);
        let mut state = 0;
        for step in 0..steps {
            let action = learner.choose(state, 0.5, &mut rng);
            let (reward, next) = mdp.step(state, action, &mut rng);
            let rate = 1.0 / (1.0 + step as f64).powf(0.4);
            learner.learn(state, action, reward, Some(next), rate).unwrap();
            printed.learn(state, action, reward, next, rate);
            state = next;
        }
        (learner, printed)
    }

    #[test]
    fn live_traces_equal_the_printed_algorithm() {
        for counts in [Counts::Thesis, Counts::Exact] {
            for (trace_decay, first) in [(0.0, 0.0), (0.3, 2.0), (0.9, -2.0), (1.0, 0.0)] {
                // More states than a group of lanes too.
                for (states, steps) in [(6, 1), (6, 7), (6, 3000), (11, 500)] {
                    let settings =
                        ModelBuildingSettings { states, counts, trace_decay, ..SETTINGS };
                    let (learner, printed) = wander(settings, first, steps);
                    let apart = learner.values().iter().zip(&printed.q).map(|(a, b)| (a - b).abs());
                    assert!(apart.fold(0.0, f64::max) < 1e-9, "{settings:?}, {steps} steps");
                }
            }
        }
    }

    #[test]
    fn models_are_sample_means() {
        let mut learner = ModelBuilding::new(SETTINGS).unwrap();
        for (visit, (reward, next)) in [(1.0, 1), (2.0, 1), (6.0, 4)].into_iter().enumerate() {
            let share = learner.observe(0, 1, reward, Some(next));
            // The current pair's probabilities sum to 1: W/n.
            assert_eq!(share, 0.9 / (visit + 1) as f64);
        }
        assert_eq!((learner.visits().of(0, 1), learner.mean_rewards()[1]), (3, 3.0));
        // Those of another pair to n/(n + 1), and to nothing without visits.
        assert_eq!(learner.transitions(0, 1), [0.0, 0.5, 0.0, 0.0, 0.25, 0.0]);
        assert_eq!(learner.transitions(5, 0), [0.0; 6]);
        let exact = ModelBuildingSettings { counts: Counts::Exact, ..SETTINGS };
        let mut learner = ModelBuilding::new(exact).unwrap();
        learner.learn(0, 1, 1.0, Some(1), 0.5).unwrap();
        assert_eq!(learner.transitions(0, 1), [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn optimistic_values_survive_only_exact_counts() {
        for (counts, kept) in [(Counts::Thesis, false), (Counts::Exact, true)] {
            let settings = ModelBuildingSettings { counts, ..SETTINGS };
            let mut learner =
                ModelBuilding::new(settings).unwrap().starting_from(&[5.0; 12]).unwrap();
            for _ in 0..40 {
                learner.learn(0, 0, 0.0, Some(0), 0.9).unwrap();
            }
            assert_eq!(learner.values()[11] == 5.0, kept, "{}", learner.values()[11]);
            assert!(kept || learner.values()[11] < 0.2);
        }
    }

    #[test]
    fn bad_input_leaves_the_learner_as_it_was() {
        let mut learner = ModelBuilding::new(SETTINGS).unwrap();
        learner.learn(0, 0, 1.0, Some(1), 0.5).unwrap();
        let before = learner.values().to_vec();
        assert!(learner.learn(1, 0, f64::NAN, Some(0), 0.5).is_err());
        assert!(learner.learn(1, 0, 1e291, Some(0), 0.5).is_err());
        assert_eq!((learner.values(), learner.visits().of(1, 0)), (&before[..], 0));
        for bad in [
            ModelBuildingSettings { states: 0, ..SETTINGS },
            ModelBuildingSettings { discount: 1.5, ..SETTINGS },
            ModelBuildingSettings { trace_decay: -0.1, ..SETTINGS },
        ] {
            assert!(ModelBuilding::new(bad).is_err());
        }
        assert!(ModelBuilding::new(SETTINGS).unwrap().starting_from(&[0.0]).is_err());
    }
}
