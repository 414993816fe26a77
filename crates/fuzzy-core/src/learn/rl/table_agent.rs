//! Q(λ) for continuous observations and actions: a grid of states, a list of actions.

use serde::{Deserialize, Serialize};

use super::{Agent, Cut, Discretiser, Policy, QLambda, QLambdaSettings, Ties, Trace};
use crate::check;
use crate::error::{Error, Result};
use crate::learn::schedule::Schedule;
use crate::rng::Rng;

/// How a [`TableAgent`] explores, and what its exploration rate is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exploring {
    /// With probability ε any action, otherwise the greedy one (2.54); the rate is ε.
    EpsilonGreedy,
    /// By Boltzmann's distribution (2.56); the rate is the temperature θ, above zero.
    Softmax,
}

impl Exploring {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::EpsilonGreedy => "epsilon-greedy",
            Self::Softmax => "softmax",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("exploration", name, [Self::EpsilonGreedy, Self::Softmax], Self::name)
    }

    /// The choice of actions at an exploration rate.
    fn at(self, rate: f64) -> Policy {
        match self {
            Self::EpsilonGreedy => Policy::EpsilonGreedy { exploration: rate, ties: Ties::First },
            Self::Softmax => Policy::Softmax { temperature: rate },
        }
    }

    /// Nothing, if these exploration rates make sense.
    fn check(self, rates: &Schedule) -> Result<()> {
        match self {
            Self::EpsilonGreedy => {
                let fraction = |rate| (0.0..=1.0).contains(&rate);
                rates.check("exploration rate", "between 0 and 1", fraction)
            }
            Self::Softmax => rates.check("temperature", "positive", |rate| rate > 0.0),
        }
    }
}

/// What a [`TableAgent`] is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct TableAgentSettings {
    /// The states.
    pub states: Discretiser,
    /// The actions, one after the other; each has as many numbers as an action of the world.
    pub actions: Vec<Vec<f64>>,
    /// The discount γ, in [0, 1].
    pub discount: f64,
    /// The trace decay λ, in [0, 1].
    pub trace_decay: f64,
    /// What a visit does to the traces.
    pub trace: Trace,
    /// When traces end.
    pub cut: Cut,
    /// α by episode.
    pub learning_rate: Schedule,
    /// How actions are explored.
    pub exploring: Exploring,
    /// ε or θ by episode.
    pub exploration: Schedule,
}

/// What a [`TableAgent`] has learned, and where it stands.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TableAgentState {
    episode: u64,
    values: Vec<f64>,
    traces: Vec<(u32, f64)>,
    last: Option<(usize, usize)>,
    next: Option<(usize, usize)>,
}

impl TableAgentState {
    /// The number of values.
    pub fn pairs(&self) -> usize {
        self.values.len()
    }
}

/// Q(λ) on a grid of observations with a list of actions (Algorithm 6.4.1).
///
/// The next action is chosen before the values change, as the algorithm is printed. Traces live on
/// from episode to episode.
///
/// ```
/// use fuzzy_core::Rng;
/// use fuzzy_core::learn::rl::{
///     Agent, Cut, Discretiser, Exploring, TableAgent, TableAgentSettings, Trace,
/// };
/// use fuzzy_core::learn::schedule::Schedule;
///
/// // A point on a line is rewarded for being near 0; an action moves it.
/// let mut agent = TableAgent::new(TableAgentSettings {
///     states: Discretiser::new(&[(-1.0, 1.0, 11)])?,
///     actions: vec![vec![-0.2], vec![0.0], vec![0.2]],
///     discount: 0.9,
///     trace_decay: 0.5,
///     trace: Trace::ReplacingState,
///     cut: Cut::Never,
///     learning_rate: Schedule::power("learning rate", 0.5, 0.0)?,
///     exploring: Exploring::EpsilonGreedy,
///     exploration: Schedule::power("exploration rate", 0.3, 0.0)?,
/// })?;
/// let (mut rng, mut action) = (Rng::new(0, 0), [0.0]);
/// for episode in 1..=50 {
///     agent.begin_episode(episode);
///     let mut place: f64 = rng.uniform_in(-1.0, 1.0);
///     for _ in 0..20 {
///         agent.act(&[place], &mut action, &mut rng);
///         place = (place + action[0]).clamp(-1.0, 1.0);
///         agent.learn(-place.abs(), &[place], true, &mut rng)?;
///     }
/// }
/// agent.exploit(&[-0.6], &mut action);
/// assert_eq!(action, [0.2]);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TableAgent {
    settings: TableAgentSettings,
    /// The numbers of all actions.
    numbers: Vec<f64>,
    learner: QLambda,
    /// The number of the episode; 0 before the first.
    episode: u64,
    learning_rate: f64,
    policy: Policy,
    /// The state and the action that the next reward is for.
    last: Option<(usize, usize)>,
    /// The state reached and the action chosen there.
    next: Option<(usize, usize)>,
}

impl TableAgent {
    /// An agent whose values are all zero.
    pub fn new(settings: TableAgentSettings) -> Result<Self> {
        check::at_least("number of actions", settings.actions.len(), 2)?;
        let outputs = settings.actions[0].len();
        check::at_least("numbers of an action", outputs, 1)?;
        for action in &settings.actions {
            check::same_length("numbers of an action", outputs, action.len())?;
            check::all_finite("action", action)?;
        }
        let (expected, rate) = ("above 0 and at most 1", |rate| rate > 0.0 && rate <= 1.0);
        settings.learning_rate.check("learning rate", expected, rate)?;
        settings.exploring.check(&settings.exploration)?;
        let learner = QLambda::new(QLambdaSettings {
            states: settings.states.states(),
            actions: settings.actions.len(),
            discount: settings.discount,
            trace_decay: settings.trace_decay,
            trace: settings.trace,
            cut: settings.cut,
        })?;
        Ok(Self {
            numbers: settings.actions.concat(),
            learner,
            episode: 0,
            learning_rate: settings.learning_rate.at(1),
            policy: settings.exploring.at(settings.exploration.at(1)),
            last: None,
            next: None,
            settings,
        })
    }

    /// The number of the present episode; 0 if none was begun.
    pub fn episode(&self) -> u64 {
        self.episode
    }

    /// What the agent is made of.
    pub fn settings(&self) -> &TableAgentSettings {
        &self.settings
    }

    /// The table.
    pub fn learner(&self) -> &QLambda {
        &self.learner
    }

    /// The greedy action of every state (2.55).
    pub fn greedy_actions(&self) -> Vec<&[f64]> {
        self.learner.greedy_actions().into_iter().map(|action| self.numbers(action)).collect()
    }

    pub(crate) fn state(&self) -> TableAgentState {
        TableAgentState {
            episode: self.episode,
            values: self.learner.values().to_vec(),
            traces: self.learner.traces().live().iter().copied().collect(),
            last: self.last,
            next: self.next,
        }
    }

    /// The agent with what was learned before.
    pub(crate) fn restored(mut self, state: TableAgentState) -> Result<Self> {
        self.learner = self.learner.restored(state.values, &state.traces)?;
        let (states, actions) = (self.settings.states.states(), self.settings.actions.len());
        for (state, action) in state.last.into_iter().chain(state.next) {
            for (what, index, count) in [("state", state, states), ("action", action, actions)] {
                let expected = format!("below {count}");
                check::within(what, index as f64, &expected, |_| index < count)?;
            }
        }
        self.begin_episode(state.episode);
        (self.last, self.next) = (state.last, state.next);
        Ok(self)
    }

    #[inline]
    fn numbers(&self, action: usize) -> &[f64] {
        let outputs = self.outputs();
        &self.numbers[action * outputs..][..outputs]
    }
}

impl Agent for TableAgent {
    fn inputs(&self) -> usize {
        self.settings.states.coordinates()
    }

    #[inline]
    fn outputs(&self) -> usize {
        self.settings.actions[0].len()
    }

    fn begin_episode(&mut self, episode: u64) {
        self.episode = episode;
        self.learning_rate = self.settings.learning_rate.at(episode);
        self.policy = self.settings.exploring.at(self.settings.exploration.at(episode));
        (self.last, self.next) = (None, None);
    }

    #[inline]
    fn act(&mut self, observation: &[f64], action: &mut [f64], rng: &mut Rng) {
        let state = self.settings.states.state(observation);
        let chosen = match self.next.take() {
            Some((reached, chosen)) if reached == state => chosen,
            _ => self.policy.choose(self.learner.action_values(state), rng),
        };
        self.last = Some((state, chosen));
        action.copy_from_slice(self.numbers(chosen));
    }

    fn exploit(&mut self, observation: &[f64], action: &mut [f64]) {
        let state = self.settings.states.state(observation);
        action.copy_from_slice(self.numbers(self.learner.greedy_action(state)));
    }

    #[inline]
    fn learn(&mut self, reward: f64, next: &[f64], continues: bool, rng: &mut Rng) -> Result<f64> {
        let Some((state, action)) = self.last else {
            return Err(Error::OutOfOrder("there is nothing to learn from before the first act"));
        };
        let reached = self.settings.states.state(next);
        let chosen = self.policy.choose(self.learner.action_values(reached), rng);
        let ahead = continues.then_some(reached);
        let error = self.learner.learn(state, action, reward, ahead, self.learning_rate)?;
        (self.last, self.next) = (None, Some((reached, chosen)));
        Ok(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> TableAgentSettings {
        TableAgentSettings {
            states: Discretiser::new(&[(-1.0, 1.0, 3)]).unwrap(),
            actions: vec![vec![-1.0, 0.5], vec![1.0, 0.25]],
            discount: 0.5,
            trace_decay: 0.3,
            trace: Trace::ReplacingState,
            cut: Cut::Never,
            learning_rate: Schedule::power("learning rate", 1.0, 0.7).unwrap(),
            exploring: Exploring::EpsilonGreedy,
            exploration: Schedule::power("exploration rate", 0.0, 0.0).unwrap(),
        }
    }

    #[test]
    fn the_next_action_is_chosen_before_the_values_change() {
        let mut agent = TableAgent::new(settings()).unwrap();
        let (mut rng, mut action) = (Rng::new(0, 0), [0.0; 2]);
        agent.act(&[0.0], &mut action, &mut rng);
        assert_eq!(action, [-1.0, 0.5]);
        // The punished action was chosen for the same state again before the punishment counted.
        agent.learn(-1.0, &[0.1], true, &mut rng).unwrap();
        agent.act(&[0.1], &mut action, &mut rng);
        assert_eq!(action, [-1.0, 0.5]);
        agent.exploit(&[0.1], &mut action);
        assert_eq!(action, [1.0, 0.25]);
    }

    #[test]
    fn a_temperature_explores_by_the_values() {
        let hot = Schedule::Power { scale: 2.0, power: 1.0 };
        let softmax = |exploration| {
            let exploring = Exploring::Softmax;
            TableAgent::new(TableAgentSettings { exploring, exploration, ..settings() })
        };
        let mut agent = softmax(hot).unwrap();
        let (mut rng, mut action) = (Rng::new(0, 0), [0.0; 2]);
        agent.act(&[0.0], &mut action, &mut rng);
        agent.learn(-action[0], &[1.0], true, &mut rng).unwrap();
        let mut greedy = |episode| {
            agent.begin_episode(episode);
            let acts = (0..4000).map(|_| {
                agent.next = None;
                agent.act(&[0.0], &mut action, &mut rng);
                action[0]
            });
            acts.filter(|&first| first < 0.0).count() as f64 / 4000.0
        };
        // 1/(1 + exp(-Q/θ)), with a value of 1 or -1 for one of both and θ = 2 and 0.02.
        let (early, late) = (greedy(1), greedy(100));
        assert!((early - 0.622).abs() < 0.03, "{early}");
        assert_eq!(late, 1.0);
        assert!(softmax(Schedule::Power { scale: 0.0, power: 1.0 }).is_err());
        assert!(Exploring::from_name("softmx").unwrap_err().to_string().contains("softmax"));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let with =
            |actions: Vec<Vec<f64>>| TableAgent::new(TableAgentSettings { actions, ..settings() });
        assert!(with(vec![vec![1.0]]).is_err());
        assert!(with(vec![vec![], vec![]]).is_err());
        assert!(with(vec![vec![1.0], vec![1.0, 2.0]]).is_err());
        assert!(with(vec![vec![1.0], vec![f64::NAN]]).is_err());
        let mut agent = TableAgent::new(settings()).unwrap();
        let mut rng = Rng::new(0, 0);
        assert!(agent.learn(1.0, &[0.0], true, &mut rng).is_err());
        agent.act(&[0.0], &mut [0.0; 2], &mut rng);
        assert!(agent.learn(f64::NAN, &[0.0], true, &mut rng).is_err());
        assert!(agent.learner().values().iter().all(|&value| value == 0.0));
    }
}
