//! The derivatives of degrees to the parameters.

use super::Shape;
use super::degree::PREPARED;
use crate::math::{Dual, Real};

/// The most parameters of a shape other than points.
const MOST: usize = 4;

impl Shape {
    /// Writes the derivatives of the degree to the parameters, where `degree` is the degree at
    /// `x`.
    ///
    /// At a foot the derivative from inside the support is given, at a shoulder zero. Where the
    /// degree jumps, or its derivative is infinite, zero is given.
    pub(crate) fn gradient<R: Real>(self, p: &[R], x: R, degree: R, derivatives: &mut [R]) {
        let zero = R::splat(0.0);
        let gradient = match self {
            Self::Triangular => {
                let [a, b, c, d] = sides(p[0], p[1], p[1], p[2], x);
                [a, b + c, d, zero]
            }
            Self::Trapezoidal => sides(p[0], p[1], p[2], p[3], x),
            Self::Gaussian | Self::GaussianWidth => {
                // The thesis's form doubles both (2.25, 2.26; 7.10, 7.11).
                let factor = if self == Self::GaussianWidth { 2.0 } else { 1.0 };
                let z = (x - p[0]) / p[1];
                let by_mean = R::splat(factor) * degree * z / p[1];
                // Where the degree is zero, z may be infinite.
                let there = zero.lt(degree);
                let only_there = |value| R::select(there, value, zero);
                // Without the copy below, whose length is not known.
                derivatives[..2].copy_from_slice(&[only_there(by_mean), only_there(by_mean * z)]);
                return;
            }
            Self::Points => return points(p, x, derivatives),
            _ => return self.gradient_by_duals(p, x, derivatives),
        };
        derivatives.copy_from_slice(&gradient[..p.len()]);
    }

    /// The derivatives that the degree's own formula yields.
    fn gradient_by_duals<R: Real>(self, p: &[R], x: R, derivatives: &mut [R]) {
        let zero = Dual::<R, MOST>::splat(0.0);
        let mut parameters = [zero; MOST];
        for (index, (parameter, &value)) in parameters.iter_mut().zip(p).enumerate() {
            *parameter = Dual::variable(value, index);
        }
        let mut prepared = [zero; PREPARED];
        self.prepare(&parameters[..p.len()], &mut prepared);
        let degree = self.prepared_degree(&prepared[..], 0, p.len(), Dual::constant(x));
        for (derivative, slope) in derivatives.iter_mut().zip(degree.slopes).take(p.len()) {
            *derivative = finite_or_zero(slope);
        }
    }

    /// The derivative of the degree to `x` itself, under prepared parameters; zero where the
    /// degree jumps or the derivative is infinite.
    pub(super) fn prepared_slope(self, prepared: &[f64], count: usize, x: f64) -> f64 {
        let x = Dual::<f64, 1>::variable(x, 0);
        finite_or_zero(self.prepared_degree(prepared, 0, count, x).slopes[0])
    }
}

/// On flat tails and vertical sides a derivative is the quotient of overflowing numbers.
#[inline(always)]
fn finite_or_zero<R: Real>(derivative: R) -> R {
    R::select(derivative.abs().le(R::splat(f64::MAX)), derivative, R::splat(0.0))
}

/// The derivatives of a trapezoid's degree to its four vertices.
#[inline(always)]
fn sides<R: Real>(a: R, b: R, c: R, d: R, x: R) -> [R; 4] {
    let zero = R::splat(0.0);
    let on_left = |value: R| R::select(a.le(x) & x.lt(b), value, zero);
    let on_right = |value: R| R::select(c.lt(x) & x.le(d), value, zero);
    // Sides so narrow that their square is no normal number get a finite slope, too.
    let square = |size: R| (size * size).max(R::splat(f64::MIN_POSITIVE));
    let (rise, fall) = (square(b - a), square(d - c));
    [
        on_left((x - b) / rise),
        on_left((a - x) / rise),
        on_right((d - x) / fall),
        on_right((x - c) / fall),
    ]
}

/// The derivatives to the places and degrees of points; only the two neighbours of `x` have any.
///
/// Between them y = (1 − u)y₀ + u·y₁ with u = (x − x₀)/(x₁ − x₀), and with the slope m of the line
/// ∂y/∂x₀ = −m(1 − u), ∂y/∂x₁ = −m·u.
fn points<R: Real>(p: &[R], x: R, derivatives: &mut [R]) {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let count = p.len() / 2;
    derivatives[..p.len()].fill(zero);
    derivatives[1] = R::select(x.lt(p[0]), one, zero);
    for index in 0..count - 1 {
        let [x0, y0, x1, y1] = std::array::from_fn(|k| p[2 * index + k]);
        let between = x0.le(x) & x.lt(x1);
        let here = |value: R| R::select(between, value, zero);
        let (u, slope) = ((x - x0) / (x1 - x0), (y1 - y0) / (x1 - x0));
        let own = [slope * (u - one), one - u, -slope * u, u].map(here);
        for (derivative, own) in derivatives[2 * index..].iter_mut().zip(own) {
            *derivative = *derivative + own;
        }
    }
    let last = &mut derivatives[2 * count - 1];
    *last = R::select(p[2 * count - 2].le(x), one, *last);
}
