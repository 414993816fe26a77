//! Settings of the techniques by which two pursuers and an evader learn at once.

use pursuit_sim::training::{TwoPursuersQLambdaTraining, TwoPursuersQlbgflcTraining};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::Setting;
use crate::errors::{Error, Result};
use crate::pickle::rebuild;

settings! {
    /// Q(λ)-learning of two pursuers and an evader at once, each on a table of its own. Defaults:
    /// Desouky's thesis, section 8.4.1; `repr(fz.TwoPursuersQLambdaTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// episodes, steps : int, optional
    ///     Games played, and time steps after which one is given up.
    /// discount, trace_decay : float, optional
    ///     γ and λ.
    /// learning_rate, learning_rate_decay : float, optional
    ///     α = learning_rate / i**learning_rate_decay in game i.
    /// exploration, exploration_decay : float, optional
    ///     ε = exploration / i**exploration_decay in game i.
    /// points : int, optional
    ///     Grid points of each input.
    /// action_step : float, optional
    ///     How far steering angles are apart, in radians; adjusted so that a whole number fits.
    /// bootstrap_at_capture : bool, optional
    ///     Whether the value of the state after a capture counts.
    /// spread, clearance : float, optional
    ///     The pursuers' first coordinates are drawn evenly within plus or minus `spread` metres of
    ///     the evader, not nearer than `clearance` metres.
    PyTwoPursuersQLambdaTraining, "TwoPursuersQLambdaTraining", TwoPursuersQLambdaTraining {
        episodes, steps, discount, trace_decay, learning_rate, learning_rate_decay, exploration,
        exploration_decay, points, action_step, bootstrap_at_capture, spread, clearance,
    }
}

settings! {
    /// The Q(λ)-learning based genetic fuzzy logic controller for two pursuers and an evader at
    /// once. Defaults: Desouky's thesis, section 8.4.1 and Table 8.1;
    /// `repr(fz.TwoPursuersQlbgflcTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// phase_1 : TwoPursuersQLambdaTraining, optional
    ///     Learns three tables; it also says where games start.
    /// stage_1 : GeneticPhase, optional
    ///     Fits a fuzzy controller to each table.
    /// stage_2 : GeneticPhase, optional
    ///     Tunes them by playing each other, for the least capture time or the largest.
    /// steps : int, optional
    ///     Time steps after which a game of stage 2 is given up.
    /// ranges : GeneRanges, optional
    ///     Where genes are drawn from.
    /// starts_per_generation : int, optional
    ///     From how many starts the individuals of a generation of stage 2 play; the mean capture
    ///     time counts.
    /// pairing : {"best", "place"}, optional
    ///     Whom an individual of stage 2 meets: the best of the other robots' last generations, or
    ///     the individuals in the same place.
    PyTwoPursuersQlbgflcTraining, "TwoPursuersQlbgflcTraining", TwoPursuersQlbgflcTraining {
        phase_1, stage_1, stage_2, steps, ranges, starts_per_generation, pairing,
    }
}
