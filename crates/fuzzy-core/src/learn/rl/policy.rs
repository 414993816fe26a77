//! Choosing an action from its estimated values.

use crate::rng::Rng;

/// The action of the largest value (2.55); the first of several.
#[inline]
pub fn greedy(values: &[f64]) -> usize {
    let mut best = 0;
    for action in 1..values.len() {
        if values[action] > values[best] {
            best = action;
        }
    }
    best
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
