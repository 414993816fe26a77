//! Who becomes a parent.

use serde::{Deserialize, Serialize};

use crate::rng::Rng;

/// How the parents of the children are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Selection {
    /// The first and second of the ranking, the third and fourth, and so on, the best pairs
    /// first: each pair has two children (section 6.4.3 of the thesis). Parents must be kept.
    Pairs,
    /// The first and second of the ranking, the second and third, and so on: each two neighbours
    /// have one child (section 3.4). Parents must be kept.
    Neighbours,
    /// Each parent is the best of so many, at least 1, drawn evenly from the whole population
    /// with replacement; each two parents have two children.
    Tournament(usize),
}

impl Selection {
    /// The children of each couple.
    pub(super) fn children_per_couple(self) -> usize {
        match self {
            Self::Neighbours => 1,
            Self::Pairs | Self::Tournament(_) => 2,
        }
    }

    /// How many of the best become parents of so many children, if that is certain.
    pub(super) fn parents(self, children: usize) -> usize {
        match self {
            Self::Pairs => children.next_multiple_of(2),
            Self::Neighbours if children > 0 => children + 1,
            Self::Neighbours | Self::Tournament(_) => 0,
        }
    }

    /// The ranks of the parents of the couple with this number, 0 for the best.
    pub(super) fn couple(self, number: usize, population: usize, rng: &mut Rng) -> [usize; 2] {
        match self {
            Self::Pairs => [2 * number, 2 * number + 1],
            Self::Neighbours => [number, number + 1],
            Self::Tournament(size) => {
                // Who has the least rank wins, so drawing ranks is enough.
                let mut winner =
                    || (0..size).map(|_| rng.below(population)).min().unwrap_or_default();
                [winner(), winner()]
            }
        }
    }
}
