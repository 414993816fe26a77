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
        self.evaluate_below(population, f64::INFINITY, fitness)
    }

    /// The same as [`Genetic::run_below`] wants it: errors that are not below the bar may be +∞.
    pub fn evaluate_below(&self, population: &[f64], bar: f64, fitness: &mut [f64]) -> Result<()> {
        if fitness.is_empty() {
            return Ok(());
        }
        let genes = check::at_least("genes", population.len() / fitness.len(), 1)?;
        check::same_length("numbers in the population", genes * fitness.len(), population.len())?;
        let blocks = population.chunks(BLOCK * genes).zip(fitness.chunks_mut(BLOCK));
        parallel::map(self.threads, blocks.collect(), |(population, fitness)| {
            self.evaluate_block(population.chunks_exact(genes), bar, fitness);
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
        bar: f64,
        fitness: &mut [f64],
    ) {
        let (system, data, zero) = (self.system, &self.data, Lanes::splat(0.0));
        let mut parameters = system.parameters().to_vec();
        let mut scratch = vec![zero; system.scratch_count()];
        let mut answers = vec![Answer { value: zero, strength: zero }; self.data.outputs()];
        for (genes, fitness) in individuals.zip(fitness) {
            parameters.copy_from_slice(system.parameters());
            *fitness = if (self.decode)(genes, &mut parameters) && system.accepts(&parameters) {
                let prepared = system.prepare(parameters.as_slice());
                let (scratch, answers) = (&mut scratch, &mut answers);
                data.mean_squared_error_below(bar, system, &prepared, scratch, answers)
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

#[cfg(test)]
mod tests {
    use super::super::SearchBounds;
    use super::*;
    use crate::output::Value;
    use crate::{
        Logic, MembershipFunction, NoRuleFires, Output, Rng, Shape, System, Tsk, Variable,
    };

    fn plane() -> (Vec<f64>, Vec<f64>) {
        let mut rng = Rng::new(2, 0);
        let points: Vec<f64> = (0..200).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        let targets = points.chunks(2).map(|p| p[0] - 0.5 * p[1]).collect();
        (points, targets)
    }

    fn settings(generations: u32, threads: usize) -> FitSettings {
        let genetic = GeneticSettings { population: 60, ..GeneticSettings::default() };
        FitSettings { genetic, stop: Stop::after(generations), seed: 3, threads }
    }

    #[test]
    fn a_plane_is_fitted_on_any_number_of_threads() {
        let (points, targets) = plane();
        let data = DataSet::new(2, &points, &targets).unwrap();
        let terms = ["N", "Z", "P"];
        for shape in [Shape::Triangular, Shape::Gaussian] {
            let inputs = ["x", "y"].map(|name| Variable::evenly(name, (-1.0, 1.0), shape, &terms));
            let inputs = inputs.into_iter().collect::<Result<Vec<_>>>().unwrap();
            let system = Tsk::zero_order("fitted", inputs, vec![0.0; 9]).unwrap();
            let fits = [1, 2, 5].map(|threads| {
                let bounds = system.search_bounds(&data);
                fit_genetic(&system, &data, bounds, &settings(150, threads), &Control::new())
                    .unwrap()
            });
            assert!(fits[0].history.best[149] < 0.05 * fits[0].history.best[0]);
            assert!(fits[0].history.best.is_sorted_by(|a, b| a >= b));
            assert!(fits.iter().all(|fit| fit.system == fits[0].system));
        }
    }

    #[test]
    fn a_system_of_several_outputs_is_fitted_from_bounds_that_keep_vertices_in_order() {
        let x = Variable::evenly("x", (-1.0, 1.0), Shape::Triangular, &["N", "Z", "P"]).unwrap();
        let u = Variable::evenly("u", (-2.0, 2.0), Shape::Trapezoidal, &["N", "Z", "P"]).unwrap();
        let constants = ["low", "high"].map(|term| (term.to_owned(), Value::Constant(0.0)));
        let sugeno = Output::sugeno("v", constants.to_vec()).unwrap();
        let rules = "if x is N then u is N and v is low\n\
                     if x is Z then u is Z\n\
                     if x is P then u is P and v is high with 0.5";
        let outputs = vec![Output::mamdani(u).unwrap(), sugeno];
        let system = System::from_text("both", vec![x], outputs, rules, Logic::default()).unwrap();
        let points: Vec<f64> = (-10..=10).map(|i| f64::from(i) / 10.0).collect();
        let targets: Vec<f64> = points.iter().flat_map(|x| [1.5 * x * x.abs(), 3.0 - x]).collect();
        let data = DataSet::with_outputs(1, 2, &points, &targets).unwrap();
        let bounds = system.search_bounds(&data);
        let inside = |(&value, &(low, high)): (&f64, &(f64, f64))| (low..=high).contains(&value);
        assert!(system.parameters().iter().zip(&bounds).all(inside));
        let weights = bounds.len() - 3;
        assert_eq!(bounds[weights..], [(1.0, 1.0), (1.0, 1.0), (0.5, 0.5)]);
        let mut rng = Rng::new(1, 0);
        for _ in 0..200 {
            let vector: Vec<f64> = bounds.iter().map(|b| rng.uniform_in(b.0, b.1)).collect();
            assert!(system.accepts(&vector), "{vector:?}");
        }
        let fit = fit_genetic(&system, &data, bounds, &settings(60, 1), &Control::new()).unwrap();
        let squares = (0..21).map(|row| {
            let mut outputs = [f64::NAN; 2];
            fit.system.evaluate_into(&points[row..=row], &mut outputs).unwrap();
            (0..2).map(|k| (outputs[k] - targets[2 * row + k]).powi(2)).sum::<f64>()
        });
        let error = squares.sum::<f64>() / 42.0;
        assert!((error - fit.history.best[59]).abs() < 1e-12);
        assert!(error < 0.2 * fit.history.best[0], "{error}");
    }

    #[test]
    fn genes_that_stand_for_no_system_never_win() {
        let x = Variable::new("x", 0.0, 1.0)
            .unwrap()
            .with_term("all", MembershipFunction::triangular(-1.0, 0.5, 2.0).unwrap())
            .unwrap();
        let system = Tsk::zero_order("one", vec![x], vec![0.0]).unwrap();
        let data = DataSet::new(1, &[0.0, 1.0], &[1.0, 1.0]).unwrap();
        let decode = |genes: &[f64], parameters: &mut [f64]| {
            // The first gene moves a vertex that may cross the next, the second is refused below 0.
            parameters[0] = genes[0];
            parameters[3] = genes[1];
            genes[1] >= 0.0
        };
        let error = SquaredError::new(&system, &data, decode).unwrap();
        let mut fitness = [0.0; 4];
        error.evaluate(&[-1.0, 1.0, 0.9, 1.0, -1.0, -0.1, 0.2, 1.0], &mut fitness).unwrap();
        assert_eq!(fitness[0], 0.0);
        // Crossed vertices; refused; no rule fires at 0.
        assert!(fitness[1..].iter().all(|fitness| fitness.is_nan()));
        assert!(
            error.system(&[0.0, -1.0]).unwrap_err().to_string().contains("stands for no system")
        );
        assert!(error.evaluate(&[0.0; 3], &mut [0.0; 2]).is_err());
        assert!(error.evaluate(&[], &mut [0.0]).is_err());
        assert!(error.evaluate(&[], &mut []).is_ok());

        let gap = system.clone().with_parameters(&[0.2, 0.5, 2.0, 0.0]).unwrap();
        let bounds: Vec<(f64, f64)> = gap.parameters().iter().map(|&p| (p, p)).collect();
        let fit = |gap: &Tsk| {
            fit_genetic(gap, &data, bounds.clone(), &settings(2, 1), &Control::new()).map(drop)
        };
        assert!(fit(&gap).unwrap_err().to_string().starts_with("no rule of \"one\" fires"));
        let gap = gap.when_no_rule_fires(NoRuleFires::Nan).unwrap();
        assert!(fit(&gap).unwrap_err().to_string().contains("number of valid individuals"));
    }
}
