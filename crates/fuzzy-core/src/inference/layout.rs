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

    /// Whether terms of this kind and another can stand in one [`Run`].
    fn matches(self, other: Self) -> bool {
        (self.shape, self.count) == (other.shape, other.count)
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
        let degree =
            |&y: &f64| self.shape.prepared_degree(prepared.as_slice(), 0, self.count, N::splat(y));
        points.iter().map(degree).collect()
    }
}

/// Where the numbers of a conclusion stand in a flat parameter vector: a constant, or the
/// coefficients of the inputs and then a constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConsequentSlot {
    /// The place of the first.
    pub place: usize,
    /// How many they are.
    pub count: usize,
}

/// Terms of one shape about one input, whose degrees are taken in one loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    input: usize,
    term: TermSlot,
    /// Where their prepared numbers begin.
    prepared: usize,
    /// Which of the degrees are theirs.
    first: usize,
    last: usize,
}

impl Run {
    /// Runs of these terms with the numbers of their inputs, in this order.
    pub fn of_terms(terms: impl IntoIterator<Item = (usize, TermSlot)>) -> Vec<Self> {
        let mut runs: Vec<Self> = Vec::new();
        let mut prepared = 0;
        for (index, (input, term)) in terms.into_iter().enumerate() {
            match runs.last_mut() {
                Some(run) if run.input == input && run.term.matches(term) => run.last = index + 1,
                _ => runs.push(Self { input, term, prepared, first: index, last: index + 1 }),
            }
            prepared += term.prepared_count();
        }
        runs
    }

    /// Writes the degrees of the run's terms.
    #[inline(always)]
    pub fn write<R: Real, P: Numbers<R> + ?Sized>(self, prepared: &P, x: &[R], degrees: &mut [R]) {
        let degrees = &mut degrees[self.first..self.last];
        let TermSlot { shape, count, .. } = self.term;
        shape.prepared_degrees(prepared, self.prepared, count, x[self.input], degrees);
    }
}
