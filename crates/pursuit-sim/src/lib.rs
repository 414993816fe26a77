//! Games of car-like robots, and the techniques that learn to play them.
//!
//! Lengths are in metres, times in seconds, angles in radians. Every formula is written over
//! [`fuzzy_core::math::Real`], so one game alone and eight games in lock-step go through the same
//! operations and give the same bits.
//!
//! ```
//! use pursuit_sim::{Controller, OneOnOne, Start, play};
//!
//! // The game of section 6.5.2 of the thesis, classical against classical (Table 6.3, row 1).
//! let game = OneOnOne::thesis()?;
//! let start = Start::evader_at(-6.0, 7.0);
//! let path = play(&game, &Controller::Classical, &Controller::Classical, start, 600)?;
//! assert_eq!(path.outcome.capture_time(game.time_step()), Some(9.6));
//! # Ok::<(), pursuit_sim::Error>(())
//! ```

pub mod error;
pub mod game;
pub mod observation;
pub mod reward;
pub mod rollout;
pub mod strategy;
pub mod training;
pub mod vehicle;

pub use error::{Error, Result};
pub use game::many_on_many::{ManyOnMany, ManyStart};
pub use game::one_on_one::{Capture, OneOnOne, Start};
pub use game::prospect::Prospect;
pub use game::two_pursuers::{Aim, Flight, TwoPursuers, TwoPursuersStart};
pub use game::wall::{Sensing, Wall};
pub use game::wall_following::{WallFollowing, WallRun};
pub use rollout::two_pursuers::TwoPursuersTrajectory;
pub use rollout::{Crew, ManyOutcome, capture_times, play_coupled, record_coupled};
pub use rollout::{Entrant, Outcome, Trajectory, play, play_many, play_pairs, play_population};
pub use strategy::{
    Controller, EvasiveTurn, FuzzyController, MixedTableController, Pd, TableController,
};
pub use strategy::{FuzzyRegulator, Regulator};
pub use vehicle::{Pose, SpeedLaw, Vehicle};
