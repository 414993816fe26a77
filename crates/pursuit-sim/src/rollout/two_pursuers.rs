//! Games of two pursuers: one with its whole path, or many for their outcomes.

use super::single::check_recorded;
use super::{DISTANCE, Outcome};
use crate::error::{Error, Result};
use crate::game::two_pursuers::{State, TwoPursuers, TwoPursuersStart, View};
use crate::observation::Observation;
use crate::reward::Closing;
use crate::strategy::{Controller, Player};
use crate::vehicle::Pose;

/// The path of a game of two pursuers: n + 1 samples of its states, n of what was done between
/// them. The robots are the pursuers, then the evader.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TwoPursuersTrajectory {
    /// The robots' poses.
    pub robots: [Vec<Pose>; 3],
    /// The distance of each pursuer from the evader (m) (8.15).
    pub distances: [Vec<f64>; 2],
    /// The robots' steering, within their limits (rad).
    pub steering: [Vec<f64>; 3],
    /// The robots' rewards (8.18).
    pub rewards: [Vec<f64>; 3],
    /// How the game ended. Its distances are those of the nearer pursuer.
    pub outcome: Outcome,
    /// Which pursuer caught the evader, 0 or 1: the nearer one, if both did.
    pub captor: Option<usize>,
}

/// Plays one game of at most `max_steps` steps, [`MOST_RECORDED`](super::MOST_RECORDED) at most,
/// and records it. The controllers are those of the pursuers, then the evader's.
///
/// ```
/// use pursuit_sim::{Controller, TwoPursuers, TwoPursuersStart, play_two_pursuers};
///
/// // The start of Figure 8.4 (b), all robots classical.
/// let game = TwoPursuers::thesis()?;
/// let start = TwoPursuersStart::pursuers_at([(-4.0, 3.0), (5.0, -2.0)]);
/// let path = play_two_pursuers(&game, [&Controller::Classical; 3], start, 600)?;
/// assert_eq!(path.outcome.capture_time(game.time_step()), Some(18.7));
/// # Ok::<(), pursuit_sim::Error>(())
/// ```
pub fn play_two_pursuers(
    game: &TwoPursuers,
    controllers: [&Controller; 3],
    start: TwoPursuersStart,
    max_steps: u32,
) -> Result<TwoPursuersTrajectory> {
    check_recorded(max_steps)?;
    let mut players = controllers.map(Player::<f64>::new);
    let mut path = TwoPursuersTrajectory::default();
    let mut played = Match::begin(game, &start.checked()?);
    loop {
        extend(&mut path.robots, played.state.robots);
        extend(&mut path.distances, played.view.distances);
        if played.outcome.captured || played.outcome.steps == max_steps {
            (path.outcome, path.captor) = (played.outcome, played.captor);
            return Ok(path);
        }
        let seen = played.seen();
        let step = played.advance([0, 1, 2].map(|robot| players[robot].steer(&seen[robot])))?;
        extend(&mut path.steering, step.steering);
        extend(&mut path.rewards, step.rewards);
    }
}

fn extend<T, const N: usize>(paths: &mut [Vec<T>; N], sample: [T; N]) {
    paths.iter_mut().zip(sample).for_each(|(path, value)| path.push(value));
}

/// A game at work, step by step.
pub(crate) struct Match<'a> {
    game: &'a TwoPursuers,
    closing: [Closing; 2],
    pub state: State<f64>,
    pub view: View,
    /// What it would be if the game ended now.
    pub outcome: Outcome,
    pub captor: Option<usize>,
}

/// What was done in one time step, and what it earned.
pub(crate) struct Step {
    /// Within the robots' limits (rad).
    pub steering: [f64; 3],
    pub rewards: [f64; 3],
}

impl<'a> Match<'a> {
    pub fn begin(game: &'a TwoPursuers, start: &TwoPursuersStart) -> Self {
        let state = State::new(start, game);
        let view = state.view(game);
        let first_distance = view.nearest();
        let outcome = Outcome {
            first_distance,
            last_distance: first_distance,
            miss_distance: first_distance,
            ..Outcome::default()
        };
        let closing = game.pursuers().map(|p| Closing::between(&p, game.evader(), game.time_step()));
        let mut begun = Self { game, closing, state, view, outcome, captor: None };
        begun.look(&view.offsets);
        begun
    }

    /// What the robots perceive.
    pub fn seen(&self) -> [Observation; 3] {
        self.state.observations(&self.view, self.game)
    }

    /// Lets the robots steer as they want, within their limits.
    pub fn advance(&mut self, wanted: [f64; 3]) -> Result<Step> {
        let (game, before) = (self.game, self.view);
        let robots = game.robots();
        let steering = [0, 1, 2].map(|robot| robots[robot].limit(wanted[robot]));
        self.state = self.state.advance(&before, steering, game);
        self.view = self.state.view(game);
        self.outcome.last_distance = self.view.nearest();
        if self.view.distances.iter().any(|distance| !distance.is_finite()) {
            let time = self.outcome.duration(game.time_step());
            return Err(Error::Diverged { time, what: DISTANCE });
        }
        self.outcome.steps += 1;
        self.look(&before.offsets);
        let [first, second] =
            [0, 1].map(|i| self.closing[i].reward(before.distances[i], self.view.distances[i]));
        Ok(Step { steering, rewards: [first, second, -(first + second)] })
    }

    /// Tests the capture, when the evader was at these offsets at the last sample.
    fn look(&mut self, before: &[(f64, f64); 2]) {
        let near = self.game.nearness(before, &self.view);
        let nearer = usize::from(near[1] < near[0]);
        self.outcome.miss_distance = near[nearer].min(self.outcome.miss_distance);
        self.outcome.captured = near[nearer] < self.game.capture_radius();
        self.captor = self.outcome.captured.then_some(nearer);
    }
}
