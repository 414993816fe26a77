//! Eligibility traces of a table: which pairs of state and action a TD error still reaches.
//!
//! A trace decays by γλ at each step, so only a few pairs are alive at a time. They are kept in a
//! list; a sweep over the whole table would do the same work on zeros (a test compares the two).

use std::collections::VecDeque;

use crate::check;
use crate::error::Result;

/// What a visit does to the traces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trace {
    /// The visited pair's trace becomes 1 (2.46).
    Replacing,
    /// The same, and those of the state's other actions become 0 (2.47).
    ReplacingState,
}

impl Trace {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Replacing => "replacing",
            Self::ReplacingState => "replacing_state",
        }
    }

    /// The kind with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("trace", name, [Self::Replacing, Self::ReplacingState], Self::name)
    }
}

/// Traces smaller than this are dropped: all that is lost is a trillionth of a learning step.
const SMALLEST: f64 = 1e-12;

/// The live traces of a table with a fixed number of actions for each state.
#[derive(Debug, Clone)]
pub struct Traces {
    kind: Trace,
    actions: usize,
    /// Pair and trace, from the oldest to the latest.
    live: VecDeque<(u32, f64)>,
}

impl Traces {
    /// No live traces.
    pub fn new(kind: Trace, actions: usize) -> Self {
        Self { kind, actions, live: VecDeque::new() }
    }

    /// The same kind of traces with these live, from the oldest to the latest.
    pub(crate) fn with_live(&self, live: impl IntoIterator<Item = (u32, f64)>) -> Self {
        Self { live: live.into_iter().collect(), ..*self }
    }

    /// Ends all traces.
    pub fn clear(&mut self) {
        self.live.clear();
    }

    /// The live pairs (index into the table) and their traces, from the oldest to the latest.
    pub fn live(&self) -> &VecDeque<(u32, f64)> {
        &self.live
    }

    /// Decays every trace, marks the visited pair, and adds `step` times the trace to the value
    /// of each live pair (2.47, 2.48): Q(s, a) += αΔ·e(s, a).
    #[inline]
    pub fn visit_and_update(&mut self, pair: usize, decay: f64, step: f64, values: &mut [f64]) {
        let (first, count) = match self.kind {
            Trace::Replacing => (pair, 1),
            Trace::ReplacingState => (pair - pair % self.actions, self.actions),
        };
        // All traces decay alike, so the oldest are the smallest.
        while self.live.front().is_some_and(|&(_, trace)| trace * decay < SMALLEST) {
            self.live.pop_front();
        }
        // Each visit replaced what it found, so there is one at most.
        let replaced = |&(other, _): &(u32, f64)| (other as usize).wrapping_sub(first) < count;
        if let Some(index) = self.live.iter().position(replaced) {
            self.live.remove(index);
        }
        for (other, trace) in &mut self.live {
            *trace *= decay;
            let value = &mut values[*other as usize];
            *value = step.mul_add(*trace, *value);
        }
        self.live.push_back((pair as u32, 1.0));
        values[pair] += step;
    }
}
