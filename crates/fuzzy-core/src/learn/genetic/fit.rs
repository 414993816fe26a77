//! Fitting a system to samples.

use super::{Elite, Genetic, GeneticSettings, History, Stop};
use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::inference::{Answer, Inference};
use crate::learn::data::DataSet;
use crate::math::{Lanes, Real};
use crate::parallel;

/// The mean squared error of a system over samples, as a fitness of chromosomes.
///
/// `decode` writes what the genes say into a parameter vector, which holds the system's own
/// parameters before, so that it may leave some as they are; it returns whether the genes stand
/// for a system at all. Genes that don't, that make parameters which the system does not
/// [accept](Inference::accepts), or with which it has no answer at some sample, have the fitness
/// NaN and never win.
///
/// ```
/// use fuzzy_core::learn::data::DataSet;
/// use fuzzy_core::learn::genetic::{Elite, Genetic, GeneticSettings, SquaredError, Stop};
/// use fuzzy_core::{Control, Error, Shape, Tsk, Variable};
///
/// let x = Variable::evenly("x", (0.0, 1.0), Shape::Gaussian, &["low", "high"])?;
/// let system = Tsk::zero_order("line", vec![x], vec![0.0, 0.0])?;
/// let data = DataSet::new(1, &[0.0, 0.5, 1.0], &[1.0, 2.0, 3.0])?;
/// // Two genes: the middle of the constants and their distance.
/// let decode = |genes: &[f64], parameters: &mut [f64]| {
///     parameters[4] = genes[0] - 0.5 * genes[1];
///     parameters[5] = genes[0] + 0.5 * genes[1];
///     true
/// };
/// let error = SquaredError::new(&system, &data, decode)?;
/// let mut search = Genetic::new([(-5.0, 5.0); 2], GeneticSettings::default(), 1)?;
/// search.run(Stop::after(50), Elite::Remembered, &Control::new(), |population, fitness| {
///     error.evaluate(population, fitness)
/// })?;
/// let best = search.best().ok_or(Error::OutOfOrder("no fitness was a number"))?;
/// assert!((best.genes[0] - 2.0).abs() < 0.01);
/// let fitted = error.system(&best.genes)?;
/// assert!((fitted.evaluate(&[0.5])? - 2.0).abs() < 0.01);
/// # Ok::<(), Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SquaredError<'a, S, D> {
    system: &'a S,
    data: DataSet,
    decode: D,
    threads: usize,
}

impl<'a, S, D> SquaredError<'a, S, D>
where
    S: Inference,
    D: Fn(&[f64], &mut [f64]) -> bool + Sync,
{
    /// The error of this system over these samples, on one thread.
    pub fn new(system: &'a S, data: &DataSet, decode: D) -> Result<Self> {
        Ok(Self { system, data: data.admitted(system)?, decode, threads: 1 })
    }

    /// The same on up to so many threads (0: one for each core); no result depends on it.
    pub fn on_threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// Writes the error of each individual of a matrix, as [`Genetic::run`] wants it.
    pub fn evaluate(&self, population: &[f64], fitness: &mut [f64]) -> Result<()> {
        if fitness.is_empty() {
            return Ok(());
        }
        let genes = check::at_least("genes", population.len() / fitness.len(), 1)?;
        check::same_length("numbers in the population", genes * fitness.len(), population.len())?;
        let blocks = population.chunks(BLOCK * genes).zip(fitness.chunks_mut(BLOCK));
        parallel::map(self.threads, blocks.collect(), |(population, fitness)| {
            self.evaluate_block(population.chunks_exact(genes), fitness);
            Ok(())
        })
        .map(|_: Vec<()>| ())
    }

    /// The system that these genes stand for, or what is wrong with it.
    pub fn system(&self, genes: &[f64]) -> Result<S> {
        let mut parameters = self.system.parameters().to_vec();
        if !(self.decode)(genes, &mut parameters) {
            return Err(Error::Unsuitable {
                what: "the chromosome".to_owned(),
                reason: "it stands for no system; choose one whose fitness is a number".to_owned(),
            });
        }
        self.system.with_parameters(&parameters)
    }

    fn evaluate_block<'b>(
        &self,
        individuals: impl Iterator<Item = &'b [f64]>,
        fitness: &mut [f64],
    ) {
        let (system, zero) = (self.system, Lanes::splat(0.0));
        let mut parameters = system.parameters().to_vec();
        let mut scratch = vec![zero; system.scratch_count()];
        let mut answers = vec![Answer { value: zero, strength: zero }; self.data.outputs()];
        for (genes, fitness) in individuals.zip(fitness) {
            parameters.copy_from_slice(system.parameters());
            *fitness = if (self.decode)(genes, &mut parameters) && system.accepts(&parameters) {
                let prepared = system.prepare(parameters.as_slice());
                self.data.mean_squared_error(system, &prepared, &mut scratch, &mut answers)
            } else {
                f64::NAN
            };
        }
    }
}

/// Individuals that a thread takes at a time.
const BLOCK: usize = 16;

/// How [`fit_genetic`] searches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitSettings {
    /// How the search breeds.
    pub genetic: GeneticSettings,
    /// When it stops.
    pub stop: Stop,
    /// What it draws its numbers from.
    pub seed: u64,
    /// On how many threads it evaluates (0: one for each core); no result depends on it.
    pub threads: usize,
}

/// The result of [`fit_genetic`].
#[derive(Debug, Clone)]
pub struct Fit<S> {
    /// The best system found.
    pub system: S,
    /// The mean squared error of the best and on average, for each generation.
    pub history: History,
}

/// Fits the parameters of a system to samples by a genetic algorithm that minimises the mean
/// squared error (2.19) over all outputs.
///
/// `bounds` has a range for each parameter, such as [`SearchBounds`](super::SearchBounds) gives;
/// equal ends hold a parameter. The system's own vector takes part in the first generation if it
/// lies within.
///
/// Individuals of invalid parameters, or that give no number at some sample, never win; if there
/// is no other, the error says why the system itself has none.
pub fn fit_genetic<S: Inference>(
    system: &S,
    data: &DataSet,
    bounds: Vec<(f64, f64)>,
    settings: &FitSettings,
    control: &Control,
) -> Result<Fit<S>> {
    check::same_length("bounds", system.parameters().len(), bounds.len())?;
    let copy = |genes: &[f64], parameters: &mut [f64]| {
        parameters.copy_from_slice(genes);
        true
    };
    let error = SquaredError::new(system, data, copy)?.on_threads(settings.threads);
    let mut search = Genetic::new(bounds, settings.genetic, settings.seed)?;
    let mut places = search.genes().iter().zip(system.parameters());
    if places.all(|(gene, &value)| gene.holds(value)) {
        search.start_from([system.parameters()])?;
    }
    search.run(settings.stop, Elite::Remembered, control, |population, fitness| {
        error.evaluate(population, fitness)
    })?;
    match search.best() {
        Some(best) => {
            Ok(Fit { system: error.system(&best.genes)?, history: search.history().clone() })
        }
        None => {
            let mut outputs = vec![f64::NAN; data.outputs()];
            for sample in 0..data.len() {
                system.evaluate_into(&data.point(sample), &mut outputs)?;
            }
            Err(Error::OutOfRange {
                what: "number of valid individuals; the best fitness found".to_owned(),
                expected: "a number (widen the bounds, or keep vertices in order)".to_owned(),
                value: f64::NAN,
            })
        }
    }
}
