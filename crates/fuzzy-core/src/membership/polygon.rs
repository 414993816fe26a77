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

    /// The middle of the core within the universe from `low` to `high`: where the degree is 1,
    /// or for shapes that don't reach 1 where it is largest or goes to 1.
    pub(crate) fn centre<N: Scalar>(self, p: &[N], low: f64, high: f64) -> N {
        let (low, high) = (N::splat(low), N::splat(high));
        let middle = |a: N, b: N| (a + b) * N::splat(0.5);
        let open = |to_right: bool, edge: N| match to_right {
            true => (edge, high),
            false => (low, edge),
        };
        let zero = N::splat(0.0);
        let (from, to) = match self {
            Self::Gaussian | Self::GaussianWidth | Self::Bell | Self::Cosine | Self::Spike => {
                (p[0], p[0])
            }
            Self::Singleton => (p[0], p[0]),
            Self::TwoSidedGaussian | Self::SigmoidDifference | Self::SigmoidProduct => (p[0], p[2]),
            Self::Triangular => (p[1], p[1]),
            Self::Trapezoidal | Self::PiShape => (p[1], p[2]),
            Self::Rectangle | Self::SemiEllipse => (p[0], p[1]),
            // A sigmoid goes to 1 beyond any number, so its core is the end of the universe.
            Self::Sigmoid => match zero.lt(p[1]) {
                true => (high, high),
                false => (low, low),
            },
            Self::SShape => open(true, p[1]),
            Self::ZShape => open(false, p[0]),
            Self::Step => open(zero.lt(p[1]), p[0]),
            Self::Ramp | Self::Concave | Self::Arc => open(p[0].lt(p[1]), p[1]),
            Self::Points => widest_top(p, low, high),
        };
        let within = |x: N| x.max(low).min(high);
        middle(within(from), within(to))
    }
}

/// The first and the last place where the degree of points is largest.
fn widest_top<N: Scalar>(p: &[N], low: N, high: N) -> (N, N) {
    let most = p.chunks_exact(2).fold(f64::NEG_INFINITY, |most, point| most.max(point[1].value()));
    let top = |point: &&[N]| point[1].value() >= most;
    let first = p.chunks_exact(2).position(|point| top(&point));
    let last = p.chunks_exact(2).rposition(|point| top(&point));
    let count = p.len() / 2;
    match (first, last) {
        (Some(first), Some(last)) => (
            if first == 0 { low } else { p[2 * first] },
            if last + 1 == count { high } else { p[2 * last] },
        ),
        _ => (low, high),
    }
}
