//! What a genetic search is made of: kinds of genes, selection, crossover, mutation.

use fuzzy_core::learn::genetic::{Crossover, Gene, Mutation, Selection};
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

use crate::arrays::{pairs, whole};
use crate::errors::{Error, Result};

/// An object that a method of its class returned, by which it is shown and pickled.
trait Made {
    const CLASS: &'static str;

    /// The method and its arguments.
    fn call<'py>(&self, py: Python<'py>) -> PyResult<(&'static str, Bound<'py, PyTuple>)>;

    fn repr(&self, py: Python<'_>) -> PyResult<String> {
        let (method, arguments) = self.call(py)?;
        let arguments = arguments.iter().map(|argument| Ok(argument.repr()?.to_string()));
        let arguments = arguments.collect::<PyResult<Vec<_>>>()?.join(", ");
        Ok(format!("{}.{method}({arguments})", Self::CLASS))
    }

    fn reduce<'py>(&self, class: &Bound<'py, PyType>) -> PyResult<Bound<'py, PyTuple>> {
        let (method, arguments) = self.call(class.py())?;
        (class.getattr(method)?, arguments).into_pyobject(class.py())
    }
}

/// One place of a chromosome: which values it may have.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.Genetic([fz.Gene.real(-1, 1), fz.Gene.integer(1, 9), fz.Gene.bit()])
/// <Genetic: 40 individuals of 3 genes, generation 0>
#[pyclass(name = "Gene", module = "fuzzyrs", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct PyGene(pub Gene);

#[pymethods]
impl PyGene {
    /// A number from `low` to `high`; equal ends hold it at one value.
    #[staticmethod]
    fn real(low: f64, high: f64) -> Result<Self> {
        Self::checked(Gene::Real { low, high })
    }

    /// A whole number from `low` to `high`, both within ±2**53.
    #[staticmethod]
    fn integer(low: i64, high: i64) -> Result<Self> {
        Self::checked(Gene::Integer { low, high })
    }

    /// 0 or 1.
    #[staticmethod]
    fn bit() -> Self {
        Self(Gene::Bit)
    }

    /// The smallest and the largest value.
    #[getter]
    fn range(&self) -> (f64, f64) {
        self.0.range()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        self.repr(py)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        slf.get().reduce(&slf.get_type())
    }
}

impl PyGene {
    fn checked(gene: Gene) -> Result<Self> {
        gene.check("the range of a gene")?;
        Ok(Self(gene))
    }
}

impl Made for PyGene {
    const CLASS: &'static str = "Gene";

    fn call<'py>(&self, py: Python<'py>) -> PyResult<(&'static str, Bound<'py, PyTuple>)> {
        Ok(match self.0 {
            Gene::Real { low, high } => ("real", (low, high).into_pyobject(py)?),
            Gene::Integer { low, high } => ("integer", (low, high).into_pyobject(py)?),
            Gene::Bit => ("bit", PyTuple::empty(py)),
        })
    }
}

/// How parents are chosen.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.Genetic([(-1, 1)] * 3, selection=fz.Selection.tournament(3))
/// <Genetic: 40 individuals of 3 genes, generation 0>
#[pyclass(name = "Selection", module = "fuzzyrs", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct PySelection(pub Selection);

#[pymethods]
impl PySelection {
    /// The first and second of the ranking, the third and fourth, and so on: each pair has two
    /// children. Parents must be of the elite.
    #[staticmethod]
    fn pairs() -> Self {
        Self(Selection::Pairs)
    }

    /// The first and second of the ranking, the second and third, and so on: each two neighbours
    /// have one child. Parents must be of the elite.
    #[staticmethod]
    fn neighbours() -> Self {
        Self(Selection::Neighbours)
    }

    /// Each parent is the best of `size` individuals drawn evenly from the whole population, with
    /// replacement; each two parents have two children.
    #[staticmethod]
    #[pyo3(signature = (size = 2))]
    fn tournament(#[pyo3(from_py_with = whole)] size: usize) -> Result<Self> {
        fuzzy_core::check::at_least("size of a tournament", size, 1)?;
        Ok(Self(Selection::Tournament(size)))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        self.repr(py)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        slf.get().reduce(&slf.get_type())
    }
}

impl Made for PySelection {
    const CLASS: &'static str = "Selection";

    fn call<'py>(&self, py: Python<'py>) -> PyResult<(&'static str, Bound<'py, PyTuple>)> {
        Ok(match self.0 {
            Selection::Pairs => ("pairs", PyTuple::empty(py)),
            Selection::Neighbours => ("neighbours", PyTuple::empty(py)),
            Selection::Tournament(size) => ("tournament", (size,).into_pyobject(py)?),
        })
    }
}

/// How the genes of two parents a and b become those of two children.
///
/// `average`, `blend`, `blx` and `simulated_binary` mix numbers: w·a + (1 - w)·b for one child,
/// (1 - w)·a + w·b for the other. Bits can only be exchanged: `one_point` or `uniform`.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.Crossover.blx(0.5)
/// Crossover.blend(-0.5, 1.5)
#[pyclass(name = "Crossover", module = "fuzzyrs", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct PyCrossover(pub Crossover);

#[pymethods]
impl PyCrossover {
    /// Genes before a cut come from one parent, those after it from the other.
    #[staticmethod]
    fn one_point() -> Self {
        Self(Crossover::OnePoint)
    }

    /// Each gene comes from either parent with probability 1/2.
    #[staticmethod]
    fn uniform() -> Self {
        Self(Crossover::Uniform)
    }

    /// One weight for all genes: `low`, or one drawn evenly from `low` to `high`.
    #[staticmethod]
    #[pyo3(signature = (low = 0.5, high = None))]
    fn average(low: f64, high: Option<f64>) -> Result<Self> {
        Self::checked(Crossover::Average { low, high: high.unwrap_or(low) })
    }

    /// A weight for each gene, drawn evenly from `low` to `high`.
    #[staticmethod]
    fn blend(low: f64, high: f64) -> Result<Self> {
        Self::checked(Crossover::Blend { low, high })
    }

    /// BLX-alpha: each gene evenly from the parents' interval, widened by alpha of its size on
    /// each side; `blend(-alpha, 1 + alpha)`.
    #[staticmethod]
    #[pyo3(signature = (alpha = 0.3))]
    fn blx(alpha: f64) -> Result<Self> {
        Self::checked(Crossover::blx(alpha))
    }

    /// Simulated binary crossover; a larger eta keeps children nearer to their parents.
    #[staticmethod]
    #[pyo3(signature = (eta = 15.0))]
    fn simulated_binary(eta: f64) -> Result<Self> {
        Self::checked(Crossover::SimulatedBinary { eta })
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        self.repr(py)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        slf.get().reduce(&slf.get_type())
    }
}

impl PyCrossover {
    fn checked(crossover: Crossover) -> Result<Self> {
        crossover.check()?;
        Ok(Self(crossover))
    }
}

impl Made for PyCrossover {
    const CLASS: &'static str = "Crossover";

    fn call<'py>(&self, py: Python<'py>) -> PyResult<(&'static str, Bound<'py, PyTuple>)> {
        Ok(match self.0 {
            Crossover::OnePoint => ("one_point", PyTuple::empty(py)),
            Crossover::Uniform => ("uniform", PyTuple::empty(py)),
            Crossover::Average { low, high } => ("average", (low, high).into_pyobject(py)?),
            Crossover::Blend { low, high } => ("blend", (low, high).into_pyobject(py)?),
            Crossover::SimulatedBinary { eta } => ("simulated_binary", (eta,).into_pyobject(py)?),
        })
    }
}

/// What happens to the numbers of a child after the crossover: each gene changes with probability
/// `rate`, and what leaves its range becomes the nearer end.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.Mutation.gaussian(rate=0.05)
/// Mutation.gaussian(0.05, 0.1)
#[pyclass(name = "Mutation", module = "fuzzyrs", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct PyMutation(pub Mutation);

#[pymethods]
impl PyMutation {
    /// Nothing.
    #[staticmethod]
    fn none() -> Self {
        Self(Mutation::None)
    }

    /// A normally distributed step; its standard deviation is `scale` times the gene's range.
    #[staticmethod]
    #[pyo3(signature = (rate = 0.1, scale = 0.1))]
    fn gaussian(rate: f64, scale: f64) -> Result<Self> {
        Self::checked(Mutation::Gaussian { rate, scale })
    }

    /// Deb's polynomial step within the size of the range; a larger eta makes smaller steps.
    #[staticmethod]
    #[pyo3(signature = (rate = 0.1, eta = 20.0))]
    fn polynomial(rate: f64, eta: f64) -> Result<Self> {
        Self::checked(Mutation::Polynomial { rate, eta })
    }

    /// The gene is drawn anew, evenly.
    #[staticmethod]
    #[pyo3(signature = (rate = 0.1))]
    fn redraw(rate: f64) -> Result<Self> {
        Self::checked(Mutation::Redraw { rate })
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        self.repr(py)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        slf.get().reduce(&slf.get_type())
    }
}

impl PyMutation {
    fn checked(mutation: Mutation) -> Result<Self> {
        mutation.check()?;
        Ok(Self(mutation))
    }
}

impl Made for PyMutation {
    const CLASS: &'static str = "Mutation";

    fn call<'py>(&self, py: Python<'py>) -> PyResult<(&'static str, Bound<'py, PyTuple>)> {
        Ok(match self.0 {
            Mutation::None => ("none", PyTuple::empty(py)),
            Mutation::Gaussian { rate, scale } => ("gaussian", (rate, scale).into_pyobject(py)?),
            Mutation::Polynomial { rate, eta } => ("polynomial", (rate, eta).into_pyobject(py)?),
            Mutation::Redraw { rate } => ("redraw", (rate,).into_pyobject(py)?),
        })
    }
}

/// Genes from an (n, 2) array of bounds, or from a list of pairs and `Gene` objects.
pub fn genes(object: &Bound<'_, PyAny>) -> Result<Vec<Gene>> {
    let Ok(items) = object.extract::<Vec<Bound<'_, PyAny>>>() else {
        return Err(Error::WrongType("genes must be a list of pairs or Gene objects".to_owned()));
    };
    if !items.iter().any(|item| item.is_instance_of::<PyGene>()) {
        return Ok(pairs(object, "genes")?.into_iter().map(Gene::from).collect());
    }
    let gene = |(index, item): (usize, &Bound<'_, PyAny>)| {
        if let Ok(gene) = item.cast::<PyGene>() {
            return Ok(gene.get().0);
        }
        let pair: PyResult<[f64; 2]> = item.extract();
        pair.map(|[low, high]| Gene::Real { low, high }).map_err(|_| {
            let came = item.repr().map_or_else(|_| "?".to_owned(), |r| r.to_string());
            Error::WrongType(format!(
                "gene {index} must be a Gene or a pair of numbers, got {came}"
            ))
        })
    };
    items.iter().enumerate().map(gene).collect()
}
