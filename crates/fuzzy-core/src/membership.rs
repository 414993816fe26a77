//! Membership functions: how well a number fits a term, from 0 to 1.
//!
//! A function is a [`Shape`] and a few numbers. Shapes work on slices, so that the numbers may
//! live in a system's flat parameter vector; [`MembershipFunction`] is a shape that carries its
//! own, checked.

use std::ops::RangeInclusive;

use crate::check;
use crate::error::{Error, Result};
use crate::math::{Real, exp2_decay};

/// The form of a membership function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Shape {
    /// exp(−½((x − m)/σ)²) with parameters `mean` m and `sigma` σ > 0, the standard deviation.
    Gaussian,
    /// exp(−((x − m)/w)²) with parameters `mean` m and `width` w > 0, the distance at which the
    /// degree has fallen to 1/e (w = √2 σ). The form of the thesis's equation 2.2, whose
    /// gradients 2.25–2.26 and learning rates belong to it.
    GaussianWidth,
    /// 0 at `a`, 1 at `b`, 0 at `c`, straight between; a ≤ b ≤ c and a < c.
    Triangular,
    /// 0 at `a`, 1 from `b` to `c`, 0 at `d`, straight between (2.1); a ≤ b ≤ c ≤ d and a < d.
    Trapezoidal,
}

/// The widths of Gaussians whose squares, and the inverses of these, are normal numbers.
const WIDTHS: RangeInclusive<f64> = 1e-150..=1e150;

/// The most parameters that a shape has.
pub(crate) const MAX_PARAMETERS: usize = 4;
/// The numbers that a shape's parameters are prepared into for [`Shape::prepared_degree`].
pub(crate) const PREPARED: usize = 4;

impl Shape {
    /// Every shape.
    pub const ALL: [Self; 4] =
        [Self::Gaussian, Self::GaussianWidth, Self::Triangular, Self::Trapezoidal];

    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gaussian => "gaussian",
            Self::GaussianWidth => "gaussian_width",
            Self::Triangular => "triangular",
            Self::Trapezoidal => "trapezoidal",
        }
    }

    /// The shape with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|shape| shape.name() == name).ok_or_else(|| {
            Error::unknown_name("membership function", name, Self::ALL.map(Self::name))
        })
    }

    /// The names of the parameters, in their order.
    pub fn parameter_names(self) -> &'static [&'static str] {
        match self {
            Self::Gaussian => &["mean", "sigma"],
            Self::GaussianWidth => &["mean", "width"],
            Self::Triangular => &["a", "b", "c"],
            Self::Trapezoidal => &["a", "b", "c", "d"],
        }
    }

    /// The number of parameters.
    pub fn parameter_count(self) -> usize {
        self.parameter_names().len()
    }

    /// Whether these are valid parameters of the shape, as many as it has.
    pub fn accepts(self, parameters: &[f64]) -> bool {
        parameters.iter().all(|value| value.is_finite())
            && match self {
                Self::Gaussian | Self::GaussianWidth => WIDTHS.contains(&parameters[1]),
                Self::Triangular | Self::Trapezoidal => {
                    let size = parameters[self.parameter_count() - 1] - parameters[0];
                    parameters.is_sorted() && size > 0.0 && size.is_finite()
                }
            }
    }

    /// Nothing, if these are valid parameters of the shape; otherwise what is wrong with them.
    pub fn check(self, parameters: &[f64]) -> Result<()> {
        let names = self.parameter_names();
        check::same_length(
            &format!("parameters of a {} membership function", self.name()),
            names.len(),
            parameters.len(),
        )?;
        if self.accepts(parameters) {
            return Ok(());
        }
        for (name, &value) in names.iter().zip(parameters) {
            check::finite(&format!("{name} of a {} membership function", self.name()), value)?;
        }
        match self {
            Self::Gaussian | Self::GaussianWidth => {
                let what = format!("{} of a {} membership function", names[1], self.name());
                check::positive(&what, parameters[1])?;
                let expected = format!("from {:e} to {:e}", WIDTHS.start(), WIDTHS.end());
                check::within(&what, parameters[1], &expected, |w| WIDTHS.contains(&w))?;
            }
            Self::Triangular | Self::Trapezoidal => {
                let what = format!("size of a {} membership function", self.name());
                check::finite(&what, parameters[names.len() - 1] - parameters[0])?;
            }
        }
        Err(Error::CrossedVertices { shape: self.name(), vertices: parameters.to_vec() })
    }

    /// Turns parameters into the numbers that [`prepared_degree`](Self::prepared_degree) wants,
    /// so that evaluation needs no division. A vertical side becomes an infinite slope.
    pub(crate) fn prepare(self, p: &[f64]) -> [f64; PREPARED] {
        match self {
            Self::Gaussian => [p[0], -0.5 * per_square(p[1]), 0.0, 0.0],
            Self::GaussianWidth => [p[0], -per_square(p[1]), 0.0, 0.0],
            Self::Triangular => [p[0], 1.0 / (p[1] - p[0]), p[2], 1.0 / (p[2] - p[1])],
            Self::Trapezoidal => [p[0], 1.0 / (p[1] - p[0]), p[3], 1.0 / (p[3] - p[2])],
        }
    }

    /// The degree of `x` under prepared parameters.
    #[inline(always)]
    pub(crate) fn prepared_degree<R: Real>(self, prepared: [R; PREPARED], x: R) -> R {
        let [first, second, third, fourth] = prepared;
        match self {
            Self::Gaussian | Self::GaussianWidth => {
                let distance = x - first;
                exp2_decay(second * (distance * distance))
            }
            Self::Triangular | Self::Trapezoidal => {
                // On a vertical side 0·∞ is NaN, which `min` drops in favour of its other side.
                let one = R::splat(1.0);
                let rising = ((x - first) * second).min(one);
                let falling = ((third - x) * fourth).min(one);
                rising.min(falling).max(R::splat(0.0))
            }
        }
    }

    /// The derivatives of the degree to the parameters, where `degree` is the degree at `x`.
    ///
    /// At a foot the derivative from inside the support is given, at a shoulder zero.
    #[inline(always)]
    pub(crate) fn gradient<R: Real>(self, p: &[R], x: R, degree: R) -> [R; MAX_PARAMETERS] {
        let zero = R::splat(0.0);
        match self {
            Self::Gaussian | Self::GaussianWidth => {
                // The thesis's form doubles both (2.25, 2.26; 7.10, 7.11).
                let factor = if self == Self::Gaussian { 1.0 } else { 2.0 };
                let z = (x - p[0]) / p[1];
                let by_mean = R::splat(factor) * degree * z / p[1];
                // Where the degree is zero, z may be infinite.
                let there = zero.lt(degree);
                let only_there = |value| R::select(there, value, zero);
                [only_there(by_mean), only_there(by_mean * z), zero, zero]
            }
            Self::Triangular => {
                let [a, b, c, d] = sides(p[0], p[1], p[1], p[2], x);
                [a, b + c, d, zero]
            }
            Self::Trapezoidal => sides(p[0], p[1], p[2], p[3], x),
        }
    }
}

/// log₂e/w², which turns a squared distance into the exponent of 2.
fn per_square(width: f64) -> f64 {
    std::f64::consts::LOG2_E / (width * width)
}

/// The derivatives of a trapezoid's degree to its four vertices.
#[inline(always)]
fn sides<R: Real>(a: R, b: R, c: R, d: R, x: R) -> [R; 4] {
    let zero = R::splat(0.0);
    let on_left = |value: R| R::select(a.le(x) & x.lt(b), value, zero);
    let on_right = |value: R| R::select(c.lt(x) & x.le(d), value, zero);
    let (rise, fall) = ((b - a) * (b - a), (d - c) * (d - c));
    [
        on_left((x - b) / rise),
        on_left((a - x) / rise),
        on_right((d - x) / fall),
        on_right((x - c) / fall),
    ]
}

/// A shape with its parameters.
///
/// ```
/// use fuzzy_core::MembershipFunction;
/// let warm = MembershipFunction::trapezoidal(15.0, 20.0, 25.0, 30.0)?;
/// assert_eq!(warm.degree(17.5), 0.5);
/// assert_eq!(warm.degree(22.0), 1.0);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MembershipFunction {
    shape: Shape,
    parameters: [f64; MAX_PARAMETERS],
}

impl MembershipFunction {
    /// A membership function of this shape.
    pub fn new(shape: Shape, parameters: &[f64]) -> Result<Self> {
        shape.check(parameters)?;
        let mut stored = [0.0; MAX_PARAMETERS];
        stored[..parameters.len()].copy_from_slice(parameters);
        Ok(Self { shape, parameters: stored })
    }

    /// [`Shape::Gaussian`].
    pub fn gaussian(mean: f64, sigma: f64) -> Result<Self> {
        Self::new(Shape::Gaussian, &[mean, sigma])
    }

    /// [`Shape::GaussianWidth`].
    pub fn gaussian_width(mean: f64, width: f64) -> Result<Self> {
        Self::new(Shape::GaussianWidth, &[mean, width])
    }

    /// [`Shape::Triangular`].
    pub fn triangular(a: f64, b: f64, c: f64) -> Result<Self> {
        Self::new(Shape::Triangular, &[a, b, c])
    }

    /// [`Shape::Trapezoidal`].
    pub fn trapezoidal(a: f64, b: f64, c: f64, d: f64) -> Result<Self> {
        Self::new(Shape::Trapezoidal, &[a, b, c, d])
    }

    /// The form of the function.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The parameters, in the order of [`Shape::parameter_names`].
    pub fn parameters(&self) -> &[f64] {
        &self.parameters[..self.shape.parameter_count()]
    }

    /// How well `x` fits, from 0 to 1. NaN stays NaN.
    pub fn degree(&self, x: f64) -> f64 {
        self.degree_prepared(self.shape.prepare(&self.parameters), x)
    }

    fn degree_prepared(&self, prepared: [f64; PREPARED], x: f64) -> f64 {
        if x.is_nan() { f64::NAN } else { self.shape.prepared_degree(prepared, x) }
    }

    /// The [`degree`](Self::degree) of each of many numbers, to the same bits.
    pub fn degrees(&self, points: &[f64], degrees: &mut [f64]) -> Result<()> {
        check::same_length("degrees", points.len(), degrees.len())?;
        let prepared = self.shape.prepare(&self.parameters);
        for (degree, &x) in degrees.iter_mut().zip(points) {
            *degree = self.degree_prepared(prepared, x);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertical_sides_belong_to_the_support() {
        let left = MembershipFunction::triangular(0.0, 0.0, 1.0).unwrap();
        assert_eq!([-1e-9, 0.0, 0.25, 1.0].map(|x| left.degree(x)), [0.0, 1.0, 0.75, 0.0]);
        let right = MembershipFunction::triangular(0.0, 1.0, 1.0).unwrap();
        assert_eq!([0.75, 1.0, 1.0 + 1e-9].map(|x| right.degree(x)), [0.75, 1.0, 0.0]);
        let box_ = MembershipFunction::trapezoidal(0.0, 0.0, 2.0, 2.0).unwrap();
        assert_eq!([-0.1, 0.0, 1.0, 2.0, 2.1].map(|x| box_.degree(x)), [0.0, 1.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn the_two_gaussians_differ_by_root_two() {
        let sigma = MembershipFunction::gaussian(1.0, 2.0).unwrap();
        let width = MembershipFunction::gaussian_width(1.0, 2.0 * 2.0_f64.sqrt()).unwrap();
        assert!((sigma.degree(3.0) - (-0.5_f64).exp()).abs() < 1e-15);
        assert!((sigma.degree(3.7) - width.degree(3.7)).abs() < 1e-15);
    }

    #[test]
    fn nan_never_becomes_a_degree() {
        for shape in Shape::ALL {
            let parameters = &[0.0, 1.0, 2.0, 3.0][..shape.parameter_count()];
            assert!(MembershipFunction::new(shape, parameters).unwrap().degree(f64::NAN).is_nan());
        }
    }

    #[test]
    fn bad_parameters_are_refused_in_words() {
        let message = |f: Result<MembershipFunction>| f.unwrap_err().to_string();
        assert_eq!(
            message(MembershipFunction::gaussian(0.0, 0.0)),
            "sigma of a gaussian membership function must be positive, got 0"
        );
        assert_eq!(
            message(MembershipFunction::trapezoidal(0.0, 2.0, 1.0, 3.0)),
            "the vertices of a trapezoidal membership function must not decrease, \
             got [0.0, 2.0, 1.0, 3.0]"
        );
        assert!(message(MembershipFunction::gaussian(f64::NAN, 1.0)).contains("must be finite"));
        assert!(
            message(MembershipFunction::triangular(1.0, 1.0, 1.0)).contains("must not decrease")
        );
        assert!(message(MembershipFunction::new(Shape::Triangular, &[1.0])).contains("expected 3"));
    }
}
