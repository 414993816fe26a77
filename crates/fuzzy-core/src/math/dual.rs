//! Numbers that carry derivatives, so that a formula written once yields its gradient too.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Real;

/// A number and its derivatives to N variables (forward-mode differentiation).
///
/// Arithmetic follows the rules of differentiation: (uv)′ = u′v + uv′ and so on. Decisions look
/// at the value and take the whole number they choose, so a derivative is that of the branch
/// that was taken: at a kink it is one-sided, and |u|′ is ±1 with the sign of u, be it that of a
/// zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<R, const N: usize> {
    /// The number itself.
    pub value: R,
    /// Its derivative to each variable.
    pub slopes: [R; N],
}

impl<R: Real, const N: usize> Dual<R, N> {
    /// A number that depends on no variable.
    #[inline(always)]
    pub fn constant(value: R) -> Self {
        Self { value, slopes: [R::splat(0.0); N] }
    }

    /// The variable with this index, below N.
    #[inline(always)]
    pub fn variable(value: R, index: usize) -> Self {
        let slope = |k| R::splat(if k == index { 1.0 } else { 0.0 });
        Self { value, slopes: from_fn(slope) }
    }

    /// f(u) for this u, from `value` = f(u) and `slope` = f′(u).
    #[inline(always)]
    fn chain(self, value: R, slope: R) -> Self {
        Self { value, slopes: self.slopes.map(|own| own * slope) }
    }
}

impl<R: Real, const N: usize> Add for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let slopes = from_fn(|k| self.slopes[k] + other.slopes[k]);
        Self { value: self.value + other.value, slopes }
    }
}

impl<R: Real, const N: usize> Sub for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let slopes = from_fn(|k| self.slopes[k] - other.slopes[k]);
        Self { value: self.value - other.value, slopes }
    }
}

impl<R: Real, const N: usize> Mul for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let slope = |k: usize| self.slopes[k].mul_add(other.value, self.value * other.slopes[k]);
        Self { value: self.value * other.value, slopes: from_fn(slope) }
    }
}

impl<R: Real, const N: usize> Div for Dual<R, N> {
    type Output = Self;
    // The rule for quotients takes the other operations.
    #[allow(clippy::suspicious_arithmetic_impl)]
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // (u/v)′ = (u′ − (u/v)·v′)/v, without v², which may overflow.
        let value = self.value / other.value;
        let slope = |k: usize| (self.slopes[k] - value * other.slopes[k]) / other.value;
        Self { value, slopes: from_fn(slope) }
    }
}

impl<R: Real, const N: usize> Neg for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: self.slopes.map(|slope| -slope) }
    }
}

impl<R: Real, const N: usize> Real for Dual<R, N> {
    type Mask = R::Mask;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::constant(R::splat(value))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let slope = |k: usize| {
            let second = self.value.mul_add(factor.slopes[k], addend.slopes[k]);
            self.slopes[k].mul_add(factor.value, second)
        };
        Self { value: self.value.mul_add(factor.value, addend.value), slopes: from_fn(slope) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.chain(self.value.abs(), R::splat(1.0).copysign(self.value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // The slope at 0 is infinite; it counts as 0, so that what is 0 and stays 0 stays finite.
        let root = self.value.sqrt();
        let zero = R::splat(0.0);
        self.chain(root, R::select(zero.lt(root), R::splat(0.5) / root, zero))
    }
    #[inline(always)]
    fn round(self) -> Self {
        Self::constant(self.value.round())
    }
    #[inline(always)]
    fn lt(self, other: Self) -> R::Mask {
        self.value.lt(other.value)
    }
    #[inline(always)]
    fn le(self, other: Self) -> R::Mask {
        self.value.le(other.value)
    }
    #[inline(always)]
    fn select(mask: R::Mask, chosen: Self, otherwise: Self) -> Self {
        Self {
            value: R::select(mask, chosen.value, otherwise.value),
            slopes: from_fn(|k| R::select(mask, chosen.slopes[k], otherwise.slopes[k])),
        }
    }
    #[inline(always)]
    fn exp2_integer(self) -> Self {
        Self::constant(self.value.exp2_integer())
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        // The mantissa is the number times 2⁻ⁿ; the exponent n is a step function.
        let (mantissa, exponent) = self.value.split_exponent();
        (self.chain(mantissa, mantissa / self.value), Self::constant(exponent))
    }
    #[inline(always)]
    fn turn_quadrant(sine: Self, cosine: Self, quadrant: Self) -> (Self, Self) {
        // A turn is linear in sine and cosine, so it turns their slopes alike.
        let turn = |sine, cosine| R::turn_quadrant(sine, cosine, quadrant.value);
        let (sine_value, cosine_value) = turn(sine.value, cosine.value);
        let slopes: [(R, R); N] = from_fn(|k| turn(sine.slopes[k], cosine.slopes[k]));
        (
            Self { value: sine_value, slopes: slopes.map(|(slope, _)| slope) },
            Self { value: cosine_value, slopes: slopes.map(|(_, slope)| slope) },
        )
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        let one = R::splat(1.0);
        let slope = one.copysign(self.value) * one.copysign(sign.value);
        self.chain(self.value.copysign(sign.value), slope)
    }
    #[inline(always)]
    fn zip_with(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        Self::constant(self.value.zip_with(other.value, function))
    }
    #[inline(always)]
    fn set_lane(&mut self, lane: usize, value: f64) {
        self.value.set_lane(lane, value);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Lanes, atan2, exp, exp2_decay, ln, powf, sin_cos, tan};
    use super::*;

    type One = Dual<f64, 1>;
    type Two = Dual<f64, 2>;

    fn sweep(low: f64, high: f64) -> impl Iterator<Item = f64> {
        (0..2001).map(move |i| low + (high - low) * f64::from(i) / 2000.0)
    }

    fn agrees(ours: f64, theirs: f64) {
        assert!((ours - theirs).abs() <= 1e-9 * theirs.abs(), "{ours} {theirs}");
    }

    /// The slope of a function of one variable agrees with its derivative over an interval.
    fn has_slope(
        (low, high): (f64, f64),
        function: impl Fn(One) -> One,
        derivative: impl Fn(f64) -> f64,
    ) {
        for x in sweep(low, high) {
            agrees(function(One::variable(x, 0)).slopes[0], derivative(x));
        }
    }

    #[test]
    fn transcendental_functions_have_their_derivatives() {
        use std::f64::consts::LN_2;
        has_slope((-700.0, 700.0), exp, f64::exp);
        has_slope((-1000.0, -0.01), exp2_decay, |x| LN_2 * x.exp2());
        has_slope((1e-3, 1e3), ln, |x| 1.0 / x);
        has_slope((1e300, f64::MAX), ln, |x| 1.0 / x);
        has_slope((-20.0, 20.0), |x| sin_cos(x).0, f64::cos);
        has_slope((-20.0, 20.0), |x| sin_cos(x).1, |x| -x.sin());
        has_slope((-20.0, 20.0), tan, |x| 1.0 / (x.cos() * x.cos()));
    }

    #[test]
    fn powers_and_angles_have_both_derivatives() {
        for x in sweep(0.01, 30.0) {
            for y in [-2.5, -0.3, 0.4, 3.0] {
                let power = powf(Two::variable(x, 0), Two::variable(y, 1));
                agrees(power.slopes[0], y * x.powf(y - 1.0));
                // At x = 1 the derivative to y vanishes.
                let logarithm = x.ln();
                if logarithm.abs() > 1e-3 {
                    agrees(power.slopes[1], logarithm * x.powf(y));
                }
            }
        }
        for angle in sweep(-3.1, 3.1) {
            let (y, x) = (7.0 * angle.sin(), 7.0 * angle.cos());
            let slopes = atan2(Two::variable(y, 0), Two::variable(x, 1)).slopes;
            assert!((slopes[0] - x / 49.0).abs() < 1e-10, "{angle}");
            assert!((slopes[1] + y / 49.0).abs() < 1e-10, "{angle}");
        }
    }

    #[test]
    fn the_rules_of_differentiation_hold() {
        let (x, y) = (Two::variable(3.0, 0), Two::variable(-2.0, 1));
        assert_eq!((x + y).slopes, [1.0, 1.0]);
        assert_eq!((x - y).slopes, [1.0, -1.0]);
        assert_eq!((-x).slopes, [-1.0, 0.0]);
        assert_eq!((x * y).slopes, [-2.0, 3.0]);
        assert_eq!((x / y).slopes, [-0.5, -0.75]);
        assert_eq!(x.mul_add(y, x).slopes, [-1.0, 3.0]);
        assert_eq!((x * x).sqrt().slopes, [1.0, 0.0]);
        assert_eq!(y.abs().slopes, [0.0, -1.0]);
        assert_eq!((x - Two::constant(3.0)).abs().slopes, [1.0, 0.0]);
        assert_eq!(x.copysign(y).slopes, [-1.0, 0.0]);
        assert_eq!(x.min(y), y);
        assert_eq!(x.round().slopes, [0.0, 0.0]);
        assert_eq!(x.zip_with(y, f64::max), Two::constant(3.0));
    }

    #[test]
    fn the_value_is_that_of_the_number_alone_to_the_bit() {
        let formula = |x: f64| (exp(x), sin_cos(x).0, ln(x.abs()));
        for x in sweep(-3.0, 3.0).filter(|x| *x != 0.0) {
            let dual = One::variable(x, 0);
            let (a, b, c) = formula(x);
            assert_eq!(exp(dual).value.to_bits(), a.to_bits());
            assert_eq!(sin_cos(dual).0.value.to_bits(), b.to_bits());
            assert_eq!(ln(dual.abs()).value.to_bits(), c.to_bits());
        }
    }

    #[test]
    fn lanes_and_scalars_agree_to_the_bit() {
        let formula = [0.1, -0.7, 1.3, 2.9, -4.0, 5.5, 0.0, 8.0];
        let lanes = Dual::<Lanes, 1>::variable(Lanes::new(formula), 0);
        let result = exp(sin_cos(lanes * lanes).0).slopes[0].to_array();
        for (x, slope) in formula.into_iter().zip(result) {
            let scalar = One::variable(x, 0);
            assert_eq!(exp(sin_cos(scalar * scalar).0).slopes[0].to_bits(), slope.to_bits());
        }
    }
}
