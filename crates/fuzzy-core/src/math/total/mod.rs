//! Elementary functions for any argument, as IEEE 754 defines them: for formulas that a user
//! writes. Their kin in [`math`](super) are faster and want arguments from a range.

mod far;
mod power;

use std::f64::consts::PI;

use super::trigonometric::{reduce, sin_cos_reduced};
use super::{Real, trigonometric};
use far::FAR;
pub use power::{exp, ln, pow};

/// The sine of an angle in radians; NaN at infinity.
#[inline(always)]
pub fn sin<R: Real>(x: R) -> R {
    sin_cos(x).0
}

/// The cosine of an angle in radians; NaN at infinity.
#[inline(always)]
pub fn cos<R: Real>(x: R) -> R {
    sin_cos(x).1
}

/// The tangent of an angle in radians; NaN at infinity.
#[inline(always)]
pub fn tan<R: Real>(x: R) -> R {
    let (sine, cosine) = sin_cos(x);
    sine / cosine
}

#[inline(always)]
fn sin_cos<R: Real>(x: R) -> (R, R) {
    let distant = R::splat(FAR).le(x.abs());
    let (near_r, near_quadrant) = reduce(R::select(distant, R::splat(0.0), x));
    let far_r = x.zip_with(x, |x, _| far::reduce(x).0);
    let far_quadrant = x.zip_with(x, |x, _| far::reduce(x).1);
    let r = R::select(distant, far_r, near_r);
    sin_cos_reduced(r, R::select(distant, far_quadrant, near_quadrant))
}

/// The angle of the vector (x, y) in [−π, π], where the signs of zeros and infinities count.
#[inline(always)]
pub fn atan2<R: Real>(y: R, x: R) -> R {
    // A quarter of the largest numbers leaves room for their sum; two infinities are a diagonal.
    let huge = R::select(x.abs().lt(y.abs()), y.abs(), x.abs());
    let scale = R::select(R::splat(1e300).lt(huge), R::splat(0.25), R::splat(1.0));
    let infinite = equal(x.abs(), f64::INFINITY) & equal(y.abs(), f64::INFINITY);
    let one = R::splat(1.0);
    let rise = R::select(infinite, one.copysign(y), y * scale);
    let run = R::select(infinite, one.copysign(x), x * scale);
    let angle = trigonometric::atan2(rise, run);
    let backwards = one.copysign(x).lt(R::splat(0.0)) & equal(x, 0.0) & equal(y, 0.0);
    R::select(backwards, R::splat(PI).copysign(y), angle)
}

#[inline(always)]
fn equal<R: Real>(x: R, value: f64) -> R::Mask {
    let value = R::splat(value);
    x.le(value) & value.le(x)
}

#[cfg(test)]
mod tests {
    use super::super::Lanes;
    use super::*;

    /// Every kind of number, and some with a meaning for one of the functions.
    const PLACES: [f64; 45] = [
        0.0,
        5e-324,
        1e-320,
        2.2e-308,
        f64::MIN_POSITIVE,
        1e-300,
        1e-160,
        1e-17,
        1e-3,
        0.25,
        1.0 / 3.0,
        0.5,
        0.75,
        1.0 - f64::EPSILON / 2.0,
        1.0,
        1.0 + f64::EPSILON,
        1.5,
        2.0,
        std::f64::consts::E,
        3.0,
        PI,
        5.0,
        7.0,
        10.0,
        63.0,
        64.0,
        65.0,
        100.5,
        101.0,
        700.0,
        700.1,
        709.5,
        709.782,
        745.0,
        746.0,
        1023.0,
        1074.0,
        1e9,
        1_073_741_824.0,
        1e15,
        9_007_199_254_740_993.0,
        1e22,
        1.2e308,
        1.7e308,
        f64::INFINITY,
    ];

    fn places() -> Vec<f64> {
        PLACES.iter().flat_map(|&x| [x, -x]).chain([f64::NAN]).collect()
    }

    /// Whether both are the same zero, infinity or NaN, or near each other.
    fn agree(ours: f64, theirs: f64, tolerance: f64) -> bool {
        if theirs == 0.0 {
            return ours == 0.0 && ours.is_sign_negative() == theirs.is_sign_negative();
        }
        // The last digit of a subnormal number is no small part of it.
        let allowed = (tolerance * theirs.abs()).max(5e-324);
        (ours.is_nan() && theirs.is_nan()) || ours == theirs || (ours - theirs).abs() <= allowed
    }

    #[test]
    fn functions_of_one_number_agree_with_the_standard_library() {
        type One = (&'static str, fn(f64) -> f64, fn(f64) -> f64);
        let functions: [One; 5] = [
            ("exp", exp, f64::exp),
            ("ln", ln, f64::ln),
            ("sin", |x| sin(x) + 0.0, |x| x.sin() + 0.0), // The sign of sin(−0) is not promised.
            ("cos", cos, f64::cos),
            ("tan", |x| tan(x) + 0.0, |x| x.tan() + 0.0),
        ];
        for (name, ours, theirs) in functions {
            for x in places() {
                let (ours, theirs) = (ours(x), theirs(x));
                assert!(agree(ours, theirs, 2e-15), "{name} {x:e}: {ours:e} {theirs:e}");
            }
        }
    }

    #[test]
    fn angles_many_turns_away_keep_their_digits() {
        let mut x = FAR * 0.9;
        while x < f64::INFINITY {
            for (ours, theirs) in [(sin(x), x.sin()), (cos(x), x.cos()), (tan(-x), (-x).tan())] {
                assert!(agree(ours, theirs, 1e-15), "{x:e}: {ours:e} {theirs:e}");
            }
            x *= 1.003_717;
        }
        // The double nearest to a multiple of π/2 (J.-M. Muller, Elementary Functions, 2016).
        let nearest = 6_381_956_970_095_103.0 * 2.0_f64.powi(797);
        assert_eq!(cos(nearest), -4.687_165_924_254_628e-19);
    }

    #[test]
    fn pow_agrees_with_the_standard_library() {
        for x in places() {
            for y in places() {
                let (ours, theirs) = (pow(x, y), x.powf(y));
                assert!(agree(ours, theirs, 3e-16), "{x:e}^{y:e}: {ours:e} {theirs:e}");
            }
        }
    }

    #[test]
    fn atan2_agrees_with_the_standard_library() {
        for y in places() {
            for x in places() {
                let (ours, theirs) = (atan2(y, x), y.atan2(x));
                assert!(agree(ours, theirs, 1e-15), "{y:e} {x:e}: {ours:e} {theirs:e}");
            }
        }
    }

    #[test]
    fn lanes_and_scalars_agree_to_the_bit() {
        let same = |lane: f64, scalar: f64| lane.to_bits() == scalar.to_bits() || lane.is_nan();
        for x in places() {
            for y in places() {
                let (lanes, others) = (Lanes::new([x; 8]), Lanes::new([y; 8]));
                let one: [(Lanes, f64); 7] = [
                    (exp(lanes), exp(x)),
                    (ln(lanes), ln(x)),
                    (sin(lanes), sin(x)),
                    (cos(lanes), cos(x)),
                    (tan(lanes), tan(x)),
                    (pow(lanes, others), pow(x, y)),
                    (atan2(lanes, others), atan2(x, y)),
                ];
                for (index, (lanes, scalar)) in one.into_iter().enumerate() {
                    let lane = lanes.to_array()[7];
                    assert_eq!(lane.is_nan(), scalar.is_nan(), "{index}: {x:e} {y:e}");
                    assert!(same(lane, scalar), "{index}: {x:e} {y:e}: {lane:e} {scalar:e}");
                }
            }
        }
    }
}
