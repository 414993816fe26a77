//! The state of a [`Genetic`] search as a document.

use serde::{Deserialize, Serialize};

use super::{FORMAT, VERSION, read, write};
use crate::check;
use crate::error::{Error, Result};
use crate::learn::genetic::{Gene, Genetic, GeneticSettings, Progress, check_chromosome};
use crate::rng::RngState;

const GENETIC: &str = "genetic";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GeneticDocument {
    format: String,
    version: u32,
    #[serde(rename = "type")]
    kind: String,
    genes: Vec<Gene>,
    settings: GeneticSettings,
    population: Vec<Vec<f64>>,
    progress: Progress,
    rng: RngState,
}

impl Genetic {
    /// The whole state of the search as a JSON document, from which it continues with the same
    /// bits.
    ///
    /// ```
    /// use fuzzy_core::learn::genetic::{Genetic, GeneticSettings};
    ///
    /// let mut search = Genetic::new([(0.0, 1.0); 3], GeneticSettings::default(), 7)?;
    /// let mut again = Genetic::from_json(&search.to_json()?)?;
    /// let fitness: Vec<f64> = search.ask().map(|x| x[0]).collect();
    /// search.tell(&fitness)?;
    /// again.tell(&fitness)?;
    /// assert_eq!(again.population(), search.population());
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn to_json(&self) -> Result<String> {
        write(&GeneticDocument {
            format: FORMAT.to_owned(),
            version: VERSION,
            kind: GENETIC.to_owned(),
            genes: self.genes().to_vec(),
            settings: *self.settings(),
            population: self.ask().map(<[f64]>::to_vec).collect(),
            progress: self.progress().clone(),
            rng: self.rng(),
        })
    }

    /// The search whose state a JSON document holds.
    pub fn from_json(text: &str) -> Result<Self> {
        let document: GeneticDocument = read(text, GENETIC)?;
        let (genes, settings, progress) = (document.genes, document.settings, document.progress);
        // A document claims no more memory than its text has.
        check::same_length("individuals", settings.population, document.population.len())?;
        for (index, individual) in document.population.iter().enumerate() {
            check_chromosome(&genes, individual)
                .map_err(|error| error.at(format!("individual {index}")))?;
        }
        let search = Self::new(genes.iter().copied(), settings, 0)?;
        for (name, individual) in [("leader", &progress.leader), ("best", &progress.best)] {
            if let Some(individual) = individual {
                check_chromosome(&genes, &individual.genes)
                    .and_then(|()| check::finite("fitness", individual.fitness))
                    .map_err(|error| error.at(name.to_owned()))?;
            }
        }
        let told = progress.history.best.len();
        check::same_length("mean fitness of the generations", told, progress.history.mean.len())?;
        let kept = if told > 0 { settings.elite } else { 0 };
        check::same_length("elite_fitness", kept, progress.elite_fitness.len())?;
        if progress.best_since > told as u64 {
            return Err(Error::OutOfRange {
                what: "best_since".to_owned(),
                expected: format!("at most the number of generations, {told}"),
                value: progress.best_since as f64,
            });
        }
        Ok(search.continued(document.population.concat(), progress, document.rng))
    }
}
