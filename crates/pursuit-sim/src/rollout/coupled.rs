//! Games of many against many, pair by pair.

use fuzzy_core::learn::coupling::check_coupling;
use fuzzy_core::{Control, check, parallel};

use super::{MOST_RECORDED, Outcome, Trajectory, play, play_pairs, seconds};
use crate::error::{Error, Result};
use crate::game::many_on_many::{ManyOnMany, ManyStart};
use crate::strategy::Controller;

/// How the robots of a side steer.
#[derive(Debug, Clone, Copy)]
pub enum Crew<'a> {
    /// All alike.
    Same(&'a Controller),
    /// Each as its own controller says.
    Each(&'a [Controller]),
}

impl Crew<'_> {
    /// The controller of a robot, which must be there.
    fn of(&self, index: usize) -> &Controller {
        match self {
            Self::Same(controller) => controller,
            Self::Each(controllers) => &controllers[index],
        }
    }

    fn check(&self, who: &str, size: usize) -> Result<()> {
        if let Self::Each(controllers) = self {
            check::same_length(&format!("controllers of the {who}"), size, controllers.len())?;
        }
        Ok(())
    }
}

/// How a game of many against many ended.
#[derive(Debug, Clone, PartialEq)]
pub struct ManyOutcome {
    /// The evader of each pursuer.
    pub coupling: Vec<usize>,
    /// How the game of each pursuer ended.
    pub pairs: Vec<Outcome>,
}

impl ManyOutcome {
    /// How many evaders were caught.
    pub fn captured(&self) -> usize {
        self.pairs.iter().filter(|pair| pair.captured).count()
    }

    /// The time steps until the last capture, or until time was up.
    pub fn steps(&self) -> u32 {
        self.pairs.iter().map(|pair| pair.steps).max().unwrap_or(0)
    }

    /// The time of the last capture (s), if all evaders were caught.
    pub fn capture_time(&self, time_step: f64) -> Option<f64> {
        (self.captured() == self.pairs.len()).then(|| seconds(self.steps(), time_step))
    }
}

/// Plays a game of at most `max_steps` steps with a coupling, on up to `threads` threads (0: one
/// for each core).
pub fn play_coupled(
    game: &ManyOnMany,
    coupling: &[usize],
    start: &ManyStart,
    crews: [Crew<'_>; 2],
    max_steps: u32,
    threads: usize,
    control: &Control,
) -> Result<ManyOutcome> {
    check_coupling(coupling, game.size())?;
    check_players(game, start, crews)?;
    let pairs: Vec<_> = coupling.iter().copied().enumerate().collect();
    let pairs = play_some(game, &pairs, start, crews, max_steps, threads, control)?;
    Ok(ManyOutcome { coupling: coupling.to_vec(), pairs })
}

/// Plays a game and records the path of each pair, which ends at its capture. All of them together
/// have at most [`MOST_RECORDED`] steps.
pub fn record_coupled(
    game: &ManyOnMany,
    coupling: &[usize],
    start: &ManyStart,
    crews: [Crew<'_>; 2],
    max_steps: u32,
) -> Result<Vec<Trajectory>> {
    check_coupling(coupling, game.size())?;
    check_players(game, start, crews)?;
    let most = f64::from(MOST_RECORDED) / game.size() as f64;
    check::within(
        "number of steps of a recorded game",
        f64::from(max_steps),
        "at most 1e7 of all \
                   pairs together",
        |steps| steps <= most,
    )?;
    let pairs = coupling.iter().copied().enumerate();
    pairs
        .map(|(i, j)| {
            let [pursuer, evader] = [crews[0].of(i), crews[1].of(j)];
            play(&game.pair(i, j)?, pursuer, evader, start.pair(i, j), max_steps)
        })
        .collect()
}

/// The capture time (s) of every pair, pursuer by pursuer; +∞ where the time is up before.
pub fn capture_times(
    game: &ManyOnMany,
    start: &ManyStart,
    crews: [Crew<'_>; 2],
    max_steps: u32,
    threads: usize,
    control: &Control,
) -> Result<Vec<f64>> {
    check_players(game, start, crews)?;
    let size = game.size();
    // Row by row, so that the games and their starts need little memory.
    let rows = parallel::map(threads, (0..size).collect(), |i| {
        let pairs: Vec<_> = (0..size).map(|j| (i, j)).collect();
        let row = play_some(game, &pairs, start, crews, max_steps, 1, control)?;
        let time = |outcome: &Outcome| outcome.capture_time(game.time_step());
        Ok::<_, Error>(
            row.iter().map(|outcome| time(outcome).unwrap_or(f64::INFINITY)).collect::<Vec<_>>(),
        )
    })?;
    Ok(rows.concat())
}

/// Plays some pairs of a game whose starts and crews have been checked.
pub(crate) fn play_some(
    game: &ManyOnMany,
    pairs: &[(usize, usize)],
    start: &ManyStart,
    crews: [Crew<'_>; 2],
    max_steps: u32,
    threads: usize,
    control: &Control,
) -> Result<Vec<Outcome>> {
    let games = pairs.iter().map(|&(i, j)| game.pair(i, j)).collect::<Result<Vec<_>>>()?;
    let starts: Vec<_> = pairs.iter().map(|&(i, j)| start.pair(i, j)).collect();
    if let [Crew::Same(pursuer), Crew::Same(evader)] = crews {
        return play_pairs(&games, pursuer, evader, &starts, max_steps, threads, control);
    }
    parallel::map(threads, (0..pairs.len()).collect(), |index| {
        let (i, j) = pairs[index];
        let [pursuer, evader] = [crews[0].of(i), crews[1].of(j)];
        let (games, starts) = (&games[index..=index], &starts[index..=index]);
        let played = play_pairs(games, pursuer, evader, starts, max_steps, 1, control)?;
        Ok::<_, Error>(played[0])
    })
}

fn check_players(game: &ManyOnMany, start: &ManyStart, crews: [Crew<'_>; 2]) -> Result<()> {
    start.check(game)?;
    crews[0].check("pursuers", game.size())?;
    crews[1].check("evaders", game.size())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strategy::Pd;
    use crate::vehicle::Pose;

    fn start(pursuers: &[(f64, f64)], evaders: &[(f64, f64)]) -> ManyStart {
        let poses = |places: &[(f64, f64)]| {
            places.iter().map(|&(x, y)| Pose { x, y, heading: 0.0 }).collect()
        };
        ManyStart { pursuers: poses(pursuers), evaders: poses(evaders) }
    }

    const CLASSICAL: Controller = Controller::Classical;

    #[test]
    fn table_8_14_comes_out_in_every_way_of_playing() {
        let game = ManyOnMany::thesis(3).unwrap();
        let start = start(
            &[(-5.0, -4.0), (-1.0, -6.0), (0.0, 0.0)],
            &[(-4.0, -4.0), (1.0, -4.0), (-3.0, -1.0)],
        );
        let control = Control::new();
        let same = [Crew::Same(&CLASSICAL); 2];
        let controllers = vec![CLASSICAL; 3];
        let each = [Crew::Each(&controllers); 2];
        let times = capture_times(&game, &start, same, 600, 1, &control).unwrap();
        assert_eq!(times, capture_times(&game, &start, each, 600, 2, &control).unwrap());
        let expected = [Some(17.1), None, Some(17.1), Some(9.9), None, Some(13.7)];
        let all = fuzzy_core::learn::coupling::couplings(3).unwrap();
        for (coupling, expected) in all.iter().zip(expected) {
            let outcome = play_coupled(&game, coupling, &start, same, 600, 1, &control).unwrap();
            assert_eq!(outcome.capture_time(0.1), expected);
            let worst = (0..3).map(|i| times[3 * i + coupling[i]]).fold(0.0, f64::max);
            assert_eq!(worst, expected.unwrap_or(f64::INFINITY));
            let paths = record_coupled(&game, coupling, &start, each, 600).unwrap();
            assert!(paths.iter().zip(&outcome.pairs).all(|(path, pair)| path.outcome == *pair));
        }
    }

    #[test]
    fn robots_may_steer_each_in_its_own_way_and_begin_in_one_place() {
        let game = ManyOnMany::thesis(2).unwrap();
        let start = start(&[(0.0, 0.0), (0.0, 0.0)], &[(0.0, 0.0), (3.0, 1.0)]);
        let controllers = [CLASSICAL, Controller::Pd(Pd::new(0.1, 0.0).unwrap())];
        let crews = [Crew::Each(&controllers), Crew::Same(&CLASSICAL)];
        let times = capture_times(&game, &start, crews, 600, 1, &Control::new()).unwrap();
        assert_eq!((times[0], times[2]), (0.0, 0.0));
        let classical = [Crew::Same(&CLASSICAL); 2];
        let both = capture_times(&game, &start, classical, 600, 1, &Control::new()).unwrap();
        assert_eq!(times[1], both[1]);
        assert_ne!(times[3], both[3]);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let game = ManyOnMany::thesis(2).unwrap();
        let start = start(&[(0.0, 0.0); 2], &[(1.0, 0.0); 2]);
        let few = [CLASSICAL];
        let play = |coupling: &[usize], crew, steps| {
            let crews = [crew, Crew::Same(&CLASSICAL)];
            play_coupled(&game, coupling, &start, crews, steps, 1, &Control::new())
                .unwrap_err()
                .to_string()
        };
        let same = Crew::Same(&CLASSICAL);
        assert!(play(&[0, 0], same, 10).contains("partner 0 is taken twice"));
        assert!(play(&[0, 1], same, 0).contains("number of steps must be at least 1"));
        assert!(play(&[0, 1], Crew::Each(&few), 10).contains("controllers of the pursuers"));
        let long = record_coupled(&game, &[0, 1], &start, [same; 2], MOST_RECORDED).unwrap_err();
        assert!(long.to_string().contains("at most 1e7 of all pairs together"));
    }
}
