//! Which number has a given degree, for functions that rise or fall all the way.

use super::Shape;
use crate::math::{Real, ln};

/// The smallest degree that is looked up where the function only tends to 0.
const SMALLEST: f64 = 1e-150;
/// The largest degree that is looked up where the function only tends to 1.
const LARGEST: f64 = 1.0 - 0.5 * f64::EPSILON;

impl Shape {
    /// The number with this degree between 0 and 1; of many the nearest to the climb. NaN for a
    /// shape that is not [monotone](Self::is_monotone).
    ///
    /// A sigmoid never reaches 0 and 1, a concave function never 0: there the answer is where the
    /// degree is 1e-150 or 1 − 2⁻⁵³, so that a rule of strength 0 has a finite conclusion.
    pub(crate) fn inverse<R: Real>(self, p: &[R], degree: R) -> R {
        let one = R::splat(1.0);
        match self {
            Self::Ramp => degree.mul_add(p[1] - p[0], p[0]),
            Self::Sigmoid => {
                let degree = degree.max(R::splat(SMALLEST)).min(R::splat(LARGEST));
                p[0] + ln(degree / (one - degree)) / p[1]
            }
            Self::SShape => smooth_inverse(p[0], p[1], degree),
            Self::ZShape => smooth_inverse(p[1], p[0], degree),
            Self::Concave => {
                // degree = 1/(1 + (e − x)/(e − i))
                let way = one / degree.max(R::splat(SMALLEST)) - one;
                p[1] - way * (p[1] - p[0])
            }
            Self::Arc => {
                // degree = √(1 − (1 − u)²), so u = 1 − √(1 − degree²), here without cancellation.
                let rest = ((one - degree) * (one + degree)).sqrt();
                p[0] + (p[1] - p[0]) * (degree * degree / (one + rest))
            }
            _ => R::splat(f64::NAN),
        }
    }
}

/// Where a smooth climb from 0 at `foot` to 1 at `top` has this degree.
fn smooth_inverse<R: Real>(foot: R, top: R, degree: R) -> R {
    let (half, size) = (R::splat(0.5), top - foot);
    let rising = foot + size * (half * degree).sqrt();
    let settling = top - size * (half * (R::splat(1.0) - degree)).sqrt();
    R::select(degree.lt(half), rising, settling)
}

#[cfg(test)]
mod tests {
    use super::super::MembershipFunction;
    use super::*;

    #[test]
    fn every_degree_has_a_finite_inverse() {
        for shape in Shape::ALL.into_iter().filter(|shape| shape.is_monotone()) {
            for parameters in [[0.5, 2.0], [0.5, -2.0], [2.0, 0.5]] {
                let Ok(function) = MembershipFunction::new(shape, &parameters) else { continue };
                for degree in [0.0, 1e-300, 0.25, 0.5, 1.0] {
                    let x = function.inverse(degree).unwrap();
                    assert!(x.is_finite(), "{shape:?}");
                    assert!((function.degree(x) - degree).abs() < 1e-15, "{shape:?} {degree}");
                }
                assert_eq!(function.inverse(1.5), None);
                assert_eq!(function.inverse(f64::NAN), None);
            }
        }
        let sigmoid = MembershipFunction::new(Shape::Sigmoid, &[0.5, 2.0]).unwrap();
        let least = 0.5 + (1e-150_f64).ln() / 2.0;
        let most = 0.5 + 53.0 * std::f64::consts::LN_2 / 2.0;
        assert!((sigmoid.inverse(0.0).unwrap() - least).abs() < 1e-9);
        assert!((sigmoid.inverse(1.0).unwrap() - most).abs() < 1e-9);
        assert_eq!(MembershipFunction::gaussian(0.0, 1.0).unwrap().inverse(0.5), None);
    }
}
