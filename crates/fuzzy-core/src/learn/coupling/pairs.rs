//! What every pair costs, learned from episodes in which n pairs are tried at once.

use crate::check;
use crate::error::Result;
use crate::learn::assignment::{Objective, assign};
use crate::learn::rl::Visits;
use crate::learn::schedule::Schedule;
use crate::math::ln;
use crate::rng::Rng;

/// How [`PairEstimates`] find out about pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exploration {
    /// The best assignment of what the costs may be at best: each estimate less
    /// confidence·√(1.5 ln m/k) in episode m, after k visits of the pair (Chen, Wang and Yuan 2013);
    /// k = ½ for one that was never tried. Where costs never change, no confidence is needed: first
    /// estimates that are lower than any cost see to it that pairs are tried.
    Optimistic {
        /// Zero or more, in the unit of the costs.
        confidence: f64,
    },
    /// The best assignment after each estimate was moved by noise of Gumbel's distribution, scaled
    /// by the temperature of the episode: for one choice among several this is softmax, and for
    /// assignments its usual approximation (Papandreou and Yuille 2011).
    Softmax(Schedule),
}

/// What [`PairEstimates`] are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct PairSettings {
    /// The first estimate of each of the n² pairs, row by row.
    pub first: Vec<f64>,
    /// Estimates above this are of pairs that go together only where there is no other way.
    pub limit: f64,
    /// What a coupling makes small.
    pub objective: Objective,
    /// How pairs are found out about.
    pub exploration: Exploration,
    /// α by the visits of a pair.
    pub learning_rate: Schedule,
}

/// The costs of all pairs of n with n, as far as they are known.
///
/// Each episode tries a coupling, and tells what each of its n pairs cost: a combinatorial bandit
/// that sees the parts of its choice (Gai, Krishnamachari and Jain 2012). n² values are learned,
/// where a table of couplings has n!.
///
/// ```
/// use fuzzy_core::Rng;
/// use fuzzy_core::learn::assignment::Objective;
/// use fuzzy_core::learn::coupling::{Exploration, PairEstimates, PairSettings};
/// use fuzzy_core::learn::schedule::Schedule;
///
/// let costs = [[4.0, 1.0, 3.0], [2.0, 9.0, 5.0], [3.0, 2.0, 2.0]];
/// let mut pairs = PairEstimates::new(PairSettings {
///     first: vec![0.0; 9],
///     limit: 60.0,
///     objective: Objective::Sum,
///     exploration: Exploration::Optimistic { confidence: 0.0 },
///     learning_rate: Schedule::power("learning rate", 1.0, 0.0)?,
/// })?;
/// let mut rng = Rng::new(1, 0);
/// for _ in 0..9 {
///     let coupling = pairs.choose(&mut rng)?;
///     let seen: Vec<f64> = coupling.iter().zip(&costs).map(|(&j, row)| row[j]).collect();
///     pairs.learn(&coupling, &seen)?;
/// }
/// assert_eq!(pairs.best()?, [1, 0, 2]);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct PairEstimates {
    settings: PairSettings,
    size: usize,
    estimates: Vec<f64>,
    visits: Visits,
    episodes: u64,
}

impl PairEstimates {
    /// Nothing was tried yet.
    pub fn new(settings: PairSettings) -> Result<Self> {
        let size = settings.first.len().isqrt();
        check::at_least("number of pairs", size, 1)?;
        check::same_length("first estimates of a square table", size * size, settings.first.len())?;
        check::all_finite("first estimates", &settings.first)?;
        check::finite("limit of the estimates", settings.limit)?;
        match settings.exploration {
            Exploration::Optimistic { confidence } => {
                check::within("confidence", confidence, "zero or more", |c| c >= 0.0)?;
            }
            Exploration::Softmax(temperature) => {
                temperature.check("temperature", "positive", |t| t > 0.0)?;
            }
        }
        let estimates = settings.first.clone();
        Ok(Self { settings, size, estimates, visits: Visits::new(size, size)?, episodes: 0 })
    }

    /// The coupling to try next.
    pub fn choose(&self, rng: &mut Rng) -> Result<Vec<usize>> {
        let costs = match self.settings.exploration {
            Exploration::Optimistic { confidence } => {
                let episode = (self.episodes + 1) as f64;
                let doubt = confidence * (1.5 * ln(episode)).sqrt();
                let at_best = |(&estimate, &visits): (&f64, &u64)| {
                    self.or_avoided(estimate - doubt / (visits as f64).max(0.5).sqrt())
                };
                self.estimates.iter().zip(self.visits()).map(at_best).collect()
            }
            Exploration::Softmax(temperature) => {
                let scale = temperature.at(self.episodes + 1);
                let mut noise = || scale * ln(-ln(1.0 - rng.uniform()).min(-f64::MIN_POSITIVE));
                self.estimates.iter().map(|estimate| estimate + noise()).collect()
            }
        };
        self.assigned(costs)
    }

    /// Learns what each pair of a coupling cost.
    pub fn learn(&mut self, coupling: &[usize], costs: &[f64]) -> Result<()> {
        super::check_coupling(coupling, self.size)?;
        check::same_length("costs of a coupling", self.size, costs.len())?;
        check::all_finite("costs of a coupling", costs)?;
        self.episodes += 1;
        for (row, (&column, &cost)) in coupling.iter().zip(costs).enumerate() {
            let rate = self.settings.learning_rate.at(self.visits.visit(row, column));
            let estimate = &mut self.estimates[row * self.size + column];
            *estimate = rate.mul_add(cost - *estimate, *estimate);
        }
        Ok(())
    }

    /// The best coupling of what is known: pairs that were never tried go together only where
    /// there is no other way. At least one coupling was tried as a whole, so there always is one
    /// after the first episode.
    pub fn best(&self) -> Result<Vec<usize>> {
        let pairs = self.estimates.iter().zip(self.visits.counts());
        let tried = |(&estimate, &visits): (&f64, &u64)| {
            if visits > 0 { self.or_avoided(estimate) } else { f64::INFINITY }
        };
        self.assigned(pairs.map(tried).collect())
    }

    /// The estimates, row by row.
    pub fn estimates(&self) -> &[f64] {
        &self.estimates
    }

    /// How often each pair was tried, row by row.
    pub fn visits(&self) -> &[u64] {
        self.visits.counts()
    }

    fn or_avoided(&self, estimate: f64) -> f64 {
        if estimate > self.settings.limit { f64::INFINITY } else { estimate }
    }

    fn assigned(&self, costs: Vec<f64>) -> Result<Vec<usize>> {
        assign(&costs, self.size, self.settings.objective)
    }
}

impl Exploration {
    /// Softmax whose temperature falls as scale/iᵖ with the episodes i, in the unit of the costs.
    pub fn softmax(scale: f64, power: f64) -> Result<Self> {
        let temperature = Schedule::Power { scale, power };
        temperature.check("temperature", "positive", |t| t > 0.0)?;
        Ok(Self::Softmax(temperature))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::coupling::couplings;

    const SURE: Exploration = Exploration::Optimistic { confidence: 0.0 };

    fn settings(size: usize, objective: Objective, exploration: Exploration) -> PairSettings {
        PairSettings {
            first: vec![0.0; size * size],
            limit: 10.0,
            objective,
            exploration,
            learning_rate: Schedule::power("learning rate", 1.0, 0.0).unwrap(),
        }
    }

    /// The largest cost and the sum of a coupling.
    fn value(costs: &[f64], coupling: &[usize]) -> (f64, f64) {
        let size = coupling.len();
        let each = || coupling.iter().enumerate().map(|(row, column)| costs[row * size + column]);
        (each().fold(0.0, f64::max), each().sum())
    }

    #[test]
    fn optimism_finds_the_best_coupling_of_all() {
        let mut rng = Rng::new(2, 0);
        for objective in [Objective::Sum, Objective::Bottleneck] {
            for size in 1..=6 {
                let costs: Vec<f64> = (0..size * size).map(|_| 1.0 + rng.below(9) as f64).collect();
                let mut pairs = PairEstimates::new(settings(size, objective, SURE)).unwrap();
                // Each episode either tries a new pair or repeats the best coupling.
                for _ in 0..size * size + 1 {
                    let coupling = pairs.choose(&mut rng).unwrap();
                    let seen: Vec<f64> =
                        coupling.iter().enumerate().map(|(i, j)| costs[i * size + j]).collect();
                    pairs.learn(&coupling, &seen).unwrap();
                }
                let own = value(&costs, &pairs.best().unwrap());
                let all = couplings(size).unwrap();
                let values = all.iter().map(|coupling| value(&costs, coupling));
                match objective {
                    Objective::Sum => {
                        let least = values.map(|(_, sum)| sum).fold(f64::INFINITY, f64::min);
                        assert_eq!(own.1, least);
                    }
                    Objective::Bottleneck => {
                        let least = values.map(|(most, _)| most).fold(f64::INFINITY, f64::min);
                        assert_eq!(own.0, least);
                    }
                }
            }
        }
    }

    #[test]
    fn noise_chooses_by_boltzmanns_distribution_where_two_couplings_are_possible() {
        let hot = Exploration::softmax(2.0, 0.0).unwrap();
        let mut own = PairEstimates::new(settings(2, Objective::Sum, hot)).unwrap();
        own.learn(&[0, 1], &[1.0, 1.0]).unwrap();
        let mut rng = Rng::new(4, 0);
        let crossed = (0..4000).filter(|_| own.choose(&mut rng).unwrap() == [1, 0]).count();
        // The better coupling more often, but not always.
        assert!((2200..3600).contains(&crossed), "{crossed}");
        let cold = Exploration::softmax(1e-9, 0.0).unwrap();
        let mut own = PairEstimates::new(settings(2, Objective::Sum, cold)).unwrap();
        own.learn(&[0, 1], &[1.0, 1.0]).unwrap();
        assert!((0..100).all(|_| own.choose(&mut rng).unwrap() == [1, 0]));
    }

    #[test]
    fn doubt_tries_again_what_failed_at_first() {
        let tried = |confidence: f64| {
            let doubtful = Exploration::Optimistic { confidence };
            let mut own = PairEstimates::new(settings(2, Objective::Sum, doubtful)).unwrap();
            let mut rng = Rng::new(0, 0);
            own.learn(&[1, 0], &[9.0, 9.0]).unwrap();
            for _ in 0..100 {
                let coupling = own.choose(&mut rng).unwrap();
                let cost = if coupling == [1, 0] { 1.0 } else { 2.0 };
                own.learn(&coupling, &[cost, cost]).unwrap();
            }
            (own.best().unwrap(), own.visits()[1])
        };
        assert_eq!(tried(0.0), (vec![0, 1], 1));
        let (best, visits) = tried(3.0);
        assert_eq!(best, [1, 0]);
        assert!(visits >= 5, "{visits}");
    }

    #[test]
    fn pairs_above_the_limit_are_avoided_and_untried_ones_not_trusted() {
        let first = vec![9.0, 9.0, 9.0, 9.0];
        let own = settings(2, Objective::Sum, SURE);
        let mut pairs = PairEstimates::new(PairSettings { first, ..own }).unwrap();
        let mut rng = Rng::new(0, 0);
        pairs.learn(&[0, 1], &[1.0, 11.0]).unwrap();
        // 1 + 11 would be less than 9 + 9.
        assert_eq!(pairs.choose(&mut rng).unwrap(), [1, 0]);
        assert_eq!(pairs.best().unwrap(), [0, 1]);
        assert_eq!(pairs.visits(), [1, 0, 0, 1]);
        assert!(pairs.learn(&[0, 0], &[1.0, 1.0]).is_err());
        assert!(pairs.learn(&[0, 1], &[1.0, f64::NAN]).is_err());
        let bad = settings(2, Objective::Sum, SURE);
        assert!(PairEstimates::new(PairSettings { first: vec![0.0; 3], ..bad }).is_err());
        assert!(Exploration::softmax(0.0, 1.0).is_err());
    }
}
