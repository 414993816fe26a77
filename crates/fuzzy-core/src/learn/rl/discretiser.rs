//! Continuous observations as states of a table.

use crate::check;
use crate::error::{Error, Result};

/// A regular grid: each coordinate is held within its range and rounded to the nearest of its
/// points; the states count row by row, the last coordinate changing fastest.
///
/// ```
/// use fuzzy_core::learn::rl::Discretiser;
/// // The thesis's 121 states: both coordinates −1, −0.8, …, 1 (section 6.4.2).
/// let grid = Discretiser::new(&[(-1.0, 1.0, 11), (-1.0, 1.0, 11)])?;
/// assert_eq!(grid.states(), 121);
/// assert_eq!(grid.state(&[-7.0, 0.05]), 5);
/// assert_eq!(grid.centre(5), [-1.0, 0.0]);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Discretiser {
    axes: Vec<Axis>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Axis {
    low: f64,
    high: f64,
    points: usize,
    per_unit: f64,
}

impl Discretiser {
    /// A grid with (low, high, points) for each coordinate, at least 2 points each and fewer than
    /// 2³² states.
    pub fn new(axes: &[(f64, f64, usize)]) -> Result<Self> {
        check::at_least("coordinates of a grid", axes.len(), 1)?;
        let axes = axes
            .iter()
            .map(|&(low, high, points)| {
                check::interval("a grid", low, high)?;
                check::at_least("points of a grid", points, 2)?;
                let per_unit = (points - 1) as f64 / (high - low);
                check::finite("points per unit of a grid", per_unit)?;
                Ok(Axis { low, high, points, per_unit })
            })
            .collect::<Result<Vec<_>>>()?;
        let states = axes.iter().try_fold(1_usize, |states, axis| states.checked_mul(axis.points));
        if states.is_none_or(|states| u32::try_from(states).is_err()) {
            return Err(Error::wrong_shape("states of a grid", "fewer than 2³²", "more"));
        }
        Ok(Self { axes })
    }

    /// (low, high, points) of each coordinate.
    pub fn axes(&self) -> Vec<(f64, f64, usize)> {
        self.axes.iter().map(|axis| (axis.low, axis.high, axis.points)).collect()
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.axes.iter().map(|axis| axis.points).product()
    }

    /// The number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.axes.len()
    }

    /// The state that an observation falls into. NaN counts as the lower end.
    #[inline]
    pub fn state(&self, observation: &[f64]) -> usize {
        let mut state = 0;
        for (axis, &value) in self.axes.iter().zip(observation) {
            let place = (value.clamp(axis.low, axis.high) - axis.low) * axis.per_unit;
            // Half-way goes up; the cast takes NaN to 0.
            state = state * axis.points + ((place + 0.5) as usize).min(axis.points - 1);
        }
        state
    }

    /// A point of one coordinate's axis.
    #[inline]
    pub fn coordinate(&self, axis: usize, point: usize) -> f64 {
        let Axis { low, high, points, .. } = self.axes[axis];
        low + (high - low) * (point as f64 / (points - 1) as f64)
    }

    /// The grid point of a state.
    pub fn centre(&self, state: usize) -> Vec<f64> {
        let mut rest = state;
        let mut point: Vec<f64> = Vec::with_capacity(self.axes.len());
        for (index, axis) in self.axes.iter().enumerate().rev() {
            point.push(self.coordinate(index, rest % axis.points));
            rest /= axis.points;
        }
        point.reverse();
        point
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_centre_falls_into_its_own_state() {
        let grid = Discretiser::new(&[(-1.0, 1.0, 11), (-1.0, 1.0, 11), (0.0, 7.0, 4)]).unwrap();
        for state in 0..grid.states() {
            assert_eq!(grid.state(&grid.centre(state)), state);
        }
    }

    #[test]
    fn observations_outside_go_to_the_edge() {
        let grid = Discretiser::new(&[(-1.0, 1.0, 11)]).unwrap();
        assert_eq!(grid.state(&[-1e300]), 0);
        assert_eq!(grid.state(&[f64::INFINITY]), 10);
        assert_eq!(grid.state(&[f64::NAN]), 0);
        assert_eq!([-0.91, -0.89, 0.09, 0.11].map(|x| grid.state(&[x])), [0, 1, 5, 6]);
    }

    #[test]
    fn degenerate_grids_are_refused() {
        assert!(Discretiser::new(&[]).is_err());
        assert!(Discretiser::new(&[(0.0, 1.0, 1)]).is_err());
        assert!(Discretiser::new(&[(1.0, 1.0, 3)]).is_err());
        assert!(Discretiser::new(&[(f64::NAN, 1.0, 3)]).is_err());
        assert!(Discretiser::new(&[(-1e308, 1e308, 3)]).is_err());
        assert!(Discretiser::new(&[(0.0, 5e-324, 3)]).is_err());
    }

    #[test]
    fn a_product_of_points_that_wraps_is_refused() {
        for points in [1 << 16, 1 << 32, (1 << 63) + 1] {
            assert!(Discretiser::new(&[(-1.0, 1.0, points); 2]).is_err(), "{points}");
        }
    }
}
