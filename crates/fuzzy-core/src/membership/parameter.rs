//! What kinds of numbers membership functions are made of.

use std::ops::RangeInclusive;

use crate::check;
use crate::error::Result;
use crate::variable::Universe;

/// What one parameter of a membership function means: which values it may have and where learners
/// search for better ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ParameterKind {
    /// A place in the universe, where the function has its peak or crosses ½.
    Centre,
    /// A place in the universe or near it, where a side of the function begins or ends.
    Vertex,
    /// A distance, from 1e-150 to 1e150.
    Width,
    /// How steep a sigmoid is; positive if it rises, negative if it falls, of a size from 1e-150
    /// to 1e150.
    Slope,
    /// An exponent without unit, from 1e-150 to 1e150.
    Power,
    /// A side: any number but 0, of which only the sign counts.
    Direction,
    /// A degree, from 0 to 1.
    Degree,
}

/// The sizes whose squares, and the inverses of these, are normal numbers.
const SIZES: RangeInclusive<f64> = 1e-150..=1e150;

/// The narrowest function that learners try, as a share of the universe.
const NARROWEST: f64 = 0.01;

impl ParameterKind {
    /// Whether a parameter of this kind may have this value.
    pub(super) fn accepts(self, value: f64) -> bool {
        match self {
            Self::Centre | Self::Vertex => value.is_finite(),
            Self::Width | Self::Power => SIZES.contains(&value),
            Self::Slope => SIZES.contains(&value.abs()),
            Self::Direction => value.is_finite() && value != 0.0,
            Self::Degree => (0.0..=1.0).contains(&value),
        }
    }

    /// Nothing, if a parameter of this kind may have this value; otherwise what is wrong with it.
    pub(super) fn check(self, what: &str, value: f64) -> Result<()> {
        check::finite(what, value)?;
        let sizes = format!("from {:e} to {:e}", SIZES.start(), SIZES.end());
        let expected = match self {
            Self::Width | Self::Power if value <= 0.0 => "positive",
            Self::Slope if value == 0.0 => "other than 0",
            Self::Slope => &format!("{sizes}, or the negative of such a number"),
            Self::Direction => "1 or -1 (or a number with the sign of the one meant)",
            Self::Degree => "between 0 and 1",
            Self::Centre | Self::Vertex | Self::Width | Self::Power => &sizes,
        };
        check::within(what, value, expected, |value| self.accepts(value))?;
        Ok(())
    }

    /// Where learners search by default for a parameter of this kind that has the value `now`.
    ///
    /// - centre: the universe;
    /// - vertex: the universe and as much again on each side;
    /// - width: from 1 % to 100 % of the size of the universe;
    /// - slope: with the present sign, so steep that the tangent at the crossover climbs from 0 to
    ///   1 within 1 % to 100 % of the universe (a sigmoid's does within 4/|slope|);
    /// - power: from ½, where a bell has a kink at its centre, to 10, where it is nearly a box;
    /// - direction: −1 to 1;
    /// - degree: 0 to 1.
    pub fn bounds(self, universe: Universe, now: f64) -> (f64, f64) {
        self.bounds_from(NARROWEST, universe, now)
    }

    /// [`bounds`](Self::bounds) with another share of the universe for the narrowest function.
    pub(super) fn bounds_from(self, narrowest: f64, universe: Universe, now: f64) -> (f64, f64) {
        let (low, high) = (universe.low(), universe.high());
        let size = high - low;
        match self {
            Self::Centre => (low, high),
            Self::Vertex => (low - size, high + size),
            Self::Width => (narrowest * size, size),
            Self::Slope if now < 0.0 => (-4.0 / (narrowest * size), -4.0 / size),
            Self::Slope => (4.0 / size, 4.0 / (narrowest * size)),
            Self::Power => (0.5, 10.0),
            Self::Direction => (-1.0, 1.0),
            Self::Degree => (0.0, 1.0),
        }
    }
}
