//! n pursuers, n evaders: as many games of one against one, once it is settled who goes for whom.

use fuzzy_core::check;

use super::one_on_one::{Capture, OneOnOne, Start};
use super::prospect::Prospect;
use crate::error::Result;
use crate::vehicle::{Pose, Vehicle};

/// As many pursuers as evaders (section 8.5).
///
/// A coupling gives each pursuer an evader of its own. Each pair then plays its game of one against
/// one; a captured pair leaves. The whole game ends at the last capture, or when time is up.
///
/// ```
/// use pursuit_sim::{ManyOnMany, Prospect};
///
/// let game = ManyOnMany::thesis(3)?;
/// assert_eq!(game.size(), 3);
/// assert_eq!(game.pair(2, 0)?.pursuer().speed(), 1.2);
/// assert_eq!(game.prospect(2, 1)?, Prospect::Hopeless);
/// # Ok::<(), pursuit_sim::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ManyOnMany {
    pursuers: Vec<Vehicle>,
    evaders: Vec<Vehicle>,
    capture_radius: f64,
    time_step: f64,
    capture: Capture,
}

impl ManyOnMany {
    /// A game with a capture radius ℓ > 0 (m) and a time step T > 0 (s). The robots may differ,
    /// but those of a side obey one speed law; at most one side stands still.
    pub fn new(
        pursuers: Vec<Vehicle>,
        evaders: Vec<Vehicle>,
        capture_radius: f64,
        time_step: f64,
    ) -> Result<Self> {
        check::at_least("number of pursuers", pursuers.len(), 1)?;
        check::same_length("evaders, one for each pursuer", pursuers.len(), evaders.len())?;
        for (who, robots) in [("pursuers", &pursuers), ("evaders", &evaders)] {
            if robots.iter().any(|robot| robot.speed_law() != robots[0].speed_law()) {
                return Err(fuzzy_core::Error::Unsuitable {
                    what: format!("speed laws of the {who}"),
                    reason: "the robots of a side must obey the same one".to_owned(),
                }
                .into());
            }
        }
        let game = Self { pursuers, evaders, capture_radius, time_step, capture: Capture::Sampled };
        let slowest = |robots: &[Vehicle]| {
            let slower = |a: &usize, b: &usize| robots[*a].speed().total_cmp(&robots[*b].speed());
            (0..robots.len()).min_by(slower).unwrap_or(0)
        };
        // If this pair can play, all can.
        game.pair(slowest(&game.pursuers), slowest(&game.evaders))?;
        Ok(game)
    }

    /// The game of section 8.5.3 with 2 or 3 pairs (Tables 8.6 and 8.10); ℓ = 0.1 m, T = 0.1 s.
    pub fn thesis(pairs: usize) -> Result<Self> {
        // Speeds (m/s) and steering limits (rad); all wheelbases are 0.3 m.
        const TWO: [&[(f64, f64)]; 2] = [&[(1.6, 0.5), (1.2, 0.6)], &[(1.0, 0.8), (0.6, 1.0)]];
        const THREE: [&[(f64, f64)]; 2] =
            [&[(2.0, 0.4), (1.6, 0.5), (1.2, 0.6)], &[(0.6, 1.0), (1.4, 0.6), (1.0, 0.8)]];
        check::within("pairs of the thesis's games", pairs as f64, "2 or 3", |n| {
            n == 2.0 || n == 3.0
        })?;
        let robots = |robots: &[(f64, f64)]| -> Result<Vec<Vehicle>> {
            robots.iter().map(|&(speed, most)| Vehicle::new(speed, 0.3, most)).collect()
        };
        let [pursuers, evaders] = if pairs == 2 { TWO } else { THREE };
        Self::new(robots(pursuers)?, robots(evaders)?, 0.1, 0.1)
    }

    /// The same game with another test of capture; [`new`](Self::new) gives the sampled one.
    pub fn with_capture(self, capture: Capture) -> Self {
        Self { capture, ..self }
    }

    /// n, the number of pairs.
    pub fn size(&self) -> usize {
        self.pursuers.len()
    }

    /// The pursuers.
    pub fn pursuers(&self) -> &[Vehicle] {
        &self.pursuers
    }

    /// The evaders.
    pub fn evaders(&self) -> &[Vehicle] {
        &self.evaders
    }

    /// ℓ (m).
    pub fn capture_radius(&self) -> f64 {
        self.capture_radius
    }

    /// T (s).
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// How captures are tested.
    pub fn capture(&self) -> Capture {
        self.capture
    }

    /// The game of a pursuer and an evader, by their indices.
    pub fn pair(&self, pursuer: usize, evader: usize) -> Result<OneOnOne> {
        let (pursuer, evader) = self.robots(pursuer, evader)?;
        let game = OneOnOne::new(*pursuer, *evader, self.capture_radius, self.time_step)?;
        Ok(game.with_capture(self.capture))
    }

    /// Whether a pursuer can be sure of an evader.
    pub fn prospect(&self, pursuer: usize, evader: usize) -> Result<Prospect> {
        let (pursuer, evader) = self.robots(pursuer, evader)?;
        Ok(Prospect::of(pursuer, evader))
    }

    fn robots(&self, pursuer: usize, evader: usize) -> Result<(&Vehicle, &Vehicle)> {
        let robot = |who, robots: &'_ [Vehicle], index: usize| {
            let expected = format!("below {}", robots.len());
            let what = format!("index of the {who}");
            check::within(&what, index as f64, &expected, |_| index < robots.len())
        };
        robot("pursuer", &self.pursuers, pursuer)?;
        robot("evader", &self.evaders, evader)?;
        Ok((&self.pursuers[pursuer], &self.evaders[evader]))
    }
}

/// Where all robots of a [`ManyOnMany`] begin. Robots may begin in the same place.
#[derive(Debug, Clone, PartialEq)]
pub struct ManyStart {
    /// The pursuers' first poses.
    pub pursuers: Vec<Pose>,
    /// The evaders' first poses.
    pub evaders: Vec<Pose>,
}

impl ManyStart {
    /// Nothing, if there is a pose for each robot of the game and all their numbers are usable, as
    /// [`Start::checked`] says.
    pub fn check(&self, game: &ManyOnMany) -> Result<()> {
        check::same_length("starts of the pursuers", game.size(), self.pursuers.len())?;
        check::same_length("starts of the evaders", game.size(), self.evaders.len())?;
        for index in 0..game.size() {
            self.pair(index, index)
                .checked()
                .map_err(|error| error.at(format!("robots {index}")))?;
        }
        Ok(())
    }

    /// Where a pursuer and an evader begin; both must be there.
    pub fn pair(&self, pursuer: usize, evader: usize) -> Start {
        Start { pursuer: self.pursuers[pursuer], evader: self.evaders[evader] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robot(speed: f64) -> Vehicle {
        Vehicle::new(speed, 0.3, 0.5).unwrap()
    }

    #[test]
    fn impossible_games_are_refused_in_words() {
        let message = |pursuers: &[f64], evaders: &[f64]| {
            let robots = |speeds: &[f64]| speeds.iter().map(|&speed| robot(speed)).collect();
            match ManyOnMany::new(robots(pursuers), robots(evaders), 0.1, 0.1) {
                Ok(_) => String::new(),
                Err(error) => error.to_string(),
            }
        };
        assert_eq!(message(&[], &[]), "number of pursuers must be at least 1, got 0");
        let unequal = message(&[1.0, 1.0], &[1.0]);
        assert_eq!(unequal, "evaders, one for each pursuer: expected 2, got 1");
        assert!(message(&[0.0, 1.0], &[0.5, 0.0]).contains("sum of the robots' speeds"));
        assert_eq!(message(&[0.5, 0.5], &[1.0, 2.0]), "", "hopeless games are legal");
        let slows = vec![robot(1.0), robot(1.0).with_speed_law(crate::SpeedLaw::Cosine)];
        let mixed = ManyOnMany::new(slows, vec![robot(1.0); 2], 0.1, 0.1).unwrap_err();
        assert!(mixed.to_string().starts_with("speed laws of the pursuers does not fit"));
        assert!(ManyOnMany::thesis(4).unwrap_err().to_string().contains("must be 2 or 3, got 4"));
        let game = ManyOnMany::thesis(2).unwrap();
        assert!(game.pair(0, 2).unwrap_err().to_string().contains("below 2, got 2"));
    }

    #[test]
    fn starts_are_checked_robot_by_robot() {
        let game = ManyOnMany::thesis(2).unwrap();
        let pose = |x| Pose { x, y: 0.0, heading: 0.0 };
        let start = |pursuers: &[f64], evaders: &[f64]| {
            let poses = |places: &[f64]| places.iter().map(|&x| pose(x)).collect();
            ManyStart { pursuers: poses(pursuers), evaders: poses(evaders) }.check(&game)
        };
        assert!(start(&[1.0, 1.0], &[1.0, 1.0]).is_ok(), "robots may begin in one place");
        let error = start(&[1.0, 1.0], &[1.0, f64::NAN]).unwrap_err().to_string();
        assert_eq!(error, "robots 1: starting x of the evader must be finite, got NaN");
        assert!(start(&[1.0], &[1.0, 2.0]).unwrap_err().to_string().contains("expected 2, got 1"));
    }
}
