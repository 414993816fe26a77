//! Games of two players with opposite rewards: matrix games, and learning Markov games.

use fuzzy_core::learn::rl::{MatrixGame, MinimaxQ, MinimaxQSettings, Play, Ties, Trace, Visits};
use fuzzy_core::{Rng, check};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use crate::arrays::{Floats, Shape, array, whole, whole_or_none};
use crate::control::PyControl;
use crate::enter::{Watch, enter};
use crate::errors::Result;
use crate::q_lambda::{below, check_step};

/// The probabilities of one player's actions.
type Strategy<'py> = Bound<'py, PyArray1<f64>>;

/// The value of a zero-sum matrix game and a pair of optimal mixed strategies.
///
/// The row player picks a row, the column player a column, at the same time; the first wins the
/// payoff there and the second loses it.
///
/// Parameters
/// ----------
/// payoffs : array_like of shape (rows, columns)
///     What the row player wins.
/// control : Control, optional
///     To stop it from another thread.
///
/// Returns
/// -------
/// value : float
///     What the row player is sure to win on average, and need not win more.
/// rows : numpy.ndarray of shape (rows,)
///     Probabilities that secure it, to within 1e-9 of the payoffs' range.
/// columns : numpy.ndarray of shape (columns,)
///     Probabilities that concede no more.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> value, rows, columns = fz.solve_matrix_game([[3, -1], [-2, 1]])
/// >>> round(value, 4), rows.round(4).tolist(), columns.round(4).tolist()
/// (0.1429, [0.4286, 0.5714], [0.2857, 0.7143])
#[pyfunction]
#[pyo3(signature = (payoffs, *, control = None))]
pub fn solve_matrix_game<'py>(
    py: Python<'py>,
    payoffs: &Bound<'py, PyAny>,
    control: Option<&Bound<'py, PyControl>>,
) -> Result<(f64, Strategy<'py>, Strategy<'py>)> {
    let payoffs = Floats::new(payoffs, "payoffs")?;
    let &[rows, columns] = payoffs.shape() else {
        let (expected, came) = ("an array of shape (rows, columns)", Shape(payoffs.shape()));
        return Err(fuzzy_core::Error::wrong_shape("payoffs", expected, came).into());
    };
    let mut game = MatrixGame::new(rows, columns)?;
    let numbers = payoffs.as_slice()?.to_vec();
    let value =
        enter(py, &Watch::new(control, None), |control| game.solve_watched(&numbers, control))?;
    let strategy = |probabilities| PyArray1::from_slice(py, probabilities);
    Ok((value, strategy(game.row_strategy()), strategy(game.column_strategy())))
}

/// Tabular minimax-Q(λ): learning a Markov game of two players with opposite rewards.
///
/// One table has a value for each joint action, the player's and the opponent's. For players with
/// any rewards, and any number of them, give each a `QLambda` of its own instead.
///
/// Parameters
/// ----------
/// states, actions, opponent_actions : int
///     The size of the table.
/// discount, trace_decay : float, optional
///     γ and λ, both in [0, 1]; λ = 0 learns from one step at a time.
/// play : {"mixed", "answer", "security"}, optional
///     What a state is worth and how both choose: as the matrix game of its values says, by mixed
///     strategies (Littman 1994); the player by its largest minimum, which the opponent answers;
///     or both by their own largest minimum.
/// ties : {"random", "first"}, optional
///     Which of several equally good actions.
/// trace : {"replacing_state", "replacing", "accumulating"}, optional
///     As for `QLambda`, of joint actions.
/// first_value : float, optional
///     What all values begin at.
/// seed : int, optional
///     For the choices.
///
/// Examples
/// --------
/// Rock, paper, scissors:
///
/// >>> import fuzzyrs as fz
/// >>> learner = fz.MinimaxQ(1, 3, 3, discount=0, trace_decay=0, seed=1)
/// >>> for episode in range(200):
/// ...     own, other = learner.choose(0, exploration=0.5)
/// ...     reward = [0, 1, -1][(own - other) % 3]
/// ...     _ = learner.learn(0, own, other, reward, None, learning_rate=1)
/// >>> own, other = learner.strategies(0)
/// >>> own.round(3).tolist()
/// [0.333, 0.333, 0.333]
#[pyclass(name = "MinimaxQ", module = "fuzzyrs")]
pub struct PyMinimaxQ {
    learner: MinimaxQ,
    visits: Visits,
    rng: Rng,
}

#[pymethods]
impl PyMinimaxQ {
    #[new]
    #[pyo3(signature = (states, actions, opponent_actions, *, discount = 0.5, trace_decay = 0.3,
                        play = "mixed", ties = "random", trace = "replacing_state",
                        first_value = 0.0, seed = 0))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        #[pyo3(from_py_with = whole)] states: usize,
        #[pyo3(from_py_with = whole)] actions: usize,
        #[pyo3(from_py_with = whole)] opponent_actions: usize,
        discount: f64,
        trace_decay: f64,
        play: &str,
        ties: &str,
        trace: &str,
        first_value: f64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let learner = MinimaxQ::new(MinimaxQSettings {
            states,
            actions,
            opponent_actions,
            discount,
            trace_decay,
            trace: Trace::from_name(trace)?,
            play: Play::from_name(play)?,
            ties: Ties::from_name(ties)?,
        })?;
        let first = check::filled("the first values", learner.values().len(), 1, first_value)?;
        let learner = learner.starting_from(&first)?;
        let visits = Visits::new(states, actions * opponent_actions)?;
        Ok(Self { learner, visits, rng: Rng::new(seed, 0) })
    }

    /// The actions of both players in a state.
    ///
    /// Parameters
    /// ----------
    /// state : int
    ///     Where to act.
    /// exploration : float, optional
    ///     The probability of any action at random, in [0, 1], for each player by itself.
    ///
    /// Returns
    /// -------
    /// (int, int)
    ///     The player's action and the opponent's, which may be ignored if it chooses by itself.
    #[pyo3(signature = (state, exploration = 0.0))]
    fn choose(
        &mut self,
        #[pyo3(from_py_with = whole)] state: usize,
        exploration: f64,
    ) -> Result<(usize, usize)> {
        self.check_state(state)?;
        fuzzy_core::check::fraction("exploration rate", exploration)?;
        Ok(self.learner.choose(state, exploration, &mut self.rng)?)
    }

    /// Learn from one step, and return the TD error.
    ///
    /// Parameters
    /// ----------
    /// state, action, opponent_action : int
    ///     What was done.
    /// reward : float
    ///     What the player won and the opponent lost.
    /// next_state : int or None
    ///     Where it led; None if the episode ended there.
    /// learning_rate : float
    ///     α, in [0, 1].
    fn learn(
        &mut self,
        #[pyo3(from_py_with = whole)] state: usize,
        #[pyo3(from_py_with = whole)] action: usize,
        #[pyo3(from_py_with = whole)] opponent_action: usize,
        reward: f64,
        #[pyo3(from_py_with = whole_or_none)] next_state: Option<usize>,
        learning_rate: f64,
    ) -> Result<f64> {
        let settings = self.learner.settings();
        check_step((settings.states, settings.actions), state, action, reward, next_state)?;
        below("opponent_action", opponent_action, settings.opponent_actions)?;
        fuzzy_core::check::fraction("learning rate", learning_rate)?;
        let joint = action * settings.opponent_actions + opponent_action;
        let chosen = (action, opponent_action);
        let error = self.learner.learn(state, chosen, reward, next_state, learning_rate)?;
        self.visits.visit(state, joint);
        Ok(error)
    }

    /// How often a joint action was learned from in a state.
    fn visits(
        &self,
        #[pyo3(from_py_with = whole)] state: usize,
        #[pyo3(from_py_with = whole)] action: usize,
        #[pyo3(from_py_with = whole)] opponent_action: usize,
    ) -> Result<u64> {
        self.check_state(state)?;
        let settings = self.learner.settings();
        below("action", action, settings.actions)?;
        below("opponent_action", opponent_action, settings.opponent_actions)?;
        Ok(self.visits.of(state, action * settings.opponent_actions + opponent_action))
    }

    /// What the player can be sure of from a state on.
    fn value(&self, #[pyo3(from_py_with = whole)] state: usize) -> Result<f64> {
        self.check_state(state)?;
        Ok(self.learner.value(state)?)
    }

    /// The probabilities of the player's and of the opponent's actions without exploration, two
    /// arrays.
    fn strategies<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] state: usize,
    ) -> Result<(Strategy<'py>, Strategy<'py>)> {
        self.check_state(state)?;
        let (own, other) = self.learner.strategies(state)?;
        Ok((PyArray1::from_vec(py, own), PyArray1::from_vec(py, other)))
    }

    /// End all eligibility traces, as one may wish to between episodes.
    fn clear_traces(&mut self) {
        self.learner.clear_traces();
    }

    /// A copy of the table, shape (states, actions, opponent_actions).
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let settings = self.learner.settings();
        let shape = [settings.states, settings.actions, settings.opponent_actions];
        array(py, self.learner.values().to_vec(), &shape)
    }
}

impl PyMinimaxQ {
    fn check_state(&self, state: usize) -> Result<()> {
        below("state", state, self.learner.settings().states)
    }
}
