//! Processes to learn on: random ones, and the gridworld of a textbook.

use super::Mdp;
use super::table::Table;
use crate::check;
use crate::error::Result;
use crate::rng::Rng;

/// The stream of a seed that processes are drawn from; learning draws from others.
const STREAM: u64 = 1 << 32;
/// Rows and columns of the gridworld.
const SIDE: usize = 5;

impl Mdp {
    /// A random process (Garnet; Archibald, McKinnon and Thomas 1995): each action leads to
    /// `branching` different states, whose probabilities are the pieces of the unit interval cut
    /// at random points. Mean rewards are drawn evenly from \[−1, 1\].
    ///
    /// ```
    /// use fuzzy_core::learn::rl::Mdp;
    /// let mdp = Mdp::garnet(20, 3, 5, 1)?;
    /// assert_eq!(mdp.transitions()[..20].iter().filter(|&&p| p > 0.0).count(), 5);
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn garnet(states: usize, actions: usize, branching: usize, seed: u64) -> Result<Self> {
        let table = Table::new(states, actions)?;
        check::at_least("branching", branching, 1)?;
        check::within("branching", branching as f64, "at most the number of states", |b| {
            b <= states as f64
        })?;
        let mut transitions = check::zeros("the transitions", table.pairs(), states)?;
        let mut rng = Rng::new(seed, STREAM);
        let mut order: Vec<usize> = (0..states).collect();
        for row in transitions.chunks_exact_mut(states) {
            let mut cuts: Vec<f64> = (1..branching).map(|_| rng.uniform()).collect();
            cuts.push(1.0);
            cuts.sort_by(f64::total_cmp);
            let mut last = 0.0;
            for (index, cut) in cuts.into_iter().enumerate() {
                // The first `branching` of a random order (Fisher and Yates).
                order.swap(index, index + rng.below(states - index));
                row[order[index]] = cut - last;
                last = cut;
            }
        }
        let rewards: Vec<f64> = (0..table.pairs()).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        Self::new(states, actions, &transitions, &rewards)
    }

    /// The 5 × 5 gridworld of Sutton and Barto (1998), example 3.8: actions 0 to 3 go north,
    /// south, east and west; a move off the grid stays and earns −1; from the second square of the
    /// first row every action leads to the last row and earns 10, from the fourth to the third row
    /// and earns 5. With probability `slip` the move is any of the four, each equally likely.
    ///
    /// ```
    /// use fuzzy_core::Control;
    /// use fuzzy_core::learn::rl::Mdp;
    /// let optimum = Mdp::gridworld(0.0)?.value_iteration(0.9, 1e-9, &Control::new())?;
    /// // The book prints 24.4 for the second square.
    /// assert_eq!((10.0 * optimum.values[4]).round(), 244.0);
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn gridworld(slip: f64) -> Result<Self> {
        const ACTIONS: usize = 4;
        check::fraction("slip", slip)?;
        let states = SIDE * SIDE;
        let mut transitions = vec![0.0; states * ACTIONS * states];
        let mut rewards = vec![0.0; states * ACTIONS];
        for state in 0..states {
            for action in 0..ACTIONS {
                let pair = state * ACTIONS + action;
                for moved in 0..ACTIONS {
                    let meant = if moved == action { 1.0 - slip } else { 0.0 };
                    let probability = meant + slip / ACTIONS as f64;
                    let (next, reward) = grid_move(state, moved);
                    transitions[pair * states + next] += probability;
                    rewards[pair] += probability * reward;
                }
            }
        }
        Self::new(states, ACTIONS, &transitions, &rewards)
    }
}

/// Where a move leads, and what it earns.
fn grid_move(state: usize, direction: usize) -> (usize, f64) {
    let (row, column) = (state / SIDE, state % SIDE);
    let end = SIDE - 1;
    match (row, column, direction) {
        (0, 1, _) => (end * SIDE + 1, 10.0),
        (0, 3, _) => (2 * SIDE + 3, 5.0),
        (0, _, 0) | (_, 0, 3) => (state, -1.0),
        (row, _, 1) if row == end => (state, -1.0),
        (_, column, 2) if column == end => (state, -1.0),
        (_, _, 0) => (state - SIDE, 0.0),
        (_, _, 1) => (state + SIDE, 0.0),
        (_, _, 2) => (state + 1, 0.0),
        _ => (state - 1, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;

    #[test]
    fn the_gridworld_has_the_values_that_the_book_prints() {
        let optimum = Mdp::gridworld(0.0).unwrap().value_iteration(0.9, 1e-9, &Control::new());
        let best: Vec<f64> = (optimum.unwrap().values.chunks(4))
            .map(|row| row.iter().copied().fold(f64::MIN, f64::max))
            .collect();
        let printed = [
            22.0, 24.4, 22.0, 19.4, 17.5, 19.8, 22.0, 19.8, 17.8, 16.0, 17.8, 19.8, 17.8, 16.0,
            14.4, 16.0, 17.8, 16.0, 14.4, 13.0, 14.4, 16.0, 14.4, 13.0, 11.7,
        ];
        for (value, printed) in best.iter().zip(printed) {
            assert!((value - printed).abs() <= 0.05 + 1e-9, "{value} {printed}");
        }
    }

    #[test]
    fn a_slip_makes_every_action_the_same_at_last() {
        let mdp = Mdp::gridworld(1.0).unwrap();
        for state in 0..25 {
            let rows = &mdp.transitions()[state * 100..][..100];
            assert!(rows.chunks(25).all(|row| row == &rows[..25]));
        }
        assert!(Mdp::gridworld(1.1).is_err());
    }

    #[test]
    fn random_processes_have_their_branching_and_differ_by_seed() {
        let mdp = Mdp::garnet(7, 2, 3, 4).unwrap();
        for row in mdp.transitions().chunks(7) {
            assert_eq!(row.iter().filter(|&&p| p > 0.0).count(), 3);
            assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
        assert_eq!(mdp, Mdp::garnet(7, 2, 3, 4).unwrap());
        assert_ne!(mdp, Mdp::garnet(7, 2, 3, 5).unwrap());
        assert!(Mdp::garnet(7, 2, 7, 0).is_ok());
        for (states, branching) in [(7, 0), (7, 8), (0, 1)] {
            assert!(Mdp::garnet(states, 2, branching, 0).is_err());
        }
    }
}
