//! Games in which one robot learns, or both.

use fuzzy_core::learn::rl::Agent;
use fuzzy_core::{Control, Rng, check};

use super::{check_starts, stream};
use crate::error::{Error, Result};
use crate::game::one_on_one::{OneOnOne, Start, State};
use crate::observation::Observation;
use crate::reward::Closing;
use crate::rollout::{DISTANCE, Outcome, STEPS_BETWEEN_CHECKS};
use crate::strategy::Player;

/// Who steers a robot, and may learn from what comes of it.
pub(super) trait Seat {
    /// Begins game i = 1, 2, ….
    fn begin(&mut self, game: u64);
    /// The steering angle wanted.
    fn steer(&mut self, seen: &Observation, rng: &mut Rng) -> f64;
    /// Takes the reward of the last step and what is seen now; a capture ended the game.
    fn learn(
        &mut self,
        reward: f64,
        seen: &Observation,
        captured: bool,
        rng: &mut Rng,
    ) -> Result<()>;
}

/// Who steers both robots of a game.
pub(super) trait Players {
    /// Begins game i = 1, 2, ….
    fn begin(&mut self, game: u64);
    /// The steering angles wanted, the pursuer's and the evader's.
    fn steer(&mut self, seen: &Views, rngs: &mut [Rng; 2]) -> Result<(f64, f64)>;
    /// Takes the pursuer's reward of the last step and what is seen now; a capture ended the game.
    fn learn(
        &mut self,
        reward: f64,
        seen: &Views,
        captured: bool,
        rngs: &mut [Rng; 2],
    ) -> Result<()>;
}

/// What the pursuer and the evader see.
pub(super) type Views = (Observation, Observation);

/// Each robot for itself: the pursuer is rewarded for the way it gains, the evader for the way it
/// wins (6.10). Each has a stream of random numbers.
impl<P: Seat + ?Sized, E: Seat + ?Sized> Players for (&mut P, &mut E) {
    fn begin(&mut self, game: u64) {
        self.0.begin(game);
        self.1.begin(game);
    }

    #[inline(always)]
    fn steer(&mut self, seen: &Views, rngs: &mut [Rng; 2]) -> Result<(f64, f64)> {
        Ok((self.0.steer(&seen.0, &mut rngs[0]), self.1.steer(&seen.1, &mut rngs[1])))
    }

    #[inline(always)]
    fn learn(
        &mut self,
        reward: f64,
        seen: &Views,
        captured: bool,
        rngs: &mut [Rng; 2],
    ) -> Result<()> {
        self.0.learn(reward, &seen.0, captured, &mut rngs[0])?;
        self.1.learn(-reward, &seen.1, captured, &mut rngs[1])
    }
}

/// A robot that doesn't learn.
impl Seat for Player<'_, f64> {
    fn begin(&mut self, _game: u64) {}

    #[inline(always)]
    fn steer(&mut self, seen: &Observation, _rng: &mut Rng) -> f64 {
        Player::steer(self, seen)
    }

    #[inline(always)]
    fn learn(&mut self, _: f64, _: &Observation, _: bool, _: &mut Rng) -> Result<()> {
        Ok(())
    }
}

/// A robot that learns: an agent that observes δ and δ̇, held within limits.
pub(super) struct Apprentice<A> {
    pub agent: A,
    /// Limits of δ (rad) and δ̇ (rad/s).
    pub limits: (f64, f64),
    /// Whether the value of the state after a capture counts.
    pub bootstrap_at_capture: bool,
}

impl<A: Agent> Apprentice<A> {
    #[inline(always)]
    fn observation(&self, seen: &Observation) -> [f64; 2] {
        let (angle, rate) = self.limits;
        [seen.angle.clamp(-angle, angle), seen.rate.clamp(-rate, rate)]
    }
}

impl<A: Agent> Seat for Apprentice<A> {
    fn begin(&mut self, game: u64) {
        self.agent.begin_episode(game);
    }

    #[inline(always)]
    fn steer(&mut self, seen: &Observation, rng: &mut Rng) -> f64 {
        let mut action = [0.0];
        self.agent.act(&self.observation(seen), &mut action, rng);
        action[0]
    }

    #[inline(always)]
    fn learn(
        &mut self,
        reward: f64,
        seen: &Observation,
        captured: bool,
        rng: &mut Rng,
    ) -> Result<()> {
        let continues = !captured || self.bootstrap_at_capture;
        self.agent.learn(reward, &self.observation(seen), continues, rng)?;
        Ok(())
    }
}

/// How many games are played to learn from, and from where.
#[derive(Debug, Clone, Copy)]
pub(super) struct Schooling<'a> {
    /// Games, or generations of games.
    pub episodes: u32,
    /// Time steps after which a game is given up.
    pub steps: u32,
    pub starts: &'a [(f64, f64)],
}

impl Schooling<'_> {
    /// Nothing, or what does not fit.
    pub fn check(&self) -> Result<()> {
        check::at_least("steps", self.steps as usize, 1)?;
        check_starts(self.starts)
    }

    /// Nothing, if the other robot is to learn from the same games.
    pub fn same_as(&self, evader: &Self) -> Result<()> {
        let numbers = [
            ("episodes or generations", self.episodes, evader.episodes),
            ("steps", self.steps, evader.steps),
        ];
        for (what, own, other) in numbers {
            let what = format!("{what} of the evader's settings, as of the pursuer's");
            check::same_length(&what, own as usize, other as usize)?;
        }
        if self.starts != evader.starts {
            return Err(fuzzy_core::Error::Unsuitable {
                what: "starts of the evader's settings".to_owned(),
                reason: "both robots learn from the same games; give both the same starts"
                    .to_owned(),
            }
            .into());
        }
        Ok(())
    }

    /// Plays all games, and adds them to those played before. The pursuer's stream of random
    /// numbers draws the starts too.
    pub fn play(
        &self,
        game: &OneOnOne,
        players: &mut impl Players,
        seed: u64,
        played: &mut Played,
        control: &Control,
    ) -> Result<()> {
        let closing = Closing::new(game);
        let mut rngs = [0, stream::EVADERS].map(|side| Rng::new(seed, stream::PURSUER + side));
        for episode in 1..=u64::from(self.episodes) {
            let (x, y) = self.starts[rngs[0].below(self.starts.len())];
            players.begin(episode);
            let duel = Duel { game, start: Start::evader_at(x, y), steps: self.steps };
            let outcome = duel.play(players, &mut rngs, control)?;
            played.durations.push(outcome.duration(game.time_step()));
            played.rewards.push(closing.reward(outcome.first_distance, outcome.last_distance));
            control.advance(1)?;
        }
        Ok(())
    }
}

/// Games that were played to learn from.
#[derive(Debug, Default)]
pub(super) struct Played {
    /// The duration of each (s).
    pub durations: Vec<f64>,
    /// The sum of the pursuer's rewards in each.
    pub rewards: Vec<f64>,
}

impl Played {
    /// The simulated time (s).
    pub fn time(&self) -> f64 {
        self.durations.iter().sum()
    }

    /// The same as histories with their names.
    pub fn histories(self) -> Vec<(String, Vec<f64>)> {
        vec![(DURATIONS.to_owned(), self.durations), (REWARDS.to_owned(), self.rewards)]
    }
}

/// What the history of the games' durations is called.
pub(super) const DURATIONS: &str = "duration of the games [s]";
const REWARDS: &str = "pursuer's total reward in the games";

/// One game to learn from.
pub(super) struct Duel<'a> {
    pub game: &'a OneOnOne,
    pub start: Start,
    /// Time steps after which it is given up.
    pub steps: u32,
}

impl Duel<'_> {
    /// Plays the game.
    pub fn play(
        &self,
        players: &mut impl Players,
        rngs: &mut [Rng; 2],
        control: &Control,
    ) -> Result<Outcome> {
        let game = self.game;
        let closing = Closing::new(game);
        let mut state = State::new(&self.start);
        let mut sight = state.sight();
        let mut outcome = Outcome {
            captured: sight.distance < game.capture_radius(),
            steps: 0,
            first_distance: sight.distance,
            last_distance: sight.distance,
            miss_distance: sight.distance,
        };
        let mut seen = (state.pursuer_sees(&sight, game), state.evader_sees(&sight, game));
        while !outcome.captured && outcome.steps < self.steps {
            let wanted = players.steer(&seen, rngs)?;
            let steering = (game.pursuer().limit(wanted.0), game.evader().limit(wanted.1));
            state = state.advance(&sight, steering.0, steering.1, game);
            let next = state.sight();
            outcome.steps += 1;
            if !next.distance.is_finite() {
                let time = outcome.duration(game.time_step());
                return Err(Error::Diverged { time, what: DISTANCE });
            }
            let reward = closing.reward(sight.distance, next.distance);
            let near = game.nearness(sight.offset, &next);
            outcome.captured = near < game.capture_radius();
            outcome.miss_distance = near.min(outcome.miss_distance);
            outcome.last_distance = next.distance;
            sight = next;
            seen = (state.pursuer_sees(&sight, game), state.evader_sees(&sight, game));
            players.learn(reward, &seen, outcome.captured, rngs)?;
            if u64::from(outcome.steps) % STEPS_BETWEEN_CHECKS == 0 {
                control.check()?;
            }
        }
        Ok(outcome)
    }
}
