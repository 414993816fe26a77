//! Exponential, logarithm and power with errors below one unit in the last place.
//!
//! A logarithm is the sum of two numbers, so that y ln x, of which e to the power is taken,
//! loses no digits even where it is 700.

use std::f64::consts::LOG2_E;

use super::super::elementary::{EXP, LN_2_HIGH, LN_2_LOW};
use super::{Real, equal};

/// A number as high + low, where low is small against high.
struct Sum<R> {
    high: R,
    low: R,
}

impl<R: Real> Sum<R> {
    /// a + b without error, for |a| ≥ |b| or a = 0.
    #[inline(always)]
    fn of(a: R, b: R) -> Self {
        let high = a + b;
        Self { high, low: b - (high - a) }
    }

    /// a·b without error.
    #[inline(always)]
    fn product(a: R, b: R) -> Self {
        let high = a * b;
        Self { high, low: a.mul_add(b, -high) }
    }

    /// a·b with an error of both low parts' product.
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let Self { high, low } = Self::product(self.high, other.high);
        let low = self.high.mul_add(other.low, self.low.mul_add(other.high, low));
        Self { high, low }
    }
}

/// 2/5, 2/7, …: from the third term on those of 2 artanh(s)/s as a polynomial in s².
const ARTANH: [f64; 11] = [
    2.0 / 5.0,
    2.0 / 7.0,
    2.0 / 9.0,
    2.0 / 11.0,
    2.0 / 13.0,
    2.0 / 15.0,
    2.0 / 17.0,
    2.0 / 19.0,
    2.0 / 21.0,
    2.0 / 23.0,
    2.0 / 25.0,
];
const TWO_THIRDS: f64 = 2.0 / 3.0;
const TWO_THIRDS_LOW: f64 = 3.700_743_415_417_188e-17; // 2/3 − TWO_THIRDS

/// The natural logarithm: −∞ at 0, NaN below.
#[inline(always)]
pub fn ln<R: Real>(x: R) -> R {
    let Sum { high, low } = ln_parts(x);
    high + low
}

/// The logarithm as a sum, so that its error is below 2⁻⁶⁰ of it.
#[inline(always)]
fn ln_parts<R: Real>(x: R) -> Sum<R> {
    const SCALE: f64 = 18_014_398_509_481_984.0; // 2⁵⁴ makes a subnormal number normal.
    let subnormal = x.lt(R::splat(f64::MIN_POSITIVE));
    let (m, n) = R::select(subnormal, x * R::splat(SCALE), x).split_exponent();
    let n = R::select(subnormal, n - R::splat(54.0), n);

    // ln(m·2ⁿ) = n ln 2 + 2s + ⅔s³ + s⁵(…) with s = (m − 1)/(m + 1).
    let s = quotient(m);
    let square = s.times(&Sum { high: s.high, low: s.low });
    let cube = square.times(&s);
    let thirds = Sum { high: R::splat(TWO_THIRDS), low: R::splat(TWO_THIRDS_LOW) };
    let third = cube.times(&thirds);
    let rest = cube.high * square.high * square.high.polynomial(&ARTANH);

    let exponent = Sum::product(n, R::splat(LN_2_HIGH));
    let two = R::splat(2.0);
    let first = Sum::of(exponent.high, two * s.high);
    let second = Sum::of(first.high, third.high);
    let exponent_low = n.mul_add(R::splat(LN_2_LOW), exponent.low);
    let low = two.mul_add(s.low, third.low) + rest + exponent_low + first.low + second.low;
    let sum = Sum::of(second.high, low);

    let positive = R::splat(0.0).lt(x) & x.lt(R::splat(f64::INFINITY));
    let pole = R::select(equal(x, 0.0), R::splat(f64::NEG_INFINITY), R::splat(f64::NAN));
    let special = R::select(equal(x, f64::INFINITY), x, pole);
    Sum {
        high: R::select(positive, sum.high, special),
        low: R::select(positive, sum.low, R::splat(0.0)),
    }
}

/// (m − 1)/(m + 1) for m between ½ and 2.
#[inline(always)]
fn quotient<R: Real>(m: R) -> Sum<R> {
    let one = R::splat(1.0);
    let numerator = m - one;
    let denominator = Sum::of(one + one, m - one);
    let high = numerator / denominator.high;
    let rest = (-high).mul_add(denominator.high, numerator);
    Sum { high, low: (-high).mul_add(denominator.low, rest) / denominator.high }
}

/// eˣ; too large a result is ∞, too small a one is subnormal and then 0.
#[inline(always)]
pub fn exp<R: Real>(x: R) -> R {
    exp_parts(Sum { high: x, low: R::splat(0.0) })
}

#[inline(always)]
fn exp_parts<R: Real>(x: Sum<R>) -> R {
    // Beyond ±800 nothing changes any more.
    let inside = x.high.abs().lt(R::splat(800.0));
    let high = x.high.clamp_symmetric(800.0);
    let low = R::select(inside, x.low, R::splat(0.0));

    // eˣ = 2ᵏ·eʳ with k = round(x/ln 2); the high part of r has no rounding error.
    let k = (high * R::splat(LOG2_E)).round();
    let r_high = k.mul_add(R::splat(-LN_2_HIGH), high);
    let r_low = k.mul_add(R::splat(-LN_2_LOW), low);
    let r = r_high + r_low;
    let linear = Sum::of(R::splat(1.0), r_high);
    let power = linear.high + (linear.low + (r * r).mul_add(r.polynomial(&EXP), r_low));

    // Two factors, for 2ᵏ itself may be too large or subnormal.
    let half = (k * R::splat(0.5)).round();
    power * half.exp2_integer() * (k - half).exp2_integer()
}

/// xʸ; x² is x·x to the bit.
///
/// As IEEE 754 has it, x⁰ = 1ʸ = 1 for every x and y, even NaN, and a negative x has a power for
/// integers y only, otherwise NaN.
#[inline(always)]
pub fn pow<R: Real>(x: R, y: R) -> R {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let size = x.abs();
    let logarithm = ln_parts(size);
    let exponent = Sum::product(y, logarithm.high);
    let low = y.mul_add(logarithm.low, exponent.low);
    let power = exp_parts(Sum { high: exponent.high, low });
    let power = R::select(equal(size, 1.0) & equal(y.abs(), f64::INFINITY), one, power);

    let negative = one.copysign(x).lt(zero);
    let power = R::select(negative, signed_power(x, y, power), power);
    let power = R::select(equal(y, 2.0), x * x, power);
    R::select(equal(x, 1.0), one, R::select(equal(y, 0.0), one, power))
}

/// The power of a negative number (or −0) from the power of its size.
#[inline(always)]
fn signed_power<R: Real>(x: R, y: R, power: R) -> R {
    let half = y * R::splat(0.5);
    let odd = R::splat(0.25).lt((half - half.round()).abs());
    let whole = R::select(odd, -power, power);
    let finite = x.lt(R::splat(0.0)) & R::splat(f64::NEG_INFINITY).lt(x);
    let broken = R::select(finite, R::splat(f64::NAN), power);
    let fraction = (y - y.round()).abs();
    R::select(R::splat(0.0).lt(fraction), broken, whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The worst distance from the standard library's value, which is the nearest number but for
    /// one in a few dozen, in units in the last place.
    fn worst(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
        let ulps = |(ours, theirs): (f64, f64)| {
            let last_place = f64::from_bits(theirs.abs().to_bits() + 1) - theirs.abs();
            (ours - theirs).abs() / last_place
        };
        pairs.map(ulps).fold(0.0, f64::max)
    }

    fn sweep(low: f64, high: f64, count: i32) -> impl Iterator<Item = f64> {
        (0..count).map(move |i| low + (high - low) * f64::from(i) / f64::from(count - 1))
    }

    #[test]
    fn the_last_digit_is_wrong_by_one_at_most() {
        assert!(worst(sweep(-745.0, 709.78, 300_001).map(|x| (exp(x), x.exp()))) <= 1.0);
        let numbers = || sweep(-320.0, 308.0, 300_001).map(|x| 10.0_f64.powf(x));
        assert!(worst(numbers().map(|x| (ln(x), x.ln()))) <= 1.0);
        assert!(worst(sweep(0.5, 2.0, 300_001).map(|x| (ln(x), x.ln()))) <= 1.0);
        // Powers of every size, in 3·10⁵ pairs.
        let exponents = sweep(-743.0, 709.0, 1009);
        let powers = exponents.flat_map(|size| {
            sweep(-3.0, 3.01, 300).map(move |x| (10.0_f64.powf(x), size / (x * 10.0_f64.ln())))
        });
        assert!(worst(powers.map(|(x, y)| (pow(x, y), x.powf(y)))) <= 1.0);
    }

    #[test]
    fn powers_that_are_numbers_are_exact() {
        for base in 2..=40 {
            let mut power = 1.0;
            for exponent in 1..=11 {
                power *= f64::from(base);
                let (base, exponent) = (f64::from(base), f64::from(exponent));
                if power < 9e15 {
                    assert_eq!(pow(base, exponent), power);
                    assert_eq!(pow(-base, exponent), (-base).powi(exponent as i32));
                    assert_eq!(pow(power, 1.0 / exponent).round(), base);
                }
                if power < 9e7 {
                    assert_eq!(pow(power * power, 0.5), power);
                }
            }
        }
        assert_eq!(pow(0.25, 1.5), 0.125);
        assert_eq!(pow(2.0, -1074.0), 5e-324);
        assert_eq!(pow(1.1, 2.0), 1.1 * 1.1);
        assert_eq!(pow(10.0, -2.0), 0.01);
    }
}
