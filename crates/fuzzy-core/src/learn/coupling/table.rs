//! A value for every coupling: Q_CF of section 8.5.

use super::couplings;
use crate::check;
use crate::error::Result;
use crate::learn::rl::{Visits, greedy, softmax};
use crate::learn::schedule::Schedule;
use crate::rng::Rng;

/// What the learning rate of a [`CouplingTable`] counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RateCount {
    /// How often the coupling was tried.
    Visits,
    /// Episodes, as the thesis prints it (Table 8.7): what is first tried late hardly learns.
    Episodes,
}

impl RateCount {
    /// The name that settings use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Visits => "visits",
            Self::Episodes => "episodes",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("count of a learning rate", name, [Self::Visits, Self::Episodes], Self::name)
    }
}

/// What a [`CouplingTable`] is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CouplingTableSettings {
    /// n, [`MOST_LISTED`](super::MOST_LISTED) at most.
    pub size: usize,
    /// θ_CF of (2.56), above zero.
    pub temperature: f64,
    /// α.
    pub learning_rate: Schedule,
    /// What its count counts.
    pub rate_count: RateCount,
}

/// The value of every coupling, learned once for each episode.
///
/// A coupling is chosen before an episode by softmax; after it, Q_CF(c) moves by α(r_CF − Q_CF(c)).
/// There is no next state whose value would count (section 8.5.2).
///
/// ```
/// use fuzzy_core::Rng;
/// use fuzzy_core::learn::coupling::{CouplingTable, CouplingTableSettings, RateCount};
/// use fuzzy_core::learn::schedule::Schedule;
///
/// let mut table = CouplingTable::new(CouplingTableSettings {
///     size: 3,
///     temperature: 1.0,
///     learning_rate: Schedule::power("learning rate", 1.0, 0.7)?,
///     rate_count: RateCount::Visits,
/// })?;
/// let mut rng = Rng::new(1, 0);
/// for _ in 0..100 {
///     let choice = table.choose(&mut rng);
///     let reward = if table.couplings()[choice] == [1, 2, 0] { 1.0 } else { 0.2 };
///     table.learn(choice, reward)?;
/// }
/// assert_eq!(table.best(), [1, 2, 0]);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct CouplingTable {
    settings: CouplingTableSettings,
    couplings: Vec<Vec<usize>>,
    values: Vec<f64>,
    visits: Visits,
    episodes: u64,
}

impl CouplingTable {
    /// A table of zeros.
    pub fn new(settings: CouplingTableSettings) -> Result<Self> {
        check::positive("temperature of the couplings", settings.temperature)?;
        let couplings = couplings(settings.size)?;
        let visits = Visits::new(1, couplings.len())?;
        Ok(Self { settings, values: vec![0.0; couplings.len()], couplings, visits, episodes: 0 })
    }

    /// The index of a coupling, by softmax.
    pub fn choose(&self, rng: &mut Rng) -> usize {
        softmax(&self.values, self.settings.temperature, rng)
    }

    /// Learns the reward of an episode that was played with the coupling of this index.
    pub fn learn(&mut self, choice: usize, reward: f64) -> Result<()> {
        check::finite("reward of a coupling", reward)?;
        self.episodes += 1;
        let visits = self.visits.visit(0, choice);
        let count = match self.settings.rate_count {
            RateCount::Visits => visits,
            RateCount::Episodes => self.episodes,
        };
        let rate = self.settings.learning_rate.at(count);
        self.values[choice] = rate.mul_add(reward - self.values[choice], self.values[choice]);
        Ok(())
    }

    /// All couplings, in the order of the values.
    pub fn couplings(&self) -> &[Vec<usize>] {
        &self.couplings
    }

    /// Q_CF.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// How often each coupling was tried.
    pub fn visits(&self) -> &[u64] {
        self.visits.counts()
    }

    /// The coupling of the largest value; the first of several.
    pub fn best(&self) -> &[usize] {
        &self.couplings[greedy(&self.values)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rate_count: RateCount, temperature: f64) -> CouplingTable {
        let learning_rate = Schedule::power("learning rate", 1.0, 1.0).unwrap();
        CouplingTable::new(CouplingTableSettings {
            size: 2,
            temperature,
            learning_rate,
            rate_count,
        })
        .unwrap()
    }

    #[test]
    fn a_rate_of_one_over_the_visits_gives_the_mean() {
        let mut own = table(RateCount::Visits, 1.0);
        for (choice, reward) in [(0, 1.0), (1, 6.0), (0, 2.0), (1, 4.0), (0, 3.0)] {
            own.learn(choice, reward).unwrap();
        }
        assert_eq!(own.values(), [2.0, 5.0]);
        assert_eq!(own.visits(), [3, 2]);
        assert_eq!(own.best(), [1, 0]);
        let mut other = table(RateCount::Episodes, 1.0);
        other.learn(0, 1.0).unwrap();
        other.learn(1, 6.0).unwrap();
        assert_eq!(other.values(), [1.0, 3.0]);
        assert!(other.learn(0, f64::NAN).is_err());
        assert_eq!(other.visits(), [1, 1]);
    }

    #[test]
    fn the_temperature_says_how_often_the_better_is_tried() {
        let mut rng = Rng::new(3, 0);
        for (temperature, expected) in [(1e-3, 1.0), (1.0, 0.731), (20.0, 0.512)] {
            let mut own = table(RateCount::Visits, temperature);
            own.learn(1, 1.0).unwrap();
            let tried = (0..20_000).map(|_| own.choose(&mut rng)).sum::<usize>() as f64 / 2e4;
            assert!((tried - expected).abs() < 0.02, "{temperature}: {tried}");
        }
        assert!(
            CouplingTable::new(CouplingTableSettings {
                temperature: 0.0,
                ..table(RateCount::Visits, 1.0).settings
            })
            .is_err()
        );
    }
}
