//! The one door to transcendental functions.
//!
//! Every function here is written once, over [`Real`], which is either a scalar `f64` or eight
//! [`Lanes`] that go through the same operations in lock-step. Scalar and batch evaluation of
//! anything built on this module therefore agree to the last bit, on every machine: IEEE 754
//! fixes `+ - * /`, square root, fused multiply-add and rounding to an integer, and nothing else
//! is used. The standard library's `exp`, `sin`, … make no such promise and are not called.
//!
//! [`total`] has the functions for any argument whatever, for formulas that a user writes; the
//! others are faster and say which arguments they want.
//!
//! [`Dual`] numbers go through the same operations and carry derivatives along, so no formula
//! has to be written a second time for its gradient.
//!
//! The polynomials are minimax fits (Remez exchange at 50 digits) with errors below 2⁻⁵⁴ of the
//! result; the tests hold each function to 2 units in the last place of the standard library's.

mod dual;
mod elementary;
mod numbers;
mod real;
pub mod total;
mod trigonometric;

pub use dual::Dual;
pub use elementary::{exp, exp2_decay, ln, powf};
pub use numbers::{Numbers, Scalar};
pub use real::{LANES, Lanes, Real};
pub use trigonometric::{atan2, sin_cos, tan, wrap_angle};
