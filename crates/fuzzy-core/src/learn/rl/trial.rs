//! A learner on a finite Markov decision process, compared with the optimum as it goes.

use super::{
    Bound, Counts, Cut, Mdp, ModelBuilding, ModelBuildingSettings, Optimum, Policy, QLambda,
    QLambdaSettings, Scale, Trace, Visits,
};
use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::learn::schedule::Schedule;
use crate::math::{LANES, Lanes, Real};
use crate::rng::Rng;

/// Which learner a [`Trial`] is of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Learner {
    /// [`QLambda`]; with a trace decay of 0, one-step Q-learning.
    QLambda {
        /// λ.
        trace_decay: f64,
        /// What a visit does to the traces.
        trace: Trace,
        /// When they end.
        cut: Cut,
    },
    /// [`ModelBuilding`].
    ModelBuilding {
        /// λ.
        trace_decay: f64,
        /// How visits are counted.
        counts: Counts,
    },
}

/// What a learning rate's count i = 1, 2, … counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Per {
    /// Visits of the current pair.
    Visit,
    /// Steps, over all pairs.
    Step,
    /// Episodes of so many steps.
    Episode {
        /// The steps of one.
        steps: u64,
    },
}

/// Settings of a [`Trial`].
#[derive(Debug, Clone, PartialEq)]
pub struct TrialSettings {
    /// What learns.
    pub learner: Learner,
    /// The discount γ, from 0 to below 1.
    pub discount: f64,
    /// The learning rate α.
    pub learning_rate: Schedule,
    /// What its count counts.
    pub per: Per,
    /// How actions are chosen.
    pub policy: Policy,
    /// First values are drawn evenly between these two; the same number twice is that number.
    pub first_values: (f64, f64),
    /// The steps after which the values are looked at, rising from 1 at least; the last ends the
    /// trial.
    pub checkpoints: Vec<u64>,
}

/// What came of a learner on a process.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The last values Q(s, a), state by state.
    pub values: Vec<f64>,
    /// What they should be.
    pub optimum: Optimum,
    /// max |Q − Q*| at each checkpoint; infinite once the values grew without bound.
    pub errors: Vec<f64>,
    /// max |Q| at each checkpoint; infinite once the values grew without bound.
    pub largest: Vec<f64>,
    /// M(1 + γ + … + γᵗ) at each checkpoint, with M as [`Scale::Used`] has it.
    pub bounds: Vec<f64>,
    /// The bound in each reading, in the order of [`Scale::ALL`], as watched at every step.
    pub watched: [Bound; 3],
    /// The step that would have taken values beyond what numbers hold, which ended the trial.
    pub diverged_at: Option<u64>,
}

/// The relative error of the optimum that learners are compared with.
const TOLERANCE: f64 = 1e-10;
/// Steps between two looks at the control.
const STEPS_BETWEEN_CHECKS: u64 = 1024;

impl Trial {
    /// Lets a learner learn. It starts in a random state and never leaves the process.
    ///
    /// ```
    /// use fuzzy_core::Control;
    /// use fuzzy_core::learn::rl::{
    ///     Counts, Learner, Mdp, Per, Policy, Ties, Trial, TrialSettings,
    /// };
    /// use fuzzy_core::learn::schedule::Schedule;
    ///
    /// let settings = TrialSettings {
    ///     learner: Learner::ModelBuilding { trace_decay: 0.9, counts: Counts::Exact },
    ///     discount: 0.9,
    ///     learning_rate: Schedule::power("learning rate", 1.0, 0.7)?,
    ///     per: Per::Visit,
    ///     policy: Policy::epsilon_greedy(1.0, Ties::First)?,
    ///     first_values: (0.0, 0.0),
    ///     checkpoints: vec![100, 10_000],
    /// };
    /// let mdp = Mdp::garnet(20, 3, 5, 0)?;
    /// let trial = Trial::run(&mdp, &settings, 0, &Control::new())?;
    /// assert!(trial.errors[1] < 0.3 * trial.errors[0]);
    /// assert_eq!(trial.watched[0].violations(), 0);
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn run(mdp: &Mdp, settings: &TrialSettings, seed: u64, control: &Control) -> Result<Self> {
        let steps = settings.check()?;
        let optimum = mdp.value_iteration(settings.discount, TOLERANCE, control)?;
        let mut rng = Rng::new(seed, 0);
        let (low, high) = settings.first_values;
        let pairs = mdp.states() * mdp.actions();
        let first: Vec<f64> = (0..pairs).map(|_| rng.uniform_in(low, high)).collect();
        let watch = |scale| Bound::new(scale, settings.discount, &first, mdp.rewards());
        let [used, printed, means] = Scale::ALL.map(watch);
        let mut trial = Self {
            values: Vec::new(),
            optimum,
            errors: Vec::with_capacity(settings.checkpoints.len()),
            largest: Vec::with_capacity(settings.checkpoints.len()),
            bounds: Vec::with_capacity(settings.checkpoints.len()),
            watched: [used?, printed?, means?],
            diverged_at: None,
        };
        let mut work = Work {
            mdp,
            settings,
            table: LearningTable::new(mdp, settings, &first)?,
            visits: Visits::new(mdp.states(), mdp.actions())?,
            state: rng.below(mdp.states()),
            rng,
        };
        for step in 1..=steps {
            if step % STEPS_BETWEEN_CHECKS == 0 {
                control.advance(STEPS_BETWEEN_CHECKS)?;
            }
            let Ok(reward) = work.step(step) else {
                trial.diverged_at = Some(step);
                break;
            };
            let values = work.table.values();
            let largest = largest_size(values);
            trial.watched.iter_mut().for_each(|bound| bound.watch(reward, largest));
            if settings.checkpoints[trial.errors.len()] == step {
                trial.note(values, largest);
            }
        }
        trial.values = work.table.values().to_vec();
        control.advance(steps % STEPS_BETWEEN_CHECKS)?;
        Ok(trial.filled(settings.checkpoints.len()))
    }

    /// Takes note of a checkpoint.
    fn note(&mut self, values: &[f64], largest: f64) {
        let apart = values.iter().zip(&self.optimum.values).map(|(a, b)| (a - b).abs());
        self.errors.push(apart.fold(0.0, f64::max));
        self.largest.push(largest);
        self.bounds.push(self.watched[0].now());
    }

    /// With what the checkpoints have that a diverged trial did not reach.
    fn filled(mut self, checkpoints: usize) -> Self {
        self.errors.resize(checkpoints, f64::INFINITY);
        self.largest.resize(checkpoints, f64::INFINITY);
        self.bounds.resize(checkpoints, self.watched[0].now());
        self
    }
}

impl TrialSettings {
    /// The number of steps, if the settings that no constructor checks are possible.
    fn check(&self) -> Result<u64> {
        let (low, high) = self.first_values;
        check::all_finite("first values", &[low, high])?;
        check::within("upper first value", high, &format!("at least {low}"), |high| high >= low)?;
        if let Per::Episode { steps } = self.per {
            check::at_least("steps of an episode", steps as usize, 1)?;
        }
        check::at_least("number of checkpoints", self.checkpoints.len(), 1)?;
        let rising = self.checkpoints.windows(2).all(|pair| pair[0] < pair[1]);
        match (self.checkpoints[0], self.checkpoints.last()) {
            (1.., Some(&last)) if rising => Ok(last),
            _ => Err(Error::Unsuitable {
                what: "checkpoints".to_owned(),
                reason: "they must be steps from 1 on, each later than the one before".to_owned(),
            }),
        }
    }
}

/// The largest |Q| of a table.
#[inline]
fn largest_size(values: &[f64]) -> f64 {
    let (groups, rest) = values.as_chunks::<LANES>();
    let sizes = groups
        .iter()
        .fold(Lanes::splat(0.0), |largest, group| largest.max(Lanes::new(*group).abs()));
    let rest = rest.iter().map(|value| value.abs());
    sizes.to_array().into_iter().chain(rest).fold(0.0, f64::max)
}

/// A trial under way.
struct Work<'a> {
    mdp: &'a Mdp,
    settings: &'a TrialSettings,
    table: LearningTable,
    visits: Visits,
    state: usize,
    rng: Rng,
}

impl Work<'_> {
    /// One step of the process and of learning; returns the reward, or the mean reward, that was
    /// learned from.
    #[inline]
    fn step(&mut self, step: u64) -> Result<f64> {
        let state = self.state;
        let row = &self.table.values()[state * self.mdp.actions()..][..self.mdp.actions()];
        let action = self.settings.policy.choose(row, &mut self.rng);
        let (reward, next) = self.mdp.step(state, action, &mut self.rng);
        let count = match self.settings.per {
            Per::Visit => self.visits.visit(state, action),
            Per::Step => step,
            Per::Episode { steps } => 1 + (step - 1) / steps,
        };
        let rate = self.settings.learning_rate.at(count);
        self.state = next;
        match &mut self.table {
            LearningTable::Free(learner) => {
                learner.learn(state, action, reward, Some(next), rate)?;
                Ok(reward)
            }
            LearningTable::Model(learner) => {
                learner.learn(state, action, reward, Some(next), rate)?;
                Ok(learner.mean_rewards()[state * self.mdp.actions() + action])
            }
        }
    }
}

/// The table that learns, of either kind.
enum LearningTable {
    Free(QLambda),
    Model(ModelBuilding),
}

impl LearningTable {
    fn new(mdp: &Mdp, settings: &TrialSettings, first: &[f64]) -> Result<Self> {
        let (states, actions, discount) = (mdp.states(), mdp.actions(), settings.discount);
        match settings.learner {
            Learner::QLambda { trace_decay, trace, cut } => {
                let settings =
                    QLambdaSettings { states, actions, discount, trace_decay, trace, cut };
                Ok(Self::Free(QLambda::new(settings)?.starting_from(first)?))
            }
            Learner::ModelBuilding { trace_decay, counts } => {
                let settings =
                    ModelBuildingSettings { states, actions, discount, trace_decay, counts };
                Ok(Self::Model(ModelBuilding::new(settings)?.starting_from(first)?))
            }
        }
    }

    #[inline]
    fn values(&self) -> &[f64] {
        match self {
            Self::Free(learner) => learner.values(),
            Self::Model(learner) => learner.values(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Ties;
    use super::*;

    fn settings(learner: Learner) -> TrialSettings {
        TrialSettings {
            learner,
            discount: 0.9,
            learning_rate: Schedule::power("learning rate", 1.0, 0.7).unwrap(),
            per: Per::Visit,
            policy: Policy::epsilon_greedy(1.0, Ties::First).unwrap(),
            first_values: (0.0, 0.0),
            checkpoints: vec![1000, 3000, 10_000],
        }
    }

    fn run(settings: &TrialSettings, seed: u64) -> Trial {
        let mdp = Mdp::garnet(20, 3, 5, seed).unwrap();
        Trial::run(&mdp, settings, seed, &Control::new()).unwrap()
    }

    const MODEL: Learner = Learner::ModelBuilding { trace_decay: 0.9, counts: Counts::Thesis };
    const NAIVE: Learner =
        Learner::QLambda { trace_decay: 0.9, trace: Trace::Replacing, cut: Cut::Never };

    #[test]
    fn model_building_approaches_the_optimum_within_the_bound() {
        for seed in 0..3 {
            let trial = run(&settings(MODEL), seed);
            assert!(trial.errors[2] < 0.5 * trial.errors[0], "{:?}", trial.errors);
            assert_eq!(trial.watched[0].violations(), 0);
            assert!(trial.largest.iter().zip(&trial.bounds).all(|(q, bound)| q <= bound));
            assert!(trial.watched[0].closest() > 0.1);
        }
    }

    #[test]
    fn naive_traces_break_the_bound() {
        for seed in 0..3 {
            let trial = run(&settings(NAIVE), seed);
            assert!(trial.watched[0].violations() > 0);
            assert!(trial.errors[0] > 10.0 * trial.optimum.values[0].abs(), "{:?}", trial.errors);
        }
    }

    #[test]
    fn values_beyond_all_numbers_end_a_trial() {
        let constant = Schedule::power("learning rate", 1.0, 0.0).unwrap();
        let checkpoints = vec![1000, 10_000, 40_000];
        let learner =
            Learner::QLambda { trace_decay: 0.9, trace: Trace::Accumulating, cut: Cut::Never };
        let trial =
            run(&TrialSettings { learning_rate: constant, checkpoints, ..settings(learner) }, 1);
        let step = trial.diverged_at.unwrap();
        assert!((10_000..40_000).contains(&step), "{step}");
        assert_eq!((trial.errors.len(), trial.errors[2]), (3, f64::INFINITY));
        assert!(trial.values.iter().all(|value| value.is_finite()));
    }

    #[test]
    fn rates_fall_by_what_they_count() {
        let linear = Schedule::linear("learning rate", 0.0, 0.0, 1).unwrap();
        let still = run(&TrialSettings { learning_rate: linear, ..settings(MODEL) }, 0);
        assert!(still.values.iter().all(|value| *value == 0.0));
        let [visit, step, episode, long] =
            [Per::Visit, Per::Step, Per::Episode { steps: 1 }, Per::Episode { steps: 10_000 }]
                .map(|per| run(&TrialSettings { per, ..settings(MODEL) }, 0));
        assert_ne!(visit.values, step.values);
        assert_eq!(step.values, episode.values);
        let one = Schedule::power("learning rate", 1.0, 0.0).unwrap();
        assert_eq!(
            long.values,
            run(&TrialSettings { learning_rate: one, ..settings(MODEL) }, 0).values
        );
    }

    #[test]
    fn impossible_settings_are_refused_and_a_stop_obeyed() {
        let good = settings(MODEL);
        let mdp = Mdp::garnet(4, 2, 2, 0).unwrap();
        for bad in [
            TrialSettings { checkpoints: vec![], ..good.clone() },
            TrialSettings { checkpoints: vec![0, 5], ..good.clone() },
            TrialSettings { checkpoints: vec![5, 5], ..good.clone() },
            TrialSettings { first_values: (1.0, 0.0), ..good.clone() },
            TrialSettings { first_values: (0.0, f64::INFINITY), ..good.clone() },
            TrialSettings { discount: 1.0, ..good.clone() },
            TrialSettings { per: Per::Episode { steps: 0 }, ..good.clone() },
        ] {
            assert!(Trial::run(&mdp, &bad, 0, &Control::new()).is_err());
        }
        let control = Control::new();
        assert!(Trial::run(&mdp, &good, 0, &control).is_ok());
        assert_eq!(control.done(), 10_000);
        control.cancel();
        assert_eq!(Trial::run(&mdp, &good, 0, &control), Err(Error::Cancelled));
    }
}
