//! Assignment: rows and columns of a square table go together one to one, at the least cost.

mod bottleneck;
mod sum;

use crate::check;
use crate::error::{Error, Result};

/// What an assignment makes small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Objective {
    /// The sum of the costs.
    Sum,
    /// The largest cost; among assignments with the same largest cost, the sum.
    Bottleneck,
}

impl Objective {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sum => "sum",
            Self::Bottleneck => "bottleneck",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("objective", name, [Self::Sum, Self::Bottleneck], Self::name)
    }
}

/// The column of each row in the best assignment of `size` rows to as many columns.
///
/// `costs` has size² entries, row by row. An entry may be infinite: such a pair is taken only where
/// there is no other way, so as few as possible are, and the objective is about the others. NaN and
/// −∞ are errors, and so are costs so far apart that their sums overflow. Several best assignments
/// are decided between by their places in the table, in the same way every time.
///
/// The sum is minimised by shortest augmenting paths (Jonker and Volgenant 1987; Crouse 2016), in
/// O(n³) operations at most. The bottleneck is found first, as the least threshold under which as
/// many rows find a column as under any; then the sum is minimised with what lies above avoided.
///
/// ```
/// use fuzzy_core::learn::assignment::{Objective, assign};
///
/// let costs = [1.0, 5.0, 4.0, 9.0];
/// assert_eq!(assign(&costs, 2, Objective::Sum)?, [1, 0]);
/// let costs = [1.0, 6.0, 6.0, 9.0];
/// assert_eq!(assign(&costs, 2, Objective::Sum)?, [0, 1]);
/// assert_eq!(assign(&costs, 2, Objective::Bottleneck)?, [1, 0]);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
pub fn assign(costs: &[f64], size: usize, objective: Objective) -> Result<Vec<usize>> {
    check::at_least("rows of the costs", size, 1)?;
    let entries = size.saturating_mul(size);
    check::same_length("entries of the costs", entries, costs.len())?;
    let refused = |cost: &f64| cost.is_nan() || *cost == f64::NEG_INFINITY;
    if let Some(entry) = costs.iter().position(refused) {
        let what = format!("costs[{}, {}]", entry / size, entry % size);
        let expected = "a number or +∞, for a pair to avoid".to_owned();
        return Err(Error::OutOfRange { what, expected, value: costs[entry] });
    }
    let most = match objective {
        Objective::Sum => f64::MAX,
        Objective::Bottleneck => bottleneck::threshold(costs, size),
    };
    Ok(sum::least(&finite(costs, size, most)?, size))
}

/// The costs less the least of them, so that any assignment with fewer entries above `most` has a
/// smaller sum.
fn finite(costs: &[f64], size: usize, most: f64) -> Result<Vec<f64>> {
    let kept = || costs.iter().copied().filter(|&cost| cost <= most);
    let least = kept().fold(f64::INFINITY, f64::min);
    let range = kept().fold(0.0, |range: f64, cost| range.max(cost - least));
    let avoided = if range > 0.0 { 2.0 * size as f64 * range } else { 1.0 };
    check::finite("sum of the costs", avoided * size as f64)?;
    Ok(costs.iter().map(|&cost| if cost <= most { cost - least } else { avoided }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::coupling::couplings;
    use crate::rng::Rng;

    /// What is made small, in the order of its importance.
    fn value(costs: &[f64], size: usize, columns: &[usize], objective: Objective) -> [f64; 3] {
        let chosen: Vec<f64> =
            columns.iter().enumerate().map(|(row, &column)| costs[row * size + column]).collect();
        let finite = || chosen.iter().copied().filter(|cost| cost.is_finite());
        let largest = match objective {
            Objective::Sum => 0.0,
            Objective::Bottleneck => finite().fold(f64::NEG_INFINITY, f64::max),
        };
        [(size - finite().count()) as f64, largest, finite().sum()]
    }

    /// Whole numbers, so that sums are exact; some infinite.
    fn random(rng: &mut Rng, size: usize, infinite: f64) -> Vec<f64> {
        let mut cost = || {
            let cost = rng.below(12) as f64 - 4.0;
            if rng.uniform() < infinite { f64::INFINITY } else { cost }
        };
        (0..size * size).map(|_| cost()).collect()
    }

    #[test]
    fn none_of_all_permutations_is_better() {
        let mut rng = Rng::new(5, 0);
        for round in 0..600 {
            let size = 1 + round % 6;
            let costs = random(&mut rng, size, [0.0, 0.3, 0.8, 1.0][round % 4]);
            for objective in [Objective::Sum, Objective::Bottleneck] {
                let found = assign(&costs, size, objective).unwrap();
                let own = value(&costs, size, &found, objective);
                for other in couplings(size).unwrap() {
                    assert!(
                        own <= value(&costs, size, &other, objective),
                        "{costs:?} {objective:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn large_tables_are_assigned_one_to_one() {
        let (size, mut rng) = (150, Rng::new(6, 0));
        let costs: Vec<f64> = (0..size * size).map(|_| rng.uniform()).collect();
        let [sum, bottleneck] = [Objective::Sum, Objective::Bottleneck].map(|objective| {
            let mut columns = assign(&costs, size, objective).unwrap();
            let value = value(&costs, size, &columns, Objective::Bottleneck);
            columns.sort_unstable();
            assert!(columns.into_iter().eq(0..size));
            value
        });
        assert!(bottleneck[1] <= sum[1] && sum[2] <= bottleneck[2]);
        // The sum of n × n uniform costs tends to π²/6 (Aldous 2001).
        assert!((sum[2] - 1.64).abs() < 0.3, "{sum:?}");
    }

    #[test]
    fn costs_that_are_none_are_refused_in_words() {
        let message = |costs: &[f64], size| {
            assign(costs, size, Objective::Bottleneck).unwrap_err().to_string()
        };
        assert_eq!(message(&[], 0), "rows of the costs must be at least 1, got 0");
        assert!(message(&[1.0; 3], 2).contains("expected 4, got 3"));
        assert!(message(&[1.0, 1.0, f64::NAN, 1.0], 2).starts_with("costs[1, 0] must be a number"));
        assert!(message(&[f64::NEG_INFINITY], 1).contains("got -inf"));
        assert!(message(&[-1e308, 1e308, 0.0, 0.0], 2).contains("sum of the costs"));
        assert_eq!(assign(&[f64::INFINITY; 4], 2, Objective::Bottleneck).unwrap().len(), 2);
    }
}
