//! Minimax-Q(λ): learning a Markov game of two players with opposite rewards.

#[cfg(test)]
mod tests;

use super::matrix_game::MatrixGame;
use super::policy::{draw, larger, largest, smallest};
use super::q_lambda::check_step;
use super::table::Table;
use super::{Ties, Trace, Traces};
use crate::check;
use crate::control::Control;
use crate::error::Result;
use crate::rng::Rng;

/// How the players choose, and what a state is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Play {
    /// The player takes a* = argmaxₐ minₒ Q(s, a, o), the opponent answers it by argminₒ Q(s, a*, o).
    /// A state is worth maxₐ minₒ Q (8.1), what the player can be sure of if the opponent sees a*.
    Answer,
    /// The same, but the opponent makes itself sure too: argminₒ maxₐ Q(s, a, o).
    Security,
    /// Both play the mixed strategies of the [`MatrixGame`] Q(s, ·, ·), whose value is that of the
    /// state (Littman 1994).
    Mixed,
}

impl Play {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Answer => "answer",
            Self::Security => "security",
            Self::Mixed => "mixed",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::Answer, Self::Security, Self::Mixed];
        check::named("way to play", name, choices, Self::name)
    }
}

/// What a [`MinimaxQ`] learner is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MinimaxQSettings {
    /// The number of states.
    pub states: usize,
    /// The number of the player's actions.
    pub actions: usize,
    /// The number of the opponent's actions.
    pub opponent_actions: usize,
    /// The discount γ, in [0, 1].
    pub discount: f64,
    /// The trace decay λ, in [0, 1].
    pub trace_decay: f64,
    /// What a visit does to the traces; "the state's other actions" are its other joint actions.
    pub trace: Trace,
    /// How both choose.
    pub play: Play,
    /// Which of several equally good actions. With [`Ties::First`] a game that begins with equal
    /// values is hardly learned: of the opponent's answers only the first is ever tried.
    pub ties: Ties,
}

/// Probabilities of the player's and of the opponent's actions.
pub type Strategies = (Vec<f64>, Vec<f64>);

/// Tabular minimax-Q(λ): one table of the joint actions (a, o) for a game whose players have
/// opposite rewards.
///
/// In one step with learning rate α, the TD error Δ = r + γ V(s') − Q(s, a, o) moves every joint
/// action by αΔ times its trace (8.1 with the traces of 2.47 and 2.48). V is the value of the
/// state under the way to [`Play`].
///
/// Players of a game with any rewards, and any number of them, can learn independently instead,
/// each with a [`QLambda`](super::QLambda) of its own that sees the others as part of the world
/// (8.2, 8.3): a table of the own actions only, which needs fewer visits.
///
/// ```
/// use fuzzy_core::Rng;
/// use fuzzy_core::learn::rl::{MinimaxQ, MinimaxQSettings, Play, Ties, Trace};
///
/// // Matching pennies, played once an episode.
/// let mut learner = MinimaxQ::new(MinimaxQSettings {
///     states: 1,
///     actions: 2,
///     opponent_actions: 2,
///     discount: 0.0,
///     trace_decay: 0.0,
///     trace: Trace::ReplacingState,
///     play: Play::Mixed,
///     ties: Ties::Random,
/// })?;
/// let mut rng = Rng::new(0, 0);
/// for _ in 0..100 {
///     let (action, opponent) = learner.choose(0, 0.5, &mut rng)?;
///     let reward = if action == opponent { 1.0 } else { -1.0 };
///     learner.learn(0, (action, opponent), reward, None, 0.5)?;
/// }
/// let (own, _) = learner.strategies(0)?;
/// assert!((own[0] - 0.5).abs() < 1e-3);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct MinimaxQ {
    settings: MinimaxQSettings,
    values: Vec<f64>,
    traces: Traces,
    /// minₒ Q(s, a, o) of each of the player's actions, state by state; NaN where the values changed
    /// since it was looked for.
    minima: Vec<f64>,
    /// A number for each of the opponent's actions, while choosing.
    other: Vec<f64>,
    /// In which order the matrix game has the actions: it prefers some to others.
    order: (Vec<usize>, Vec<usize>),
    game: MatrixGame,
    /// A state and its value since the values changed last.
    evaluated: Option<(usize, f64)>,
}

impl MinimaxQ {
    /// A learner whose values are all zero.
    pub fn new(settings: MinimaxQSettings) -> Result<Self> {
        let MinimaxQSettings { states, actions, opponent_actions, .. } = settings;
        check::at_least("number of actions", actions, 1)?;
        check::at_least("number of the opponent's actions", opponent_actions, 1)?;
        let joint = actions.saturating_mul(opponent_actions);
        let table = Table::new(states, joint)?;
        check::fraction("discount", settings.discount)?;
        check::fraction("trace decay", settings.trace_decay)?;
        Ok(Self {
            settings,
            values: table.filled("the table", 0.0)?,
            traces: Traces::new(settings.trace, joint),
            minima: Table::new(states, actions)?.filled("the least values", f64::NAN)?,
            other: vec![0.0; opponent_actions],
            order: ((0..actions).collect(), (0..opponent_actions).collect()),
            game: MatrixGame::new(actions, opponent_actions)?,
            evaluated: None,
        })
    }

    /// The learner with other first values, in the order of [`values`](Self::values).
    pub fn starting_from(mut self, values: &[f64]) -> Result<Self> {
        check::same_length("first values", self.values.len(), values.len())?;
        check::all_finite("first values", values)?;
        self.values.copy_from_slice(values);
        self.minima.fill(f64::NAN);
        self.evaluated = None;
        Ok(self)
    }

    /// What the learner is made of.
    pub fn settings(&self) -> &MinimaxQSettings {
        &self.settings
    }

    /// The table Q(s, a, o), state by state, and for each of the player's actions all of the
    /// opponent's.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The traces.
    pub fn traces(&self) -> &Traces {
        &self.traces
    }

    /// Ends all eligibility traces, as one may wish to between episodes.
    pub fn clear_traces(&mut self) {
        self.traces.clear();
    }

    /// The payoffs Q(s, ·, ·) of a state, for each of the player's actions all of the opponent's.
    #[inline]
    pub fn joint_values(&self, state: usize) -> &[f64] {
        let joint = self.joint();
        &self.values[state * joint..][..joint]
    }

    /// The value V(s) of a state.
    pub fn value(&self, state: usize) -> Result<f64> {
        let payoffs = self.joint_values(state);
        match self.settings.play {
            Play::Answer | Play::Security => Ok(self.max_min(payoffs)),
            Play::Mixed => self.game.clone().solve(payoffs),
        }
    }

    /// The actions of both players in a state: without exploration as [`Play`] says; each explores
    /// by itself with probability ε, and then any of its actions is as likely.
    ///
    /// The state must be below the number of states. A matrix game that cannot be solved is an
    /// error.
    #[inline]
    pub fn choose(&mut self, state: usize, epsilon: f64, rng: &mut Rng) -> Result<(usize, usize)> {
        let (action, opponent) = match self.settings.play {
            Play::Answer => self.answered(state, rng),
            Play::Security => self.secured(state, rng),
            Play::Mixed => self.mixed(state, rng)?,
        };
        let explore = |action: usize, actions: usize, rng: &mut Rng| {
            if rng.uniform() < epsilon { rng.below(actions) } else { action }
        };
        let action = explore(action, self.settings.actions, rng);
        Ok((action, explore(opponent, self.settings.opponent_actions, rng)))
    }

    /// Learns from one step in which the players chose the joint action (a, o), and returns the TD
    /// error Δ. `next` is the state reached, or `None` if the episode ended in one whose value is
    /// zero.
    ///
    /// A reward that is not finite, a step to be made beyond ±10²⁹⁰, or a matrix game that cannot
    /// be solved, is an error that leaves the table as it was.
    #[inline]
    pub fn learn(
        &mut self,
        state: usize,
        (action, opponent): (usize, usize),
        reward: f64,
        next: Option<usize>,
        learning_rate: f64,
    ) -> Result<f64> {
        let ahead = match (next, self.evaluated) {
            (None, _) => 0.0,
            (Some(next), Some((state, value))) if state == next => value,
            (Some(next), _) => self.evaluate(next)?,
        };
        let pair = state * self.joint() + action * self.settings.opponent_actions + opponent;
        let error = self.settings.discount.mul_add(ahead, reward) - self.values[pair];
        let step = learning_rate * error;
        check_step(step)?;
        let decay = self.settings.discount * self.settings.trace_decay;
        self.traces.visit_and_update(pair, decay, step, &mut self.values);
        for &(changed, _) in self.traces.live() {
            self.minima[changed as usize / self.settings.opponent_actions] = f64::NAN;
        }
        self.evaluated = None;
        Ok(error)
    }

    /// The probabilities with which each player, seen alone, [`choose`](Self::choose)s without
    /// exploration: an opponent that answers one of several a* goes with it. Of several solutions of
    /// a matrix game it is the one found first, with the actions in their order; choices take them
    /// in a random order.
    pub fn strategies(&self, state: usize) -> Result<Strategies> {
        let MinimaxQSettings { actions, opponent_actions, play, ties, .. } = self.settings;
        let payoffs = self.joint_values(state);
        if play == Play::Mixed {
            let mut game = self.game.clone();
            game.solve(payoffs)?;
            return Ok((game.row_strategy().to_vec(), game.column_strategy().to_vec()));
        }
        let rows = || payoffs.chunks_exact(opponent_actions);
        let minima: Vec<f64> = rows().map(smallest).collect();
        let own = evenly(&minima, ties);
        if play == Play::Security {
            let mut other = vec![f64::NEG_INFINITY; opponent_actions];
            rows().for_each(|row| raise(&mut other, row));
            return Ok((own, evenly(&negated(&other), ties)));
        }
        let mut other = vec![0.0; opponent_actions];
        for (row, chosen) in rows().zip(&own).take(actions).filter(|(_, chosen)| **chosen > 0.0) {
            let answer = evenly(&negated(row), ties);
            other.iter_mut().zip(answer).for_each(|(sum, p)| *sum = chosen.mul_add(p, *sum));
        }
        Ok((own, other))
    }

    /// The number of joint actions.
    #[inline]
    fn joint(&self) -> usize {
        self.settings.actions * self.settings.opponent_actions
    }

    /// maxₐ minₒ of a state's payoffs.
    #[inline]
    fn max_min(&self, payoffs: &[f64]) -> f64 {
        let rows = payoffs.chunks_exact(self.settings.opponent_actions);
        rows.map(smallest).fold(f64::NEG_INFINITY, larger)
    }

    /// The value of a state that was not chosen in before.
    #[inline]
    fn evaluate(&mut self, state: usize) -> Result<f64> {
        let (joint, columns) = (self.joint(), self.settings.opponent_actions);
        let payoffs = &self.values[state * joint..][..joint];
        match self.settings.play {
            Play::Answer | Play::Security => Ok(self.max_min(payoffs)),
            Play::Mixed => {
                let payoff = |row, column| payoffs[row * columns + column];
                self.game.solve_by(payoff, &Control::new())
            }
        }
    }

    /// a* = argmaxₐ minₒ Q(s, a, o).
    #[inline]
    fn own_choice(&mut self, state: usize, rng: &mut Rng) -> usize {
        let MinimaxQSettings { actions, opponent_actions, ties, .. } = self.settings;
        let joint = self.joint();
        let rows = self.values[state * joint..][..joint].chunks_exact(opponent_actions);
        let minima = &mut self.minima[state * actions..][..actions];
        for (least, row) in minima.iter_mut().zip(rows).filter(|(least, _)| least.is_nan()) {
            *least = smallest(row);
        }
        self.evaluated = Some((state, largest(minima)));
        ties.greedy(minima, rng)
    }

    /// a* and argminₒ Q(s, a*, o).
    #[inline]
    fn answered(&mut self, state: usize, rng: &mut Rng) -> (usize, usize) {
        let action = self.own_choice(state, rng);
        let columns = self.settings.opponent_actions;
        let row = &self.values[state * self.joint() + action * columns..][..columns];
        self.other.iter_mut().zip(row).for_each(|(other, payoff)| *other = -payoff);
        (action, self.settings.ties.greedy(&self.other, rng))
    }

    /// a* and argminₒ maxₐ Q(s, a, o).
    #[inline]
    fn secured(&mut self, state: usize, rng: &mut Rng) -> (usize, usize) {
        let action = self.own_choice(state, rng);
        let joint = self.joint();
        self.other.fill(f64::NEG_INFINITY);
        let rows = self.values[state * joint..][..joint].chunks_exact(self.other.len());
        rows.for_each(|row| raise(&mut self.other, row));
        self.other.iter_mut().for_each(|most| *most = -*most);
        (action, self.settings.ties.greedy(&self.other, rng))
    }

    /// Actions drawn from the strategies of the matrix game.
    fn mixed(&mut self, state: usize, rng: &mut Rng) -> Result<(usize, usize)> {
        let (joint, columns) = (self.joint(), self.settings.opponent_actions);
        if self.settings.ties == Ties::Random {
            shuffle(&mut self.order.0, rng);
            shuffle(&mut self.order.1, rng);
        }
        let payoffs = &self.values[state * joint..][..joint];
        let (rows, order) = &self.order;
        let payoff = |row: usize, column: usize| payoffs[rows[row] * columns + order[column]];
        let value = self.game.solve_by(payoff, &Control::new())?;
        self.evaluated = Some((state, value));
        let pick = |strategy: &[f64], order: &[usize], rng: &mut Rng| {
            // Rounding may lead past the end; any action with a probability is as good there.
            let place = draw(strategy.iter().copied(), rng);
            order[place.or_else(|| strategy.iter().position(|&p| p > 0.0)).unwrap_or(0)]
        };
        let action = pick(self.game.row_strategy(), rows, rng);
        Ok((action, pick(self.game.column_strategy(), order, rng)))
    }
}

/// Replaces each number by that of the row, where that is larger.
#[inline]
fn raise(most: &mut [f64], row: &[f64]) {
    most.iter_mut().zip(row).for_each(|(most, &payoff)| *most = larger(*most, payoff));
}

fn negated(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| -value).collect()
}

/// With which probabilities actions of these values are greedy.
fn evenly(values: &[f64], ties: Ties) -> Vec<f64> {
    let most = largest(values);
    let greedy = |&value: &f64| if value == most { 1.0 } else { 0.0 };
    let mut shares: Vec<f64> = values.iter().map(greedy).collect();
    match ties {
        Ties::First => {
            let rest = shares.iter().position(|&share| share > 0.0).map_or(0, |first| first + 1);
            shares[rest..].fill(0.0);
        }
        Ties::Random => {
            let count: f64 = shares.iter().sum();
            shares.iter_mut().for_each(|share| *share /= count);
        }
    }
    shares
}

/// Puts the items into an order of which each is as likely (Fisher and Yates).
fn shuffle(items: &mut [usize], rng: &mut Rng) {
    for last in (1..items.len()).rev() {
        items.swap(last, rng.below(last + 1));
    }
}
