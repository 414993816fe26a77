//! Eight games side by side.

use fuzzy_core::Control;
use fuzzy_core::math::{LANES, Lanes, Real};

use super::{DISTANCE, Outcome, STEPS_BETWEEN_CHECKS, seconds};
use crate::error::{Error, Result};

/// A game in eight lanes, of which each is at a time of its own.
pub(crate) trait Board {
    /// What the robots see of each other.
    type Sight;

    /// Begins a game in a lane, and returns its first distance (m).
    fn begin(&mut self, lane: usize, game: usize) -> f64;

    /// What is seen now.
    fn look(&self) -> Look<Self::Sight>;

    /// All robots move, having seen that.
    fn advance(&mut self, sight: &Self::Sight);

    /// The time step (s).
    fn time_step(&self) -> f64;
}

/// What is seen in eight games.
pub(crate) struct Look<S> {
    pub sight: S,
    /// The distance that decides on capture (m).
    pub near: Lanes,
    /// The distance at this sample (m).
    pub distance: Lanes,
    /// The lanes in which that is a capture, as bits.
    pub caught: u32,
}

/// Plays so many games of at most `max_steps` steps, and returns how each ended.
///
/// Whenever one ends, the next begins in its lane, so all eight stay busy; which lane a game falls
/// into does not change it. The last begin first: those of a population's newcomers, which are not
/// among the best and play long, so that few lanes are empty at the end.
pub(crate) fn play_in_lanes(
    board: &mut impl Board,
    games: usize,
    max_steps: u32,
    control: &Control,
) -> Result<Vec<Outcome>> {
    let mut outcomes = vec![Outcome::default(); games];
    let mut seats =
        Seats { seats: [None; LANES], waiting: 0..games, closest: Lanes::splat(0.0), max_steps };
    let mut step = 0;
    for lane in 0..LANES {
        seats.next(board, lane, step);
    }
    let (mut taken, mut deadline) = (seats.taken(), seats.deadline());
    while taken != 0 {
        let look = board.look();
        seats.closest = look.near.min(seats.closest);
        if look.caught & taken != 0 || step >= deadline {
            for lane in 0..LANES {
                if let Some((game, outcome)) = seats.ended(lane, &look, step, board.time_step())? {
                    outcomes[game] = outcome;
                    seats.next(board, lane, step);
                }
            }
            (taken, deadline) = (seats.taken(), seats.deadline());
            continue;
        }
        board.advance(&look.sight);
        step += 1;
        if step % STEPS_BETWEEN_CHECKS == 0 {
            control.check()?;
        }
    }
    Ok(outcomes)
}

/// What each lane plays.
struct Seats {
    seats: [Option<Seat>; LANES],
    /// The games that were not begun.
    waiting: std::ops::Range<usize>,
    closest: Lanes,
    max_steps: u32,
}

#[derive(Clone, Copy)]
struct Seat {
    game: usize,
    /// The step of the table at which the game began.
    begun: u64,
    first_distance: f64,
}

impl Seats {
    /// Begins the next game in a lane, or leaves it empty.
    fn next(&mut self, board: &mut impl Board, lane: usize, step: u64) {
        self.seats[lane] = self.waiting.next_back().map(|game| {
            let first_distance = board.begin(lane, game);
            self.closest.set_lane(lane, first_distance);
            Seat { game, begun: step, first_distance }
        });
    }

    /// The number and the outcome of a lane's game, if it ends at this step.
    fn ended<S>(
        &self,
        lane: usize,
        look: &Look<S>,
        step: u64,
        time_step: f64,
    ) -> Result<Option<(usize, Outcome)>> {
        let Some(seat) = self.seats[lane] else { return Ok(None) };
        let (steps, captured) = (step - seat.begun, look.caught >> lane & 1 == 1);
        if !captured && steps < u64::from(self.max_steps) {
            return Ok(None);
        }
        let steps = steps as u32;
        let last_distance = look.distance.to_array()[lane];
        if !last_distance.is_finite() {
            return Err(Error::Diverged { time: seconds(steps, time_step), what: DISTANCE });
        }
        let outcome = Outcome {
            captured,
            steps,
            first_distance: seat.first_distance,
            last_distance,
            miss_distance: self.closest.to_array()[lane],
        };
        Ok(Some((seat.game, outcome)))
    }

    /// The lanes in which a game is played, as bits.
    fn taken(&self) -> u32 {
        (0..LANES).map(|lane| u32::from(self.seats[lane].is_some()) << lane).sum()
    }

    /// The step at which the oldest game's time is up.
    fn deadline(&self) -> u64 {
        let oldest = self.seats.iter().flatten().map(|seat| seat.begun).min();
        oldest.unwrap_or(0) + u64::from(self.max_steps)
    }
}
