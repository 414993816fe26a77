//! Genetic algorithms.

use fuzzy_core::check;
use fuzzy_core::learn::data::{self, DataSet};
use fuzzy_core::learn::genetic::{Genetic, GeneticSettings};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use crate::arrays::{Floats, array, pairs, whole};
use crate::control::PyControl;
use crate::enter::{Watch, enter};
use crate::errors::Result;
use crate::tsk::PyTsk;

/// A real-coded genetic algorithm that minimises a fitness of your own.
///
/// `ask()` gives the population, `tell(fitness)` takes the fitness of each individual and breeds
/// the next. The best are kept; children of neighbours in the ranking are made by one-point
/// crossover; the rest is drawn evenly within the bounds. A fitness of NaN ranks last.
///
/// Parameters
/// ----------
/// bounds : array_like of shape (genes, 2)
///     The range of each gene.
/// population : int, optional
///     Individuals, at least 4.
/// crossover, mutation : float, optional
///     The shares of a new generation that are children and that are drawn anew.
/// seed : int, optional
///     The same seed gives the same search.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> search = fz.Genetic([(-1, 1), (-1, 1)], seed=3)
/// >>> for _ in range(100):
/// ...     population = search.ask()
/// ...     search.tell((population**2).sum(axis=1))
/// >>> genes, fitness = search.best
/// >>> bool(fitness < 0.01)
/// True
#[pyclass(name = "Genetic", module = "fuzzyrs")]
pub struct PyGenetic(Genetic);

#[pymethods]
impl PyGenetic {
    #[new]
    #[pyo3(signature = (bounds, *, population = 40, crossover = 0.2, mutation = 0.1, seed = 0))]
    fn new(
        bounds: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = whole)] population: usize,
        crossover: f64,
        mutation: f64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let settings = GeneticSettings { population, crossover, mutation };
        Ok(Self(Genetic::new(pairs(bounds, "bounds")?, settings, seed)?))
    }

    /// Replace the first individuals by the rows of an array, before the first `tell`.
    fn start_from(&mut self, vectors: &Bound<'_, PyAny>) -> Result<()> {
        let vectors = Floats::new(vectors, "vectors")?;
        let rows = vectors.rows("vectors", self.0.genes())?;
        Ok(self.0.start_from(rows.chunks_exact(self.0.genes()))?)
    }

    /// The individuals whose fitness is wanted, as an array of shape (population, genes).
    fn ask<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [self.0.ask().len(), self.0.genes()];
        array(py, self.0.population().to_vec(), &shape)
    }

    /// Take the fitness of each individual, smaller is better, and breed the next generation.
    fn tell(&mut self, fitness: &Bound<'_, PyAny>) -> Result<()> {
        let fitness = Floats::new(fitness, "fitness")?;
        Ok(self.0.tell(fitness.vector("fitness")?)?)
    }

    /// The best individual of the generation last told and its fitness; None before that, or if
    /// every fitness was NaN.
    #[getter]
    fn best<'py>(&self, py: Python<'py>) -> Option<(Bound<'py, PyArray1<f64>>, f64)> {
        let best = self.0.best()?;
        Some((PyArray1::from_slice(py, &best.genes), best.fitness))
    }

    /// Generations told so far.
    #[getter]
    fn generation(&self) -> u64 {
        self.0.generation()
    }
}

/// Fit all parameters of a system to samples by a genetic algorithm, entirely in Rust.
///
/// Parameters
/// ----------
/// system : TSK
///     Where the search begins; it takes part in the first generation.
/// X : array_like of shape (n, inputs)
///     The samples' inputs.
/// y : array_like of shape (n,)
///     The wanted outputs.
/// bounds : array_like of shape (parameters, 2), optional
///     The range of each parameter. By default the system's own, with the consequents within the
///     range of `y` widened by its size.
/// population, crossover, mutation, seed : optional
///     As for `Genetic`.
/// generations : int, optional
///     How long to search.
/// control : Control, optional
///     To stop it from another thread.
/// progress : callable, optional
///     Called now and then with the number of generations done.
///
/// Returns
/// -------
/// system : TSK
///     The best one found.
/// history : numpy.ndarray
///     The best mean squared error of each generation.
#[pyfunction]
#[pyo3(signature = (system, X, y, *, bounds = None, population = 80, crossover = 0.4, mutation = 0.1,
                    generations = 200, seed = 0, control = None, progress = None))]
#[allow(non_snake_case, clippy::too_many_arguments)]
pub fn fit_genetic<'py>(
    py: Python<'py>,
    system: &Bound<'py, PyTsk>,
    X: &Bound<'py, PyAny>,
    y: &Bound<'py, PyAny>,
    bounds: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = whole)] population: usize,
    crossover: f64,
    mutation: f64,
    #[pyo3(from_py_with = whole)] generations: u32,
    #[pyo3(from_py_with = whole)] seed: u64,
    control: Option<&Bound<'py, PyControl>>,
    progress: Option<Py<PyAny>>,
) -> Result<(PyTsk, Bound<'py, PyArray1<f64>>)> {
    let system = &system.get().0;
    let (points, targets) = (Floats::new(X, "X")?, Floats::new(y, "y")?);
    let inputs = system.inputs().len();
    let (rows, wanted) = (points.rows("X", inputs)?, targets.vector("y")?);
    check::same_length("numbers in y, one for each row of X", rows.len() / inputs, wanted.len())?;
    let samples = DataSet::new(inputs, rows, wanted)?;
    let bounds = match bounds {
        Some(bounds) => pairs(bounds, "bounds")?,
        None => data::default_bounds(system, targets.as_slice()?),
    };
    let settings = GeneticSettings { population, crossover, mutation };
    let watch = Watch::new(control, progress);
    let fit = enter(py, &watch, |control| {
        data::fit_genetic(system, &samples, bounds, settings, generations, seed, control)
    })?;
    Ok((PyTsk(fit.system), PyArray1::from_vec(py, fit.history)))
}
