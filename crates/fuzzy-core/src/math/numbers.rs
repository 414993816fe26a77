//! Vectors of numbers that a formula reads, in whatever form they are stored.

use super::{Dual, Lanes, Real};

/// Numbers that a formula reads by their index: shared by all lanes, or one for each lane.
pub trait Numbers<R> {
    /// The number at this index.
    fn number(&self, index: usize) -> R;

    /// The K numbers from this index on.
    #[inline(always)]
    fn block<const K: usize>(&self, first: usize) -> [R; K] {
        std::array::from_fn(|k| self.number(first + k))
    }
}

impl<R: Real> Numbers<R> for [f64] {
    #[inline(always)]
    fn number(&self, index: usize) -> R {
        R::splat(self[index])
    }

    #[inline(always)]
    fn block<const K: usize>(&self, first: usize) -> [R; K] {
        // One check of the bounds instead of K.
        let own = &self[first..first + K];
        std::array::from_fn(|k| R::splat(own[k]))
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

impl<const N: usize> Numbers<Dual<Lanes, N>> for [Dual<f64, N>] {
    #[inline(always)]
    fn number(&self, index: usize) -> Dual<Lanes, N> {
        let Dual { value, slopes } = self[index];
        Dual { value: Lanes::splat(value), slopes: slopes.map(Lanes::splat) }
    }
}

/// A number that is one value, so that decisions about it can be taken: a plain one, or one that
/// carries derivatives.
pub trait Scalar: Real<Mask = bool> {
    /// The value without derivatives.
    fn value(self) -> f64;
}

impl Scalar for f64 {
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
}

impl<const N: usize> Scalar for Dual<f64, N> {
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
}
