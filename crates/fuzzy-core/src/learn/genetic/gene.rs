//! What stands at each place of a chromosome.

use serde::{Deserialize, Serialize};

use crate::check;
use crate::error::Result;
use crate::rng::Rng;

/// One place of a chromosome: which values it may have. A chromosome may mix the kinds; its
/// values are stored as `f64` whatever the kind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Gene {
    /// A number from `low` to `high`; equal ends hold the gene at one value.
    Real {
        /// The smallest value.
        low: f64,
        /// The largest value.
        high: f64,
    },
    /// A whole number from `low` to `high`, both within ±2⁵³.
    Integer {
        /// The smallest value.
        low: i64,
        /// The largest value.
        high: i64,
    },
    /// 0 or 1.
    Bit,
}

impl From<(f64, f64)> for Gene {
    fn from((low, high): (f64, f64)) -> Self {
        Self::Real { low, high }
    }
}

impl Gene {
    /// The smallest and the largest value.
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Real { low, high } => (low, high),
            Self::Integer { low, high } => (low as f64, high as f64),
            Self::Bit => (0.0, 1.0),
        }
    }

    /// Whether the gene may have this value.
    pub fn holds(self, value: f64) -> bool {
        self.contain(value) == value
    }

    /// Nothing, or what is wrong with the range, which messages call so.
    pub fn check(self, range: &str) -> Result<()> {
        /// Beyond it not every whole number is an `f64`.
        const LARGEST: u64 = 1 << 53;
        if let Self::Integer { low, high } = self {
            for (end, value) in [("lower", low), ("upper", high)] {
                let what = format!("{end} end of {range}");
                check::within(&what, value as f64, "from -2^53 to 2^53", |_| {
                    value.unsigned_abs() <= LARGEST
                })?;
            }
        }
        let (low, high) = self.range();
        if low != high {
            check::interval(range, low, high)?;
        }
        check::finite(range, low)?;
        Ok(())
    }

    /// A value drawn evenly.
    pub(super) fn draw(self, rng: &mut Rng) -> f64 {
        match self {
            Self::Real { low, high } => self.contain(rng.uniform_in(low, high)),
            Self::Integer { low, high } => {
                (low + rng.below(high.abs_diff(low) as usize + 1) as i64) as f64
            }
            Self::Bit => rng.below(2) as f64,
        }
    }

    /// The nearest value that the gene may have.
    pub(super) fn contain(self, value: f64) -> f64 {
        let (low, high) = self.range();
        let within = value.max(low).min(high);
        match self {
            Self::Real { .. } => within,
            Self::Integer { .. } | Self::Bit => within.round(),
        }
    }
}
