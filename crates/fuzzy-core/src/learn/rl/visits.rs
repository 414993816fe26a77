//! How often each pair of state and action was visited.

use super::table::Table;
use crate::error::Result;

/// Counts the visits of each pair, on which learning rates may depend.
///
/// ```
/// use fuzzy_core::learn::rl::Visits;
/// use fuzzy_core::learn::schedule::Schedule;
///
/// let mut visits = Visits::new(10, 2)?;
/// let rate = Schedule::power("learning rate", 1.0, 0.7)?;
/// assert_eq!(rate.at(visits.visit(3, 1)), 1.0);
/// assert_eq!(rate.at(visits.visit(3, 1)), rate.at(2));
/// assert_eq!(visits.of(3, 1), 2);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Visits {
    actions: usize,
    counts: Vec<u64>,
}

impl Visits {
    /// No visits.
    pub fn new(states: usize, actions: usize) -> Result<Self> {
        let counts = Table::new(states, actions)?.filled("the visits", 0)?;
        Ok(Self { actions, counts })
    }

    /// Counts a visit and returns how many there were with it.
    #[inline]
    pub fn visit(&mut self, state: usize, action: usize) -> u64 {
        let count = &mut self.counts[state * self.actions + action];
        *count += 1;
        *count
    }

    /// How often a pair was visited.
    pub fn of(&self, state: usize, action: usize) -> u64 {
        self.counts[state * self.actions + action]
    }

    /// The counts, state by state.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }
}
