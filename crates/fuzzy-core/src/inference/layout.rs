//! Where the parameters of terms stand in a flat parameter vector.

use crate::math::{Numbers, Real, Scalar};
use crate::membership::Shape;
use crate::variable::Variable;

/// A term's shape, and where its parameters stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TermSlot {
    pub shape: Shape,
    pub offset: usize,
    pub count: usize,
}

impl TermSlot {
    /// The terms of a variable whose parameters begin at `offset`, which is moved behind them.
    pub fn of_variable(variable: &Variable, offset: &mut usize) -> Vec<Self> {
        let mut slots = Vec::with_capacity(variable.terms().len());
        for term in variable.terms() {
            let count = term.function.parameters().len();
            slots.push(Self { shape: term.function.shape(), offset: *offset, count });
            *offset += count;
        }
        slots
    }

    /// The term's own part of a parameter vector.
    pub fn own<N>(self, parameters: &[N]) -> &[N] {
        &parameters[self.offset..][..self.count]
    }

    /// Whether the term's part of a vector is valid.
    pub fn accepts(self, parameters: &[f64]) -> bool {
        self.shape.accepts(self.own(parameters))
    }

    /// The numbers that the parameters are prepared into.
    pub fn prepared_count(self) -> usize {
        self.shape.prepared_count(self.count)
    }

    /// Prepares the term's part of a vector.
    pub fn prepare<N: Real>(self, parameters: &[N], prepared: &mut [N]) {
        self.shape.prepare(self.own(parameters), prepared);
    }

    /// The degrees of the term at fixed points.
    pub fn degrees<N: Scalar>(self, parameters: &[N], points: &[f64]) -> Vec<N>
    where
        [N]: Numbers<N>,
    {
        let mut prepared = vec![N::splat(0.0); self.prepared_count()];
        self.prepare(parameters, &mut prepared);
        let degree = |&y: &f64| {
            self.shape.prepared_degree(prepared.as_slice(), 0, prepared.len(), N::splat(y))
        };
        points.iter().map(degree).collect()
    }
}
