//! Q(λ)-learning of the pursuer (Algorithm 6.4.1).

use fuzzy_core::learn::rl::{Cut, Discretiser, QLambda, QLambdaSettings, Trace};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Control, Rng, check};

use super::{Trained, check_starts, stream, thesis_starts};
use crate::error::Result;
use crate::game::one_on_one::{OneOnOne, Start, State};
use crate::reward::Closing;
use crate::rollout::{STEPS_BETWEEN_CHECKS, seconds};
use crate::strategy::{Controller, Player, TableController};

/// What the history of the games' durations is called.
pub(super) const DURATIONS: &str = "duration of the games [s]";

/// Settings of Q(λ)-learning on a grid of states and actions.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | episodes | games played | 1000 (6.5.2; 200 as phase 1 of QLBGFLC) |
/// | steps | time steps after which a game is given up | 6000 (6.5.2) |
/// | discount | γ | 0.5 (6.5.2) |
/// | trace_decay | λ | 0.3 (6.5.2) |
/// | learning_rate, learning_rate_decay | α = rate/iᵈᵉᶜᵃʸ in game i | 1, 0.7 (6.16) |
/// | exploration, exploration_decay | ε = rate/iᵈᵉᶜᵃʸ in game i | 0.1, 1 (6.17 is lost in the scan; this reading gives the published capture times) |
/// | points | grid points of δ and of δ̇ on \[−1, 1\] | 11 (6.4.2) |
/// | actions | steering angles from −u_max to u_max | 11 (6.4.2) |
/// | bootstrap_at_capture | whether the value of the state after a capture counts | true: the algorithm has no terminal case, and since every step on the way is rewarded, a value of zero would punish the capture |
/// | starts | positions of the evader, drawn evenly for each game | [`thesis_starts`] |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct QLambdaTraining {
    pub episodes: u32,
    pub steps: u32,
    pub discount: f64,
    pub trace_decay: f64,
    pub learning_rate: f64,
    pub learning_rate_decay: f64,
    pub exploration: f64,
    pub exploration_decay: f64,
    pub points: usize,
    pub actions: usize,
    pub bootstrap_at_capture: bool,
    pub starts: Vec<(f64, f64)>,
}

impl Default for QLambdaTraining {
    fn default() -> Self {
        Self {
            episodes: 1000,
            steps: 6000,
            discount: 0.5,
            trace_decay: 0.3,
            learning_rate: 1.0,
            learning_rate_decay: 0.7,
            exploration: 0.1,
            exploration_decay: 1.0,
            points: 11,
            actions: 11,
            bootstrap_at_capture: true,
            starts: thesis_starts(),
        }
    }
}

impl QLambdaTraining {
    /// Learns to pursue this evader.
    pub fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        let (table, durations) = self.train_table(game, evader, seed, control)?;
        Ok(Trained {
            controller: Controller::Table(table),
            learning_time: durations.iter().sum(),
            history: vec![(DURATIONS.to_owned(), durations)],
        })
    }

    /// The greedy table after learning, and the duration of each game (s).
    pub(super) fn train_table(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<(TableController, Vec<f64>)> {
        check::at_least("episodes", self.episodes as usize, 1)?;
        check::at_least("steps", self.steps as usize, 1)?;
        check::at_least("actions", self.actions, 2)?;
        check_starts(&self.starts)?;
        let rates = Rates {
            learning: Schedule::power(
                "learning rate",
                self.learning_rate,
                self.learning_rate_decay,
            )?,
            exploration: Schedule::power(
                "exploration rate",
                self.exploration,
                self.exploration_decay,
            )?,
        };
        let mut apprentice = Apprentice::new(self, game, evader)?;
        let mut rng = Rng::new(seed, stream::Q_LAMBDA);
        let mut durations = Vec::new();
        for episode in 1..=u64::from(self.episodes) {
            let (x, y) = self.starts[rng.below(self.starts.len())];
            let rate = (rates.learning.at(episode), rates.exploration.at(episode));
            let steps = apprentice.play(&Start::evader_at(x, y), rate, &mut rng, control)?;
            durations.push(seconds(steps, game.time_step()));
            control.advance(1)?;
        }
        Ok((apprentice.table()?, durations))
    }
}

struct Rates {
    learning: Schedule,
    exploration: Schedule,
}

/// A pursuer that learns while it plays.
struct Apprentice<'a> {
    settings: &'a QLambdaTraining,
    game: &'a OneOnOne,
    evader: Player<'a, f64>,
    closing: Closing,
    states: Discretiser,
    steering: Vec<f64>,
    learner: QLambda,
}

impl<'a> Apprentice<'a> {
    fn new(
        settings: &'a QLambdaTraining,
        game: &'a OneOnOne,
        evader: &'a Controller,
    ) -> Result<Self> {
        let axis = (-1.0, 1.0, settings.points);
        let states = Discretiser::new(&[axis, axis])?;
        let most = game.pursuer().max_steering();
        let step = 2.0 * most / (settings.actions - 1) as f64;
        let learner = QLambda::new(QLambdaSettings {
            states: states.states(),
            actions: settings.actions,
            discount: settings.discount,
            trace_decay: settings.trace_decay,
            trace: Trace::ReplacingState,
            cut: Cut::Never,
        })?;
        Ok(Self {
            settings,
            game,
            evader: Player::new(evader),
            closing: Closing::new(game),
            states,
            steering: (0..settings.actions).map(|a| a as f64 * step - most).collect(),
            learner,
        })
    }

    /// Plays one game and returns its number of steps.
    fn play(
        &mut self,
        start: &Start,
        (learning_rate, exploration): (f64, f64),
        rng: &mut Rng,
        control: &Control,
    ) -> Result<u32> {
        let game = self.game;
        let mut state = State::new(start);
        let mut sight = state.sight();
        let mut seen = state.pursuer_sees(&sight, game);
        let mut cell = self.states.state(&[seen.angle, seen.rate]);
        let mut action = self.learner.choose(cell, exploration, rng);
        let mut captured = sight.distance < game.capture_radius();
        for step in 0..self.settings.steps {
            if captured {
                return Ok(step);
            }
            let pursuer = game.pursuer().limit(self.steering[action]);
            let evader = game.evader().limit(self.evader.steer(&state.evader_sees(&sight, game)));
            state = state.advance(&sight, pursuer, evader, game);
            let next_sight = state.sight();
            let reward = self.closing.reward(sight.distance, next_sight.distance);
            captured = game.nearness(sight.offset, &next_sight) < game.capture_radius();
            sight = next_sight;
            seen = state.pursuer_sees(&sight, game);
            let next_cell = self.states.state(&[seen.angle, seen.rate]);
            // As printed: the next action is chosen before the values change.
            let next_action = self.learner.choose(next_cell, exploration, rng);
            let counts = !captured || self.settings.bootstrap_at_capture;
            self.learner.learn(cell, action, reward, counts.then_some(next_cell), learning_rate)?;
            (cell, action) = (next_cell, next_action);
            if u64::from(step + 1) % STEPS_BETWEEN_CHECKS == 0 {
                control.check()?;
            }
        }
        Ok(self.settings.steps)
    }

    /// The greedy steering angle of every state (2.55).
    fn table(&self) -> Result<TableController> {
        let greedy = self.learner.greedy_actions();
        let angles = greedy.into_iter().map(|action| self.steering[action]).collect();
        TableController::new(self.states.clone(), angles)
    }
}
