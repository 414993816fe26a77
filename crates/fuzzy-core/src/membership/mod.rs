//! Membership functions: how well a number fits a term, from 0 to 1.
//!
//! A function is a [`Shape`] and a few numbers. Shapes work on slices, so that the numbers may
//! live in a system's flat parameter vector; [`MembershipFunction`] is a shape that carries its
//! own, checked.
//!
//! | Name | Equation | MATLAB | fuzzylite |
//! |------|----------|--------|-----------|
//! | `gaussian` | exp(−½((x − m)/σ)²) | `gaussmf` | Gaussian |
//! | `gaussian_width` | exp(−((x − m)/w)²) | | |
//! | `two_sided_gaussian` | exp(−½((x − m₁)/σ₁)²) before m₁ times exp(−½((x − m₂)/σ₂)²) beyond m₂ | `gauss2mf` | GaussianProduct |
//! | `bell` | 1/(1 + \|(x − c)/w\|²ˢ) | `gbellmf` | Bell |
//! | `sigmoid` | σ(x) = 1/(1 + e^(−s(x − c))) | `sigmf` | Sigmoid |
//! | `sigmoid_difference` | \|σ₁(x) − σ₂(x)\| | `dsigmf` | SigmoidDifference |
//! | `sigmoid_product` | σ₁(x)·σ₂(x) | `psigmf` | SigmoidProduct |
//! | `s_shape` | S(u): 2u² to u = ½, then 1 − 2(1 − u)², u = (x − a)/(b − a) | `smf` | SShape |
//! | `z_shape` | 1 − S(u) | `zmf` | ZShape |
//! | `pi_shape` | S from a to b, 1 to c, 1 − S from c to d | `pimf` | PiShape |
//! | `triangular` | 0 at a, 1 at b, 0 at c | `trimf` | Triangle |
//! | `trapezoidal` | 0 at a, 1 from b to c, 0 at d | `trapmf` | Trapezoid |
//! | `ramp` | u = (x − s)/(e − s) within 0 and 1 | `linsmf`, `linzmf` | Ramp |
//! | `rectangle` | 1 from a to b | | Rectangle |
//! | `singleton` | 1 at x | | |
//! | `step` | 1 from a place on, to one side | | Binary |
//! | `concave` | (e − i)/(2e − i − x) before e, 1 beyond | | Concave |
//! | `cosine` | ½(1 + cos(2π(x − c)/w)) within w/2 of c | | Cosine |
//! | `semi_ellipse` | √(1 − ((x − c)/r)²) | | SemiEllipse |
//! | `arc` | √(1 − ((x − e)/(e − s))²) from s to e, 1 beyond | | Arc |
//! | `spike` | exp(−\|10(x − c)/w\|) | | Spike |
//! | `points` | lines between (x₀, y₀), (x₁, y₁), … | | Discrete |
//!
//! Others order parameters differently: MATLAB's bell is (width, slope, centre) and its sigmoid
//! (slope, centre); fuzzylite's pairs of sigmoids are (left, rising, falling, right).

mod constraints;
mod degree;
mod gradient;
mod inverse;
mod parameter;
mod polygon;
mod properties;
mod shape;

use crate::check;
use crate::error::Result;
use crate::math::{LANES, Lanes, Real};

pub(crate) use constraints::Constraints;
pub use parameter::ParameterKind;
pub use shape::Shape;

/// A shape with its parameters.
///
/// ```
/// use fuzzy_core::MembershipFunction;
/// let warm = MembershipFunction::trapezoidal(15.0, 20.0, 25.0, 30.0)?;
/// assert_eq!(warm.degree(17.5), 0.5);
/// assert_eq!(warm.degree(22.0), 1.0);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MembershipFunction {
    shape: Shape,
    parameters: Vec<f64>,
    prepared: Vec<f64>,
}

impl MembershipFunction {
    /// A membership function of this shape.
    pub fn new(shape: Shape, parameters: &[f64]) -> Result<Self> {
        shape.check(parameters)?;
        let mut prepared = vec![0.0; shape.prepared_count(parameters.len())];
        shape.prepare(parameters, &mut prepared);
        Ok(Self { shape, parameters: parameters.to_vec(), prepared })
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
        &self.parameters
    }

    /// How well `x` fits, from 0 to 1. NaN stays NaN.
    pub fn degree(&self, x: f64) -> f64 {
        self.degree_or_nan(x)
    }

    /// The [`degree`](Self::degree) of each of many numbers, to the same bits.
    pub fn degrees(&self, points: &[f64], degrees: &mut [f64]) -> Result<()> {
        check::same_length("degrees", points.len(), degrees.len())?;
        let (eights, rest) = points.as_chunks::<LANES>();
        let (eights_of_degrees, rest_of_degrees) = degrees.as_chunks_mut::<LANES>();
        for (x, degrees) in eights.iter().zip(eights_of_degrees) {
            *degrees = self.degree_or_nan(Lanes::new(*x)).to_array();
        }
        for (&x, degree) in rest.iter().zip(rest_of_degrees) {
            *degree = self.degree(x);
        }
        Ok(())
    }

    #[inline(always)]
    fn degree_or_nan<R: Real>(&self, x: R) -> R {
        let (prepared, count) = (self.prepared.as_slice(), self.parameters.len());
        R::select(x.le(x), self.shape.prepared_degree(prepared, 0, count, x), x)
    }

    /// The derivatives of the degree at `x` to the parameters, in their order.
    ///
    /// At a foot of a triangle or trapezoid it is that from inside the support, at a shoulder
    /// zero; at another kink that of one side; zero where the degree jumps or its derivative is
    /// infinite. At NaN all are NaN.
    pub fn gradient(&self, x: f64) -> Vec<f64> {
        let mut derivatives = vec![f64::NAN; self.parameters.len()];
        self.write_gradient(x, &mut derivatives);
        derivatives
    }

    /// The [`gradient`](Self::gradient) at each of many numbers, row by row.
    pub fn gradients(&self, points: &[f64], derivatives: &mut [f64]) -> Result<()> {
        let width = self.parameters.len();
        check::same_length("derivatives", points.len() * width, derivatives.len())?;
        for (row, &x) in derivatives.chunks_exact_mut(width).zip(points) {
            self.write_gradient(x, row);
        }
        Ok(())
    }

    fn write_gradient(&self, x: f64, derivatives: &mut [f64]) {
        if x.is_nan() {
            derivatives.fill(f64::NAN);
        } else {
            self.shape.gradient(&self.parameters, x, self.degree(x), derivatives);
        }
    }

    /// The derivative of the degree to `x` itself; zero where the degree jumps or its derivative
    /// is infinite, at a kink that of one side. NaN stays NaN.
    pub fn slope(&self, x: f64) -> f64 {
        if x.is_nan() {
            return f64::NAN;
        }
        self.shape.prepared_slope(&self.prepared, self.parameters.len(), x)
    }

    /// The [`slope`](Self::slope) at each of many numbers.
    pub fn slopes(&self, points: &[f64], slopes: &mut [f64]) -> Result<()> {
        check::same_length("slopes", points.len(), slopes.len())?;
        for (slope, &x) in slopes.iter_mut().zip(points) {
            *slope = self.slope(x);
        }
        Ok(())
    }

    /// The number with this degree, of many the nearest to the climb; `None` unless the shape is
    /// [monotone](Shape::is_monotone) and the degree between 0 and 1.
    ///
    /// A sigmoid never reaches 0 and 1, a concave function never 0: there it is the number whose
    /// degree is 1e-150 or 1 − 2⁻⁵³.
    pub fn inverse(&self, degree: f64) -> Option<f64> {
        let known = self.shape.is_monotone() && (0.0..=1.0).contains(&degree);
        known.then(|| self.shape.inverse(&self.parameters, degree))
    }
}
