//! Vectors of numbers that a formula reads, in whatever form they are stored.

use super::{Dual, Lanes, Real};

/// Numbers that a formula reads by their index: shared by all lanes, or one for each lane.
pub trait Numbers<R> {
    /// The number at this index.
    fn number(&self, index: usize) -> R;
}

impl<R: Real> Numbers<R> for [f64] {
    #[inline(always)]
    fn number(&self, index: usize) -> R {
        R::splat(self[index])
    }
}

impl Numbers<Lanes> for [Lanes] {
    #[inline(always)]
    fn number(&self, index: usize) -> Lanes {
        self[index]
    }
}

impl<R: Real, const N: usize> Numbers<Dual<R, N>> for [Dual<R, N>] {
    #[inline(always)]
    fn number(&self, index: usize) -> Dual<R, N> {
        self[index]
    }
}
