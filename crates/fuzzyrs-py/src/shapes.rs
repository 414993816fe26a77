//! A function for each shape of membership functions.

use fuzzy_core::{MembershipFunction, Shape};
use pyo3::prelude::*;

use crate::arrays::pairs;
use crate::errors::Result;
use crate::membership::PyMembershipFunction;

/// Functions that make a membership function from its parameters, and one that puts them all, and
/// `points`, into the module.
macro_rules! shapes {
    ($($(#[$doc:meta])* $name:ident($($parameter:ident),+) = $shape:ident;)+) => {
        $(
            $(#[$doc])*
            #[pyfunction]
            fn $name($($parameter: f64),+) -> Result<PyMembershipFunction> {
                let parameters = [$($parameter),+];
                Ok(PyMembershipFunction(MembershipFunction::new(Shape::$shape, &parameters)?))
            }
        )+

        pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
            $(module.add_function(wrap_pyfunction!($name, module)?)?;)+
            module.add_function(wrap_pyfunction!(points, module)?)
        }
    };
}

shapes! {
    /// exp(-((x - mean)/sigma)²/2).
    ///
    /// Parameters
    /// ----------
    /// mean : float
    ///     Where the degree is 1.
    /// sigma : float
    ///     The standard deviation, from 1e-150 to 1e150.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    gaussian(mean, sigma) = Gaussian;

    /// exp(-((x - mean)/width)²), the form of Desouky's thesis; width is sqrt(2) times sigma.
    ///
    /// Parameters
    /// ----------
    /// mean : float
    ///     Where the degree is 1.
    /// width : float
    ///     The distance at which the degree is 1/e, from 1e-150 to 1e150.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    gaussian_width(mean, width) = GaussianWidth;

    /// A Gaussian flank on either side: exp(-((x - left_mean)/left_sigma)²/2) before `left_mean` times
    /// exp(-((x - right_mean)/right_sigma)²/2) beyond `right_mean`.
    ///
    /// The degree is 1 between the means; where they are crossed it stays below 1. MATLAB's gauss2mf.
    ///
    /// Parameters
    /// ----------
    /// left_mean, right_mean : float
    ///     Where the flanks end and begin.
    /// left_sigma, right_sigma : float
    ///     Their standard deviations, from 1e-150 to 1e150.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    two_sided_gaussian(left_mean, left_sigma, right_mean, right_sigma) = TwoSidedGaussian;

    /// 1/(1 + |(x - centre)/width|^(2 slope)).
    ///
    /// MATLAB's gbellmf, with the centre first.
    ///
    /// Parameters
    /// ----------
    /// centre : float
    ///     Where the degree is 1.
    /// width : float
    ///     The distance at which the degree is 0.5, from 1e-150 to 1e150.
    /// slope : float
    ///     How steep it is there; positive, without unit.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    bell(centre, width, slope) = Bell;

    /// 1/(1 + exp(-slope (x - centre))).
    ///
    /// MATLAB's sigmf, with the centre first.
    ///
    /// Parameters
    /// ----------
    /// centre : float
    ///     Where the degree is 0.5.
    /// slope : float
    ///     Positive if the degree rises, negative if it falls.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    sigmoid(centre, slope) = Sigmoid;

    /// The absolute difference of two sigmoids.
    ///
    /// MATLAB's dsigmf, with the centres before the slopes.
    ///
    /// Parameters
    /// ----------
    /// left_centre, right_centre : float
    ///     Where each sigmoid is 0.5.
    /// left_slope, right_slope : float
    ///     Positive if it rises, negative if it falls.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    sigmoid_difference(left_centre, left_slope, right_centre, right_slope) = SigmoidDifference;

    /// The product of two sigmoids.
    ///
    /// MATLAB's psigmf, with the centres before the slopes.
    ///
    /// Parameters
    /// ----------
    /// left_centre, right_centre : float
    ///     Where each sigmoid is 0.5.
    /// left_slope, right_slope : float
    ///     Positive if it rises, negative if it falls.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    sigmoid_product(left_centre, left_slope, right_centre, right_slope) = SigmoidProduct;

    /// Rises smoothly from `a` to `b`: 2u² up to the middle and 1 - 2(1 - u)² from there, with
    /// u = (x - a)/(b - a).
    ///
    /// MATLAB's smf.
    ///
    /// Parameters
    /// ----------
    /// a, b : float
    ///     Where the degree leaves 0 and where it reaches 1, a < b.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    s_shape(a, b) = SShape;

    /// Falls smoothly from `a` to `b`: 1 - s_shape(a, b).
    ///
    /// MATLAB's zmf.
    ///
    /// Parameters
    /// ----------
    /// a, b : float
    ///     Where the degree leaves 1 and where it reaches 0, a < b.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    z_shape(a, b) = ZShape;

    /// Rises smoothly from `a` to `b`, stays at 1 until `c` and falls smoothly to `d`.
    ///
    /// MATLAB's pimf.
    ///
    /// Parameters
    /// ----------
    /// a, b, c, d : float
    ///     The vertices, a <= b <= c <= d and a < d. Where two are equal the side is vertical.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    pi_shape(a, b, c, d) = PiShape;

    /// Rises from `a` to `b` and falls to `c`.
    ///
    /// Parameters
    /// ----------
    /// a, b, c : float
    ///     The vertices, a <= b <= c and a < c. Where two are equal the side is vertical.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    triangular(a, b, c) = Triangular;

    /// Rises from `a` to `b`, stays at 1 until `c` and falls to `d`.
    ///
    /// Parameters
    /// ----------
    /// a, b, c, d : float
    ///     The vertices, a <= b <= c <= d and a < d. Where two are equal the side is vertical.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    trapezoidal(a, b, c, d) = Trapezoidal;

    /// 0 at `start`, 1 at `end` and beyond, straight between; falls if start > end.
    ///
    /// Parameters
    /// ----------
    /// start, end : float
    ///     Two different places.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    ramp(start, end) = Ramp;

    /// 1 from `a` to `b`, both included, and 0 elsewhere.
    ///
    /// Parameters
    /// ----------
    /// a, b : float
    ///     The ends, a < b.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    rectangle(a, b) = Rectangle;

    /// 1 exactly at `x` and 0 elsewhere.
    ///
    /// Parameters
    /// ----------
    /// x : float
    ///     The place.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    singleton(x) = Singleton;

    /// 1 at `at` and on one side of it, 0 on the other.
    ///
    /// Parameters
    /// ----------
    /// at : float
    ///     Where the degree jumps.
    /// direction : float
    ///     1 if the degree is 1 on the right, -1 if it is 1 on the left.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    step(at, direction) = Step;

    /// (end - inflection)/(2 end - inflection - x) before `end` and 1 beyond.
    ///
    /// It rises to the right if inflection < end and to the left if inflection > end.
    ///
    /// Parameters
    /// ----------
    /// inflection : float
    ///     Where the degree is 0.5.
    /// end : float
    ///     Where it reaches 1.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    concave(inflection, end) = Concave;

    /// (1 + cos(2 pi (x - centre)/width))/2 within half the width of the centre, 0 elsewhere.
    ///
    /// Parameters
    /// ----------
    /// centre : float
    ///     Where the degree is 1.
    /// width : float
    ///     The distance between the feet, from 1e-150 to 1e150.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    cosine(centre, width) = Cosine;

    /// sqrt(1 - ((x - c)/r)²) between `a` and `b`, with their middle c and r = (b - a)/2.
    ///
    /// Parameters
    /// ----------
    /// a, b : float
    ///     The ends, a < b.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    semi_ellipse(a, b) = SemiEllipse;

    /// A quarter of an ellipse, sqrt(1 - ((x - end)/(end - start))²) from `start` to `end`.
    ///
    /// 0 before and 1 beyond; falls if start > end.
    ///
    /// Parameters
    /// ----------
    /// start, end : float
    ///     Two different places.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    arc(start, end) = Arc;

    /// exp(-|10 (x - centre)/width|).
    ///
    /// Parameters
    /// ----------
    /// centre : float
    ///     Where the degree is 1.
    /// width : float
    ///     Ten times the distance at which the degree is 1/e, from 1e-150 to 1e150.
    ///
    /// Returns
    /// -------
    /// MembershipFunction
    spike(centre, width) = Spike;
}

/// Straight lines between points; outside them the degree of the nearest end.
///
/// Parameters
/// ----------
/// points : array_like of shape (n, 2)
///     Pairs (x, degree), two at least, x increasing, degrees from 0 to 1.
///
/// Returns
/// -------
/// MembershipFunction
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.points([(0, 0), (1, 0.8), (4, 0.2)])(0.5)
/// 0.4
#[pyfunction]
fn points(points: &Bound<'_, PyAny>) -> Result<PyMembershipFunction> {
    let parameters: Vec<f64> =
        pairs(points, "points")?.into_iter().flat_map(|(x, degree)| [x, degree]).collect();
    Ok(PyMembershipFunction(MembershipFunction::new(Shape::Points, &parameters)?))
}
