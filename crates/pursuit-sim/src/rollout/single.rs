//! One game, with everything that happened.

use fuzzy_core::check;

use super::{DISTANCE, Outcome};
use crate::error::{Error, Result};
use crate::game::one_on_one::{OneOnOne, Start, State};
use crate::reward::Closing;
use crate::strategy::{Controller, Player};
use crate::vehicle::Pose;

/// The path of a game: n + 1 samples of its states, n of what was done between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// The pursuer's poses.
    pub pursuer: Vec<Pose>,
    /// The evader's poses.
    pub evader: Vec<Pose>,
    /// The distance between them (m).
    pub distance: Vec<f64>,
    /// The pursuer's steering, within its limit (rad).
    pub pursuer_steering: Vec<f64>,
    /// The evader's steering, within its limit (rad).
    pub evader_steering: Vec<f64>,
    /// The pursuer's reward (6.10).
    pub reward: Vec<f64>,
    /// How the game ended.
    pub outcome: Outcome,
}

/// The most steps of a game that is recorded: about a gigabyte.
pub const MOST_RECORDED: u32 = 10_000_000;

/// Plays one game of at most `max_steps` steps, [`MOST_RECORDED`] at most, and records it.
pub fn play(
    game: &OneOnOne,
    pursuer: &Controller,
    evader: &Controller,
    start: Start,
    max_steps: u32,
) -> Result<Trajectory> {
    check::at_least("number of steps", max_steps as usize, 1)?;
    check::within(
        "number of steps of a recorded game",
        f64::from(max_steps),
        "at most 1e7",
        |n| n <= f64::from(MOST_RECORDED),
    )?;
    let closing = Closing::new(game);
    let (mut pursuer, mut evader) = (Player::<f64>::new(pursuer), Player::<f64>::new(evader));
    let mut state = State::new(&start.checked()?);
    let mut sight = state.sight();
    let mut path = Trajectory {
        pursuer: vec![state.pursuer],
        evader: vec![state.evader],
        distance: vec![sight.distance],
        pursuer_steering: Vec::new(),
        evader_steering: Vec::new(),
        reward: Vec::new(),
        outcome: Outcome {
            captured: false,
            steps: 0,
            first_distance: sight.distance,
            last_distance: sight.distance,
            miss_distance: sight.distance,
        },
    };
    for step in 0..=max_steps {
        path.outcome = Outcome {
            captured: sight.distance < game.capture_radius(),
            steps: step,
            last_distance: sight.distance,
            miss_distance: sight.distance.min(path.outcome.miss_distance),
            ..path.outcome
        };
        if path.outcome.captured || step == max_steps {
            break;
        }
        let wanted = pursuer.steer(&state.pursuer_sees(&sight, game));
        let pursuer_steering = game.pursuer().limit(wanted);
        let evader_steering = game.evader().limit(evader.steer(&state.evader_sees(&sight, game)));
        let next = state.advance(&sight, pursuer_steering, evader_steering, game);
        let next_sight = next.sight();
        if !next_sight.distance.is_finite() {
            let time = path.outcome.duration(game.time_step());
            return Err(Error::Diverged { time, what: DISTANCE });
        }
        path.pursuer_steering.push(pursuer_steering);
        path.evader_steering.push(evader_steering);
        path.reward.push(closing.reward(sight.distance, next_sight.distance));
        (state, sight) = (next, next_sight);
        path.pursuer.push(state.pursuer);
        path.evader.push(state.evader);
        path.distance.push(sight.distance);
    }
    Ok(path)
}
