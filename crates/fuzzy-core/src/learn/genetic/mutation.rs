//! How the numbers of a child change by chance.

use serde::{Deserialize, Serialize};

use super::Gene;
use crate::check;
use crate::error::Result;
use crate::math::powf;
use crate::rng::Rng;

/// What happens to the numbers of a child after the crossover. Each gene changes with
/// probability `rate`, on its own; what leaves its range becomes the nearer end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Mutation {
    /// Nothing.
    None,
    /// Adds a normally distributed number of mean 0.
    Gaussian {
        /// The probability that a gene changes.
        rate: f64,
        /// The standard deviation, as a share of the size of the gene's range.
        scale: f64,
    },
    /// Polynomial mutation (Deb and Agrawal 1999): adds δ times the size of the range, with
    /// δ = (2u)^(1/(η+1)) − 1 for u < ½ and 1 − (2 − 2u)^(1/(η+1)) above, u drawn evenly from
    /// \[0, 1). A larger η ≥ 0 makes smaller steps.
    Polynomial {
        /// The probability that a gene changes.
        rate: f64,
        /// The distribution index η.
        eta: f64,
    },
    /// Draws the gene anew, evenly.
    Redraw {
        /// The probability that a gene changes.
        rate: f64,
    },
}

impl Mutation {
    /// Nothing, or what does not fit.
    pub fn check(self) -> Result<()> {
        match self {
            Self::None => {}
            Self::Gaussian { rate, scale } => {
                check::fraction("rate of the mutation", rate)?;
                check::within("scale of the mutation", scale, "zero or more", |s| s >= 0.0)?;
            }
            Self::Polynomial { rate, eta } => {
                check::fraction("rate of the mutation", rate)?;
                check::within("eta of the mutation", eta, "zero or more", |eta| eta >= 0.0)?;
            }
            Self::Redraw { rate } => {
                check::fraction("rate of the mutation", rate)?;
            }
        }
        Ok(())
    }

    /// Whether a gene changes, drawn where there is a choice.
    pub(super) fn strikes(self, rng: &mut Rng) -> bool {
        match self {
            Self::None => false,
            Self::Gaussian { rate, .. } | Self::Polynomial { rate, .. } | Self::Redraw { rate } => {
                rng.uniform() < rate
            }
        }
    }

    /// What becomes of the value of a gene that changes.
    pub(super) fn change(self, gene: Gene, value: f64, rng: &mut Rng) -> f64 {
        let (low, high) = gene.range();
        match self {
            Self::None => value,
            Self::Gaussian { scale, .. } => value + scale * (high - low) * rng.normal(),
            Self::Polynomial { eta, .. } => value + (high - low) * step(rng.uniform(), eta),
            Self::Redraw { .. } => gene.draw(rng),
        }
    }
}

/// A polynomial step δ, between −1 and 1.
fn step(u: f64, eta: f64) -> f64 {
    let power = 1.0 / (eta + 1.0);
    if u < 0.5 { powf(2.0 * u, power) - 1.0 } else { 1.0 - powf(2.0 - 2.0 * u, power) }
}
