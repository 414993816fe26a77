//! Tables over states and actions.

use crate::check;
use crate::error::{Error, Result};

/// The size of a table with a row for each state: pair (s, a) has the index s·actions + a.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Table {
    pub states: usize,
    pub actions: usize,
}

impl Table {
    /// At least one of each, and fewer than 2³² pairs.
    pub fn new(states: usize, actions: usize) -> Result<Self> {
        check::at_least("number of states", states, 1)?;
        check::at_least("number of actions", actions, 1)?;
        let pairs = states.checked_mul(actions);
        if pairs.is_none_or(|pairs| u32::try_from(pairs).is_err()) {
            let actual = format!("{states} states × {actions} actions");
            return Err(Error::wrong_shape("size of the table", "fewer than 2³² pairs", actual));
        }
        Ok(Self { states, actions })
    }

    /// The number of pairs.
    pub fn pairs(self) -> usize {
        self.states * self.actions
    }

    /// A value for each pair.
    pub fn filled<T: Clone>(self, what: &str, value: T) -> Result<Vec<T>> {
        check::filled(what, self.states, self.actions, value)
    }
}
