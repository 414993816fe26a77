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

    /// Plays all games, and adds the duration of each (s) to the others.
    ///
    /// The pursuer is rewarded for the way it gains, the evader for the way it wins (6.10). Each
    /// has a stream of random numbers; the pursuer's draws the starts too.
    pub fn play<P: Seat + ?Sized, E: Seat + ?Sized>(
        &self,
        game: &OneOnOne,
        pursuer: &mut P,
        evader: &mut E,
        seed: u64,
        durations: &mut Vec<f64>,
        control: &Control,
    ) -> Result<()> {
        let mut rngs = [0, stream::EVADERS].map(|side| Rng::new(seed, stream::PURSUER + side));
        for episode in 1..=u64::from(self.episodes) {
            let (x, y) = self.starts[rngs[0].below(self.starts.len())];
            pursuer.begin(episode);
            evader.begin(episode);
            let duel = Duel { game, start: Start::evader_at(x, y), steps: self.steps };
            let outcome = duel.play(pursuer, evader, &mut rngs, control)?;
            durations.push(outcome.duration(game.time_step()));
            control.advance(1)?;
        }
        Ok(())
    }
}

/// One game to learn from.
pub(super) struct Duel<'a> {
    pub game: &'a OneOnOne,
    pub start: Start,
    /// Time steps after which it is given up.
    pub steps: u32,
}

impl Duel<'_> {
    /// Plays the game.
    pub fn play<P: Seat + ?Sized, E: Seat + ?Sized>(
        &self,
        pursuer: &mut P,
        evader: &mut E,
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
            let steering = (
                game.pursuer().limit(pursuer.steer(&seen.0, &mut rngs[0])),
                game.evader().limit(evader.steer(&seen.1, &mut rngs[1])),
            );
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
            pursuer.learn(reward, &seen.0, outcome.captured, &mut rngs[0])?;
            evader.learn(-reward, &seen.1, outcome.captured, &mut rngs[1])?;
            if u64::from(outcome.steps) % STEPS_BETWEEN_CHECKS == 0 {
                control.check()?;
            }
        }
        Ok(outcome)
    }
}
