//! Many games for their outcomes: eight in lock-step, blocks of games on several threads.

use fuzzy_core::math::{Lanes, Real};
use fuzzy_core::{Control, check, parallel};

use super::Outcome;
use super::entrant::{Entrant, Individuals};
use super::lanes::{Board, Look, play_in_lanes};
use crate::error::{Error, Result};
use crate::game::one_on_one::{OneOnOne, Start, State};
use crate::observation::Sight;
use crate::strategy::{Controller, Player};
use crate::vehicle::Motion;

/// Games that one thread takes at a time; fixed, so that it cannot depend on the threads.
pub(super) const BLOCK: usize = 256;

/// Plays a game of at most `max_steps` steps from every start, on up to `threads` threads (0: one
/// for each core). Equal to [`play`](super::play) from each start, to the bit.
pub fn play_many(
    game: &OneOnOne,
    pursuer: &Controller,
    evader: &Controller,
    starts: &[Start],
    max_steps: u32,
    threads: usize,
    control: &Control,
) -> Result<Vec<Outcome>> {
    let jobs: Vec<Job<'_>> = starts.iter().map(Job::from).collect();
    play_blocks(game, [pursuer, evader], &jobs, max_steps, threads, control)
}

/// Plays each game once, from the start in the same place, on up to `threads` threads. The robots
/// may differ from game to game, but not the speed law of a side; radius, time step and the test
/// of capture must be the same in all.
pub fn play_pairs(
    games: &[OneOnOne],
    pursuer: &Controller,
    evader: &Controller,
    starts: &[Start],
    max_steps: u32,
    threads: usize,
    control: &Control,
) -> Result<Vec<Outcome>> {
    check::same_length("starts of the pairs", games.len(), starts.len())?;
    let Some(first) = games.first() else { return Ok(Vec::new()) };
    for game in games {
        check_alike(first, game)?;
    }
    let jobs: Vec<Job<'_>> = games
        .iter()
        .zip(starts)
        .map(|(game, start)| Job { motions: Some(game.motions()), ..Job::from(start) })
        .collect();
    play_blocks(first, [pursuer, evader], &jobs, max_steps, threads, control)
}

/// Nothing, if both games can be played side by side.
fn check_alike(first: &OneOnOne, other: &OneOnOne) -> Result<()> {
    let rules = |game: &OneOnOne| (game.capture_radius(), game.time_step(), game.capture());
    let laws = |game: &OneOnOne| [game.pursuer(), game.evader()].map(|robot| robot.speed_law());
    if rules(first) == rules(other) && laws(first) == laws(other) {
        return Ok(());
    }
    Err(fuzzy_core::Error::Unsuitable {
        what: "games of the pairs".to_owned(),
        reason: "all must have one capture radius, time step and test of capture, and all robots \
                 of a side one speed law"
            .to_owned(),
    }
    .into())
}

fn play_blocks(
    game: &OneOnOne,
    players: [&Controller; 2],
    jobs: &[Job<'_>],
    max_steps: u32,
    threads: usize,
    control: &Control,
) -> Result<Vec<Outcome>> {
    check::at_least("number of steps", max_steps as usize, 1)?;
    for job in jobs {
        job.start.checked()?;
    }
    let blocks = parallel::map(threads, jobs.chunks(BLOCK).collect(), |jobs| {
        let mut board = Duels::new(game, players.map(Player::new), |index| jobs[index]);
        let played = play_in_lanes(&mut board, jobs.len(), max_steps, control)?;
        control.advance(jobs.len() as u64)?;
        Ok::<_, Error>(played)
    })?;
    Ok(blocks.concat())
}

/// Lets every individual of a population play a game from each start: first all from the first
/// start, then all from the second, and so on. If both robots have a population, the first play
/// each other, the second, and so on; both must be of one size.
pub fn play_population(
    game: &OneOnOne,
    pursuer: Entrant<'_>,
    evader: Entrant<'_>,
    starts: &[Start],
    max_steps: u32,
    control: &Control,
) -> Result<Vec<Outcome>> {
    let entrants = [pursuer, evader];
    let individuals = Individuals::of(&entrants)?;
    let mut board = Duels::new(game, entrants.map(|entrant| entrant.player()), |index| {
        let (start, numbers) = individuals.game(index);
        Job { numbers, ..Job::from(&starts[start]) }
    });
    play_in_lanes(&mut board, individuals.games(starts.len()), max_steps, control)
}

/// What a game is begun with.
#[derive(Clone, Copy)]
struct Job<'a> {
    start: &'a Start,
    /// The prepared numbers of the pursuer's fuzzy system and of the evader's, if they are an
    /// individual's own.
    numbers: [Option<&'a [f64]>; 2],
    /// How the robots move, if not as the game's.
    motions: Option<[Motion; 2]>,
}

impl<'a> From<&'a Start> for Job<'a> {
    fn from(start: &'a Start) -> Self {
        Self { start, numbers: [None; 2], motions: None }
    }
}

/// Eight games of one pursuer and one evader.
struct Duels<'a, J> {
    game: &'a OneOnOne,
    /// The pursuer's, then the evader's.
    players: [Player<'a, Lanes>; 2],
    motions: [Motion<Lanes>; 2],
    state: State<Lanes>,
    /// The evaders' offsets at the last sample.
    before: (Lanes, Lanes),
    jobs: J,
}

impl<'a, 'b, J: Fn(usize) -> Job<'b>> Duels<'a, J> {
    fn new(game: &'a OneOnOne, players: [Player<'a, Lanes>; 2], jobs: J) -> Self {
        Self {
            game,
            players,
            motions: game.motions().map(Motion::splat),
            state: State::splat(&State::new(&Start::evader_at(1.0, 0.0))),
            before: (Lanes::splat(0.0), Lanes::splat(0.0)),
            jobs,
        }
    }
}

impl<'b, J: Fn(usize) -> Job<'b>> Board for Duels<'_, J> {
    type Sight = Sight<Lanes>;

    fn begin(&mut self, lane: usize, game: usize) -> f64 {
        let job = (self.jobs)(game);
        let state = State::new(job.start);
        let sight = state.sight();
        self.state.set_lane(lane, &state);
        self.before.0.set_lane(lane, sight.offset.0);
        self.before.1.set_lane(lane, sight.offset.1);
        for (player, numbers) in self.players.iter_mut().zip(job.numbers) {
            if let Some(numbers) = numbers {
                player.set_lane(lane, numbers);
            }
        }
        for (own, motion) in self.motions.iter_mut().zip(job.motions.iter().flatten()) {
            own.set_lane(lane, motion);
        }
        sight.distance
    }

    #[inline(always)]
    fn look(&self) -> Look<Self::Sight> {
        let sight = self.state.sight();
        let near = self.game.nearness(self.before, &sight);
        let caught = Lanes::bits(near.lt(Lanes::splat(self.game.capture_radius())));
        Look { near, distance: sight.distance, caught, sight }
    }

    #[inline(always)]
    fn advance(&mut self, sight: &Self::Sight) {
        let [pursuer, evader] = &mut self.players;
        let wanted = [
            pursuer.steer(&self.state.pursuer_sees(sight, self.game)),
            evader.steer(&self.state.evader_sees(sight, self.game)),
        ];
        let steering = std::array::from_fn(|side| self.motions[side].limit(wanted[side]));
        self.state = self.state.moved(sight, steering, &self.motions);
        self.before = sight.offset;
    }

    fn time_step(&self) -> f64 {
        self.game.time_step()
    }
}
