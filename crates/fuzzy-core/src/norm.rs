//! Norms: how degrees are joined by AND (t-norms) and by OR (s-norms).
//!
//! Each t-norm T and the s-norm S of the same name are dual: S(a, b) = 1 − T(1 − a, 1 − b).
//! All are commutative, associative and monotone, with T(a, 1) = a and S(a, 0) = a, so that
//! T(a, 0) = 0 and the order of a chain doesn't matter but for rounding.

use crate::check;
use crate::error::{Error, Result};
use crate::math::Real;

/// A triangular norm, the AND of two degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TNorm {
    /// min(a, b).
    Min,
    /// a·b.
    Product,
    /// max(0, a + b − 1), the bounded difference.
    Lukasiewicz,
    /// min(a, b) where max(a, b) = 1, elsewhere 0.
    Drastic,
    /// a·b/(2 − (a + b − a·b)).
    Einstein,
    /// a·b/(a + b − a·b), and 0 where both are 0.
    Hamacher,
    /// min(a, b) where a + b > 1, elsewhere 0.
    Nilpotent,
}

/// A triangular conorm, the OR of two degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SNorm {
    /// max(a, b).
    Max,
    /// a + b − a·b; MATLAB's probor.
    ProbabilisticSum,
    /// min(1, a + b), the bounded sum.
    Lukasiewicz,
    /// max(a, b) where min(a, b) = 0, elsewhere 1.
    Drastic,
    /// (a + b)/(1 + a·b).
    Einstein,
    /// (a + b − 2a·b)/(1 − a·b), and 1 where both are 1.
    Hamacher,
    /// max(a, b) where a + b < 1, elsewhere 1.
    Nilpotent,
}

impl TNorm {
    /// Every t-norm.
    pub const ALL: [Self; 7] = [
        Self::Min,
        Self::Product,
        Self::Lukasiewicz,
        Self::Drastic,
        Self::Einstein,
        Self::Hamacher,
        Self::Nilpotent,
    ];

    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Min => "min",
            Self::Product => "product",
            Self::Lukasiewicz => "lukasiewicz",
            Self::Drastic => "drastic",
            Self::Einstein => "einstein",
            Self::Hamacher => "hamacher",
            Self::Nilpotent => "nilpotent",
        }
    }

    /// The t-norm with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("t-norm", name, Self::ALL, Self::name)
    }

    /// The norm of two degrees from 0 to 1.
    #[inline(always)]
    pub fn apply<R: Real>(self, a: R, b: R) -> R {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        match self {
            Self::Min => a.min(b),
            Self::Product => a * b,
            // Such that 1 is exactly neutral.
            Self::Lukasiewicz => (a.min(b) - (one - a.max(b))).max(zero),
            Self::Drastic => R::select(one.le(a.max(b)), a.min(b), zero),
            Self::Einstein => a * b / (R::splat(2.0) - SNorm::ProbabilisticSum.apply(a, b)),
            Self::Hamacher => {
                let either = SNorm::ProbabilisticSum.apply(a, b);
                R::select(zero.lt(either), a * b / either, zero)
            }
            Self::Nilpotent => R::select(one.lt(a + b), a.min(b), zero),
        }
    }
}

impl SNorm {
    /// Every s-norm.
    pub const ALL: [Self; 7] = [
        Self::Max,
        Self::ProbabilisticSum,
        Self::Lukasiewicz,
        Self::Drastic,
        Self::Einstein,
        Self::Hamacher,
        Self::Nilpotent,
    ];

    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Max => "max",
            Self::ProbabilisticSum => "probabilistic_sum",
            Self::Lukasiewicz => "lukasiewicz",
            Self::Drastic => "drastic",
            Self::Einstein => "einstein",
            Self::Hamacher => "hamacher",
            Self::Nilpotent => "nilpotent",
        }
    }

    /// The s-norm with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("s-norm", name, Self::ALL, Self::name)
    }

    /// The norm of two degrees from 0 to 1.
    #[inline(always)]
    pub fn apply<R: Real>(self, a: R, b: R) -> R {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        match self {
            Self::Max => a.max(b),
            // hi + lo·(1 − hi), so that 0 is exactly neutral and 1 exactly absorbs.
            Self::ProbabilisticSum => a.min(b).mul_add(one - a.max(b), a.max(b)),
            Self::Lukasiewicz => (a + b).min(one),
            Self::Drastic => R::select(a.min(b).le(zero), a.max(b), one),
            Self::Einstein => (a + b) / (one + a * b),
            Self::Hamacher => {
                let product = a * b;
                let either = Self::ProbabilisticSum.apply(a, b);
                let joined = (either - product) / (one - product);
                // Near 1 that would lose its digits; there the dual t-norm keeps them.
                let dual = one - TNorm::Hamacher.apply(one - a, one - b);
                R::select((a + b).lt(one), joined, dual)
            }
            Self::Nilpotent => R::select((a + b).lt(one), a.max(b), one),
        }
    }
}

/// How the conclusions of several rules about one output are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Aggregation {
    /// Added up without a bound, so that every rule counts.
    Sum,
    /// Joined by an s-norm.
    Norm(SNorm),
}

impl Aggregation {
    /// The name that files and messages use: "sum" or the name of the s-norm.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sum => "sum",
            Self::Norm(norm) => norm.name(),
        }
    }

    /// The aggregation with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        if name == Self::Sum.name() {
            return Ok(Self::Sum);
        }
        SNorm::from_name(name).map(Self::Norm).map_err(|_| {
            let known = SNorm::ALL.map(SNorm::name).into_iter().chain([Self::Sum.name()]);
            Error::unknown_name("aggregation", name, known)
        })
    }

    /// Two degrees joined.
    #[inline(always)]
    pub fn apply<R: Real>(self, a: R, b: R) -> R {
        match self {
            Self::Sum => a + b,
            Self::Norm(norm) => norm.apply(a, b),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees() -> impl Iterator<Item = f64> {
        (0..=20).map(|i| f64::from(i) / 20.0)
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn norms_keep_their_axioms() {
        for norm in TNorm::ALL {
            let and = |a: f64, b: f64| norm.apply(a, b);
            for (a, b) in degrees().flat_map(|a| degrees().map(move |b| (a, b))) {
                assert!(close(and(a, b), and(b, a)), "{norm:?}");
                assert!((0.0..=a.min(b) + 1e-15).contains(&and(a, b)), "{norm:?} {a} {b}");
                assert!(close(and(a, 1.0), a) && and(a, 0.0) == 0.0, "{norm:?}");
            }
        }
    }

    #[test]
    fn neutral_elements_were_missed_by_rounding() {
        for degree in (0..=1000).map(|i| f64::from(i) / 1000.0) {
            for (and, or) in TNorm::ALL.into_iter().zip(SNorm::ALL) {
                assert_eq!((and.apply(1.0, degree), and.apply(degree, 1.0)), (degree, degree));
                assert_eq!((or.apply(0.0, degree), or.apply(degree, 0.0)), (degree, degree));
                assert_eq!((or.apply(1.0, degree), or.apply(degree, 1.0)), (1.0, 1.0), "{or:?}");
            }
        }
    }

    #[test]
    fn norms_of_one_name_are_dual() {
        // Powers of two, so that 1 − a is exact and no jump is missed by rounding.
        let exact = || (0..=16).map(|i| f64::from(i) / 16.0);
        for (t, s) in TNorm::ALL.into_iter().zip(SNorm::ALL) {
            for (a, b) in exact().flat_map(|a| exact().map(move |b| (a, b))) {
                let dual = 1.0 - t.apply(1.0 - a, 1.0 - b);
                assert!(close(s.apply(a, b), dual), "{s:?} {a} {b}");
            }
        }
    }

    #[test]
    fn norms_are_associative() {
        let exact = || (0..=8).map(|i| f64::from(i) / 8.0);
        for (t, s) in TNorm::ALL.into_iter().zip(SNorm::ALL) {
            for a in exact() {
                for (b, c) in exact().flat_map(|b| exact().map(move |c| (b, c))) {
                    assert!(close(t.apply(t.apply(a, b), c), t.apply(a, t.apply(b, c))), "{t:?}");
                    assert!(close(s.apply(s.apply(a, b), c), s.apply(a, s.apply(b, c))), "{s:?}");
                }
            }
        }
    }

    #[test]
    fn names_lead_back() {
        assert!(TNorm::ALL.iter().all(|&norm| TNorm::from_name(norm.name()) == Ok(norm)));
        assert!(SNorm::ALL.iter().all(|&norm| SNorm::from_name(norm.name()) == Ok(norm)));
        assert_eq!(Aggregation::from_name("sum"), Ok(Aggregation::Sum));
        let message = Aggregation::from_name("summ").unwrap_err().to_string();
        assert_eq!(message, "unknown aggregation \"summ\"; did you mean \"sum\"?");
        assert!(TNorm::from_name("prodct").unwrap_err().to_string().contains("\"product\""));
    }
}
