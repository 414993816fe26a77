//! Sets of genetic operators that go by a name.

use fuzzy_core::check;
use fuzzy_core::learn::genetic::{GeneticSettings, Mutation};

use crate::error::Result;

/// Which genetic operators a search uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operators {
    /// Tournaments of two, blend crossover BLX-0.3, a tenth of the genes changed by a fiftieth of
    /// their range.
    Modern,
    /// The thesis's (section 2.4): averages of neighbours in the ranking, and mutants that are
    /// drawn anew as a whole.
    Averaging,
    /// The same, but a mutant is one of the kept with a single gene drawn anew (Figure 2.5).
    SingleGene,
}

impl Operators {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Modern => "modern",
            Self::Averaging => "averaging",
            Self::SingleGene => "single-gene",
        }
    }

    /// The operators with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::Modern, Self::Averaging, Self::SingleGene];
        Ok(check::named("set of genetic operators", name, choices, Self::name)?)
    }

    /// Settings of a search with a population of this size (Table 4.3: half of the population
    /// is kept, 0.4 are children and 0.1 mutants; the modern operators have shares of their own).
    pub fn settings(self, population: usize) -> GeneticSettings {
        let (elite, tenth) = (population / 2, population / 10);
        let averaging = GeneticSettings { population, elite, ..GeneticSettings::averaging() };
        match self {
            Self::Modern => GeneticSettings {
                population,
                mutation: Mutation::Gaussian { rate: 0.1, scale: 0.02 },
                ..GeneticSettings::default()
            },
            Self::Averaging => GeneticSettings { immigrants: tenth, ..averaging },
            Self::SingleGene => GeneticSettings { immigrants: 0, mutants: tenth, ..averaging },
        }
    }
}
