//! Membership functions as polygons, and the middle of their cores, as formulas of their
//! parameters.

use super::Shape;
use crate::math::Scalar;

impl Shape {
    /// The vertices (x, degree) of a [piecewise-linear](Self::is_piecewise_linear) shape, from
    /// left to right; two of one x make a jump. Left of the first and right of the last the
    /// degree is constant. None for other shapes.
    pub(crate) fn vertices<N: Scalar>(self, p: &[N]) -> Option<Vec<(N, N)>> {
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        Some(match self {
            Self::Triangular => vec![(p[0], zero), (p[1], one), (p[2], zero)],
            Self::Trapezoidal => vec![(p[0], zero), (p[1], one), (p[2], one), (p[3], zero)],
            Self::Rectangle => vec![(p[0], zero), (p[0], one), (p[1], one), (p[1], zero)],
            Self::Ramp if p[0].lt(p[1]) => vec![(p[0], zero), (p[1], one)],
            Self::Ramp => vec![(p[1], one), (p[0], zero)],
            Self::Points => p.chunks_exact(2).map(|point| (point[0], point[1])).collect(),
            _ => return None,
        })
    }

    /// The middle of the core, or the place of the greatest degree, within the universe from
    /// `low` to `high`: [`MembershipFunction::centre`](super::MembershipFunction::centre).
    pub(crate) fn centre<N: Scalar>(self, p: &[N], low: f64, high: f64) -> N {
        let one = N::splat(1.0);
        let (low, high) = (N::splat(low), N::splat(high));
        let open = |to_right: bool, edge: N| if to_right { (edge, high) } else { (low, edge) };
        let rises = |direction: N| direction.value() > 0.0;
        let (from, to) = match self {
            Self::Gaussian
            | Self::GaussianWidth
            | Self::Bell
            | Self::Cosine
            | Self::Spike
            | Self::Singleton => (p[0], p[0]),
            Self::TwoSidedGaussian if p[2].lt(p[0]) => {
                let ratio = p[3] / p[1];
                let crossing = p[0] + (p[2] - p[0]) / (one + ratio * ratio);
                (crossing, crossing)
            }
            Self::TwoSidedGaussian => (p[0], p[2]),
            Self::SigmoidDifference | Self::SigmoidProduct => {
                let between = middle(p[0], p[2]);
                (between, between)
            }
            Self::SemiEllipse => {
                let between = middle(p[0], p[1]);
                (between, between)
            }
            Self::Triangular => (p[1], p[1]),
            Self::Trapezoidal | Self::PiShape => (p[1], p[2]),
            Self::Rectangle => (p[0], p[1]),
            // A sigmoid rises for ever.
            Self::Sigmoid => open(rises(p[1]), if rises(p[1]) { high } else { low }),
            Self::SShape => open(true, p[1]),
            Self::ZShape => open(false, p[0]),
            Self::Step => open(rises(p[1]), p[0]),
            Self::Ramp | Self::Concave | Self::Arc => open(rises(p[1] - p[0]), p[1]),
            Self::Points => highest(p, low, high),
        };
        let within = |x: N| x.max(low).min(high);
        middle(within(from), within(to))
    }
}

/// The middle of two numbers, however large they are.
fn middle<N: Scalar>(low: N, high: N) -> N {
    low * N::splat(0.5) + high * N::splat(0.5)
}

/// The smallest interval that holds the places within the universe where points are highest.
fn highest<N: Scalar>(p: &[N], low: N, high: N) -> (N, N) {
    let degree = |x: N| {
        let (first, last) = (0, p.len() - 2);
        let right = p.chunks_exact(2).position(|point| x.lt(point[0]));
        match right.map(|index| 2 * index) {
            None => p[last + 1],
            Some(0) => p[first + 1],
            Some(right) => {
                let share = (x - p[right - 2]) / (p[right] - p[right - 2]);
                share.mul_add(p[right + 1] - p[right - 1], p[right - 1])
            }
        }
    };
    let inside = |point: &&[N]| low.lt(point[0]) && point[0].lt(high);
    let mut corners = vec![(low, degree(low))];
    corners.extend(p.chunks_exact(2).filter(inside).map(|point| (point[0], point[1])));
    corners.push((high, degree(high)));
    let most = corners.iter().fold(0.0, |most: f64, corner| most.max(corner.1.value()));
    let mut places =
        corners.iter().filter(|corner| corner.1.value() == most).map(|corner| corner.0);
    let first = places.next().unwrap_or(low);
    (first, places.last().unwrap_or(first))
}
