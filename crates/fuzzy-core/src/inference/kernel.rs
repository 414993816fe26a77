//! The code of rule systems, made once.
//!
//! Every number type that a rule system is evaluated in gives a copy of all its formulas. Generic
//! functions are compiled in each crate that calls them, which took minutes; the functions here
//! have no type parameters, so the copies are made in this crate alone.

use super::jacobian::Slopes;
use super::plan::{Plan, Prepared};
use super::{Answer, Interface};
use crate::math::{Lanes, Real, Scalar};

/// Numbers that systems can be evaluated in, when their parameters are prepared as `N`.
pub trait Kernel<N: Real>: Real {
    /// [`Inference::infer`](super::Inference::infer) of a rule system.
    #[doc(hidden)]
    fn infer(
        plan: &Plan,
        interface: &Interface,
        prepared: &Prepared<N>,
        x: &[Self],
        scratch: &mut [Self],
        answers: &mut [Answer<Self>],
    );

    /// [`Rules::fire`](super::Rules::fire) of a rule system.
    #[doc(hidden)]
    fn fire(
        plan: &Plan,
        prepared: &Prepared<N>,
        x: &[Self],
        scratch: &mut [Self],
        strengths: &mut [Self],
    );
}

/// Numbers that the parameters of systems can be prepared as.
pub trait Parameter: Scalar {
    /// [`Inference::prepare`](super::Inference::prepare) of a rule system.
    #[doc(hidden)]
    fn prepare(plan: &Plan, parameters: &[Self]) -> Prepared<Self>;
}

macro_rules! kernels {
    ($($prepared:ty => $number:ty),* $(,)?) => {$(
        impl Kernel<$prepared> for $number {
            fn infer(
                plan: &Plan,
                interface: &Interface,
                prepared: &Prepared<$prepared>,
                x: &[Self],
                scratch: &mut [Self],
                answers: &mut [Answer<Self>],
            ) {
                let fallbacks = interface.outputs().iter().map(|(_, choice)| choice.fallback());
                plan.infer(prepared, x, scratch, fallbacks, answers);
            }

            fn fire(
                plan: &Plan,
                prepared: &Prepared<$prepared>,
                x: &[Self],
                scratch: &mut [Self],
                strengths: &mut [Self],
            ) {
                plan.fire(prepared, x, scratch, strengths);
            }
        }
    )*};
}
kernels!(
    f64 => f64,
    f64 => Lanes,
    f64 => Slopes,
    Slopes => Slopes,
    Slopes => Slopes<Lanes>,
);

macro_rules! parameters {
    ($($number:ty),*) => {$(
        impl Parameter for $number {
            fn prepare(plan: &Plan, parameters: &[Self]) -> Prepared<Self> {
                plan.prepare(parameters)
            }
        }
    )*};
}
parameters!(f64, Slopes);
