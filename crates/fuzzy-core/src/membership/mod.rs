//! Membership functions: how well a number fits a term, from 0 to 1.
//!
//! A function is a [`Shape`] and a few numbers. Shapes work on slices, so that the numbers may
//! live in a system's flat parameter vector; [`MembershipFunction`] is a shape that carries its
//! own, checked.

mod degree;
mod gradient;
mod inverse;
mod parameter;
mod polygon;
mod shape;

use crate::check;
use crate::error::Result;

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
        if x.is_nan() {
            return f64::NAN;
        }
        self.shape.prepared_degree(self.prepared.as_slice(), 0, self.parameters.len(), x)
    }

    /// The [`degree`](Self::degree) of each of many numbers, to the same bits.
    pub fn degrees(&self, points: &[f64], degrees: &mut [f64]) -> Result<()> {
        check::same_length("degrees", points.len(), degrees.len())?;
        for (degree, &x) in degrees.iter_mut().zip(points) {
            *degree = self.degree(x);
        }
        Ok(())
    }

    /// The derivatives of the degree at `x` to the parameters, in their order.
    ///
    /// At a foot of a triangle or trapezoid it is that from inside the support, at a shoulder
    /// zero; at another kink that of one side; zero where the degree jumps or its derivative is
    /// infinite. At NaN all are NaN.
    pub fn gradient(&self, x: f64) -> Vec<f64> {
        let mut derivatives = vec![f64::NAN; self.parameters.len()];
        if !x.is_nan() {
            self.shape.gradient(&self.parameters, x, self.degree(x), &mut derivatives);
        }
        derivatives
    }

    /// The derivative of the degree to `x` itself; zero where the degree jumps or its derivative
    /// is infinite, at a kink that of one side. NaN stays NaN.
    pub fn slope(&self, x: f64) -> f64 {
        if x.is_nan() {
            return f64::NAN;
        }
        self.shape.prepared_slope(&self.prepared, self.parameters.len(), x)
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
            message(MembershipFunction::triangular(1.0, 1.0, 1.0))
                .contains("must be above a (1), got 1")
        );
        assert!(message(MembershipFunction::new(Shape::Triangular, &[1.0])).contains("expected 3"));
    }
}
