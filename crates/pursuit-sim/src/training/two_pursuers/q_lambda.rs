//! Q(λ)-learning of all three robots.

use std::array::from_fn;

use fuzzy_core::learn::rl::{Exploring, TableAgent};
use fuzzy_core::{Control, Rng, check};

use super::{ROBOTS, SIDES, Surroundings, TwoPursuersTrained};
use crate::error::Result;
use crate::game::two_pursuers::TwoPursuers;
use crate::rollout::STEPS_BETWEEN_CHECKS;
use crate::rollout::two_pursuers::Match;
use crate::strategy::Controller;
use crate::training::duel::{Apprentice, Seat};
use crate::training::q_lambda::{TableLearning, even_angles, table};
use crate::training::stream;
use crate::vehicle::Vehicle;

/// Settings of Q(λ)-learning of two pursuers and an evader at once; each has a table of its own
/// over its δ and δ̇ and knows nothing of the others' actions and rewards (8.18).
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | episodes | games played | 2000 (8.4.1) |
/// | steps | time steps after which a game is given up | 6000 (8.4.1) |
/// | discount | γ | 0.5 (8.4.1) |
/// | trace_decay | λ | 0.3 (8.4.1) |
/// | learning_rate, learning_rate_decay | α = rate/iᵈᵉᶜᵃʸ in game i | 1, 0.7 (8.13) |
/// | exploration, exploration_decay | ε = rate/iᵈᵉᶜᵃʸ in game i | 1, 1 (8.14) |
/// | points | grid points of δ and of δ̇ on \[−1, 1\] | 11 (8.4.1) |
/// | action_step | how far steering angles are apart (rad), from −u_max to u_max; adjusted so that a whole number fits | 0.1: 11, 11 and 17 angles (8.4.1) |
/// | bootstrap_at_capture | whether the value of the state after a capture counts | true, as in [`QLambdaTraining`](crate::training::QLambdaTraining) |
/// | spread, clearance | the pursuers' first coordinates are drawn evenly within ± spread (m) of the evader, not nearer than the clearance (m) | 6, 1: the thesis says "random positions"; the square holds those of Figure 8.4 |
///
/// Of equally good actions the first is taken; the thesis does not say which.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct TwoPursuersQLambdaTraining {
    pub episodes: u32,
    pub steps: u32,
    pub discount: f64,
    pub trace_decay: f64,
    pub learning_rate: f64,
    pub learning_rate_decay: f64,
    pub exploration: f64,
    pub exploration_decay: f64,
    pub points: usize,
    pub action_step: f64,
    pub bootstrap_at_capture: bool,
    pub spread: f64,
    pub clearance: f64,
}

impl Default for TwoPursuersQLambdaTraining {
    fn default() -> Self {
        Self {
            episodes: 2000,
            steps: 6000,
            discount: 0.5,
            trace_decay: 0.3,
            learning_rate: 1.0,
            learning_rate_decay: 0.7,
            exploration: 1.0,
            exploration_decay: 1.0,
            points: 11,
            action_step: 0.1,
            bootstrap_at_capture: true,
            spread: 6.0,
            clearance: 1.0,
        }
    }
}

impl TwoPursuersQLambdaTraining {
    /// All three robots learn, in the same games.
    ///
    /// ```
    /// use fuzzy_core::Control;
    /// use pursuit_sim::TwoPursuers;
    /// use pursuit_sim::training::TwoPursuersQLambdaTraining;
    ///
    /// let settings = TwoPursuersQLambdaTraining { episodes: 20, ..Default::default() };
    /// let trained = settings.train(&TwoPursuers::thesis()?, 7, &Control::new())?;
    /// assert_eq!(trained.history[0].1.len(), 20);
    /// # Ok::<(), pursuit_sim::Error>(())
    /// ```
    pub fn train(
        &self,
        game: &TwoPursuers,
        seed: u64,
        control: &Control,
    ) -> Result<TwoPursuersTrained> {
        let ([first, second, evader], durations) = self.school(game, seed, control)?;
        let tables = [table(&first)?, table(&second)?, table(&evader)?];
        Ok(TwoPursuersTrained::by_tables(tables.map(Controller::Table), durations))
    }

    /// Nothing, or what does not fit.
    pub(super) fn check(&self, game: &TwoPursuers) -> Result<()> {
        check::at_least("steps", self.steps as usize, 1)?;
        self.surroundings().check()?;
        self.apprentices(game).map(|_| ())
    }

    pub(super) fn surroundings(&self) -> Surroundings {
        Surroundings { spread: self.spread, clearance: self.clearance }
    }

    /// Lets the robots learn, and returns their learners and the duration of each game (s).
    pub(super) fn school(
        &self,
        game: &TwoPursuers,
        seed: u64,
        control: &Control,
    ) -> Result<([TableAgent; 3], Vec<f64>)> {
        self.check(game)?;
        let mut robots = self.apprentices(game)?;
        let mut rngs = SIDES.map(|side| Rng::new(seed, stream::PURSUER + side));
        let mut starts = Rng::new(seed, stream::TWO_PURSUERS_STARTS);
        let mut durations = Vec::new();
        for episode in 1..=u64::from(self.episodes) {
            robots.iter_mut().for_each(|robot| robot.begin(episode));
            let mut played = Match::begin(game, &self.surroundings().draw(&mut starts));
            let mut seen = played.seen();
            while !played.outcome.captured && played.outcome.steps < self.steps {
                let wanted = from_fn(|i| robots[i].steer(&seen[i], &mut rngs[i]));
                let rewards = played.advance(wanted)?.rewards;
                seen = played.seen();
                for (i, robot) in robots.iter_mut().enumerate() {
                    let captured = played.outcome.captured;
                    robot.learn(rewards[i], &seen[i], captured, &mut rngs[i])?;
                }
                if u64::from(played.outcome.steps) % STEPS_BETWEEN_CHECKS == 0 {
                    control.check()?;
                }
            }
            durations.push(played.outcome.duration(game.time_step()));
            control.advance(1)?;
        }
        Ok((robots.map(|robot| robot.agent), durations))
    }

    fn apprentices(&self, game: &TwoPursuers) -> Result<[Apprentice<TableAgent>; 3]> {
        let [first, second, evader] = game.robots();
        Ok([
            self.apprentice(first, ROBOTS[0])?,
            self.apprentice(second, ROBOTS[1])?,
            self.apprentice(evader, ROBOTS[2])?,
        ])
    }

    /// A learner in this robot.
    fn apprentice(&self, robot: &Vehicle, name: &str) -> Result<Apprentice<TableAgent>> {
        let angles =
            robot.steering_angles(self.action_step).map_err(|error| error.at(name.to_owned()))?;
        check::at_least("episodes", self.episodes as usize, 1)?;
        let learning = TableLearning {
            points: self.points,
            discount: self.discount,
            trace_decay: self.trace_decay,
            learning_rate: (self.learning_rate, self.learning_rate_decay),
            exploring: Exploring::EpsilonGreedy,
            exploration: (self.exploration, self.exploration_decay),
            bootstrap_at_capture: self.bootstrap_at_capture,
        };
        learning.apprentice(even_angles(robot, angles.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_have_the_sizes_of_section_8_4() {
        let game = TwoPursuers::thesis().unwrap();
        let robots = TwoPursuersQLambdaTraining::default().apprentices(&game).unwrap();
        let sizes = robots.map(|robot| {
            let settings = robot.agent.settings();
            (settings.states.states(), settings.actions.len())
        });
        assert_eq!(sizes, [(121, 11), (121, 11), (121, 17)]);
        let pairs: usize = sizes.iter().map(|(states, actions)| states * actions).sum();
        assert_eq!(pairs, 4719);
    }

    #[test]
    fn impossible_settings_are_refused_in_words() {
        let game = TwoPursuers::thesis().unwrap();
        let message = |settings: TwoPursuersQLambdaTraining| {
            settings.train(&game, 0, &Control::new()).unwrap_err().to_string()
        };
        let default = TwoPursuersQLambdaTraining::default();
        let step = message(TwoPursuersQLambdaTraining { action_step: 1e-9, ..default.clone() });
        assert!(step.starts_with("first pursuer: number of steering angles"), "{step}");
        let none = message(TwoPursuersQLambdaTraining { episodes: 0, ..default.clone() });
        assert_eq!(none, "episodes must be at least 1, got 0");
        assert!(message(TwoPursuersQLambdaTraining { steps: 0, ..default }).contains("steps"));
    }
}
