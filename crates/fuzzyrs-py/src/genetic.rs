//! Genetic algorithms.

use std::path::PathBuf;

use fuzzy_core::check;
use fuzzy_core::format::{read, write_atomically};
use fuzzy_core::learn::data::DataSet;
use fuzzy_core::learn::genetic::{
    Crossover, Fit, FitSettings, Genetic, GeneticSettings, Individual, Mutation, SearchBounds,
    Selection, Stop, fit_genetic as fit,
};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Floats, array, pairs, whole, whole_or_none};
use crate::control::PyControl;
use crate::enter::{Watch, enter};
use crate::errors::{Error, Result};
use crate::operators::{PyCrossover, PyGene, PyMutation, PySelection, genes};
use crate::systems::PySystem;
use crate::tsk::PyTsk;

/// An individual as Python has it: its genes and its fitness.
type Told<'py> = Option<(Bound<'py, PyArray1<f64>>, f64)>;

/// A genetic algorithm that minimises a fitness of your own, over numbers, whole numbers and bits.
///
/// `ask()` gives the population, `tell(fitness)` takes the fitness of each individual and breeds
/// the next: the elite unchanged, children, mutants and immigrants. `minimise` runs the loop. A
/// fitness that is not finite ranks last and never becomes the best; the best of the whole search
/// is never lost.
///
/// Parameters
/// ----------
/// genes : array_like of shape (genes, 2), or list of (float, float) or Gene
///     The range of each gene, or its kind and range.
/// population : int, optional
///     Individuals, at least 4.
/// elite : int, optional
///     How many of the best are kept unchanged.
/// mutants : int, optional
///     How many are copies of one of the elite with one gene drawn anew.
/// immigrants : int, optional
///     How many are drawn anew. All others are children.
/// selection : Selection, optional
///     Who their parents are. By default the winners of tournaments of two.
/// crossover : Crossover, optional
///     How numbers are crossed. By default BLX-0.3.
/// bit_crossover : Crossover, optional
///     How bits are crossed: one-point, or by default uniform.
/// mutation : Mutation, optional
///     How a child's numbers change. By default Gaussian steps of 0.1 of the range for one in ten.
/// bit_flip : float, optional
///     The probability that a bit of a child flips.
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
/// >>> bool(fitness < 1e-4)
/// True
///
/// Section 3.4 of Desouky's thesis, 48 numbers and 25 bits:
///
/// >>> search = fz.Genetic(
/// ...     [(0, 1)] * 48 + [fz.Gene.bit()] * 25, population=40, elite=20, immigrants=4,
/// ...     selection=fz.Selection.neighbours(), crossover=fz.Crossover.average(0.5),
/// ...     bit_crossover=fz.Crossover.one_point(), mutation=fz.Mutation.none(), bit_flip=0)
#[pyclass(name = "Genetic", module = "fuzzyrs")]
pub struct PyGenetic(Genetic);

#[pymethods]
impl PyGenetic {
    #[new]
    #[pyo3(signature = (
        genes, *, population = 40, elite = 2, mutants = 0, immigrants = 0,
        selection = PySelection(Selection::Tournament(2)),
        crossover = PyCrossover(Crossover::blx(0.3)),
        bit_crossover = PyCrossover(Crossover::Uniform),
        mutation = PyMutation(Mutation::Gaussian { rate: 0.1, scale: 0.1 }),
        bit_flip = 0.02, seed = 0,
    ))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        genes: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = whole)] population: usize,
        #[pyo3(from_py_with = whole)] elite: usize,
        #[pyo3(from_py_with = whole)] mutants: usize,
        #[pyo3(from_py_with = whole)] immigrants: usize,
        selection: PySelection,
        crossover: PyCrossover,
        bit_crossover: PyCrossover,
        mutation: PyMutation,
        bit_flip: f64,
        #[pyo3(from_py_with = whole)] seed: u64,
    ) -> Result<Self> {
        let settings = GeneticSettings {
            population,
            elite,
            mutants,
            immigrants,
            selection: selection.0,
            crossover: crossover.0,
            bit_crossover: bit_crossover.0,
            mutation: mutation.0,
            bit_flip,
        };
        Ok(Self(Genetic::new(self::genes(genes)?, settings, seed)?))
    }

    /// Replace the first individuals by the rows of an array, before the first `tell`.
    fn start_from(&mut self, vectors: &Bound<'_, PyAny>) -> Result<()> {
        let vectors = Floats::new(vectors, "vectors")?;
        let genes = self.0.genes().len();
        let rows = vectors.rows("vectors", genes)?;
        Ok(self.0.start_from(rows.chunks_exact(genes))?)
    }

    /// The individuals whose fitness is wanted, as an array of shape (population, genes); those
    /// kept from the last generation come first.
    fn ask<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [self.0.ask().len(), self.0.genes().len()];
        array(py, self.0.population().to_vec(), &shape)
    }

    /// Take the fitness of each individual, smaller is better, and breed the next generation.
    ///
    /// Parameters
    /// ----------
    /// fitness : array_like of shape (population,)
    ///     What is not finite ranks last.
    /// violation : array_like of shape (population,), optional
    ///     How far each individual violates constraints; zero or less if it is feasible. The
    ///     feasible come first, by fitness, then the others, by violation, and NaN last. Only the
    ///     feasible become the best.
    #[pyo3(signature = (fitness, violation = None))]
    fn tell(
        &mut self,
        fitness: &Bound<'_, PyAny>,
        violation: Option<&Bound<'_, PyAny>>,
    ) -> Result<()> {
        let fitness = Floats::new(fitness, "fitness")?;
        let fitness = fitness.vector("fitness")?;
        let Some(violation) = violation else { return Ok(self.0.tell(fitness)?) };
        let violation = Floats::new(violation, "violation")?;
        Ok(self.0.tell_constrained(fitness, violation.vector("violation")?)?)
    }

    /// Whether the best is at the target or smaller, or has not changed for so many generations.
    #[pyo3(signature = (*, target = None, stagnation = None))]
    fn is_done(
        &self,
        target: Option<f64>,
        #[pyo3(from_py_with = whole_or_none)] stagnation: Option<usize>,
    ) -> Result<bool> {
        let stop = stop(1, target, stagnation);
        stop.check()?;
        Ok(stop.is_early(&self.0))
    }

    /// The best individual of the whole search and its fitness, as far as it was told; None as
    /// long as no fitness of a feasible individual was finite. If fitness is noisy this is the
    /// luckiest; see `leader`.
    #[getter]
    fn best<'py>(&self, py: Python<'py>) -> Told<'py> {
        told(py, self.0.best())
    }

    /// The best individual of the generation last told and its fitness, or None.
    #[getter]
    fn leader<'py>(&self, py: Python<'py>) -> Told<'py> {
        told(py, self.0.leader())
    }

    /// The "best" and the "mean" fitness of each generation, among feasible individuals with a
    /// finite fitness; NaN if there was none.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (dict, history) = (PyDict::new(py), self.0.history());
        dict.set_item("best", PyArray1::from_slice(py, &history.best))?;
        dict.set_item("mean", PyArray1::from_slice(py, &history.mean))?;
        Ok(dict)
    }

    /// Generations told so far.
    #[getter]
    fn generation(&self) -> u64 {
        self.0.generation()
    }

    /// Generations told since the best was found.
    #[getter]
    fn stagnation(&self) -> u64 {
        self.0.stagnation()
    }

    /// The kind and range of each gene.
    #[getter]
    fn genes(&self) -> Vec<PyGene> {
        self.0.genes().iter().copied().map(PyGene).collect()
    }

    /// The whole state of the search as a JSON document, from which it continues with the same
    /// numbers.
    fn to_json(&self) -> Result<String> {
        Ok(self.0.to_json()?)
    }

    /// The search whose state a JSON document holds.
    #[staticmethod]
    fn from_json(text: &str) -> Result<Self> {
        Ok(Self(Genetic::from_json(text)?))
    }

    /// Write the state of the search to a JSON file: the old file stays until the new one is
    /// complete.
    fn save(&self, path: PathBuf) -> Result<()> {
        Ok(write_atomically(&path, &self.0.to_json()?)?)
    }

    /// Read a search from a file that `save` wrote.
    #[staticmethod]
    fn load(path: PathBuf) -> Result<Self> {
        Self::from_json(&read(&path)?)
    }

    fn __repr__(&self) -> String {
        let (individuals, genes) = (self.0.ask().len(), self.0.genes().len());
        let generation = self.0.generation();
        let best = self.0.best().map_or_else(String::new, |b| format!(", best {}", b.fitness));
        format!(
            "<Genetic: {individuals} individuals of {genes} genes, generation {generation}{best}>"
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let text = slf.try_borrow()?.to_json()?;
        (slf.get_type().getattr("from_json")?, (text,)).into_pyobject(slf.py())
    }
}

fn told<'py>(py: Python<'py>, individual: Option<&Individual>) -> Told<'py> {
    let individual = individual?;
    Some((PyArray1::from_slice(py, &individual.genes), individual.fitness))
}

fn stop(generations: u32, target: Option<f64>, stagnation: Option<usize>) -> Stop {
    let stagnation = stagnation.map(|count| u32::try_from(count).unwrap_or(u32::MAX));
    Stop { generations, target, stagnation }
}

/// Fit all parameters of a system to samples by a genetic algorithm, entirely in Rust. It
/// minimises the mean squared error over all outputs.
///
/// Systems whose vertices cross, or that have no answer at some sample, never win.
///
/// Parameters
/// ----------
/// system : TSK or System
///     Where the search begins; it takes part in the first generation.
/// X : array_like of shape (n, inputs)
///     The samples' inputs.
/// y : array_like of shape (n,) or (n, outputs)
///     The wanted outputs.
/// bounds : array_like of shape (parameters, 2), optional
///     The range of each parameter. By default the system's own, with vertices half-way to their
///     neighbours at most, consequents within the range of `y` widened by its size, and rules'
///     weights as they are.
/// generations : int, optional
///     How long to search at most.
/// target : float, optional
///     Stop when the error is this or smaller.
/// stagnation : int, optional
///     Stop when the best has not changed for so many generations.
/// population, elite, mutants, immigrants, selection, crossover, mutation, seed : optional
///     As for `Genetic`.
/// threads : int, optional
///     Threads to use; 0 means one for each core. The result does not depend on it.
/// control : Control, optional
///     To stop it from another thread.
/// progress : callable, optional
///     Called now and then with the number of generations done.
///
/// Returns
/// -------
/// system : TSK or System
///     The best one found.
/// history : numpy.ndarray
///     The best mean squared error of each generation.
#[pyfunction]
#[pyo3(signature = (
    system, X, y, *, bounds = None, generations = 200, target = None, stagnation = None,
    population = 80, elite = 2, mutants = 0, immigrants = 0,
    selection = PySelection(Selection::Tournament(2)),
    crossover = PyCrossover(Crossover::blx(0.3)),
    mutation = PyMutation(Mutation::Gaussian { rate: 0.1, scale: 0.1 }),
    seed = 0, threads = 1, control = None, progress = None,
))]
#[allow(non_snake_case, clippy::too_many_arguments)]
pub fn fit_genetic<'py>(
    py: Python<'py>,
    system: &Bound<'py, PyAny>,
    X: &Bound<'py, PyAny>,
    y: &Bound<'py, PyAny>,
    bounds: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = whole)] generations: u32,
    target: Option<f64>,
    #[pyo3(from_py_with = whole_or_none)] stagnation: Option<usize>,
    #[pyo3(from_py_with = whole)] population: usize,
    #[pyo3(from_py_with = whole)] elite: usize,
    #[pyo3(from_py_with = whole)] mutants: usize,
    #[pyo3(from_py_with = whole)] immigrants: usize,
    selection: PySelection,
    crossover: PyCrossover,
    mutation: PyMutation,
    #[pyo3(from_py_with = whole)] seed: u64,
    #[pyo3(from_py_with = whole)] threads: usize,
    control: Option<&Bound<'py, PyControl>>,
    progress: Option<Py<PyAny>>,
) -> Result<(Bound<'py, PyAny>, Bound<'py, PyArray1<f64>>)> {
    let genetic = GeneticSettings {
        population,
        elite,
        mutants,
        immigrants,
        selection: selection.0,
        crossover: crossover.0,
        mutation: mutation.0,
        ..GeneticSettings::default()
    };
    let stop = stop(generations, target, stagnation);
    let settings = FitSettings { genetic, stop, seed, threads };
    let job = Job { X, y, bounds, settings, watch: Watch::new(control, progress) };
    let (system, history) = if let Ok(tsk) = system.cast::<PyTsk>() {
        let fit = job.run(py, &tsk.get().0)?;
        (Bound::new(py, PyTsk(fit.system))?.into_any(), fit.history)
    } else if let Ok(system) = system.cast::<PySystem>() {
        let fit = job.run(py, &system.get().0)?;
        (Bound::new(py, PySystem(fit.system))?.into_any(), fit.history)
    } else {
        let came = system.get_type().name()?;
        return Err(Error::WrongType(format!("system must be a TSK or a System, got {came}")));
    };
    Ok((system, PyArray1::from_vec(py, history.best)))
}

/// A fit but for the system.
#[allow(non_snake_case)]
struct Job<'a, 'py> {
    X: &'a Bound<'py, PyAny>,
    y: &'a Bound<'py, PyAny>,
    bounds: Option<&'a Bound<'py, PyAny>>,
    settings: FitSettings,
    watch: Watch,
}

impl Job<'_, '_> {
    fn run<S: SearchBounds>(&self, py: Python<'_>, system: &S) -> Result<Fit<S>> {
        let interface = system.interface();
        let (inputs, outputs) = (interface.inputs().len(), interface.outputs().len());
        let (points, targets) = (Floats::new(self.X, "X")?, Floats::new(self.y, "y")?);
        let rows = points.rows("X", inputs)?;
        let wanted = match (outputs, targets.shape()) {
            (1, [_]) => targets.as_slice()?,
            (1, shape) if shape.len() != 2 => targets.vector("y")?,
            _ => targets.rows("y", outputs)?,
        };
        let (expected, came) = (rows.len() / inputs, wanted.len() / outputs);
        check::same_length("numbers in y, one for each row of X", expected, came)?;
        let samples = DataSet::with_outputs(inputs, outputs, rows, wanted)?;
        let bounds = match self.bounds {
            Some(bounds) => pairs(bounds, "bounds")?,
            None => system.search_bounds(&samples),
        };
        let settings = &self.settings;
        enter(py, &self.watch, |control| fit(system, &samples, bounds, settings, control))
    }
}
