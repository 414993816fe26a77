//! Games for learners of the caller's own.

use std::ops::Range;

use fuzzy_core::learn::rl::Agent;
use fuzzy_core::{Control, Rng, check};

use super::duel::{Apprentice, Duel, Seat};
use super::{check_starts, stream};
use crate::error::Result;
use crate::game::one_on_one::{OneOnOne, Start};
use crate::observation::Observation;
use crate::reward::Closing;
use crate::rollout::Outcome;
use crate::strategy::{Controller, Player};

/// Which robot learns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The pursuer, rewarded for the way it gains (6.10).
    Pursuer,
    /// The evader, rewarded for the opposite.
    Evader,
}

impl Role {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pursuer => "pursuer",
            Self::Evader => "evader",
        }
    }

    /// The role with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        Ok(check::named("role", name, [Self::Pursuer, Self::Evader], Self::name)?)
    }
}

/// Games in which an agent learns to steer one robot; it observes δ (rad) and δ̇ (rad/s).
#[derive(Debug, Clone, PartialEq)]
pub struct Practice<'a> {
    /// The game.
    pub game: &'a OneOnOne,
    /// Which robot the agent steers.
    pub role: Role,
    /// Who steers the other.
    pub opponent: &'a Controller,
    /// Positions of the evader (m), drawn evenly.
    pub starts: &'a [(f64, f64)],
    /// Time steps after which a game is given up.
    pub steps: u32,
    /// Whether the value of the state after a capture counts.
    pub bootstrap_at_capture: bool,
}

impl Practice<'_> {
    /// Plays the episodes with these numbers, from 1 on, and lets the agent learn.
    ///
    /// Where a game starts depends on the seed and its number alone, so that practice in two parts
    /// is the same as in one. `rng` is for the agent's exploration. On an error the agent is as it
    /// was when that came up.
    pub fn play<A: Agent>(
        &self,
        agent: &mut A,
        rng: &mut Rng,
        episodes: Range<u64>,
        seed: u64,
        control: &Control,
    ) -> Result<Vec<Outcome>> {
        self.check_agent(agent)?;
        let limits = (f64::INFINITY, f64::INFINITY);
        let bootstrap_at_capture = self.bootstrap_at_capture;
        let mut own = Apprentice { agent, limits, bootstrap_at_capture };
        let mut other = Player::new(self.opponent);
        let mut outcomes = Vec::new();
        for episode in episodes {
            own.agent.begin_episode(episode);
            let duel = self.duel(seed, stream::PRACTICE + episode);
            outcomes.push(self.seat(&duel, &mut own, &mut other, rng, control)?);
            control.advance(1)?;
        }
        Ok(outcomes)
    }

    /// Plays a game without exploration, and learns nothing. Tests have numbers of their own, and
    /// are always the same under a seed.
    pub fn test<A: Agent>(
        &self,
        agent: &mut A,
        number: u64,
        seed: u64,
        control: &Control,
    ) -> Result<Outcome> {
        self.check_agent(agent)?;
        let duel = self.duel(seed, stream::PRACTICE_TESTS + number);
        let mut other = Player::new(self.opponent);
        self.seat(&duel, &mut Settled(agent), &mut other, &mut Rng::new(0, 0), control)
    }

    /// The sum of the agent's rewards in a game.
    pub fn reward(&self, outcome: &Outcome) -> f64 {
        let gained = Closing::new(self.game).reward(outcome.first_distance, outcome.last_distance);
        match self.role {
            Role::Pursuer => gained,
            Role::Evader => -gained,
        }
    }

    /// Nothing, or what does not fit.
    pub fn check(&self) -> Result<()> {
        check::at_least("steps", self.steps as usize, 1)?;
        check_starts(self.starts)
    }

    fn check_agent(&self, agent: &impl Agent) -> Result<()> {
        self.check()?;
        check::same_length("observations of an agent in this game", 2, agent.inputs())?;
        check::same_length("actions of an agent in this game", 1, agent.outputs())?;
        Ok(())
    }

    /// The game whose start is drawn from this stream.
    fn duel(&self, seed: u64, stream: u64) -> Duel<'_> {
        let (x, y) = self.starts[Rng::new(seed, stream).below(self.starts.len())];
        Duel { game: self.game, start: Start::evader_at(x, y), steps: self.steps }
    }

    fn seat(
        &self,
        duel: &Duel<'_>,
        own: &mut impl Seat,
        other: &mut Player<'_, f64>,
        rng: &mut Rng,
        control: &Control,
    ) -> Result<Outcome> {
        // Who doesn't learn draws no numbers.
        let mut rngs = [rng.clone(), rng.clone()];
        let played = match self.role {
            Role::Pursuer => duel.play(&mut (own, other), &mut rngs, control),
            Role::Evader => duel.play(&mut (other, own), &mut rngs, control),
        };
        let [first, second] = rngs;
        *rng = if self.role == Role::Pursuer { first } else { second };
        played
    }
}

/// An agent that does what it has learned, and learns no more.
struct Settled<'a, A>(&'a mut A);

impl<A: Agent> Seat for Settled<'_, A> {
    fn begin(&mut self, _game: u64) {}

    fn steer(&mut self, seen: &Observation, _: &mut Rng) -> f64 {
        let mut action = [0.0];
        self.0.exploit(&[seen.angle, seen.rate], &mut action);
        action[0]
    }

    fn learn(&mut self, _: f64, _: &Observation, _: bool, _: &mut Rng) -> Result<()> {
        Ok(())
    }
}
