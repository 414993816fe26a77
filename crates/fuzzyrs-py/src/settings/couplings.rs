//! Settings of the techniques that learn who goes for whom.

use fuzzy_core::learn::assignment::Objective;
use fuzzy_core::learn::coupling::RateCount;
use pursuit_sim::training::{
    CoupledRobotsTraining, CouplingReward, CouplingTraining, FirstEstimate, PairExploration,
    PairwiseTraining, Steering,
};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::Setting;
use crate::errors::{Error, Result};
use crate::pickle::rebuild;

named_setting!(Objective, RateCount, CouplingReward, FirstEstimate, PairExploration, Steering);

settings! {
    /// The robots that learn to steer while couplings are learned. Defaults: Desouky's thesis,
    /// section 8.5, but for the discount and the exploration; `repr(fz.CoupledRobotsTraining())`
    /// shows them.
    ///
    /// Parameters
    /// ----------
    /// steering : {"softmax", "epsilon-greedy", "classical"}, optional
    ///     Whether they learn by Q(λ), and how they explore.
    /// discount, trace_decay : float, optional
    ///     γ and λ.
    /// learning_rate, learning_rate_decay : float, optional
    ///     α = learning_rate / m**learning_rate_decay in episode m.
    /// exploration, exploration_decay : float, optional
    ///     The temperature or ε is exploration / m**exploration_decay in episode m.
    /// points : int, optional
    ///     Grid points of each input.
    /// action_step : float, optional
    ///     The distance of the steering angles, in radians.
    /// bootstrap_at_capture : bool, optional
    ///     Whether the value of the state after a capture counts.
    PyCoupledRobotsTraining, "CoupledRobotsTraining", CoupledRobotsTraining {
        steering, discount, trace_decay, learning_rate, learning_rate_decay, exploration,
        exploration_decay, points, action_step, bootstrap_at_capture,
    }
}

settings! {
    /// A table with a value for every coupling. Defaults: Desouky's thesis, section 8.5;
    /// `repr(fz.CouplingTraining())` shows them.
    ///
    /// Parameters
    /// ----------
    /// episodes, steps : int, optional
    ///     Games played, and time steps after which one is given up.
    /// robots : CoupledRobotsTraining, optional
    ///     How the robots steer meanwhile.
    /// reward : {"r_over_T2", "r_over_f", "inv_f"}, optional
    ///     What a coupling is rewarded for: the sum of the pursuers' rewards over the squared time of
    ///     the game or over its steps, or one over its steps.
    /// temperature : float, optional
    ///     By which couplings are chosen.
    /// learning_rate, learning_rate_decay : float, optional
    ///     α = learning_rate / k**learning_rate_decay.
    /// rate_count : {"visits", "episodes"}, optional
    ///     What k counts: how often the coupling was tried, or the episodes.
    PyCouplingTraining, "CouplingTraining", CouplingTraining {
        episodes, steps, robots, reward, temperature, learning_rate, learning_rate_decay, rate_count,
    }
}

settings! {
    /// An estimate for every pair, and an exact assignment before every game. For any number of
    /// pairs; `repr(fz.PairwiseTraining())` shows the defaults.
    ///
    /// Parameters
    /// ----------
    /// episodes, steps : int, optional
    ///     Games played, and time steps after which one is given up.
    /// robots : CoupledRobotsTraining, optional
    ///     How the robots steer meanwhile.
    /// objective : {"bottleneck", "sum"}, optional
    ///     What is to be small: the time of the last capture, at which the game ends, or the sum of
    ///     all capture times.
    /// exploration : {"optimistic", "softmax"}, optional
    ///     How pairs are found out about.
    /// first_estimate : {"reach", "zero"}, optional
    ///     Of every pair: the time in which both could meet at the least, or 0.
    /// confidence : float, optional
    ///     How far estimates are doubted if exploration is optimistic and the robots learn, in
    ///     seconds.
    /// temperature, temperature_decay : float, optional
    ///     The temperature of softmax is temperature / m**temperature_decay in episode m, in
    ///     seconds.
    /// learning_rate, learning_rate_decay : float, optional
    ///     α = learning_rate / k**learning_rate_decay at the k-th visit of a pair.
    PyPairwiseTraining, "PairwiseTraining", PairwiseTraining {
        episodes, steps, robots, objective, exploration, first_estimate, confidence, temperature,
        temperature_decay, learning_rate, learning_rate_decay,
    }
}
