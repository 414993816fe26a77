//! The reward-based genetic algorithm (Algorithm 6.4.4).

use fuzzy_core::{Control, Rng};

use super::coevolution::{Coevolution, Games, Pursuit};
use super::duel::Schooling;
use super::tuning::PlayedSearch;
use super::{GeneRanges, GeneticPhase, Pairing, Technique, Trained, stream, thesis_starts};
use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::reward::Closing;
use crate::rollout::Outcome;
use crate::strategy::Controller;

/// Settings of a genetic search from random controllers that maximises the reward.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | genetic | size of the search | 1000 iterations of 40, crossover 0.2, mutation 0.1 (6.5.2) |
/// | steps | time steps after which a game is given up | 300 (6.5.2) |
/// | ranges | where genes are drawn from | [`GeneRanges`] |
/// | starts | positions of the evader, one drawn for each generation | [`thesis_starts`] |
/// | pairing | whom an individual meets if both robots learn; the pursuer's settings decide | [`Pairing::Best`] |
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
    pub pairing: Pairing,
}

impl Default for RewardGaTraining {
    fn default() -> Self {
        Self {
            genetic: GeneticPhase::default(),
            steps: 300,
            ranges: GeneRanges::default(),
            starts: thesis_starts(),
            pairing: Pairing::Best,
        }
    }
}

impl Technique for RewardGaTraining {
    fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        let rng = Rng::new(seed, stream::REWARD_GA);
        let mut search = self.genetic.search(&self.ranges, rng)?;
        let closing = Closing::new(game);
        let games = self.games(game, seed);
        games.check()?;
        let played = PlayedSearch { games, evader }.run(
            &mut search,
            self.genetic.iterations,
            control,
            |o| -mean_reward(&closing, o),
        )?;
        let mean_reward = played.history.iter().map(|fitness| -fitness).collect();
        Ok(Trained {
            controller: Controller::Fuzzy(Box::new(played.controller)),
            evader: None,
            learning_time: played.learning_time,
            history: vec![("best mean reward".to_owned(), mean_reward)],
        })
    }

    fn train_both(
        &self,
        evader: &Self,
        game: &OneOnOne,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        self.schooling().same_as(&evader.schooling())?;
        let stream = stream::REWARD_GA;
        let searches = [
            self.genetic.search(&self.ranges, Rng::new(seed, stream))?,
            evader.genetic.search(&evader.ranges, Rng::new(seed, stream + stream::EVADERS))?,
        ];
        let closing = Closing::new(game);
        let breeding = Coevolution { games: self.games(game, seed), pairing: self.pairing };
        breeding.check(searches.each_ref())?;
        let bred = breeding
            .run(searches, self.genetic.iterations, control, |o| -mean_reward(&closing, o))?;
        let [controller, evader] = bred.controllers;
        let [pursuers, evaders] = bred.history.map(|losses| losses.iter().map(|l| -l).collect());
        Ok(Trained {
            controller,
            evader: Some(evader),
            learning_time: bred.learning_time,
            history: vec![
                ("best mean reward".to_owned(), pursuers),
                ("evader: least mean reward".to_owned(), evaders),
            ],
        })
    }
}

impl RewardGaTraining {
    fn games<'a>(&'a self, game: &'a OneOnOne, seed: u64) -> Games<Pursuit<'a>, 2> {
        let rng = Rng::new(seed, stream::REWARD_GA_STARTS);
        let arena = Pursuit { game, starts: &self.starts };
        Games { arena, starts: 1, steps: self.steps, rng }
    }

    fn schooling(&self) -> Schooling<'_> {
        Schooling { episodes: self.genetic.iterations, steps: self.steps, starts: &self.starts }
    }
}

/// The pursuer's reward in a step of a game, on average.
fn mean_reward(closing: &Closing, outcome: &Outcome) -> f64 {
    closing.reward(outcome.first_distance, outcome.last_distance) / f64::from(outcome.steps.max(1))
}
