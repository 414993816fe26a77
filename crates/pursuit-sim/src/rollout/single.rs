//! One game, with everything that happened.

use fuzzy_core::check;

use super::{DISTANCE, Outcome};
use crate::error::{Error, Result};
use crate::game::one_on_one::{OneOnOne, Start, State};
use crate::observation::{Observation, Sight};
use crate::reward::Closing;
use crate::strategy::{Controller, Player};
use crate::vehicle::Pose;

/// The path of a game: n + 1 samples of its states, n of what was done between them.
#[derive(Debug, Clone, Default, PartialEq)]
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
    check_recorded(max_steps)?;
    let closing = Closing::new(game);
    let mut player = Player::<f64>::new(pursuer);
    let mut path = Trajectory::default();
    path.outcome = drive(
        game,
        |seen| player.steer(seen),
        &mut Player::new(evader),
        start,
        max_steps,
        |step| {
            let Step { state, sight, .. } = step;
            path.pursuer.push(state.pursuer);
            path.evader.push(state.evader);
            path.distance.push(sight.distance);
            if let Some(steering) = step.steering {
                path.pursuer_steering.push(steering.0);
                path.evader_steering.push(steering.1);
            }
        },
    )?;
    let pairs = path.distance.windows(2);
    path.reward = pairs.map(|pair| closing.reward(pair[0], pair[1])).collect();
    Ok(path)
}

/// Nothing, or that games of so many steps cannot be recorded.
pub(super) fn check_recorded(max_steps: u32) -> Result<()> {
    check::at_least("number of steps", max_steps as usize, 1)?;
    check::within(
        "number of steps of a recorded game",
        f64::from(max_steps),
        "at most 1e7",
        |n| n <= f64::from(MOST_RECORDED),
    )?;
    Ok(())
}

/// One sample of a game.
pub(crate) struct Step<'a> {
    pub state: &'a State<f64>,
    pub sight: &'a Sight,
    /// How the pursuer and the evader steer from here, within their limits (rad); not at the end.
    pub steering: Option<(f64, f64)>,
}

/// Plays one game, and shows every sample of it to `visit`.
pub(crate) fn drive(
    game: &OneOnOne,
    mut pursuer: impl FnMut(&Observation) -> f64,
    evader: &mut Player<'_, f64>,
    start: Start,
    max_steps: u32,
    mut visit: impl FnMut(&Step<'_>),
) -> Result<Outcome> {
    let mut state = State::new(&start.checked()?);
    let mut sight = state.sight();
    let mut before = sight.offset;
    let mut outcome = Outcome {
        captured: false,
        steps: 0,
        first_distance: sight.distance,
        last_distance: sight.distance,
        miss_distance: sight.distance,
    };
    loop {
        let near = game.nearness(before, &sight);
        outcome.captured = near < game.capture_radius();
        outcome.miss_distance = near.min(outcome.miss_distance);
        outcome.last_distance = sight.distance;
        let seen = state.pursuer_sees(&sight, game);
        if outcome.captured || outcome.steps == max_steps {
            visit(&Step { state: &state, sight: &sight, steering: None });
            return Ok(outcome);
        }
        let wanted = evader.steer(&state.evader_sees(&sight, game));
        let steering = (game.pursuer().limit(pursuer(&seen)), game.evader().limit(wanted));
        visit(&Step { state: &state, sight: &sight, steering: Some(steering) });
        state = state.advance(&sight, steering.0, steering.1, game);
        before = sight.offset;
        sight = state.sight();
        if !sight.distance.is_finite() {
            let time = outcome.duration(game.time_step());
            return Err(Error::Diverged { time, what: DISTANCE });
        }
        outcome.steps += 1;
    }
}
