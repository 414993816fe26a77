//! Random numbers that are the same on every machine and for any number of threads.
//!
//! A stream belongs to a piece of work: (seed, stream) names it, whoever runs it. The generator
//! is ChaCha with 8 rounds; the conversions to numbers are written here, so that no dependency
//! can change the drawn values (a test pins the first ones).

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng as _, SeedableRng as _};
use serde::{Deserialize, Serialize};

use crate::math::{ln, sin_cos};

/// A stream of random numbers.
///
/// ```
/// use fuzzy_core::Rng;
/// let mut first = Rng::new(7, 0);
/// let mut again = Rng::new(7, 0);
/// assert_eq!(first.uniform(), again.uniform());
/// ```
#[derive(Debug, Clone)]
pub struct Rng(ChaCha8Rng);

/// Where a stream stands, so that it can be continued elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RngState {
    /// The generator's key, made from the seed.
    pub key: [u64; 4],
    /// The number of the stream.
    pub stream: u64,
    /// The 32-bit words drawn so far.
    pub position: u64,
}

impl Rng {
    /// The stream with this number under this seed.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut state = seed;
        let key = std::array::from_fn(|_| split_mix(&mut state));
        Self::from_state(RngState { key, stream, position: 0 })
    }

    /// The stream that continues where another stood.
    pub fn from_state(state: RngState) -> Self {
        let mut key = [0; 32];
        for (bytes, word) in key.chunks_exact_mut(8).zip(state.key) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(state.stream);
        generator.set_word_pos(state.position.into());
        Self(generator)
    }

    /// Where the stream stands.
    ///
    /// ```
    /// use fuzzy_core::Rng;
    /// let mut rng = Rng::new(7, 3);
    /// rng.uniform();
    /// assert_eq!(Rng::from_state(rng.state()).uniform(), rng.uniform());
    /// ```
    pub fn state(&self) -> RngState {
        let seed = self.0.get_seed();
        let (words, _) = seed.as_chunks::<8>();
        RngState {
            key: std::array::from_fn(|k| u64::from_le_bytes(words[k])),
            stream: self.0.get_stream(),
            // No search draws 2⁶⁴ words.
            position: self.0.get_word_pos() as u64,
        }
    }

    /// 64 random bits.
    #[inline]
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number in [0, 1), a multiple of 2⁻⁵³.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        to_uniform(self.bits())
    }

    /// A number in [low, high).
    #[inline]
    pub fn uniform_in(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A number of the standard normal distribution (Box and Muller 1958).
    #[inline]
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * ln(1.0 - self.uniform())).sqrt();
        radius * sin_cos(std::f64::consts::TAU * self.uniform()).1
    }

    /// An integer below `bound`, each equally likely (Lemire's method); 0 for a bound of 0.
    #[inline]
    pub fn below(&mut self, bound: usize) -> usize {
        let bound = bound as u64;
        let mut product = u128::from(self.bits()) * u128::from(bound);
        if (product as u64) < bound {
            let rejected = bound.wrapping_neg() % bound;
            while (product as u64) < rejected {
                product = u128::from(self.bits()) * u128::from(bound);
            }
        }
        (product >> 64) as usize
    }
}

/// A number in [0, 1), a multiple of 2⁻⁵³, that depends on a seed and some numbers alone: for
/// chance in something that must be a pure function of what it sees.
///
/// ```
/// use fuzzy_core::rng::uniform_of;
/// assert_eq!(uniform_of(7, &[0.1, 0.2]), uniform_of(7, &[0.1, 0.2]));
/// assert_ne!(uniform_of(7, &[0.1, 0.2]), uniform_of(8, &[0.1, 0.2]));
/// ```
#[inline]
pub fn uniform_of(seed: u64, numbers: &[f64]) -> f64 {
    let mix = |mut state: u64| split_mix(&mut state);
    to_uniform(numbers.iter().fold(mix(seed), |hash, number| mix(hash ^ number.to_bits())))
}

/// The 53 upper bits as a number in [0, 1).
#[inline]
fn to_uniform(bits: u64) -> f64 {
    const SCALE: f64 = 1.0 / (1_u64 << 53) as f64;
    (bits >> 11) as f64 * SCALE
}

/// SplitMix64 (Steele, Lea and Flood 2014): spreads a seed over the generator's key.
fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PINNED: [u64; 3] =
        [750_246_842_200_029_553, 7_753_984_170_494_292_168, 14_802_111_886_762_705_951];

    #[test]
    fn the_first_draws_never_change() {
        let mut rng = Rng::new(2010, 1);
        let drawn: [u64; 3] = std::array::from_fn(|_| rng.bits());
        assert_eq!(drawn, PINNED);
        let mut rng = Rng::new(2010, 1);
        assert_eq!(rng.uniform(), (PINNED[0] >> 11) as f64 / 2.0_f64.powi(53));
    }

    #[test]
    fn streams_and_seeds_differ() {
        let draws: Vec<u64> =
            [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(s, t)| Rng::new(s, t).bits()).to_vec();
        for (i, a) in draws.iter().enumerate() {
            assert!(!draws[..i].contains(a));
        }
    }

    #[test]
    fn integers_below_a_bound_are_evenly_spread() {
        let mut rng = Rng::new(0, 0);
        let mut counts = [0_u32; 7];
        for _ in 0..70_000 {
            counts[rng.below(7)] += 1;
        }
        // Five standard deviations of a binomial with n = 70 000, p = 1/7 are 463.
        assert!(counts.iter().all(|&count| count.abs_diff(10_000) < 463), "{counts:?}");
        assert_eq!(rng.below(1), 0);
        assert_eq!(rng.below(0), 0);
    }

    #[test]
    fn normal_numbers_have_their_moments() {
        let mut rng = Rng::new(4, 0);
        let drawn: Vec<f64> = (0..100_000).map(|_| rng.normal()).collect();
        let moment = |n: i32| drawn.iter().map(|x| x.powi(n)).sum::<f64>() / 1e5;
        // Five standard deviations of each mean.
        assert!(moment(1).abs() < 0.016);
        assert!((moment(2) - 1.0).abs() < 0.023);
        assert!((moment(4) - 3.0).abs() < 0.16);
    }

    #[test]
    fn a_stream_continues_from_its_state() {
        let mut rng = Rng::new(2010, 5);
        for _ in 0..1000 {
            rng.uniform();
            let (mut again, mut own) = (Rng::from_state(rng.state()), rng.clone());
            assert_eq!([(); 20].map(|()| again.bits()), [(); 20].map(|()| own.bits()));
        }
    }

    #[test]
    fn hashed_numbers_are_evenly_spread_and_independent() {
        let each =
            |seed: u64| (0..40_000).map(move |i| uniform_of(seed, &[f64::from(i) * 0.1, 3.0]));
        // Five standard deviations of each mean.
        assert!((each(1).sum::<f64>() / 4e4 - 0.5).abs() < 0.0073);
        let both = each(1).zip(each(2)).map(|(a, b)| (a - 0.5) * (b - 0.5));
        assert!((both.sum::<f64>() / 4e4).abs() < 0.0021);
        let next = each(1).zip(each(1).skip(1)).map(|(a, b)| (a - 0.5) * (b - 0.5));
        assert!((next.sum::<f64>() / 4e4).abs() < 0.0021);
    }

    #[test]
    fn uniform_stays_below_one() {
        let mut rng = Rng::new(3, 0);
        let mean = (0..100_000).map(|_| rng.uniform_in(-2.0, 4.0)).sum::<f64>() / 1e5;
        assert!((mean - 1.0).abs() < 0.03);
        assert!((0..100_000).all(|_| (0.0..1.0).contains(&rng.uniform())));
    }
}
