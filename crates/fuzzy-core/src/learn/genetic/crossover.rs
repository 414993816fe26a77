//! How two parents make two children.

use serde::{Deserialize, Serialize};

use crate::check;
use crate::error::Result;
use crate::math::powf;
use crate::rng::Rng;

/// How the genes of two parents a and b become those of two children.
///
/// All but the first two mix numbers: w·a + (1 − w)·b for the first child and (1 − w)·a + w·b for
/// the second. They differ in where the weight w comes from. Only the first two suit bits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Crossover {
    /// The genes before a cut come from one parent, those after it from the other. The cut is
    /// drawn evenly among the places that leave something of each.
    OnePoint,
    /// Each gene comes from either parent, with probability ½.
    Uniform,
    /// One weight for all genes, drawn evenly from `low` to `high`; none is drawn if they are
    /// equal (3.4: ½).
    Average {
        /// The least weight.
        low: f64,
        /// The greatest weight.
        high: f64,
    },
    /// A weight for each gene, drawn evenly from `low` to `high`; −α to 1 + α is BLX-α
    /// (Eshelman and Schaffer 1993).
    Blend {
        /// The least weight.
        low: f64,
        /// The greatest weight.
        high: f64,
    },
    /// Simulated binary crossover (Deb and Agrawal 1995): for each gene w = (1 ± β)/2, the sign
    /// drawn evenly, with β = (2u)^(1/(η+1)) for u ≤ ½ and (2 − 2u)^(−1/(η+1)) above, u drawn
    /// evenly from \[0, 1). A larger η ≥ 0 keeps children nearer to their parents.
    SimulatedBinary {
        /// The distribution index η.
        eta: f64,
    },
}

impl Crossover {
    /// The average of both parents, the first weighted by r: r·a + (1 − r)·b.
    pub fn average(r: f64) -> Self {
        Self::Average { low: r, high: r }
    }

    /// BLX-α: each gene evenly from the parents' interval, widened by α of its size on each side.
    pub fn blx(alpha: f64) -> Self {
        Self::Blend { low: -alpha, high: 1.0 + alpha }
    }

    /// Whether children have only values that a parent has.
    pub(super) fn exchanges(self) -> bool {
        matches!(self, Self::OnePoint | Self::Uniform)
    }

    /// Nothing, or what does not fit.
    pub fn check(self) -> Result<()> {
        match self {
            Self::OnePoint | Self::Uniform => {}
            Self::Average { low, high } | Self::Blend { low, high } => {
                check::finite("least weight of the crossover", low)?;
                let expected = format!("at least the least weight, {low}");
                check::within("greatest weight of the crossover", high, &expected, |w| w >= low)?;
            }
            Self::SimulatedBinary { eta } => {
                check::within("eta of the crossover", eta, "zero or more", |eta| eta >= 0.0)?;
            }
        }
        Ok(())
    }

    /// Writes the genes of both children at the given places.
    pub(super) fn cross(
        self,
        places: &[usize],
        parents: [&[f64]; 2],
        children: [&mut [f64]; 2],
        rng: &mut Rng,
    ) {
        let [first, second] = children;
        let mut each = |pair: &mut dyn FnMut(usize, f64, f64) -> (f64, f64)| {
            for (index, &place) in places.iter().enumerate() {
                (first[place], second[place]) = pair(index, parents[0][place], parents[1][place]);
            }
        };
        match self {
            Self::OnePoint => {
                let cut = 1 + rng.below(places.len().saturating_sub(1));
                each(&mut |index, a, b| if index < cut { (a, b) } else { (b, a) });
            }
            Self::Uniform => {
                each(&mut |_, a, b| if rng.below(2) == 0 { (a, b) } else { (b, a) });
            }
            Self::Average { low, high } => {
                let weight = if low == high { low } else { rng.uniform_in(low, high) };
                each(&mut |_, a, b| mix(weight, a, b));
            }
            Self::Blend { low, high } => {
                each(&mut |_, a, b| mix(rng.uniform_in(low, high), a, b));
            }
            Self::SimulatedBinary { eta } => each(&mut |_, a, b| {
                let spread = spread(rng.uniform(), eta);
                let sign = if rng.below(2) == 0 { 1.0 } else { -1.0 };
                mix(0.5 * (1.0 + sign * spread), a, b)
            }),
        }
    }
}

/// Both weighted sums, without an overflow between finite numbers whose distance is finite.
fn mix(weight: f64, a: f64, b: f64) -> (f64, f64) {
    (weight.mul_add(a - b, b), weight.mul_add(b - a, a))
}

/// The children's distance over the parents', β.
fn spread(u: f64, eta: f64) -> f64 {
    let power = 1.0 / (eta + 1.0);
    if u <= 0.5 { powf(2.0 * u, power) } else { powf(1.0 / (2.0 - 2.0 * u), power) }
}
