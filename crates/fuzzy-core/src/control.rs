//! Stopping long work from outside, and watching how far it is.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::error::{Error, Result};

/// A handle shared by a computation and whoever waits for it.
///
/// The computation calls [`advance`](Self::advance) between pieces of work; the waiting side
/// reads [`done`](Self::done) and may [`cancel`](Self::cancel). Neither influences a result.
#[derive(Debug, Default)]
pub struct Control {
    cancelled: AtomicBool,
    done: AtomicU64,
}

impl Control {
    /// A handle on work that has not begun.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the computation to stop; it ends with [`Error::Cancelled`] at its next check.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Takes the request to stop back, when the work has ended.
    pub fn reset(&self) {
        self.cancelled.store(false, Ordering::Relaxed);
    }

    /// Whether a stop was asked for.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Pieces of work done so far, over everything that shares this handle.
    pub fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// Reports finished pieces of work, and ends with an error if a stop was asked for.
    pub fn advance(&self, pieces: u64) -> Result<()> {
        self.done.fetch_add(pieces, Ordering::Relaxed);
        self.check()
    }

    /// Nothing, or an error if a stop was asked for; for use within a long piece of work.
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }
}
