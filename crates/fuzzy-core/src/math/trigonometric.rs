//! Sine, cosine, tangent, the angle of a vector, and angles brought back into one turn.

use std::f64::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI};

use super::Real;

// π/2 in three parts: with a fused multiply-add the reduction below loses nothing.
const HALF_PI_MIDDLE: f64 = 6.123_233_995_736_766e-17;
const HALF_PI_LOW: f64 = -1.497_384_904_859_169_8e-33;

/// (sin r − r)/r³ as a polynomial in r², for |r| ≤ π/4.
const SIN: [f64; 6] = [
    -0.166_666_666_666_666_32,
    0.008_333_333_333_322_418,
    -0.000_198_412_698_298_123_53,
    2.755_731_369_357_077e-6,
    -2.505_075_838_483_407_6e-8,
    1.589_681_185_805_929_6e-10,
];

/// (cos r − 1 + r²/2)/r⁴ as a polynomial in r², for |r| ≤ π/4.
const COS: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_413_1,
    2.480_158_728_948_717e-5,
    -2.755_731_435_382_994_3e-7,
    2.087_572_348_420_066e-9,
    -1.135_965_909_937_063_2e-11,
];

/// (arctan t − t)/t³ as a polynomial in t², for |t| ≤ tan(π/8).
const ATAN: [f64; 11] = [
    -0.333_333_333_333_332,
    0.199_999_999_999_540_4,
    -0.142_857_142_802_442_63,
    0.111_111_107_859_159_81,
    -0.090_908_978_298_117_52,
    0.076_920_615_147_901_34,
    -0.066_631_189_483_964_46,
    0.058_479_981_663_963_03,
    -0.050_397_957_918_155_63,
    0.038_077_027_183_852_36,
    -0.017_920_830_972_973_104,
];

const TAN_PI_8: f64 = 0.414_213_562_373_095_03;

/// Sine and cosine of an angle in radians, for |x| ≤ 2³⁰ (further out they lose digits).
#[inline(always)]
pub fn sin_cos<R: Real>(x: R) -> (R, R) {
    let (r, quadrant) = reduce(x);
    sin_cos_reduced(r, quadrant)
}

/// Sine and cosine of r + quadrant·π/2, for |r| ≤ π/4 and an integral quadrant.
#[inline(always)]
pub(super) fn sin_cos_reduced<R: Real>(r: R, quadrant: R) -> (R, R) {
    let square = r * r;
    let sine = (r * square).mul_add(square.polynomial(&SIN), r);
    let half = square.mul_add(R::splat(-0.5), R::splat(1.0));
    let cosine = (square * square).mul_add(square.polynomial(&COS), half);
    R::turn_quadrant(sine, cosine, quadrant)
}

/// x = r + quadrant·π/2 with |r| ≤ π/4.
#[inline(always)]
pub(super) fn reduce<R: Real>(x: R) -> (R, R) {
    let quadrant = (x * R::splat(FRAC_2_PI)).round();
    let r = quadrant.mul_add(R::splat(-FRAC_PI_2), x);
    let r = quadrant.mul_add(R::splat(-HALF_PI_MIDDLE), r);
    (quadrant.mul_add(R::splat(-HALF_PI_LOW), r), quadrant)
}

/// The tangent of an angle in radians, for |x| ≤ 2³⁰.
#[inline(always)]
pub fn tan<R: Real>(x: R) -> R {
    let (sine, cosine) = sin_cos(x);
    sine / cosine
}

/// The angle of the vector (x, y) in (−π, π]; 0 for the null vector, NaN if either is NaN.
#[inline(always)]
pub fn atan2<R: Real>(y: R, x: R) -> R {
    let (rise, run) = (y.abs(), x.abs());
    let steep = run.lt(rise);
    let small = R::select(steep, run, rise);
    let large = R::select(steep, rise, run);

    // arctan(small/large) in [0, π/4]: above tan(π/8), arctan a = π/4 + arctan((a − 1)/(a + 1)).
    let upper = (large * R::splat(TAN_PI_8)).lt(small);
    let numerator = R::select(upper, small - large, small);
    let denominator = R::select(upper, small + large, large);
    let null = large.le(R::splat(0.0));
    let t = numerator / R::select(null, R::splat(1.0), denominator);
    let square = t * t;
    let partial = (t * square).mul_add(square.polynomial(&ATAN), t);
    let octant = partial + R::select(upper, R::splat(FRAC_PI_4), R::splat(0.0));

    let quarter = R::select(steep, R::splat(FRAC_PI_2) - octant, octant);
    let half = R::select(x.lt(R::splat(0.0)), R::splat(PI) - quarter, quarter);
    half.copysign(y)
}

/// The same direction as an angle in (−π, π].
#[inline(always)]
pub fn wrap_angle<R: Real>(angle: R) -> R {
    let turns = (angle * R::splat(0.5 * FRAC_1_PI)).round();
    let r = turns.mul_add(R::splat(-2.0 * PI), angle);
    let r = turns.mul_add(R::splat(-4.0 * HALF_PI_MIDDLE), r);
    R::select(r.le(R::splat(-PI)), R::splat(PI), r)
}

#[cfg(test)]
mod tests {
    use super::super::Lanes;
    use super::*;

    fn sweep(low: f64, high: f64) -> impl Iterator<Item = f64> {
        let count = 200_001;
        (0..count).map(move |i| low + (high - low) * f64::from(i) / f64::from(count - 1))
    }

    #[test]
    fn sin_cos_tan_agree_with_the_standard_library() {
        for (low, high) in [(-10.0, 10.0), (-1e4, 1e4), (1e9 - 50.0, 1e9)] {
            for x in sweep(low, high) {
                let (sine, cosine) = sin_cos(x);
                assert!((sine - x.sin()).abs() <= 2.3e-16, "sin {x}: {sine} {}", x.sin());
                assert!((cosine - x.cos()).abs() <= 2.3e-16, "cos {x}: {cosine} {}", x.cos());
                let limit = 4e-16 * (1.0 + x.tan() * x.tan());
                assert!((tan(x) - x.tan()).abs() <= limit, "tan {x}");
            }
        }
    }

    #[test]
    fn quadrants_have_the_right_signs() {
        for k in -8..=8 {
            let x = f64::from(k) * FRAC_PI_2 + 0.3;
            let (sine, cosine) = sin_cos(x);
            assert!((sine - x.sin()).abs() < 1e-15 && (cosine - x.cos()).abs() < 1e-15, "{k}");
        }
    }

    #[test]
    fn atan2_agrees_with_the_standard_library() {
        for angle in sweep(-PI, PI) {
            for radius in [1e-9, 0.3, 1.0, 7e12] {
                let (y, x) = (radius * angle.sin(), radius * angle.cos());
                let (ours, theirs) = (atan2(y, x), y.atan2(x));
                assert!((ours - theirs).abs() <= 2.5 * f64::EPSILON * theirs.abs(), "{y} {x}");
            }
        }
    }

    #[test]
    fn atan2_of_the_axes_and_the_null_vector() {
        assert_eq!(atan2(0.0, 0.0), 0.0);
        assert_eq!(atan2(0.0, 1.0), 0.0);
        assert_eq!(atan2(1.0, 0.0), FRAC_PI_2);
        assert_eq!(atan2(-1.0, 0.0), -FRAC_PI_2);
        assert_eq!(atan2(0.0, -1.0), PI);
        assert_eq!(atan2(1.0, 1.0), FRAC_PI_4);
        assert!(atan2(f64::NAN, 1.0).is_nan());
        assert!(atan2(1.0, f64::NAN).is_nan());
    }

    #[test]
    fn wrapped_angles_point_the_same_way() {
        for angle in sweep(-100.0, 100.0) {
            let wrapped = wrap_angle(angle);
            assert!(wrapped > -PI && wrapped <= PI);
            let turns = (angle - wrapped) / (2.0 * PI);
            assert!((turns - turns.round()).abs() < 1e-14);
        }
        assert_eq!(wrap_angle(PI), PI);
        assert_eq!(wrap_angle(-PI), PI);
        assert_eq!(wrap_angle(0.0), 0.0);
    }

    #[test]
    fn lanes_and_scalars_agree_to_the_bit() {
        let values: Vec<f64> = sweep(-50.0, 50.0).collect();
        for chunk in values.chunks_exact(8) {
            let lanes = Lanes::new(chunk.try_into().unwrap());
            let (sine, cosine) = sin_cos(lanes);
            let wrapped = wrap_angle(lanes).to_array();
            let angle = atan2(lanes, Lanes::splat(1.7) - lanes).to_array();
            for i in 0..8 {
                assert_eq!((sine.to_array()[i], cosine.to_array()[i]), sin_cos(chunk[i]));
                assert_eq!(wrapped[i], wrap_angle(chunk[i]));
                assert_eq!(angle[i], atan2(chunk[i], 1.7 - chunk[i]));
            }
        }
    }
}
