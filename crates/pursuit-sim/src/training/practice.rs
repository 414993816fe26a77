//! Games for learners of the caller's own.

use std::ops::Range;

use fuzzy_core::learn::rl::Agent;
use fuzzy_core::{Control, Rng, check};

use super::duel::{Apprentice, Duel};
use super::{check_starts, stream};
use crate::error::Result;
use crate::game::one_on_one::{OneOnOne, Start};
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
        check::at_least("steps", self.steps as usize, 1)?;
        check_starts(self.starts)?;
        check::same_length("observations of an agent in this game", 2, agent.inputs())?;
        check::same_length("actions of an agent in this game", 1, agent.outputs())?;
        let unlimited = (f64::INFINITY, f64::INFINITY);
        let bootstrap_at_capture = self.bootstrap_at_capture;
        let mut own = Apprentice { agent, limits: unlimited, bootstrap_at_capture };
        let mut other = Player::new(self.opponent);
        let mut outcomes = Vec::new();
        for episode in episodes {
            let mut starts = Rng::new(seed, stream::PRACTICE + episode);
            let (x, y) = self.starts[starts.below(self.starts.len())];
            own.agent.begin_episode(episode);
            let duel = Duel { game: self.game, start: Start::evader_at(x, y), steps: self.steps };
            // Who doesn't learn draws no numbers.
            let mut rngs = [rng.clone(), rng.clone()];
            let played = match self.role {
                Role::Pursuer => duel.play(&mut own, &mut other, &mut rngs, control),
                Role::Evader => duel.play(&mut other, &mut own, &mut rngs, control),
            };
            let [first, second] = rngs;
            *rng = if self.role == Role::Pursuer { first } else { second };
            outcomes.push(played?);
            control.advance(1)?;
        }
        Ok(outcomes)
    }
}
