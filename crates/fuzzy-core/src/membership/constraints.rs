//! What keeps parameters valid while a learner moves them by steps that don't know what is.

use std::ops::Range;

use super::shape::Relation;
use super::{ParameterKind, Shape};
use crate::variable::{Universe, Variable};

/// The least distance between parameters that must differ, as a share of the universe.
const LEAST_GAP: f64 = 1e-3;

/// The set of valid parameters of all terms of some variables, one after the other.
///
/// Widths, powers and slopes stay as far from zero as [`ParameterKind::bounds`] has it, or as they
/// were at first if that was nearer; degrees stay between 0 and 1, and a direction stays. Places
/// are free, but vertices stay in order, and those that must differ stay a thousandth of the
/// universe apart, or as near as they were.
#[derive(Debug, Clone)]
pub(crate) struct Constraints {
    ranges: Vec<(f64, f64)>,
    related: Vec<Related>,
}

/// The parameters of a function that relate to each other.
#[derive(Debug, Clone)]
struct Related {
    place: Range<usize>,
    relation: Relation,
    gap: f64,
    /// For two that differ: which is the larger.
    rises: bool,
}

impl Constraints {
    /// For steps that begin from the parameters which the variables have.
    pub fn new(variables: &[Variable]) -> Self {
        Self::with_ranges(variables, ParameterKind::range)
    }

    /// The same, but every parameter stays within the [bounds](ParameterKind::bounds) that
    /// learners search, or as far outside as it was at first; the narrowest function is this
    /// share of its universe.
    pub fn within_bounds(variables: &[Variable], narrowest: f64) -> Self {
        Self::with_ranges(variables, |kind, universe, now| match kind {
            ParameterKind::Direction => (now, now),
            _ => {
                let (low, high) = kind.bounds_from(narrowest, universe, now);
                (low.min(now), high.max(now))
            }
        })
    }

    fn with_ranges(
        variables: &[Variable],
        range_of: impl Fn(ParameterKind, Universe, f64) -> (f64, f64),
    ) -> Self {
        let (mut ranges, mut related) = (Vec::new(), Vec::new());
        for variable in variables {
            let universe = variable.universe();
            for term in variable.terms() {
                let (shape, values) = (term.function.shape(), term.function.parameters());
                let place = ranges.len()..ranges.len() + values.len();
                let range =
                    |(k, &now): (usize, &f64)| range_of(shape.parameter_kind(k), universe, now);
                ranges.extend(values.iter().enumerate().map(range));
                related.extend(Related::new(shape, values, place, universe));
            }
        }
        Self { ranges, related }
    }

    /// Brings parameters to the nearest valid ones, parameter by parameter and then relation by
    /// relation: vertices that have crossed meet in their mean. NaN stays NaN. Returns how many
    /// ranges and relations did not hold.
    pub fn apply(&self, parameters: &mut [f64]) -> usize {
        let mut held = 0;
        for (value, &(low, high)) in parameters.iter_mut().zip(&self.ranges) {
            let within = value.clamp(low, high);
            held += usize::from(within != *value);
            *value = within;
        }
        for related in &self.related {
            held += usize::from(related.apply(&mut parameters[related.place.clone()]));
        }
        held
    }
}

impl ParameterKind {
    /// Where a parameter of this kind may go that has the value `now`.
    fn range(self, universe: Universe, now: f64) -> (f64, f64) {
        let (low, high) = self.bounds(universe, now);
        match self {
            Self::Centre | Self::Vertex => (f64::NEG_INFINITY, f64::INFINITY),
            Self::Width | Self::Power => (low.min(now), f64::INFINITY),
            Self::Slope if now < 0.0 => (f64::NEG_INFINITY, high.max(now)),
            Self::Slope => (low.min(now), f64::INFINITY),
            Self::Direction => (now, now),
            Self::Degree => (0.0, 1.0),
        }
    }
}

impl Related {
    /// The relation of this shape's parameters, if they have one.
    fn new(shape: Shape, now: &[f64], place: Range<usize>, universe: Universe) -> Option<Self> {
        let relation = shape.relation();
        let least = LEAST_GAP * (universe.high() - universe.low());
        let size = now[now.len() - 1] - now[0];
        let gap = match relation {
            Relation::None => return None,
            Relation::Sorted | Relation::Apart => least.min(size.abs()),
            Relation::Increasing => {
                let places = now.iter().step_by(2);
                places.clone().zip(places.skip(1)).map(|(a, b)| b - a).fold(least, f64::min)
            }
        };
        Some(Self { place, relation, gap, rises: size > 0.0 })
    }

    /// Returns whether the relation did not hold.
    fn apply(&self, own: &mut [f64]) -> bool {
        match self.relation {
            Relation::None => false,
            Relation::Sorted => put_in_order(own, 1, 0.0) | spread(own, self.gap),
            Relation::Apart if self.rises => spread(own, self.gap),
            Relation::Apart => {
                own.reverse();
                let spread = spread(own, self.gap);
                own.reverse();
                spread
            }
            Relation::Increasing => put_in_order(own, 2, self.gap),
        }
    }
}

/// Spreads numbers evenly about their middle if the last is less than `gap` above the first;
/// returns whether it was.
fn spread(numbers: &mut [f64], gap: f64) -> bool {
    let last = numbers.len() - 1;
    let lacking = gap - (numbers[last] - numbers[0]);
    if lacking > 0.0 {
        let first = (-0.5_f64).mul_add(lacking, numbers[0]);
        for (index, number) in numbers.iter_mut().enumerate() {
            *number = gap.mul_add(index as f64 / last as f64, first);
        }
    }
    lacking > 0.0
}

/// The nearest numbers in the sense of least squares of which each is at least `gap` above the one
/// before: neighbours that are not are pooled in their mean. Every `step`-th number takes part.
/// Returns whether any was not.
fn put_in_order(numbers: &mut [f64], step: usize, gap: f64) -> bool {
    let next = numbers.iter().skip(step).step_by(step);
    if numbers.iter().step_by(step).zip(next).all(|(a, b)| b - a >= gap) {
        return false;
    }
    // The mean and the size of each pool, after the gaps have been taken out.
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (index, &number) in numbers.iter().step_by(step).enumerate() {
        let (mut mean, mut size) = (gap.mul_add(-(index as f64), number), 1);
        while let Some(&(other, count)) = pools.last().filter(|(other, _)| *other > mean) {
            pools.pop();
            mean = (other * count as f64 + mean * size as f64) / (count + size) as f64;
            size += count;
        }
        pools.push((mean, size));
    }
    let means = pools.into_iter().flat_map(|(mean, size)| std::iter::repeat_n(mean, size));
    for (index, (number, mean)) in numbers.iter_mut().step_by(step).zip(means).enumerate() {
        *number = gap.mul_add(index as f64, mean);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MembershipFunction, Rng};

    fn valid_start(shape: Shape, rng: &mut Rng) -> Vec<f64> {
        let count = shape.parameter_count().unwrap_or(8);
        loop {
            let mut numbers: Vec<f64> = (0..count).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
            if rng.uniform() < 0.8 {
                numbers.sort_by(f64::total_cmp);
            }
            if shape.accepts(&numbers) {
                return numbers;
            }
        }
    }

    fn constrained(shape: Shape, start: &[f64], moved: &[f64]) -> Vec<f64> {
        let function = MembershipFunction::new(shape, start).unwrap();
        let x = Variable::new("x", -1.0, 1.0).unwrap().with_term("t", function).unwrap();
        let mut moved = moved.to_vec();
        Constraints::new(&[x]).apply(&mut moved);
        moved
    }

    #[test]
    fn every_shape_stays_valid_wherever_a_step_leads() {
        let mut rng = Rng::new(5, 0);
        for shape in Shape::ALL {
            for size in [1e-3, 0.3, 10.0, 1e6] {
                for _ in 0..50 {
                    let start = valid_start(shape, &mut rng);
                    let moved: Vec<f64> =
                        start.iter().map(|v| v + size * rng.uniform_in(-1.0, 1.0)).collect();
                    let kept = constrained(shape, &start, &moved);
                    assert!(shape.accepts(&kept), "{shape:?} {start:?} {moved:?} {kept:?}");
                }
                let start = valid_start(shape, &mut rng);
                assert_eq!(constrained(shape, &start, &start), start, "{shape:?}");
            }
        }
    }

    #[test]
    fn crossed_vertices_meet_in_their_mean() {
        let start = [-1.0, 0.0, 0.5, 1.0];
        let kept = constrained(Shape::Trapezoidal, &start, &[-1.0, 0.5, 0.1, 1.0]);
        assert_eq!(kept, [-1.0, 0.3, 0.3, 1.0]);
        let kept = constrained(Shape::Triangular, &start[..3], &[3.0, 0.0, 0.0]);
        assert!((kept[0] - 0.999).abs() < 1e-12 && (kept[2] - 1.001).abs() < 1e-12, "{kept:?}");
        let falling = constrained(Shape::Ramp, &[0.5, -0.5], &[-0.5, 0.5]);
        assert!(falling[0] > falling[1]);
    }

    #[test]
    fn widths_stay_above_a_hundredth_of_the_universe_or_what_they_were() {
        assert_eq!(constrained(Shape::Gaussian, &[0.0, 0.5], &[4.0, -1.0]), [4.0, 0.02]);
        assert_eq!(constrained(Shape::Gaussian, &[0.0, 0.001], &[0.0, -1.0]), [0.0, 0.001]);
        assert_eq!(constrained(Shape::Sigmoid, &[0.0, -3.0], &[0.0, 3.0]), [0.0, -2.0]);
    }

    #[test]
    fn within_bounds_places_are_held_too_and_what_was_held_is_counted() {
        let x = Variable::new("x", -1.0, 1.0)
            .unwrap()
            .with_term("far", MembershipFunction::new(Shape::Gaussian, &[-3.0, 0.5]).unwrap())
            .unwrap()
            .with_term("t", MembershipFunction::triangular(-1.0, 0.0, 1.0).unwrap())
            .unwrap();
        let constraints = Constraints::within_bounds(&[x], 0.1);
        let mut moved = [-4.0, 0.1, -5.0, 2.0, 1.0];
        // The mean, the width, the first vertex, and two vertices that crossed.
        assert_eq!(constraints.apply(&mut moved), 4);
        assert_eq!(moved, [-3.0, 0.2, -3.0, 1.5, 1.5]);
        assert_eq!(constraints.apply(&mut moved), 0);
        let mut wide = [0.0, 9.0, -1.0, 0.0, 1.0];
        assert_eq!(constraints.apply(&mut wide), 1);
        assert_eq!(wide[1], 2.0);
    }
}
