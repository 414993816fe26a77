//! Where a membership function is above 0, where it is 1, and the corners that it has.

use super::{MembershipFunction, Shape};
use crate::variable::Universe;

type Interval = (f64, f64);

impl MembershipFunction {
    /// The smallest closed interval that holds every number of the universe with a degree above
    /// 0; `None` if there is none.
    ///
    /// Of the equation, not of its rounding: a Gaussian's is the whole universe.
    pub fn support(&self, universe: Universe) -> Option<Interval> {
        if self.shape == Shape::Points {
            let corners = self.corners_within(universe);
            let pieces = corners.windows(2).filter(|ends| ends[0].1 > 0.0 || ends[1].1 > 0.0);
            return hull(pieces.flatten());
        }
        let (low, high) = common(self.unlimited_support()?, universe)?;
        (low < high || self.degree(low) > 0.0).then_some((low, high))
    }

    /// The smallest interval that holds every number of the universe with degree 1; `None` if
    /// there is none.
    ///
    /// Of the equation, not of its rounding: a sigmoid has none, as it never reaches 1.
    pub fn core(&self, universe: Universe) -> Option<Interval> {
        if self.shape == Shape::Points {
            let corners = self.corners_within(universe);
            return hull(corners.iter().filter(|corner| corner.1 == 1.0));
        }
        common(self.unlimited_core()?, universe)
    }

    /// The middle of the [`core`](Self::core). Where a function does not reach 1 within the
    /// universe, the place of its greatest degree there:
    ///
    /// - the end of the universe that is nearest to the core beyond it, or to which a sigmoid
    ///   rises;
    /// - the middle of the highest points;
    /// - (m₁/σ₁² + m₂/σ₂²)/(1/σ₁² + 1/σ₂²), where the flanks of a two-sided Gaussian cross;
    /// - half-way between the centres of two sigmoids, which is the peak of their difference or
    ///   product if they are equally steep.
    pub fn centre(&self, universe: Universe) -> f64 {
        self.shape.centre(&self.parameters, universe.low(), universe.high())
    }

    /// The corners (x, degree) of a [piecewise linear](Shape::is_piecewise_linear) function, x
    /// never decreasing; `None` for other shapes.
    ///
    /// Between two corners the degree is on the line between them, before the first and after
    /// the last it is theirs. A vertical side has two corners at one x, where the degree is the
    /// greater of both.
    pub fn vertices(&self) -> Option<Vec<(f64, f64)>> {
        self.shape.vertices(&self.parameters)
    }

    /// The support on the line of all numbers, for shapes other than points.
    fn unlimited_support(&self) -> Option<Interval> {
        let p = self.parameters();
        Some(match self.shape {
            Shape::Triangular => (p[0], p[2]),
            Shape::Trapezoidal | Shape::PiShape => (p[0], p[3]),
            Shape::Rectangle | Shape::SemiEllipse => (p[0], p[1]),
            Shape::Cosine => (p[0] - 0.5 * p[1], p[0] + 0.5 * p[1]),
            Shape::SShape => (p[0], f64::INFINITY),
            Shape::ZShape => (f64::NEG_INFINITY, p[1]),
            Shape::Ramp | Shape::Arc => half_line(p[0], p[1] - p[0]),
            Shape::Step => half_line(p[0], p[1]),
            Shape::Singleton => (p[0], p[0]),
            // The sigmoids cancel.
            Shape::SigmoidDifference if p[..2] == p[2..] => return None,
            Shape::Gaussian
            | Shape::GaussianWidth
            | Shape::TwoSidedGaussian
            | Shape::Bell
            | Shape::Sigmoid
            | Shape::SigmoidDifference
            | Shape::SigmoidProduct
            | Shape::Concave
            | Shape::Spike
            | Shape::Points => (f64::NEG_INFINITY, f64::INFINITY),
        })
    }

    /// The core on the line of all numbers, for shapes other than points.
    fn unlimited_core(&self) -> Option<Interval> {
        let p = self.parameters();
        Some(match self.shape {
            Shape::Gaussian
            | Shape::GaussianWidth
            | Shape::Bell
            | Shape::Cosine
            | Shape::Spike
            | Shape::Singleton => (p[0], p[0]),
            Shape::TwoSidedGaussian if p[0] <= p[2] => (p[0], p[2]),
            Shape::Triangular => (p[1], p[1]),
            Shape::Trapezoidal | Shape::PiShape => (p[1], p[2]),
            Shape::Rectangle => (p[0], p[1]),
            Shape::SemiEllipse => {
                let middle = 0.5 * p[0] + 0.5 * p[1];
                (middle, middle)
            }
            Shape::SShape => (p[1], f64::INFINITY),
            Shape::ZShape => (f64::NEG_INFINITY, p[0]),
            Shape::Ramp | Shape::Arc | Shape::Concave => half_line(p[1], p[1] - p[0]),
            Shape::Step => half_line(p[0], p[1]),
            Shape::TwoSidedGaussian
            | Shape::Sigmoid
            | Shape::SigmoidDifference
            | Shape::SigmoidProduct
            | Shape::Points => return None,
        })
    }

    /// The ends of the universe and the points between them, with their degrees.
    fn corners_within(&self, universe: Universe) -> Vec<(f64, f64)> {
        let (low, high) = (universe.low(), universe.high());
        let points = self.parameters().chunks_exact(2).map(|point| (point[0], point[1]));
        let mut corners = vec![(low, self.degree(low))];
        corners.extend(points.filter(|&(x, _)| low < x && x < high));
        corners.push((high, self.degree(high)));
        corners
    }
}

/// The smallest interval that holds the places of corners that come in their order.
fn hull<'a>(corners: impl IntoIterator<Item = &'a (f64, f64)>) -> Option<Interval> {
    let mut places = corners.into_iter().map(|corner| corner.0);
    let first = places.next()?;
    Some((first, places.last().unwrap_or(first)))
}

/// All numbers from `end` on in this direction.
fn half_line(end: f64, direction: f64) -> Interval {
    if direction > 0.0 { (end, f64::INFINITY) } else { (f64::NEG_INFINITY, end) }
}

/// What an interval and the universe have in common.
fn common((low, high): Interval, universe: Universe) -> Option<Interval> {
    let (low, high) = (low.max(universe.low()), high.min(universe.high()));
    (low <= high).then_some((low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIVERSE: (f64, f64) = (-10.0, 10.0);

    fn universe((low, high): Interval) -> Universe {
        Universe::new(low, high).unwrap()
    }

    /// Support, core and centre.
    fn properties(
        shape: Shape,
        parameters: &[f64],
        within: Interval,
    ) -> (Option<Interval>, Option<Interval>, f64) {
        let function = MembershipFunction::new(shape, parameters).unwrap();
        let within = universe(within);
        (function.support(within), function.core(within), function.centre(within))
    }

    #[test]
    fn a_function_is_looked_at_within_the_universe() {
        let trapezoid = |within| properties(Shape::Trapezoidal, &[0.0, 1.0, 3.0, 5.0], within);
        assert_eq!(trapezoid(UNIVERSE), (Some((0.0, 5.0)), Some((1.0, 3.0)), 2.0));
        assert_eq!(trapezoid((2.0, 4.0)), (Some((2.0, 4.0)), Some((2.0, 3.0)), 2.5));
        // Its end alone has the degree 0.
        assert_eq!(trapezoid((5.0, 6.0)), (None, None, 5.0));
        let box_ = properties(Shape::Rectangle, &[0.0, 5.0], (5.0, 6.0));
        assert_eq!(box_, (Some((5.0, 5.0)), Some((5.0, 5.0)), 5.0));
        let falling = properties(Shape::Ramp, &[4.0, 0.0], UNIVERSE);
        assert_eq!(falling, (Some((-10.0, 4.0)), Some((-10.0, 0.0)), -5.0));
    }

    #[test]
    fn where_1_is_never_reached_the_centre_is_the_greatest_degree() {
        let sigmoid = |slope| properties(Shape::Sigmoid, &[1.0, slope], UNIVERSE);
        assert_eq!(sigmoid(2.0), (Some(UNIVERSE), None, 10.0));
        assert_eq!(sigmoid(-2.0), (Some(UNIVERSE), None, -10.0));
        let pair = |shape, p: &[f64]| properties(shape, p, UNIVERSE);
        assert_eq!(pair(Shape::SigmoidProduct, &[-1.0, 5.0, 3.0, -5.0]).2, 1.0);
        assert_eq!(pair(Shape::SigmoidDifference, &[1.0, 2.0, 1.0, 2.0]).0, None);
        let crossed = pair(Shape::TwoSidedGaussian, &[2.0, 1.0, 0.0, 2.0]);
        assert_eq!((crossed.1, crossed.2), (None, 1.6));
    }

    #[test]
    fn points_may_have_gaps_and_several_tops() {
        let points = [0.0, 0.0, 1.0, 0.5, 2.0, 0.0, 3.0, 0.0, 4.0, 0.5, 6.0, 0.0];
        let properties = |within| properties(Shape::Points, &points, within);
        assert_eq!(properties(UNIVERSE), (Some((0.0, 6.0)), None, 2.5));
        assert_eq!(properties((2.0, 3.0)), (None, None, 2.5));
        assert_eq!(properties((0.5, 2.5)), (Some((0.5, 2.0)), None, 1.0));
    }
}
