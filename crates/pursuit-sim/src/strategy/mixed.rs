//! Steering by chance, with probabilities for each state.

use fuzzy_core::check;
use fuzzy_core::learn::rl::Discretiser;
use fuzzy_core::math::{Real, wrap_angle};
use fuzzy_core::rng::uniform_of;

use crate::error::{Error, Result};
use crate::observation::Observation;

/// A mixed strategy: for each state of a grid over both robots' angles, the own δ and the other's,
/// the probability of each of some steering angles.
///
/// What is drawn depends on the seed and on what is seen, nothing else: the same game takes the
/// same course, alone or among many.
#[derive(Debug, Clone, PartialEq)]
pub struct MixedTableController {
    states: Discretiser,
    angles: Vec<f64>,
    probabilities: Vec<f64>,
    seed: u64,
    /// The sums of the probabilities up to each angle, state by state; infinite at the last that
    /// has any.
    sums: Vec<f64>,
}

/// How far the probabilities of a state may be from 1 together.
const LARGEST_EXCESS: f64 = 1e-9;

impl MixedTableController {
    /// Steering angles (rad), and for each state their probabilities one after the other.
    pub fn new(
        states: Discretiser,
        angles: Vec<f64>,
        probabilities: Vec<f64>,
        seed: u64,
    ) -> Result<Self> {
        if states.coordinates() != 2 {
            let (name, inputs) = ("mixed table".to_owned(), states.coordinates());
            return Err(Error::ControllerInputs { name, inputs });
        }
        check::at_least("steering angles", angles.len(), 1)?;
        check::all_finite("steering angles", &angles)?;
        let expected = states.states().saturating_mul(angles.len());
        check::same_length("probabilities of all states", expected, probabilities.len())?;
        let mut sums = Vec::with_capacity(probabilities.len());
        for (state, row) in probabilities.chunks_exact(angles.len()).enumerate() {
            for &probability in row {
                check::fraction(&format!("probability in state {state}"), probability)?;
            }
            let total: f64 = row.iter().sum();
            let what = format!("sum of the probabilities in state {state}");
            check::within(&what, total, "1", |total| (total - 1.0).abs() <= LARGEST_EXCESS)?;
            let last = row.iter().rposition(|&probability| probability > 0.0);
            let mut sum = 0.0;
            sums.extend(row.iter().enumerate().map(|(angle, probability)| {
                sum += probability;
                if Some(angle) == last { f64::INFINITY } else { sum }
            }));
        }
        Ok(Self { states, angles, probabilities, seed, sums })
    }

    /// The grid over the own δ and the other robot's.
    pub fn states(&self) -> &Discretiser {
        &self.states
    }

    /// The steering angles (rad).
    pub fn angles(&self) -> &[f64] {
        &self.angles
    }

    /// Their probabilities, state by state.
    pub fn probabilities(&self) -> &[f64] {
        &self.probabilities
    }

    /// What the draws depend on besides what is seen.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The steering angle drawn (rad).
    #[inline(always)]
    pub(crate) fn steer<R: Real>(&self, seen: &Observation<R>) -> R {
        let other = wrap_angle(seen.angle - seen.heading_difference);
        let state =
            seen.angle.zip_with(other, |own, other| self.states.state(&[own, other]) as f64);
        // The distance changes even while the angles do not.
        let drawn = seen
            .distance
            .zip_with(seen.heading_difference, |one, two| uniform_of(self.seed, &[one, two]));
        state.zip_with(drawn, |state, drawn| self.angle(state as usize, drawn))
    }

    #[inline]
    fn angle(&self, state: usize, drawn: f64) -> f64 {
        let count = self.angles.len();
        let sums = &self.sums[state * count..][..count];
        self.angles[sums.iter().position(|&sum| drawn < sum).unwrap_or(0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Discretiser {
        Discretiser::new(&[(-1.0, 1.0, 3), (-1.0, 1.0, 3)]).unwrap()
    }

    fn seen(angle: f64, heading_difference: f64, distance: f64) -> Observation {
        Observation { angle, rate: 0.0, distance, heading_difference }
    }

    #[test]
    fn angles_are_drawn_as_often_as_they_should_be() {
        let mut probabilities = vec![0.0; 9 * 4];
        for state in 0..9 {
            probabilities[state * 4..][..4].copy_from_slice(&[0.5, 0.0, 0.3, 0.2]);
        }
        let table =
            MixedTableController::new(grid(), vec![-0.2, 7.0, 0.1, 0.3], probabilities, 4).unwrap();
        let drawn: Vec<f64> =
            (0..20_000).map(|i| table.steer(&seen(0.3, 0.1, f64::from(i) * 1e-3))).collect();
        for (angle, p) in [(-0.2, 0.5), (7.0, 0.0), (0.1, 0.3), (0.3, 0.2)] {
            let share = drawn.iter().filter(|&&drawn| drawn == angle).count() as f64 / 20_000.0;
            assert!((share - p).abs() <= 0.018, "{angle}: {share}");
        }
    }

    #[test]
    fn the_state_is_of_both_angles() {
        // One angle for each state.
        let mut probabilities = vec![0.0; 81];
        (0..9).for_each(|state| probabilities[state * 10] = 1.0);
        let angles: Vec<f64> = (0..9).map(f64::from).collect();
        let table = MixedTableController::new(grid(), angles, probabilities, 0).unwrap();
        // Own δ 1, the other's −1: state 6; and once around.
        assert_eq!(table.steer(&seen(1.0, 2.0, 5.0)), 6.0);
        assert_eq!(table.steer(&seen(1.0, 2.0 - std::f64::consts::TAU, 5.0)), 6.0);
        assert_eq!(table.steer(&seen(0.0, -1.0, 5.0)), 5.0);
    }

    #[test]
    fn what_is_no_strategy_is_refused() {
        let with = |angles: Vec<f64>, probabilities: Vec<f64>| {
            MixedTableController::new(grid(), angles, probabilities, 0)
        };
        assert!(with(vec![0.0, 1.0], vec![0.5; 18]).is_ok());
        assert!(with(vec![], vec![]).is_err());
        assert!(with(vec![0.0, f64::NAN], vec![0.5; 18]).is_err());
        assert!(with(vec![0.0, 1.0], vec![0.5; 17]).is_err());
        assert!(with(vec![0.0, 1.0], vec![0.6; 18]).is_err());
        let mut negative = vec![0.5; 18];
        negative[..2].copy_from_slice(&[-0.5, 1.5]);
        assert!(with(vec![0.0, 1.0], negative).is_err());
        let line = Discretiser::new(&[(-1.0, 1.0, 3)]).unwrap();
        assert!(MixedTableController::new(line, vec![0.0], vec![1.0; 3], 0).is_err());
    }
}
