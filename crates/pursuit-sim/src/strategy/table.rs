//! Steering by a look-up table.

use fuzzy_core::check;
use fuzzy_core::learn::rl::Discretiser;

use crate::error::{Error, Result};

/// A steering angle for each state of a grid over δ and δ̇.
#[derive(Debug, Clone, PartialEq)]
pub struct TableController {
    states: Discretiser,
    steering: Vec<f64>,
}

impl TableController {
    /// A table with the steering angle (rad) of every state.
    pub fn new(states: Discretiser, steering: Vec<f64>) -> Result<Self> {
        if states.coordinates() != 2 {
            let (name, inputs) = ("table".to_owned(), states.coordinates());
            return Err(Error::ControllerInputs { name, inputs });
        }
        check::same_length("steering angles of the table", states.states(), steering.len())?;
        check::all_finite("steering angles", &steering)?;
        Ok(Self { states, steering })
    }

    /// The grid.
    pub fn states(&self) -> &Discretiser {
        &self.states
    }

    /// The angles, state by state (rad).
    pub fn angles(&self) -> &[f64] {
        &self.steering
    }

    /// The steering angle (rad) for δ (rad) and δ̇ (rad/s).
    #[inline(always)]
    pub fn steering(&self, angle: f64, rate: f64) -> f64 {
        self.steering[self.states.state(&[angle, rate])]
    }
}
