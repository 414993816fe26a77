//! Choosing an action from its estimated values.

use crate::check;
use crate::error::Result;
use crate::math::{LANES, Lanes, Real, exp};
use crate::rng::Rng;

/// Which of several largest values is greedy.
///
/// The first costs least. A learner whose values stay equal for long, as those of a game that two
/// play do, never tries the others of a tie: it needs a random one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ties {
    /// The first.
    First,
    /// Any, each equally likely.
    Random,
}

impl Ties {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Random => "random",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("way to break ties", name, [Self::First, Self::Random], Self::name)
    }

    /// The greedy action, broken ties included; 0 if there are no values.
    #[inline]
    pub fn greedy(self, values: &[f64], rng: &mut Rng) -> usize {
        match self {
            Self::First => greedy(values),
            Self::Random => greedy_at_random(values, rng),
        }
    }
}

/// How actions are chosen from their values (section 2.5.4).
///
/// ```
/// use fuzzy_core::Rng;
/// use fuzzy_core::learn::rl::{Policy, Ties};
///
/// let mut rng = Rng::new(1, 0);
/// let values = [0.0, 1.0, 1.0];
/// assert_eq!(Policy::epsilon_greedy(0.0, Ties::First)?.choose(&values, &mut rng), 1);
/// assert!(Policy::epsilon_greedy(0.0, Ties::Random)?.choose(&values, &mut rng) > 0);
/// // A temperature near zero is greedy.
/// assert!(Policy::softmax(1e-9)?.choose(&values, &mut rng) > 0);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Policy {
    /// With probability ε any action, otherwise one of the largest value (2.54).
    EpsilonGreedy {
        /// ε, in [0, 1]: 1 is uniformly random.
        exploration: f64,
        /// Which of several.
        ties: Ties,
    },
    /// Probabilities by Boltzmann's distribution (2.56).
    Softmax {
        /// θ, above zero: large is uniformly random, small is greedy.
        temperature: f64,
    },
}

impl Policy {
    /// ε-greedy with ε in [0, 1].
    pub fn epsilon_greedy(exploration: f64, ties: Ties) -> Result<Self> {
        check::fraction("exploration rate", exploration)?;
        Ok(Self::EpsilonGreedy { exploration, ties })
    }

    /// Softmax with a temperature above zero.
    pub fn softmax(temperature: f64) -> Result<Self> {
        check::positive("temperature", temperature)?;
        Ok(Self::Softmax { temperature })
    }

    /// An action for a state with these action values; 0 if there are none.
    #[inline]
    pub fn choose(&self, values: &[f64], rng: &mut Rng) -> usize {
        match *self {
            Self::EpsilonGreedy { exploration, ties } => {
                if rng.uniform() < exploration {
                    rng.below(values.len())
                } else {
                    ties.greedy(values, rng)
                }
            }
            Self::Softmax { temperature } => softmax(values, temperature, rng),
        }
    }
}

/// The largest of a state's values; −∞ if there are none.
#[inline]
pub(super) fn largest(values: &[f64]) -> f64 {
    best(values, f64::NEG_INFINITY, larger)
}

/// The smallest of some values; ∞ if there are none.
#[inline]
pub(super) fn smallest(values: &[f64]) -> f64 {
    best(values, f64::INFINITY, |a, b| if b < a { b } else { a })
}

/// The larger of two numbers; the first if either is NaN.
#[inline]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

#[inline]
fn best(values: &[f64], none: f64, better: impl Fn(f64, f64) -> f64) -> f64 {
    // Four places side by side: no comparison waits for more than a quarter of the others. The
    // last four values may be looked at twice.
    let Some(&last) = values.last_chunk::<4>() else {
        return values.iter().copied().fold(none, better);
    };
    let groups = values.as_chunks::<4>().0.iter();
    let found = groups.fold(last, |m, group| std::array::from_fn(|i| better(m[i], group[i])));
    better(better(found[0], found[1]), better(found[2], found[3]))
}

/// The action of the largest value (2.55); the first of several.
#[inline]
pub fn greedy(values: &[f64]) -> usize {
    // Which action is best changes all the time, so a branch on it would be mispredicted: all
    // values are compared with the largest first, eight at a time.
    let best = largest(values);
    match places(values, best) {
        // Nothing equals a largest value that is NaN.
        Some(found) => found.trailing_zeros() as usize % MASK,
        None => values.iter().position(|&value| value == best).unwrap_or(0),
    }
}

/// As many values have a bit each in a mask of their places.
const MASK: usize = u64::BITS as usize;

/// Which of some values are their largest, as bits; nothing if they are too few or too many.
#[inline]
fn places(values: &[f64], largest: f64) -> Option<u64> {
    let last = values.last_chunk::<LANES>().filter(|_| values.len() <= MASK)?;
    let equal =
        |group: &[f64; LANES]| u64::from(Lanes::bits(Lanes::splat(largest).le(Lanes::new(*group))));
    let groups = values.as_chunks::<LANES>().0.iter().enumerate();
    let found = groups.fold(0, |found, (i, group)| found | equal(group) << (i * LANES));
    Some(found | equal(last) << (values.len() - LANES))
}

/// With probability ε any action, each equally likely; otherwise the [`greedy`] one (2.54).
#[inline]
pub fn epsilon_greedy(values: &[f64], epsilon: f64, rng: &mut Rng) -> usize {
    if rng.uniform() < epsilon { rng.below(values.len()) } else { greedy(values) }
}

/// One of the actions of the largest value, each equally likely.
#[inline]
pub fn greedy_at_random(values: &[f64], rng: &mut Rng) -> usize {
    let best = largest(values);
    if let Some(mut found) = places(values, best) {
        let ties = found.count_ones() as usize;
        let others = if ties > 1 { rng.below(ties) } else { 0 };
        (0..others).for_each(|_| found &= found - 1);
        return found.trailing_zeros() as usize % MASK;
    }
    let ties = values.iter().filter(|&&value| value == best).count();
    let chosen = if ties > 1 { rng.below(ties) } else { 0 };
    let mut equal = values.iter().enumerate().filter(|&(_, &value)| value == best);
    equal.nth(chosen).map_or(0, |(action, _)| action)
}

/// An action with probability exp(Q/θ)/Σ exp(Q/θ) (2.56), for finite values and θ above zero.
///
/// The largest value is subtracted from each first: no exponential overflows, and one is 1.
#[inline]
pub fn softmax(values: &[f64], temperature: f64, rng: &mut Rng) -> usize {
    let best = largest(values);
    let groups = || values.chunks(LANES).map(|group| weights(group, best, temperature));
    // The exponentials of so many are kept between the sum and the choice.
    let mut kept = [[0.0; LANES]; 8];
    let chosen = if values.len() <= kept.as_flattened().len() {
        kept.iter_mut().zip(groups()).for_each(|(kept, group)| *kept = group);
        draw(kept.as_flattened()[..values.len()].iter().copied(), rng)
    } else {
        draw(groups().flatten(), rng)
    };
    chosen.unwrap_or_else(|| greedy(values))
}

/// The index of a weight, drawn in proportion to it; nothing where rounding leads past the end.
#[inline]
pub(super) fn draw(weights: impl Iterator<Item = f64> + Clone, rng: &mut Rng) -> Option<usize> {
    let mut rest = rng.uniform() * weights.clone().sum::<f64>();
    weights.enumerate().find_map(|(index, weight)| {
        rest -= weight;
        (rest < 0.0).then_some(index)
    })
}

/// The probabilities with which [`softmax`] chooses.
pub fn softmax_probabilities(values: &[f64], temperature: f64) -> Vec<f64> {
    let best = largest(values);
    let groups = values.chunks(LANES).map(|group| weights(group, best, temperature));
    let mut weights: Vec<f64> = groups.flatten().collect();
    weights.truncate(values.len());
    let total: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= total);
    weights
}

/// exp((Q − best)/θ) of eight values at most; 0 in the place of those that are missing.
#[inline]
fn weights(group: &[f64], best: f64, temperature: f64) -> [f64; LANES] {
    let mut padded = [f64::NEG_INFINITY; LANES];
    padded[..group.len()].copy_from_slice(group);
    let below = padded.map(|value| (value - best) / temperature);
    exp(Lanes::new(below)).to_array()
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

    /// How often each of `count` choices was made.
    fn frequencies(policy: Policy, values: &[f64], count: usize) -> Vec<f64> {
        let mut rng = Rng::new(9, 0);
        let mut chosen = vec![0.0; values.len()];
        (0..count).for_each(|_| chosen[policy.choose(values, &mut rng)] += 1.0);
        chosen.into_iter().map(|chosen| chosen / count as f64).collect()
    }

    #[test]
    fn softmax_has_the_printed_probabilities() {
        // More values than a group of lanes, and more than are kept.
        for count in [11, 70] {
            let values: Vec<f64> = (0..count).map(|i| f64::from(i % 4) - 700.0).collect();
            let total: f64 = values.iter().map(|v| ((v + 700.0) / 0.8_f64).exp()).sum();
            let expected: Vec<f64> =
                values.iter().map(|v| ((v + 700.0) / 0.8_f64).exp() / total).collect();
            let exact = softmax_probabilities(&values, 0.8);
            let drawn = frequencies(Policy::softmax(0.8).unwrap(), &values, 200_000);
            for ((p, exact), drawn) in expected.iter().zip(exact).zip(drawn) {
                assert!((p - exact).abs() < 1e-14);
                // Five standard deviations.
                assert!((p - drawn).abs() < 5.0 * (p / 200_000.0).sqrt(), "{p} {drawn}");
            }
        }
    }

    #[test]
    fn softmax_survives_any_finite_values() {
        let extreme = [-1e308, 1e308, 0.0, 5e-324];
        for temperature in [5e-324, 1.0, 1e308] {
            let probabilities = softmax_probabilities(&extreme, temperature);
            assert!((probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            assert!(probabilities.iter().all(|p| p.is_finite()));
        }
        assert_eq!(frequencies(Policy::softmax(5e-324).unwrap(), &extreme, 100)[1], 1.0);
        assert!(Policy::softmax(0.0).is_err() && Policy::softmax(f64::NAN).is_err());
    }

    #[test]
    fn ties_are_broken_at_random_on_request() {
        let random = |exploration| Policy::epsilon_greedy(exploration, Ties::Random).unwrap();
        let values = [2.0, -1.0, 2.0, 2.0];
        let drawn = frequencies(random(0.0), &values, 30_000);
        assert_eq!(drawn[1], 0.0);
        // Five standard deviations of a binomial with p = 1/3.
        assert!([0, 2, 3].iter().all(|&i| (drawn[i] - 1.0 / 3.0).abs() < 0.0137), "{drawn:?}");
        assert!((frequencies(random(1.0), &values, 30_000)[1] - 0.25).abs() < 0.0126);
        let first = Policy::epsilon_greedy(0.0, Ties::First).unwrap();
        assert_eq!(frequencies(first, &values, 10)[0], 1.0);
        assert!(Policy::epsilon_greedy(1.1, Ties::First).is_err());
    }
}
