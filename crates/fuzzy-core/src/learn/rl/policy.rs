//! Choosing an action from its estimated values.

use crate::math::{LANES, Lanes, Real};
use crate::rng::Rng;

/// The largest of a state's values; −∞ if there are none.
#[inline]
pub(super) fn largest(values: &[f64]) -> f64 {
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    // Four maxima side by side: no comparison waits for more than a quarter of the others. The
    // last four values may be looked at twice.
    let Some(&last) = values.last_chunk::<4>() else {
        return values.iter().copied().fold(f64::NEG_INFINITY, larger);
    };
    let groups = values.as_chunks::<4>().0.iter();
    let maxima = groups.fold(last, |m, group| std::array::from_fn(|i| larger(m[i], group[i])));
    larger(larger(maxima[0], maxima[1]), larger(maxima[2], maxima[3]))
}

/// The action of the largest value (2.55); the first of several.
#[inline]
pub fn greedy(values: &[f64]) -> usize {
    // Which action is best changes all the time, so a branch on it would be mispredicted: all
    // values are compared with the largest first, eight at a time.
    const MASK: usize = u64::BITS as usize;
    let best = largest(values);
    match values.last_chunk::<LANES>() {
        Some(last) if values.len() <= MASK => {
            let equal = |group: &[f64; LANES]| {
                u64::from(Lanes::bits(Lanes::splat(best).le(Lanes::new(*group))))
            };
            let groups = values.as_chunks::<LANES>().0.iter().enumerate();
            let found = groups.fold(0, |found, (i, group)| found | equal(group) << (i * LANES));
            let found = found | equal(last) << (values.len() - LANES);
            // Nothing equals a largest value that is NaN.
            found.trailing_zeros() as usize % MASK
        }
        _ => values.iter().position(|&value| value == best).unwrap_or(0),
    }
}

/// With probability ε any action, each equally likely; otherwise the [`greedy`] one (2.54).
#[inline]
pub fn epsilon_greedy(values: &[f64], epsilon: f64, rng: &mut Rng) -> usize {
    if rng.uniform() < epsilon { rng.below(values.len()) } else { greedy(values) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_values_is_greedy() {
        assert_eq!(greedy(&[0.0, 0.0, 0.0]), 0);
        assert_eq!(greedy(&[-1.0, 3.0, 3.0, 2.0]), 1);
        for count in 1..200 {
            let mut rng = Rng::new(count, 0);
            let values: Vec<f64> = (0..count).map(|_| rng.below(9) as f64 - 4.0).collect();
            let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(Some(greedy(&values)), values.iter().position(|&v| v == largest));
        }
    }

    #[test]
    fn exploration_happens_as_often_as_asked() {
        let mut rng = Rng::new(4, 0);
        let values = [0.0, 1.0, 0.0, 0.0];
        let other = (0..40_000).filter(|_| epsilon_greedy(&values, 0.4, &mut rng) != 1).count();
        // 0.4·3/4 of the choices differ; five standard deviations are 458.
        assert!(other.abs_diff(12_000) < 458, "{other}");
        assert!((0..1000).all(|_| epsilon_greedy(&values, 0.0, &mut rng) == 1));
    }
}
