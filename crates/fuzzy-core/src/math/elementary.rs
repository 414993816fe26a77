//! Exponential, logarithm and power.

use std::f64::consts::LOG2_E;

use super::Real;

pub(super) const LN_2_HIGH: f64 = std::f64::consts::LN_2;
pub(super) const LN_2_LOW: f64 = 2.319_046_813_846_299_6e-17; // ln 2 − LN_2_HIGH

/// (eʳ − 1 − r)/r² for |r| ≤ ½ ln 2.
pub(super) const EXP: [f64; 10] = [
    0.500_000_000_000_001_2,
    0.166_666_666_666_667,
    0.041_666_666_666_515_45,
    0.008_333_333_333_307_092,
    0.001_388_888_894_700_889_3,
    0.000_198_412_699_176_050_66,
    2.480_148_994_871_089_7e-5,
    2.755_721_612_357_781e-6,
    2.763_127_825_344_758_3e-7,
    2.511_791_088_966_205_2e-8,
];

/// (2ʳ − 1)/r for |r| ≤ ½.
const EXP2: [f64; 11] = [
    std::f64::consts::LN_2,
    0.240_226_506_959_101_33,
    0.055_504_108_664_821_74,
    0.009_618_129_107_593_396,
    0.001_333_355_814_637_882,
    0.000_154_035_304_580_118_57,
    1.525_273_386_770_773_8e-5,
    1.321_543_484_637_146_6e-6,
    1.017_804_640_590_968_2e-7,
    7.073_855_690_805_282e-9,
    4.457_393_849_876_815e-10,
];

/// (2 artanh(s) − 2s)/s³ as a polynomial in s², for s ≤ (√2 − 1)/(√2 + 1).
const LN: [f64; 7] = [
    0.666_666_666_666_673_4,
    0.399_999_999_994_143,
    0.285_714_287_424_789_7,
    0.222_221_985_631_318_48,
    0.181_835_648_831_777_55,
    0.153_140_354_369_256_38,
    0.147_961_093_360_328_03,
];

/// Below this, eˣ is flushed to zero (the results there are below 3.4e-308).
const EXP_UNDERFLOW: f64 = -708.0;
/// Above this, eˣ counts as infinite (the results there are above 1.2e308).
const EXP_OVERFLOW: f64 = 709.4;

/// eˣ. Zero below −708, infinity above 709.4, so that 2ᵏ below is a normal number; NaN stays NaN.
#[inline(always)]
pub fn exp<R: Real>(x: R) -> R {
    // eˣ = 2ᵏ·eʳ with k = round(x/ln 2), so |r| ≤ ½ ln 2.
    let k = (x * R::splat(LOG2_E)).round();
    let r = k.mul_add(R::splat(-LN_2_HIGH), x);
    let r = k.mul_add(R::splat(-LN_2_LOW), r);
    let tail = r.polynomial(&EXP);
    let power = (r * r).mul_add(tail, r) + R::splat(1.0);
    let scaled = power * k.exp2_integer();
    let bounded = R::select(R::splat(EXP_OVERFLOW).lt(x), R::splat(f64::INFINITY), scaled);
    R::select(x.lt(R::splat(EXP_UNDERFLOW)), R::splat(0.0), bounded)
}

/// 2ˣ for x ≤ 0, as Gaussians need it: fewer operations than [`exp`], whose argument would have
/// to be brought to a multiple of ln 2 first. Zero below −1022; NaN stays NaN.
#[inline(always)]
pub fn exp2_decay<R: Real>(x: R) -> R {
    let k = x.round();
    let r = x - k;
    let scaled = r.mul_add(r.polynomial(&EXP2), R::splat(1.0)) * k.exp2_integer();
    R::select(x.lt(R::splat(-1022.0)), R::splat(0.0), scaled)
}

/// The natural logarithm of a positive normal number; anything else gives an arbitrary number.
#[inline(always)]
pub fn ln<R: Real>(x: R) -> R {
    // ln(m·2ⁿ) = n ln 2 + 2 artanh(s) with s = (m − 1)/(m + 1).
    let (m, n) = x.split_exponent();
    let s = (m - R::splat(1.0)) / (m + R::splat(1.0));
    let square = s * s;
    let tail = s * square * square.polynomial(&LN);
    let head = s.mul_add(R::splat(2.0), n * R::splat(LN_2_LOW)) + tail;
    n.mul_add(R::splat(LN_2_HIGH), head)
}

/// xʸ for a positive x, as e^(y ln x): the relative error grows with |y ln x| times 1e-16, which
/// is what schedules and scales need; it is no general power function.
#[inline(always)]
pub fn powf<R: Real>(x: R, y: R) -> R {
    exp(y * ln(x))
}

#[cfg(test)]
mod tests {
    use super::super::Lanes;
    use super::*;

    fn ulps(ours: f64, theirs: f64) -> f64 {
        (ours - theirs).abs() / (theirs.abs() * f64::EPSILON).max(f64::MIN_POSITIVE)
    }

    fn sweep(low: f64, high: f64) -> impl Iterator<Item = f64> {
        let count = 200_001;
        (0..count).map(move |i| low + (high - low) * f64::from(i) / f64::from(count - 1))
    }

    #[test]
    fn exp_agrees_with_the_standard_library_within_two_ulps() {
        let worst = sweep(-708.0, 709.3).map(|x| ulps(exp(x), x.exp())).fold(0.0, f64::max);
        assert!(worst <= 2.0, "{worst} ulps");
    }

    #[test]
    fn exp_has_exact_special_values() {
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(-0.0), 1.0);
        assert_eq!(exp(f64::NEG_INFINITY), 0.0);
        assert_eq!(exp(f64::INFINITY), f64::INFINITY);
        assert_eq!(exp(-708.1), 0.0);
        assert_eq!(exp(1e300), f64::INFINITY);
        assert_eq!(exp(-1e300), 0.0);
        assert!(exp(f64::NAN).is_nan());
        assert!(exp(709.4).is_finite());
    }

    #[test]
    fn exp2_decay_agrees_with_the_standard_library_within_two_ulps() {
        let worst = sweep(-1021.9, 0.0).map(|x| ulps(exp2_decay(x), x.exp2())).fold(0.0, f64::max);
        assert!(worst <= 2.0, "{worst} ulps");
        assert_eq!(exp2_decay(0.0), 1.0);
        assert_eq!(exp2_decay(-3.0), 0.125);
        assert_eq!(exp2_decay(-1022.5), 0.0);
        assert_eq!(exp2_decay(f64::NEG_INFINITY), 0.0);
        assert!(exp2_decay(f64::NAN).is_nan());
    }

    #[test]
    fn ln_agrees_with_the_standard_library_within_two_ulps() {
        let worst = sweep(-300.0, 300.0)
            .map(|x| 10.0_f64.powf(x / 10.0))
            .map(|x| ulps(ln(x), x.ln()))
            .fold(0.0, f64::max);
        assert!(worst <= 2.0, "{worst} ulps");
        assert_eq!(ln(1.0), 0.0);
    }

    #[test]
    fn powf_serves_schedules() {
        for i in 1..=2000 {
            let i = f64::from(i);
            assert!(ulps(powf(1.0 / i, 0.7), (1.0 / i).powf(0.7)) <= 10.0);
        }
    }

    #[test]
    fn lanes_and_scalars_agree_to_the_bit() {
        let values: Vec<f64> = sweep(-720.0, 720.0).collect();
        for chunk in values.chunks_exact(8) {
            let lanes = Lanes::new(chunk.try_into().unwrap());
            assert_eq!(exp(lanes).to_array(), std::array::from_fn(|i| exp(chunk[i])));
            let decay = exp2_decay(-lanes.abs()).to_array();
            assert_eq!(decay, std::array::from_fn(|i| exp2_decay(-chunk[i].abs())));
            let positive = lanes.abs() + Lanes::splat(1e-3);
            let expected = std::array::from_fn(|i| ln(chunk[i].abs() + 1e-3));
            assert_eq!(ln(positive).to_array(), expected);
        }
    }
}
