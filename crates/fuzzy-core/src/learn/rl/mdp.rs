//! Finite Markov decision processes, and what is optimal in them.

use super::policy::largest;
use super::table::Table;
use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::rng::Rng;

/// A finite Markov decision process (2.5.1): from state s, action a leads to state j with
/// probability P(s, a, j) and earns r(s, a) on average.
///
/// ```
/// use fuzzy_core::Control;
/// use fuzzy_core::learn::rl::Mdp;
///
/// // Action 1 moves on to the other state and earns 1 in state 0; action 0 stays.
/// let stay_or_move = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];
/// let mdp = Mdp::new(2, 2, &stay_or_move, &[0.0, 1.0, 0.0, 0.0])?;
/// let optimum = mdp.value_iteration(0.5, 1e-12, &Control::new())?;
/// // V(0) = 1 + ½·½·V(0).
/// assert!((optimum.values[1] - 4.0 / 3.0).abs() <= optimum.error);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mdp {
    table: Table,
    /// P(s, a, j), a row of states for each pair.
    transitions: Vec<f64>,
    /// The states that each pair may lead to, with the probability of it or one before it.
    successors: Vec<Vec<(u32, f64)>>,
    rewards: Vec<f64>,
    reward_noise: f64,
}

/// How far the probabilities of a row may be from 1 in sum.
const SUM_TOLERANCE: f64 = 1e-9;

/// Optimal action values and how exact they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// Q*(s, a), state by state.
    pub values: Vec<f64>,
    /// No value is further from the true one.
    pub error: f64,
    /// Sweeps over the table that it took.
    pub sweeps: u64,
}

impl Mdp {
    /// A process from its transition probabilities, in the order (state, action, next state), and
    /// mean rewards (state, action). Probabilities are not negative and sum to 1 within 10⁻⁹ for
    /// each pair; they are divided by their sum.
    pub fn new(
        states: usize,
        actions: usize,
        transitions: &[f64],
        rewards: &[f64],
    ) -> Result<Self> {
        let table = Table::new(states, actions)?;
        check::same_length("mean rewards", table.pairs(), rewards.len())?;
        check::all_finite("mean rewards", rewards)?;
        if table.pairs().checked_mul(states) != Some(transitions.len()) {
            let expected = format!("{states} × {actions} × {states}");
            let (what, actual) = ("transition probabilities", transitions.len());
            return Err(Error::wrong_shape(what, expected, actual));
        }
        let mut own = Vec::with_capacity(transitions.len());
        let mut successors = Vec::with_capacity(table.pairs());
        for (pair, row) in transitions.chunks_exact(states).enumerate() {
            let place = || format!("state {}, action {}", pair / actions, pair % actions);
            let row = normalised(row).map_err(|error| error.at(place()))?;
            let mut below = 0.0;
            let possible = row.iter().enumerate().filter(|&(_, &probability)| probability > 0.0);
            successors.push(
                possible
                    .map(|(next, &probability)| {
                        below += probability;
                        (next as u32, below)
                    })
                    .collect(),
            );
            own.extend(row);
        }
        let (transitions, rewards) = (own, rewards.to_vec());
        Ok(Self { table, transitions, successors, rewards, reward_noise: 0.0 })
    }

    /// The process with rewards spread evenly over r(s, a) ± `half_width`.
    pub fn with_reward_noise(mut self, half_width: f64) -> Result<Self> {
        check::within("reward noise", half_width, "zero or more", |noise| noise >= 0.0)?;
        self.reward_noise = half_width;
        Ok(self)
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.table.states
    }

    /// The number of actions in each state.
    pub fn actions(&self) -> usize {
        self.table.actions
    }

    /// P(s, a, j), in this order.
    pub fn transitions(&self) -> &[f64] {
        &self.transitions
    }

    /// The mean rewards r(s, a), state by state.
    pub fn rewards(&self) -> &[f64] {
        &self.rewards
    }

    /// How far a reward may be from its mean.
    pub fn reward_noise(&self) -> f64 {
        self.reward_noise
    }

    /// Does an action, and returns the reward and the next state. State and action must be there.
    #[inline]
    pub fn step(&self, state: usize, action: usize, rng: &mut Rng) -> (f64, usize) {
        let pair = state * self.table.actions + action;
        let successors = &self.successors[pair];
        let drawn = rng.uniform();
        let index = successors.partition_point(|&(_, below)| below <= drawn);
        // The last sum may be smaller than 1 by rounding.
        let next = successors[index.min(successors.len() - 1)].0 as usize;
        let mean = self.rewards[pair];
        let noisy = self.reward_noise > 0.0;
        let noise = if noisy { rng.uniform_in(-1.0, 1.0) * self.reward_noise } else { 0.0 };
        (mean + noise, next)
    }

    /// Q* for a discount γ below 1, no further from the true one than `tolerance` times the
    /// largest of its values: Q ← r + γ Σ P max Q (2.42), over and over.
    ///
    /// A sweep that changes no value by more than d leaves an error of γd/(1 − γ) at most, and
    /// rounding adds to it; it is an error if the tolerance cannot be reached for that.
    pub fn value_iteration(
        &self,
        discount: f64,
        tolerance: f64,
        control: &Control,
    ) -> Result<Optimum> {
        check::within("discount", discount, "from 0 to below 1", |g| (0.0..1.0).contains(&g))?;
        check::positive("tolerance", tolerance)?;
        let Table { states, actions } = self.table;
        let mut values = self.rewards.clone();
        let mut best = check::zeros("the states' values", states, 1)?;
        let mut least_change = f64::INFINITY;
        for sweep in 1.. {
            control.check()?;
            for (best, row) in best.iter_mut().zip(values.chunks_exact(actions)) {
                *best = largest(row);
            }
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for (pair, value) in values.iter_mut().enumerate() {
                let ahead = self.expected(pair, &best);
                let new = discount.mul_add(ahead, self.rewards[pair]);
                change = change.max((new - *value).abs());
                size = size.max(new.abs());
                *value = new;
            }
            check::finite("value", size)?;
            // Each sum over the states rounds as often as it has terms.
            let rounding = (states + 4) as f64 * f64::EPSILON * size;
            let error = discount.mul_add(change, rounding) / (1.0 - discount);
            if error <= tolerance * size || size == 0.0 {
                return Ok(Optimum { values, error, sweeps: sweep });
            }
            if change <= rounding && change >= least_change {
                let reason = format!(
                    "rounding leaves an error of {error:e} for values up to {size:e}; ask for a \
                     larger tolerance or a smaller discount"
                );
                return Err(Error::Unsuitable { what: format!("tolerance {tolerance:e}"), reason });
            }
            least_change = change.min(least_change);
        }
        Err(Error::OutOfOrder("value iteration ends with a result or an error"))
    }

    /// Σⱼ P(s, a, j)·v(j).
    fn expected(&self, pair: usize, values: &[f64]) -> f64 {
        let row = &self.transitions[pair * self.table.states..][..self.table.states];
        let possible = self.successors[pair].iter();
        possible.map(|&(next, _)| row[next as usize] * values[next as usize]).sum()
    }
}

/// A row of probabilities divided by its sum, which must be near 1.
fn normalised(row: &[f64]) -> Result<Vec<f64>> {
    for &probability in row {
        check::within("a transition probability", probability, "between 0 and 1", |p| {
            (0.0..=1.0 + SUM_TOLERANCE).contains(&p)
        })?;
    }
    let sum: f64 = row.iter().sum();
    check::within("sum of the transition probabilities", sum, "1", |sum| {
        (sum - 1.0).abs() <= SUM_TOLERANCE
    })?;
    Ok(row.iter().map(|probability| probability / sum).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_optimum_satisfies_its_equation() {
        for seed in 0..5 {
            let mdp = Mdp::garnet(20, 3, 5, seed).unwrap();
            let optimum = mdp.value_iteration(0.9, 1e-12, &Control::new()).unwrap();
            let best: Vec<f64> = optimum
                .values
                .chunks(3)
                .map(|q| q.iter().copied().fold(f64::MIN, f64::max))
                .collect();
            for (pair, value) in optimum.values.iter().enumerate() {
                let row = &mdp.transitions()[20 * pair..][..20];
                let ahead: f64 = row.iter().zip(&best).map(|(p, v)| p * v).sum();
                let residual = mdp.rewards()[pair] + 0.9 * ahead - value;
                assert!(residual.abs() <= 2.0 * optimum.error, "{residual}");
            }
            assert!(optimum.error < 1e-10);
        }
    }

    #[test]
    fn the_stated_error_holds() {
        // One state, one action: Q* = 1/(1 − γ).
        let mdp = Mdp::new(1, 1, &[1.0], &[1.0]).unwrap();
        for tolerance in [0.5, 1e-3, 1e-9] {
            let optimum = mdp.value_iteration(0.99, tolerance, &Control::new()).unwrap();
            let error = (optimum.values[0] - 100.0).abs();
            assert!(error <= optimum.error && optimum.error <= tolerance * 100.0);
            assert!(error > optimum.error / 1.001 || error < 1e-12);
        }
        let error = mdp.value_iteration(0.99, 1e-18, &Control::new()).unwrap_err();
        assert!(error.to_string().contains("larger tolerance"), "{error}");
        assert!(mdp.value_iteration(1.0, 1e-9, &Control::new()).is_err());
    }

    #[test]
    fn a_stop_is_obeyed() {
        let control = Control::new();
        control.cancel();
        let mdp = Mdp::new(1, 1, &[1.0], &[1.0]).unwrap();
        assert_eq!(mdp.value_iteration(0.9, 1e-9, &control), Err(Error::Cancelled));
    }

    #[test]
    fn steps_follow_the_probabilities() {
        let mdp = Mdp::new(3, 1, &[0.2, 0.0, 0.8, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], &[1.0, 2.0, 3.0]);
        let mdp = mdp.unwrap().with_reward_noise(0.5).unwrap();
        let mut rng = Rng::new(0, 0);
        let drawn: Vec<(f64, usize)> = (0..20_000).map(|_| mdp.step(0, 0, &mut rng)).collect();
        let stayed = drawn.iter().filter(|(_, next)| *next == 0).count();
        // Five standard deviations.
        assert!(stayed.abs_diff(4000) < 283, "{stayed}");
        assert!(drawn.iter().all(|&(reward, next)| next != 1 && (0.5..1.5).contains(&reward)));
        let mean = drawn.iter().map(|(reward, _)| reward).sum::<f64>() / 20_000.0;
        assert!((mean - 1.0).abs() < 0.0103, "{mean}");
        assert_eq!(mdp.clone().with_reward_noise(0.0).unwrap().step(1, 0, &mut rng), (2.0, 0));
    }

    #[test]
    fn impossible_processes_are_refused() {
        let reason = |transitions: &[f64], rewards: &[f64]| {
            Mdp::new(2, 1, transitions, rewards).unwrap_err().to_string()
        };
        let sum = reason(&[1.0, 0.0, 0.5, 0.4], &[0.0; 2]);
        assert!(sum.starts_with("state 1, action 0: sum of the transition"), "{sum}");
        assert!(reason(&[1.5, -0.5, 0.5, 0.5], &[0.0; 2]).contains("between 0 and 1"));
        assert!(reason(&[f64::NAN, 1.0, 0.5, 0.5], &[0.0; 2]).contains("finite"));
        assert!(reason(&[1.0, 0.0, 1.0], &[0.0; 2]).contains("2 × 1 × 2"));
        assert!(reason(&[1.0, 0.0, 1.0, 0.0], &[0.0; 3]).contains("mean rewards"));
        assert!(reason(&[1.0, 0.0, 1.0, 0.0], &[0.0, f64::INFINITY]).contains("finite"));
        assert!(Mdp::new(0, 1, &[], &[]).is_err());
        assert!(Mdp::new(usize::MAX, usize::MAX, &[], &[]).is_err());
        let mdp = Mdp::new(1, 1, &[1.0], &[0.0]).unwrap();
        assert!(mdp.clone().with_reward_noise(-1.0).is_err());
        assert!(mdp.with_reward_noise(f64::NAN).is_err());
    }
}
