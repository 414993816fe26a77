//! Where degrees have no derivative.

use fuzzy_core::membership::ParameterKind;
use fuzzy_core::{MembershipFunction, Shape};

/// The distance from `x` to the nearest place where the degree jumps or has a kink.
pub fn distance_to_kinks(function: &MembershipFunction, x: f64) -> f64 {
    let p = function.parameters();
    let kinks = match function.shape() {
        Shape::Gaussian
        | Shape::GaussianWidth
        | Shape::TwoSidedGaussian
        | Shape::Sigmoid
        | Shape::SigmoidProduct => vec![],
        Shape::SigmoidDifference => crossing_of_sigmoids(p).into_iter().collect(),
        // Its foot on either side.
        Shape::Cosine => vec![p[0] - 0.5 * p[1], p[0] + 0.5 * p[1]],
        shape => (0..p.len())
            .filter(|&index| {
                use ParameterKind::{Centre, Vertex};
                matches!(shape.parameter_kind(index), Centre | Vertex)
            })
            .map(|index| p[index])
            .collect(),
    };
    kinks.into_iter().map(|kink| (kink - x).abs()).fold(f64::INFINITY, f64::min)
}

/// Where s₁(x − c₁) = s₂(x − c₂).
fn crossing_of_sigmoids(p: &[f64]) -> Option<f64> {
    (p[1] != p[3]).then(|| (p[1] * p[0] - p[3] * p[2]) / (p[1] - p[3]))
}
