//! How the degree of a number is computed, in two steps: parameters are *prepared* once, so that
//! the evaluation at many numbers needs hardly a division.
//!
//! Everything is written over [`Real`] and without a branch on values: one formula serves a single
//! number, eight in lock-step and, through [`Dual`](crate::math::Dual), its own derivatives.

use std::f64::consts::{FRAC_PI_2, LOG2_E, PI};

use super::Shape;
use crate::math::{Numbers, Real, exp, exp2_decay, powf, sin_cos};

/// The numbers that parameters are prepared into, except those of points.
pub(super) const PREPARED: usize = 4;
/// The numbers that one point is prepared into: its place, its degree and the slope to the next.
const PREPARED_POINT: usize = 3;

impl Shape {
    /// The numbers that so many parameters are prepared into.
    pub(crate) fn prepared_count(self, parameters: usize) -> usize {
        if self == Self::Points { parameters / 2 * PREPARED_POINT } else { PREPARED }
    }

    /// Turns parameters into the numbers that [`prepared_degree`](Self::prepared_degree) reads.
    /// A vertical side becomes an infinite slope.
    pub(crate) fn prepare<R: Real>(self, p: &[R], prepared: &mut [R]) {
        let number = R::splat;
        let zero = number(0.0);
        let numbers = match self {
            Self::Gaussian => [p[0], number(-0.5) * per_square(p[1]), zero, zero],
            Self::GaussianWidth => [p[0], -per_square(p[1]), zero, zero],
            Self::TwoSidedGaussian => {
                let half = number(-0.5);
                [p[0], half * per_square(p[1]), p[2], half * per_square(p[3])]
            }
            Self::Bell => [p[0], number(1.0) / p[1], number(2.0) * p[2], zero],
            Self::Sigmoid => [p[0], -p[1], zero, zero],
            Self::SigmoidDifference | Self::SigmoidProduct => [p[0], -p[1], p[2], -p[3]],
            Self::SShape | Self::Ramp | Self::Arc => [p[0], climb(p[0], p[1]), zero, zero],
            Self::ZShape => [p[1], climb(p[1], p[0]), zero, zero],
            Self::Triangular => [p[0], climb(p[0], p[1]), p[2], climb(p[1], p[2])],
            Self::Trapezoidal | Self::PiShape => [p[0], climb(p[0], p[1]), p[3], climb(p[2], p[3])],
            Self::Rectangle => [p[0], p[1], zero, zero],
            Self::Singleton => [p[0], p[0], zero, zero],
            Self::Step => {
                let side = number(1.0).copysign(p[1]);
                [p[0] * side, side, zero, zero]
            }
            Self::Concave => [p[1], number(1.0) / (p[1] - p[0]), zero, zero],
            Self::Cosine => [p[0], number(PI) / p[1], zero, zero],
            Self::SemiEllipse => [p[0], number(2.0) / (p[1] - p[0]), p[1], zero],
            Self::Spike => [p[0], number(-10.0 * LOG2_E) / p[1], zero, zero],
            Self::Points => return prepare_points(p, prepared),
        };
        prepared[..PREPARED].copy_from_slice(&numbers);
    }

    /// The degrees of `x` in terms of this shape, `count` parameters each, whose prepared numbers
    /// stand one after the other from `first` on.
    #[inline(always)]
    pub(crate) fn prepared_degrees<R, P>(
        self,
        prepared: &P,
        first: usize,
        count: usize,
        x: R,
        degrees: &mut [R],
    ) where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let size = self.prepared_count(count);
        let places = degrees.iter_mut().enumerate().map(|(index, own)| (first + index * size, own));
        // The usual formulas are named here, so that their loops hold no decision and no call.
        match self {
            Self::Gaussian | Self::GaussianWidth => places.for_each(|(first, degree)| {
                let [mean, factor] = prepared.block(first);
                *degree = gaussian(mean, factor, x);
            }),
            Self::Triangular | Self::Trapezoidal => {
                places.for_each(|(first, degree)| *degree = trapezoid(prepared.block(first), x));
            }
            other => places.for_each(|(first, degree)| {
                *degree = other.prepared_degree(prepared, first, count, x);
            }),
        }
    }

    /// The degree of `x`, where the prepared numbers of `count` parameters begin at `first`.
    /// That of NaN is an arbitrary number.
    pub(crate) fn prepared_degree<R, P>(self, prepared: &P, first: usize, count: usize, x: R) -> R
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let n = |index: usize| prepared.number(first + index);
        let all = || prepared.block(first);
        match self {
            Self::Gaussian | Self::GaussianWidth => {
                let [mean, factor] = prepared.block(first);
                gaussian(mean, factor, x)
            }
            Self::Triangular | Self::Trapezoidal => trapezoid(all(), x),
            Self::TwoSidedGaussian => two_sided_gaussian(all(), x),
            Self::Bell => bell(n(0), n(1), n(2), x),
            Self::Sigmoid => sigmoid(n(0), n(1), x),
            Self::SigmoidDifference => (sigmoid(n(0), n(1), x) - sigmoid(n(2), n(3), x)).abs(),
            Self::SigmoidProduct => sigmoid(n(0), n(1), x) * sigmoid(n(2), n(3), x),
            Self::SShape | Self::ZShape => smooth(ramp(n(0), n(1), x)),
            Self::PiShape => smooth(trapezoid(all(), x)),
            Self::Ramp => ramp(n(0), n(1), x),
            Self::Rectangle | Self::Singleton => indicator(n(0).le(x) & x.le(n(1))),
            Self::Step => indicator(n(0).le(x * n(1))),
            Self::Concave => concave(n(0), n(1), x),
            Self::Cosine => cosine(n(0), n(1), x),
            Self::SemiEllipse => semi_ellipse(n(0), n(1), n(2), x),
            Self::Arc => arc(ramp(n(0), n(1), x)),
            Self::Spike => exp2_decay((x - n(0)).abs() * n(1)),
            Self::Points => on_points(prepared, first, count / 2, x),
        }
    }
}

/// log₂e/w², which turns a squared distance into the exponent of 2.
fn per_square<R: Real>(width: R) -> R {
    R::splat(LOG2_E) / (width * width)
}

/// The slope of the line from 0 at `foot` to 1 at `top`, such that at `top` it is not below 1.
fn climb<R: Real>(foot: R, top: R) -> R {
    let size = top - foot;
    let slope = R::splat(1.0) / size;
    let short = (size * slope).lt(R::splat(1.0));
    R::select(short, slope * R::splat(1.0 + f64::EPSILON), slope)
}

#[inline(always)]
fn gaussian<R: Real>(mean: R, factor: R, x: R) -> R {
    let distance = x - mean;
    exp2_decay(factor * (distance * distance))
}

#[inline(always)]
fn trapezoid<R: Real>([left, rise, right, fall]: [R; 4], x: R) -> R {
    // On a vertical side 0·∞ is NaN, which `min` drops in favour of its other side.
    let one = R::splat(1.0);
    let rising = ((x - left) * rise).min(one);
    let falling = ((right - x) * fall).min(one);
    rising.min(falling).max(R::splat(0.0))
}

fn ramp<R: Real>(start: R, climb: R, x: R) -> R {
    ((x - start) * climb).min(R::splat(1.0)).max(R::splat(0.0))
}

fn two_sided_gaussian<R: Real>([left, left_factor, right, right_factor]: [R; 4], x: R) -> R {
    let zero = R::splat(0.0);
    let before = (x - left).min(zero);
    let beyond = (x - right).max(zero);
    exp2_decay(left_factor * (before * before) + right_factor * (beyond * beyond))
}

fn bell<R: Real>(centre: R, per_width: R, power: R, x: R) -> R {
    // The logarithm within the power is that of normal numbers.
    let distance = ((x - centre) * per_width).abs().min(R::splat(f64::MAX));
    let apart = R::splat(f64::MIN_POSITIVE).le(distance);
    let growth = R::select(apart, powf(distance, power), R::splat(0.0));
    R::splat(1.0) / (R::splat(1.0) + growth)
}

fn sigmoid<R: Real>(centre: R, minus_slope: R, x: R) -> R {
    R::splat(1.0) / (R::splat(1.0) + exp((x - centre) * minus_slope))
}

/// Two parabolas that make a smooth climb of a straight one.
fn smooth<R: Real>(climb: R) -> R {
    let (one, two, rest) = (R::splat(1.0), R::splat(2.0), R::splat(1.0) - climb);
    R::select(climb.lt(R::splat(0.5)), two * climb * climb, one - two * rest * rest)
}

fn indicator<R: Real>(inside: R::Mask) -> R {
    R::select(inside, R::splat(1.0), R::splat(0.0))
}

fn concave<R: Real>(end: R, per_size: R, x: R) -> R {
    let way = ((end - x) * per_size).max(R::splat(0.0));
    R::splat(1.0) / (R::splat(1.0) + way)
}

fn cosine<R: Real>(centre: R, per_width: R, x: R) -> R {
    // ½(1 + cos 2t) = cos² t, which has no cancellation near the feet.
    let angle = ((x - centre) * per_width).clamp_symmetric(FRAC_PI_2);
    let (_, cosine) = sin_cos(angle);
    let inside = angle.abs().lt(R::splat(FRAC_PI_2));
    R::select(inside, cosine * cosine, R::splat(0.0))
}

fn semi_ellipse<R: Real>(left: R, per_radius: R, right: R, x: R) -> R {
    // 1 − ((x − c)/r)² = (x − a)/r · (b − x)/r, which has no cancellation near the ends.
    let side = |distance: R| (distance * per_radius).max(R::splat(0.0)).min(R::splat(2.0));
    (side(x - left) * side(right - x)).min(R::splat(1.0)).sqrt()
}

fn arc<R: Real>(climb: R) -> R {
    // 1 − (1 − u)² = u + u(1 − u).
    climb.mul_add(R::splat(1.0) - climb, climb).sqrt()
}

fn prepare_points<R: Real>(p: &[R], prepared: &mut [R]) {
    let last = p.len() / 2 - 1;
    for (index, numbers) in prepared.chunks_exact_mut(PREPARED_POINT).enumerate().take(last + 1) {
        let (x, y) = (p[2 * index], p[2 * index + 1]);
        let slope = match p.get(2 * index + 2..2 * index + 4) {
            Some(next) => (next[1] - y) / (next[0] - x),
            None => R::splat(0.0),
        };
        numbers.copy_from_slice(&[x, y, slope]);
    }
}

fn on_points<R, P>(prepared: &P, first: usize, count: usize, x: R) -> R
where
    R: Real,
    P: Numbers<R> + ?Sized,
{
    let point = |index: usize, part: usize| prepared.number(first + PREPARED_POINT * index + part);
    let mut degree = point(0, 1);
    for index in 0..count - 1 {
        let (place, start, slope) = (point(index, 0), point(index, 1), point(index, 2));
        degree = R::select(place.le(x), (x - place).mul_add(slope, start), degree);
    }
    let (place, end) = (point(count - 1, 0), point(count - 1, 1));
    R::select(place.le(x), end, degree).min(R::splat(1.0)).max(R::splat(0.0))
}

#[cfg(test)]
mod tests {
    use super::super::{MembershipFunction, ParameterKind};
    use super::*;
    use crate::math::{LANES, Lanes};

    fn example(shape: Shape) -> MembershipFunction {
        let parameter = |index: usize| match shape.parameter_kind(index) {
            ParameterKind::Centre | ParameterKind::Vertex => 0.61 * index as f64 - 0.9,
            ParameterKind::Width | ParameterKind::Power => 0.7,
            ParameterKind::Slope => 3.1 - 2.0 * index as f64,
            ParameterKind::Direction => -1.0,
            ParameterKind::Degree => 1.0 / index as f64,
        };
        let count = shape.parameter_count().unwrap_or(8);
        let parameters: Vec<f64> = (0..count).map(parameter).collect();
        MembershipFunction::new(shape, &parameters).unwrap()
    }

    #[test]
    fn lanes_and_scalars_agree_to_the_bit() {
        let (infinity, tiny) = (f64::INFINITY, f64::MIN_POSITIVE);
        let mut places: Vec<f64> = (-400..400).map(|i| f64::from(i) / 80.0).collect();
        places.extend([-infinity, infinity, -0.9, 0.93, tiny, -1e300, 1e300, 0.32]);
        for shape in Shape::ALL {
            let function = example(shape);
            let (parameters, count) = (function.parameters(), function.parameters().len());
            let many: Vec<Lanes> = parameters.iter().map(|&p| Lanes::splat(p)).collect();
            let mut prepared = vec![Lanes::splat(0.0); shape.prepared_count(count)];
            shape.prepare(&many, &mut prepared);
            for eight in places.chunks_exact(LANES) {
                let x = Lanes::new(eight.try_into().unwrap());
                let degrees = shape.prepared_degree(prepared.as_slice(), 0, count, x);
                let mut gradients = vec![Lanes::splat(0.0); count];
                shape.gradient(&many, x, degrees, &mut gradients);
                for (lane, &x) in eight.iter().enumerate() {
                    let degree = degrees.to_array()[lane];
                    assert_eq!(degree.to_bits(), function.degree(x).to_bits(), "{shape:?} {x}");
                    for (own, other) in function.gradient(x).iter().zip(&gradients) {
                        let other = other.to_array()[lane];
                        assert_eq!(own.to_bits(), other.to_bits(), "{shape:?} {x}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_two_gaussians_differ_by_root_two() {
        let [degree] = degrees(Shape::Gaussian, &[1.0, 2.0], [3.7]);
        let [other] = degrees(Shape::GaussianWidth, &[1.0, 2.0 * 2.0_f64.sqrt()], [3.7]);
        assert!((degree - other).abs() < 1e-15);
        assert!((degree - (-0.5 * 1.35_f64 * 1.35).exp()).abs() < 1e-15);
    }

    fn degrees<const N: usize>(shape: Shape, parameters: &[f64], x: [f64; N]) -> [f64; N] {
        let function = MembershipFunction::new(shape, parameters).unwrap();
        x.map(|x| function.degree(x))
    }

    #[test]
    fn tops_are_exactly_1() {
        for size in (1..1000).map(|size| f64::from(size) / 7.0) {
            for shape in [Shape::Ramp, Shape::SShape, Shape::Arc] {
                assert_eq!(degrees(shape, &[0.3, 0.3 + size], [0.3 + size]), [1.0], "{shape:?}");
            }
            assert_eq!(degrees(Shape::Ramp, &[size, 0.3], [0.3]), [1.0]);
            assert_eq!(degrees(Shape::Triangular, &[-size, 0.1, size], [0.1]), [1.0]);
        }
    }

    #[test]
    fn vertical_sides_belong_to_the_support() {
        let x = [-1e-9, 0.0, 0.25, 1.0, 1.0 + 1e-9];
        let triangle = |vertices: &[f64]| degrees(Shape::Triangular, vertices, x);
        assert_eq!(triangle(&[0.0, 0.0, 1.0]), [0.0, 1.0, 0.75, 0.0, 0.0]);
        assert_eq!(triangle(&[0.0, 1.0, 1.0]), [0.0, 0.0, 0.25, 1.0, 0.0]);
        for shape in [Shape::Trapezoidal, Shape::PiShape] {
            assert_eq!(degrees(shape, &[0.0, 0.0, 1.0, 1.0], x), [0.0, 1.0, 1.0, 1.0, 0.0]);
        }
        assert_eq!(degrees(Shape::Rectangle, &[0.0, 1.0], x), [0.0, 1.0, 1.0, 1.0, 0.0]);
        assert_eq!(degrees(Shape::Step, &[1.0, 1.0], [0.9, 1.0, 2.0]), [0.0, 1.0, 1.0]);
        assert_eq!(degrees(Shape::Step, &[1.0, -1.0], [0.9, 1.0, 1.1]), [1.0, 1.0, 0.0]);
        assert_eq!(degrees(Shape::Singleton, &[1.0], [0.9, 1.0, 1.1]), [0.0, 1.0, 0.0]);
    }

    /// A shape with its parameters, three numbers and their degrees.
    type Case = (Shape, &'static [f64], [f64; 3], [f64; 3]);

    #[test]
    fn degrees_follow_the_equations() {
        let e = std::f64::consts::E;
        let cases: [Case; 12] = [
            (Shape::Bell, &[1.0, 2.0, 3.0], [1.0, 3.0, 5.0], [1.0, 0.5, 1.0 / 65.0]),
            (Shape::Bell, &[1.0, 2.0, 0.001], [1.0, 3.0, -1.0], [1.0, 0.5, 0.5]),
            (Shape::Sigmoid, &[1.0, 2.0], [1.5, -1e9, 1e9], [e / (1.0 + e), 0.0, 1.0]),
            (Shape::SShape, &[0.0, 4.0], [1.0, 2.0, 3.0], [0.125, 0.5, 0.875]),
            (Shape::ZShape, &[0.0, 4.0], [1.0, 2.0, 3.0], [0.875, 0.5, 0.125]),
            (Shape::Ramp, &[4.0, 0.0], [1.0, 5.0, -1.0], [0.75, 0.0, 1.0]),
            (Shape::Concave, &[1.0, 2.0], [-1.0, 1.0, 3.0], [0.25, 0.5, 1.0]),
            (Shape::Arc, &[0.0, 5.0], [-1.0, 1.0, 2.0], [0.0, 0.6, 0.8]),
            (Shape::SemiEllipse, &[-5.0, 5.0], [-3.0, 4.0, 5.0], [0.8, 0.6, 0.0]),
            (Shape::Spike, &[1.0, 10.0], [2.0, 1.0, 0.0], [1.0 / e, 1.0, 1.0 / e]),
            (Shape::Cosine, &[1.0, 4.0], [0.0, 1.0, 3.0], [0.5, 1.0, 0.0]),
            (
                Shape::TwoSidedGaussian,
                &[0.0, 1.0, 2.0, 0.5],
                [1.0, 2.0, 2.0 + 0.5_f64.sqrt()],
                [1.0, 1.0, 1.0 / e],
            ),
        ];
        for (shape, parameters, x, expected) in cases {
            for (ours, theirs) in degrees(shape, parameters, x).into_iter().zip(expected) {
                assert!((ours - theirs).abs() <= 2.0 * f64::EPSILON * theirs, "{shape:?} {ours}");
            }
        }
        let points = [0.0, 0.25, 1.0, 0.75, 3.0, 0.0];
        let x = [-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 4.0];
        let expected = [0.25, 0.25, 0.5, 0.75, 0.375, 0.0, 0.0];
        assert_eq!(degrees(Shape::Points, &points, x), expected);
    }
}
