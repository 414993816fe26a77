//! Games of two pursuers: one with its whole path, or many for their outcomes.

use fuzzy_core::math::{Lanes, Real};
use fuzzy_core::{Control, check, parallel};

use super::entrant::{Entrant, Individuals};
use super::lanes::{Board, Look, play_in_lanes};
use super::many::BLOCK;
use super::single::check_recorded;
use super::{DISTANCE, Outcome};
use crate::error::{Error, Result};
use crate::game::two_pursuers::{State, TwoPursuers, TwoPursuersStart, View};
use crate::observation::Observation;
use crate::reward::Closing;
use crate::strategy::{Controller, Player};
use crate::vehicle::{Motion, Pose};

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
/// use pursuit_sim::rollout::two_pursuers;
/// use pursuit_sim::{Controller, TwoPursuers, TwoPursuersStart};
///
/// // The start of Figure 8.4 (b), all robots classical.
/// let game = TwoPursuers::thesis()?;
/// let start = TwoPursuersStart::pursuers_at([(-4.0, 3.0), (5.0, -2.0)]);
/// let path = two_pursuers::play(&game, [&Controller::Classical; 3], start, 600)?;
/// assert_eq!(path.outcome.capture_time(game.time_step()), Some(18.7));
/// # Ok::<(), pursuit_sim::Error>(())
/// ```
pub fn play(
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
        let closing =
            game.pursuers().map(|p| Closing::between(&p, game.evader(), game.time_step()));
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
        let motions = game.motions();
        let steering = [0, 1, 2].map(|robot| motions[robot].limit(wanted[robot]));
        self.state = self.state.moved(&before, steering, &motions);
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

/// Plays a game of at most `max_steps` steps from every start, on up to `threads` threads (0: one
/// for each core). Equal to [`play`] from each start, to the bit.
pub fn play_many(
    game: &TwoPursuers,
    controllers: [&Controller; 3],
    starts: &[TwoPursuersStart],
    max_steps: u32,
    threads: usize,
    control: &Control,
) -> Result<Vec<Outcome>> {
    check::at_least("number of steps", max_steps as usize, 1)?;
    for start in starts {
        start.checked()?;
    }
    let blocks = parallel::map(threads, starts.chunks(BLOCK).collect(), |starts| {
        let players = controllers.map(Player::new);
        let mut board = Matches::new(game, players, |index| (&starts[index], [None; 3]));
        let played = play_in_lanes(&mut board, starts.len(), max_steps, control)?;
        control.advance(starts.len() as u64)?;
        Ok::<_, Error>(played)
    })?;
    Ok(blocks.concat())
}

/// Lets every individual of a population play a game from each start: first all from the first
/// start, then all from the second, and so on. If several robots have a population, the first play
/// each other, the second, and so on; all must be of one size.
pub fn play_population(
    game: &TwoPursuers,
    entrants: [Entrant<'_>; 3],
    starts: &[TwoPursuersStart],
    max_steps: u32,
    control: &Control,
) -> Result<Vec<Outcome>> {
    let individuals = Individuals::of(&entrants)?;
    let mut board = Matches::new(game, entrants.map(|entrant| entrant.player()), |index| {
        let (start, numbers) = individuals.game(index);
        (&starts[start], numbers)
    });
    play_in_lanes(&mut board, individuals.games(starts.len()), max_steps, control)
}

/// Eight games of two pursuers. `jobs` says where a game begins, and with which prepared numbers of
/// the robots' fuzzy systems if they are individuals' own.
struct Matches<'a, J> {
    game: &'a TwoPursuers,
    players: [Player<'a, Lanes>; 3],
    motions: [Motion<Lanes>; 3],
    state: State<Lanes>,
    /// The evaders' offsets at the last sample.
    before: [(Lanes, Lanes); 2],
    jobs: J,
}

impl<'a, 'b, J> Matches<'a, J>
where
    J: Fn(usize) -> (&'b TwoPursuersStart, [Option<&'b [f64]>; 3]),
{
    fn new(game: &'a TwoPursuers, players: [Player<'a, Lanes>; 3], jobs: J) -> Self {
        let zero = Lanes::splat(0.0);
        let empty = TwoPursuersStart::pursuers_at([(1.0, 0.0); 2]);
        Self {
            game,
            players,
            motions: game.motions().map(Motion::splat),
            state: State::splat(&State::new(&empty, game)),
            before: [(zero, zero); 2],
            jobs,
        }
    }
}

impl<'b, J> Board for Matches<'_, J>
where
    J: Fn(usize) -> (&'b TwoPursuersStart, [Option<&'b [f64]>; 3]),
{
    type Sight = View<Lanes>;

    fn begin(&mut self, lane: usize, game: usize) -> f64 {
        let (start, numbers) = (self.jobs)(game);
        let state = State::new(start, self.game);
        let view = state.view(self.game);
        self.state.set_lane(lane, &state);
        for (before, offset) in self.before.iter_mut().zip(view.offsets) {
            before.0.set_lane(lane, offset.0);
            before.1.set_lane(lane, offset.1);
        }
        for (player, numbers) in self.players.iter_mut().zip(numbers) {
            if let Some(numbers) = numbers {
                player.set_lane(lane, numbers);
            }
        }
        view.nearest()
    }

    #[inline(always)]
    fn look(&self) -> Look<Self::Sight> {
        let view = self.state.view(self.game);
        let [first, second] = self.game.nearness(&self.before, &view);
        let near = second.min(first);
        let caught = Lanes::bits(near.lt(Lanes::splat(self.game.capture_radius())));
        Look { near, distance: view.nearest(), caught, sight: view }
    }

    #[inline(always)]
    fn advance(&mut self, view: &Self::Sight) {
        let seen = self.state.observations(view, self.game);
        let steering = std::array::from_fn(|robot| {
            self.motions[robot].limit(self.players[robot].steer(&seen[robot]))
        });
        self.state = self.state.moved(view, steering, &self.motions);
        self.before = view.offsets;
    }

    fn time_step(&self) -> f64 {
        self.game.time_step()
    }
}
