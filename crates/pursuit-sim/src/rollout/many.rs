//! Many games for their outcomes: eight in lock-step, blocks of games on several threads.

use fuzzy_core::inference::TskGrid;
use fuzzy_core::math::{LANES, Lanes, Real};
use fuzzy_core::{Control, check, parallel};

use super::{DISTANCE, Outcome, STEPS_BETWEEN_CHECKS, seconds};
use crate::error::{Error, Result};
use crate::game::one_on_one::{OneOnOne, Start, State};
use crate::observation::Sight;
use crate::strategy::{Controller, FuzzyController, Player};

/// Games that one thread takes at a time; fixed, so that it cannot depend on the threads.
const BLOCK: usize = 256;

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
    check::at_least("number of steps", max_steps as usize, 1)?;
    for start in starts {
        start.checked()?;
    }
    let blocks = parallel::map(threads, starts.chunks(BLOCK).collect(), |starts| {
        let mut table = LaneTable::new(game, Player::new(pursuer), Player::new(evader), max_steps);
        let played = table.play(starts.len(), control, |job| (&starts[job], [None; 2]))?;
        control.advance(starts.len() as u64)?;
        Ok::<_, Error>(played)
    })?;
    Ok(blocks.concat())
}

/// Who steers a robot in the games of a population.
#[derive(Debug, Clone, Copy)]
pub enum Entrant<'a> {
    /// The same controller in every game.
    Same(&'a Controller),
    /// In each game another individual: parameter vectors of the controller's system, one after
    /// the other. They are not checked: they come from a search that keeps to its bounds.
    Population(&'a FuzzyController, &'a [f64]),
}

impl Entrant<'_> {
    fn player(&self) -> Player<'_, Lanes> {
        match self {
            Self::Same(controller) => Player::new(controller),
            Self::Population(controller, _) => Player::fuzzy(controller),
        }
    }

    /// The prepared numbers of every individual; none of a controller that stays.
    fn individuals(&self) -> Vec<Vec<f64>> {
        let Self::Population(controller, population) = self else { return Vec::new() };
        let grid: &TskGrid = controller.system().grid();
        let prepare = |individual| {
            let mut prepared = vec![0.0; grid.prepared_count()];
            grid.prepare(individual, &mut prepared);
            prepared
        };
        population.chunks_exact(grid.parameter_count()).map(prepare).collect()
    }
}

/// Lets every individual of a population play a game from the same start. If both robots have a
/// population, the first play each other, the second, and so on; both must be of one size.
pub fn play_population(
    game: &OneOnOne,
    pursuer: Entrant<'_>,
    evader: Entrant<'_>,
    start: &Start,
    max_steps: u32,
    control: &Control,
) -> Result<Vec<Outcome>> {
    let individuals = [pursuer.individuals(), evader.individuals()];
    let count = match [&pursuer, &evader] {
        [Entrant::Population(..), Entrant::Population(..)] => {
            let [pursuers, evaders] = individuals.each_ref().map(Vec::len);
            check::same_length("evaders of a population", pursuers, evaders)?;
            pursuers
        }
        _ => individuals[0].len().max(individuals[1].len()),
    };
    let mut table = LaneTable::new(game, pursuer.player(), evader.player(), max_steps);
    let own = |side: usize, job: usize| individuals[side].get(job).map(Vec::as_slice);
    table.play(count, control, |job| (start, [own(0, job), own(1, job)]))
}

/// Eight games side by side. Whenever one ends, the next begins in its lane, so all eight stay
/// busy; which lane a game falls into does not change it.
struct LaneTable<'a> {
    game: &'a OneOnOne,
    pursuer: Player<'a, Lanes>,
    evader: Player<'a, Lanes>,
    max_steps: u32,
    state: State<Lanes>,
    /// The evaders' offsets at the last sample.
    before: (Lanes, Lanes),
    closest: Lanes,
    /// What each lane plays, and at which step of the table it began.
    seats: [Option<Seat>; LANES],
}

#[derive(Clone, Copy)]
struct Seat {
    job: usize,
    begun: u64,
    first_distance: f64,
}

impl<'a> LaneTable<'a> {
    fn new(
        game: &'a OneOnOne,
        pursuer: Player<'a, Lanes>,
        evader: Player<'a, Lanes>,
        max_steps: u32,
    ) -> Self {
        Self {
            game,
            pursuer,
            evader,
            max_steps,
            state: State::splat(&State::new(&Start::evader_at(1.0, 0.0))),
            before: (Lanes::splat(0.0), Lanes::splat(0.0)),
            closest: Lanes::splat(0.0),
            seats: [None; LANES],
        }
    }

    /// Plays `count` games; `job` says from where, and with which numbers of the pursuer and of
    /// the evader.
    fn play<'b>(
        &mut self,
        count: usize,
        control: &Control,
        job: impl Fn(usize) -> (&'b Start, [Option<&'b [f64]>; 2]),
    ) -> Result<Vec<Outcome>> {
        let mut outcomes = vec![Outcome::default(); count];
        let mut waiting = 0..count;
        for lane in 0..LANES {
            self.seat(lane, 0, waiting.next(), &job);
        }
        let mut step = 0;
        let (mut taken, mut deadline) = (self.taken(), self.deadline());
        while taken != 0 {
            let sight = self.state.sight();
            let near = self.game.nearness(self.before, &sight);
            self.closest = near.min(self.closest);
            let radius = Lanes::splat(self.game.capture_radius());
            let caught = Lanes::bits(near.lt(radius)) & taken;
            if caught != 0 || step >= deadline {
                for lane in 0..LANES {
                    let captured = caught >> lane & 1 == 1;
                    if let Some((ended, outcome)) = self.ended(lane, captured, &sight, step)? {
                        outcomes[ended] = outcome;
                        self.seat(lane, step, waiting.next(), &job);
                    }
                }
                (taken, deadline) = (self.taken(), self.deadline());
                continue;
            }
            self.advance(&sight);
            step += 1;
            if step % STEPS_BETWEEN_CHECKS == 0 {
                control.check()?;
            }
        }
        Ok(outcomes)
    }

    /// The job and the outcome of a lane's game, if it ends at this step.
    fn ended(
        &self,
        lane: usize,
        captured: bool,
        sight: &Sight<Lanes>,
        step: u64,
    ) -> Result<Option<(usize, Outcome)>> {
        let Some(seat) = self.seats[lane] else { return Ok(None) };
        let steps = step - seat.begun;
        if !captured && steps < u64::from(self.max_steps) {
            return Ok(None);
        }
        let steps = steps as u32;
        let last_distance = sight.distance.to_array()[lane];
        if !last_distance.is_finite() {
            let time = seconds(steps, self.game.time_step());
            return Err(Error::Diverged { time, what: DISTANCE });
        }
        let outcome = Outcome {
            captured,
            steps,
            first_distance: seat.first_distance,
            last_distance,
            miss_distance: self.closest.to_array()[lane],
        };
        Ok(Some((seat.job, outcome)))
    }

    #[inline(always)]
    fn advance(&mut self, sight: &Sight<Lanes>) {
        let wanted = self.pursuer.steer(&self.state.pursuer_sees(sight, self.game));
        let pursuer = self.game.pursuer().limit(wanted);
        let wanted = self.evader.steer(&self.state.evader_sees(sight, self.game));
        let evader = self.game.evader().limit(wanted);
        self.state = self.state.advance(sight, pursuer, evader, self.game);
        self.before = sight.offset;
    }

    /// Begins a game in a lane, or leaves it empty.
    fn seat<'b>(
        &mut self,
        lane: usize,
        step: u64,
        next: Option<usize>,
        job: impl Fn(usize) -> (&'b Start, [Option<&'b [f64]>; 2]),
    ) {
        self.seats[lane] = next.map(|index| {
            let (start, numbers) = job(index);
            let state = State::new(start);
            let sight = state.sight();
            let first_distance = sight.distance;
            self.state.set_lane(lane, &state);
            self.before.0.set_lane(lane, sight.offset.0);
            self.before.1.set_lane(lane, sight.offset.1);
            self.closest.set_lane(lane, first_distance);
            for (player, numbers) in [&mut self.pursuer, &mut self.evader].into_iter().zip(numbers)
            {
                if let Some(numbers) = numbers {
                    player.set_lane(lane, numbers);
                }
            }
            Seat { job: index, begun: step, first_distance }
        });
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
