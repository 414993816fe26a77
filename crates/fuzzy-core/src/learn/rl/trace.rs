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
    /// The visited pair's trace decays as all do and 1 is added: (2.49) for a table, whose value of
    /// a pair has the derivative 1 by its own entry and 0 by the others.
    Accumulating,
}

impl Trace {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Replacing => "replacing",
            Self::ReplacingState => "replacing_state",
            Self::Accumulating => "accumulating",
        }
    }

    /// The kind with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let kinds = [Self::Replacing, Self::ReplacingState, Self::Accumulating];
        check::named("trace", name, kinds, Self::name)
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

    /// Gives each of the first `pairs` pairs a trace of 1, as chapter 5's algorithm begins.
    pub(super) fn fill(&mut self, pairs: usize) -> Result<()> {
        let mut live = check::filled("the traces", pairs, 1, (0_u32, 1.0))?;
        live.iter_mut().zip(0..).for_each(|((pair, _), index)| *pair = index);
        self.live = live.into();
        Ok(())
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
        let trace = self.take(pair, decay);
        for (other, trace) in &mut self.live {
            *trace *= decay;
            let value = &mut values[*other as usize];
            *value = step.mul_add(*trace, *value);
        }
        self.live.push_back((pair as u32, trace));
        values[pair] = step.mul_add(trace, values[pair]);
    }

    /// Decays every trace and marks the visited pair.
    #[inline]
    pub fn visit(&mut self, pair: usize, decay: f64) {
        let trace = self.take(pair, decay);
        self.live.iter_mut().for_each(|(_, trace)| *trace *= decay);
        self.live.push_back((pair as u32, trace));
    }

    /// Takes what a visit replaces out of the list, and what would become too small; returns the
    /// trace that the visited pair gets.
    #[inline]
    fn take(&mut self, pair: usize, decay: f64) -> f64 {
        let (first, count) = match self.kind {
            Trace::Replacing | Trace::Accumulating => (pair, 1),
            Trace::ReplacingState => (pair - pair % self.actions, self.actions),
        };
        // All traces decay alike, so the oldest are the smallest; where they accumulate an old one
        // may be larger, and keeps what follows it a little longer than need be.
        while self.live.front().is_some_and(|&(_, trace)| trace * decay < SMALLEST) {
            self.live.pop_front();
        }
        // Each visit replaced what it found, so there is one at most.
        let replaced = |&(other, _): &(u32, f64)| (other as usize).wrapping_sub(first) < count;
        let index = self.live.iter().position(replaced);
        let before = index.and_then(|index| self.live.remove(index));
        match (self.kind, before) {
            (Trace::Accumulating, Some((_, trace))) => trace.mul_add(decay, 1.0),
            _ => 1.0,
        }
    }
}
