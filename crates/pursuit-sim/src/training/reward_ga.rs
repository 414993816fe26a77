//! The reward-based genetic algorithm (Algorithm 6.4.4).

use fuzzy_core::{Control, Rng};

use super::tuning::PlayedSearch;
use super::{GeneRanges, GeneticPhase, Trained, stream, thesis_starts};
use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::reward::Closing;
use crate::strategy::Controller;

/// Settings of a genetic search from random controllers that maximises the reward.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | genetic | size of the search | 1000 iterations of 40, crossover 0.2, mutation 0.1 (6.5.2) |
/// | steps | time steps after which a game is given up | 300 (6.5.2) |
/// | ranges | where genes are drawn from | [`GeneRanges`] |
/// | starts | positions of the evader, one drawn for each generation | [`thesis_starts`] |
///
/// Fitness is the mean reward of a step. "Equation 6.10" names the reward of a single step; its
/// sum would not tell a fast capture from a slow one.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct RewardGaTraining {
    pub genetic: GeneticPhase,
    pub steps: u32,
    pub ranges: GeneRanges,
    pub starts: Vec<(f64, f64)>,
}

impl Default for RewardGaTraining {
    fn default() -> Self {
        Self {
            genetic: GeneticPhase::default(),
            steps: 300,
            ranges: GeneRanges::default(),
            starts: thesis_starts(),
        }
    }
}

impl RewardGaTraining {
    /// Learns to pursue this evader.
    pub fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        let rng = Rng::new(seed, stream::REWARD_GA);
        let mut search = self.genetic.search(&self.ranges, rng)?;
        let closing = Closing::new(game);
        let games = PlayedSearch {
            game,
            evader,
            starts: &self.starts,
            steps: self.steps,
            rng: Rng::new(seed, stream::REWARD_GA_STARTS),
        };
        games.check()?;
        let played = games.run(&mut search, self.genetic.iterations, control, |outcome| {
            let total = closing.reward(outcome.first_distance, outcome.last_distance);
            -total / f64::from(outcome.steps.max(1))
        })?;
        let mean_reward = played.history.iter().map(|fitness| -fitness).collect();
        Ok(Trained {
            controller: Controller::Fuzzy(Box::new(played.controller)),
            learning_time: played.learning_time,
            history: vec![("best mean reward".to_owned(), mean_reward)],
        })
    }
}
