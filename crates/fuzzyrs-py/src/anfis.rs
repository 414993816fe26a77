//! ANFIS, on all samples and on one after the other, and recursive least squares.

use fuzzy_core::inference::{Adaptive, Inference};
use fuzzy_core::learn::anfis::{
    AnfisSettings, History, LeastSquares, Online, PremiseStep, SampleOrder, Solver, Stop, fit,
};
use fuzzy_core::learn::data::DataSet;
use fuzzy_core::learn::recursive::RecursiveLeastSquares;
use fuzzy_core::{Error as CoreError, System, Tsk, check};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Floats, Shape, array, whole, whole_or_none};
use crate::control::PyControl;
use crate::enter::{Watch, enter};
use crate::errors::{Error, Result};
use crate::pickle::rebuild;
use crate::systems::PySystem;
use crate::tsk::PyTsk;

/// What `fit_anfis` found.
#[pyclass(name = "AnfisFit", module = "fuzzyrs", frozen)]
pub struct PyAnfisFit {
    system: Py<PyAny>,
    history: History,
    best_epoch: usize,
    stopped: Stop,
}

#[pymethods]
impl PyAnfisFit {
    /// The system of the best epoch.
    #[getter]
    fn system<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        self.system.bind(py).clone()
    }

    /// How the training went, a number for each epoch: the root mean squared errors `"training"`
    /// and, if there are validation samples, `"validation"`, both after the consequents were
    /// fitted, and `"rate"`, the rate or length of the step that followed.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let history = PyDict::new(py);
        let History { training, validation, step } = &self.history;
        history.set_item("training", PyArray1::from_slice(py, training))?;
        if !validation.is_empty() {
            history.set_item("validation", PyArray1::from_slice(py, validation))?;
        }
        history.set_item("rate", PyArray1::from_slice(py, step))?;
        Ok(history)
    }

    /// The number of the best epoch, from 0.
    #[getter]
    fn best_epoch(&self) -> usize {
        self.best_epoch
    }

    /// Why the training ended: `"epochs"` (all are done), `"patience"`, `"fixed"` (the premises
    /// don't move, so one epoch is all), `"cancelled"` or `"diverged"`.
    #[getter]
    fn stopped(&self) -> &'static str {
        self.stopped.name()
    }

    /// Where a training diverged, what was wrong there; else None.
    #[getter]
    fn reason(&self) -> Option<String> {
        match &self.stopped {
            Stop::Diverged(error) => Some(error.to_string()),
            _ => None,
        }
    }

    fn __repr__(&self) -> String {
        let epochs = self.history.training.len();
        let judged = match self.history.validation.as_slice() {
            [] => self.history.training.get(self.best_epoch),
            validation => validation.get(self.best_epoch),
        };
        let error = judged.copied().unwrap_or(f64::NAN);
        format!(
            "<AnfisFit: error {error:.6} in epoch {} of {epochs}, stopped by \"{}\">",
            self.best_epoch,
            self.stopped()
        )
    }
}

/// Fit a system to samples by ANFIS, entirely in Rust: consequents by least squares, membership
/// functions by their gradient (Jang 1993).
///
/// Each epoch fits the consequents, takes the errors, and moves the parameters of the inputs'
/// membership functions, which stay valid: widths positive, vertices in order. The system of the
/// epoch with the least error is returned, of the validation samples if there are some.
///
/// Parameters
/// ----------
/// system : TSK or System
///     Where the training begins. The outputs of a System must all be Sugeno's.
/// X : array_like of shape (n, inputs)
///     The samples' inputs.
/// y : array_like of shape (n,) or (n, outputs)
///     The wanted outputs.
/// epochs : int, optional
///     The most epochs.
/// solver : {"cholesky", "orthogonal"} or None, optional
///     How least squares are solved: by the normal equations, or by reflections, which are slower
///     and exact to more digits. Where columns depend on each other, or samples are fewer than
///     unknowns, both give the solution of least norm. None keeps the consequents.
/// ridge : float, optional
///     Added to the diagonal of the normal matrix: keeps consequents small that the samples say
///     little about.
/// premise : {"normalised", "batch", "sequential", "shuffled", "fixed"}, optional
///     How membership functions move. "normalised": a step of length `rate` against the gradient
///     over all samples, as MATLAB's `anfis` has it; the length grows by `increase` after four
///     falls of the error, and shrinks by `decrease` after it rose and fell twice in turn. "batch":
///     `rate` times the mean gradient. "sequential" and "shuffled": `rate` times the gradient after
///     each sample, in the order of the rows or in an order drawn anew for each epoch. "fixed":
///     not at all.
/// rate, increase, decrease : float, optional
///     See `premise`.
/// validation : tuple of two array_like, optional
///     Samples (X, y) that decide which epoch is the best.
/// patience : int, optional
///     End after so many epochs without a new best error.
/// seed : int, optional
///     Of the order "shuffled".
/// control : Control, optional
///     To stop it from another thread; after its first epoch the best is returned.
/// progress : callable, optional
///     Called now and then with the number of epochs done.
///
/// Returns
/// -------
/// AnfisFit
///     With the `system` and the `history`.
///
/// Raises
/// ------
/// NoRuleFiresError
///     At a sample no rule fires, and the system has no value for that.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz, numpy as np
/// >>> x = np.linspace(0, 10, 101)
/// >>> y = np.sin(2 * x) / np.exp(x / 5)
/// >>> bells = {f"b{c}": fz.bell(c, 1.25, 2) for c in (0, 2.5, 5, 7.5, 10)}
/// >>> names = dict(zip("abcde", bells.values()))
/// >>> start = fz.TSK([fz.Variable("x", (0, 10), names)], np.zeros((5, 2)), order=1)
/// >>> fit = fz.fit_anfis(start, x[:, None], y, epochs=20)
/// >>> [f"{error:.6f}" for error in fit.history["training"][:3]]
/// ['0.069409', '0.068026', '0.066663']
/// >>> fit.best_epoch
/// 19
#[pyfunction]
#[pyo3(signature = (system, X, y, *, epochs = 100, solver = Some("cholesky"), ridge = 0.0,
                    premise = "normalised", rate = 0.01, increase = 1.1, decrease = 0.9,
                    validation = None, patience = None, seed = 0, control = None, progress = None))]
#[allow(non_snake_case, clippy::too_many_arguments)]
pub fn fit_anfis<'py>(
    py: Python<'py>,
    system: &Bound<'py, PyAny>,
    X: &Bound<'py, PyAny>,
    y: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = whole)] epochs: u32,
    solver: Option<&str>,
    ridge: f64,
    premise: &str,
    rate: f64,
    increase: f64,
    decrease: f64,
    validation: Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>,
    #[pyo3(from_py_with = whole_or_none)] patience: Option<usize>,
    #[pyo3(from_py_with = whole)] seed: u64,
    control: Option<&Bound<'py, PyControl>>,
    progress: Option<Py<PyAny>>,
) -> Result<PyAnfisFit> {
    let consequents = match solver {
        Some(name) => Some(LeastSquares { ridge, solver: Solver::from_name(name)? }),
        None => None,
    };
    let premise = premise_step(premise, rate, increase, decrease)?;
    let patience = patience.map(|patience| u32::try_from(patience).unwrap_or(u32::MAX));
    let settings = AnfisSettings { epochs, consequents, premise, patience, seed };
    let watch = Watch::new(control, progress);
    let known = Known::new(system)?;
    let data = known.samples(X, y)?;
    let validation = validation.map(|(X, y)| known.samples(&X, &y)).transpose()?;
    match known {
        Known::Grid(system) => {
            run(py, &*system, &data, validation.as_ref(), &settings, &watch, PyTsk)
        }
        Known::Rules(system) => {
            run(py, &*system, &data, validation.as_ref(), &settings, &watch, PySystem)
        }
    }
}

fn premise_step(name: &str, rate: f64, increase: f64, decrease: f64) -> Result<PremiseStep> {
    Ok(match name {
        "normalised" => PremiseStep::Normalised { step: rate, increase, decrease },
        "batch" => PremiseStep::Batch { rate },
        "sequential" => PremiseStep::Sequential { rate, order: SampleOrder::AsGiven },
        "shuffled" => PremiseStep::Sequential { rate, order: SampleOrder::Shuffled },
        "fixed" => PremiseStep::Fixed,
        _ => {
            let known = ["normalised", "batch", "sequential", "shuffled", "fixed"];
            return Err(CoreError::unknown_name("premise step", name, known).into());
        }
    })
}

/// A system that ANFIS takes.
enum Known {
    Grid(Box<Tsk>),
    Rules(Box<System>),
}

impl Known {
    fn new(system: &Bound<'_, PyAny>) -> Result<Self> {
        if let Ok(grid) = system.cast::<PyTsk>() {
            return Ok(Self::Grid(Box::new(grid.get().0.clone())));
        }
        let Ok(rules) = system.cast::<PySystem>() else {
            let came = system.get_type().name()?;
            return Err(Error::WrongType(format!("system must be a TSK or a System, got {came}")));
        };
        Ok(Self::Rules(Box::new(rules.get().0.clone())))
    }

    /// The number of inputs and of outputs.
    fn sizes(&self) -> (usize, usize) {
        let interface = match self {
            Self::Grid(system) => system.interface(),
            Self::Rules(system) => system.interface(),
        };
        (interface.inputs().len(), interface.outputs().len())
    }

    fn samples(&self, points: &Bound<'_, PyAny>, targets: &Bound<'_, PyAny>) -> Result<DataSet> {
        let (inputs, outputs) = self.sizes();
        let (points, targets) = (Floats::new(points, "X")?, Floats::new(targets, "y")?);
        let rows = points.rows("X", inputs)?;
        let wanted = rows_of_targets(&targets, outputs)?;
        let (count, given) = (rows.len() / inputs, wanted.len() / outputs);
        check::same_length("rows of y, one for each row of X", count, given)?;
        Ok(DataSet::with_outputs(inputs, outputs, rows, wanted)?)
    }
}

/// The numbers of an (n, outputs) array, or of an (n,) array for a single output.
fn rows_of_targets<'a>(targets: &'a Floats<'_>, outputs: usize) -> Result<&'a [f64]> {
    match *targets.shape() {
        [_] if outputs == 1 => targets.as_slice(),
        [_, width] if width == outputs => targets.as_slice(),
        ref shape => {
            let expected = match outputs {
                1 => "an array of shape (n,)".to_owned(),
                _ => format!("an array of shape (n, {outputs})"),
            };
            Err(CoreError::wrong_shape("y", expected, Shape(shape)).into())
        }
    }
}

fn run<S, P>(
    py: Python<'_>,
    system: &S,
    data: &DataSet,
    validation: Option<&DataSet>,
    settings: &AnfisSettings,
    watch: &Watch,
    wrap: impl Fn(S) -> P,
) -> Result<PyAnfisFit>
where
    S: Adaptive,
    P: pyo3::PyClass + Into<PyClassInitializer<P>>,
{
    let trained = enter(py, watch, |control| fit(system, data, validation, settings, control))?;
    Ok(PyAnfisFit {
        system: Py::new(py, wrap(trained.system))?.into_any(),
        history: trained.history,
        best_epoch: trained.best_epoch,
        stopped: trained.stopped,
    })
}

/// A system whose consequents follow a stream of samples by recursive least squares; its
/// membership functions stay as they are.
///
/// Parameters
/// ----------
/// system : TSK or System
///     Where the learning begins. The outputs of a System must all be Sugeno's.
/// forgetting : float, optional
///     The weight of a sample falls by this factor with each that follows; 1 forgets nothing.
/// covariance : float or list of array_like, optional
///     How uncertain the consequents are at first: large to trust the samples. Matrices, one for
///     each output, go on where another learner was.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> x = fz.Variable.evenly("x", (0, 1), ["low", "high"])
/// >>> online = fz.OnlineAnfis(fz.TSK([x], [0, 0]))
/// >>> for step in range(40):
/// ...     online.learn([step / 40], 3 * step / 40)
/// >>> round(online.system(0.5), 1)
/// 1.5
#[pyclass(name = "OnlineAnfis", module = "fuzzyrs")]
pub struct PyOnlineAnfis {
    learner: Learner,
    forgetting: f64,
}

enum Learner {
    Grid(Box<Online<Tsk>>),
    Rules(Box<Online<System>>),
}

/// Does the same with either learner.
macro_rules! either {
    ($learner:expr, $online:ident => $work:expr) => {
        match $learner {
            Learner::Grid($online) => $work,
            Learner::Rules($online) => $work,
        }
    };
}

#[pymethods]
impl PyOnlineAnfis {
    #[new]
    #[pyo3(signature = (system, *, forgetting = 1.0, covariance = None))]
    fn new(
        system: &Bound<'_, PyAny>,
        forgetting: f64,
        covariance: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let covariance = Covariance::new(covariance)?;
        let scale = covariance.scale();
        let learner = match Known::new(system)? {
            Known::Grid(system) => {
                Learner::Grid(Box::new(Online::new(&*system, forgetting, scale)?))
            }
            Known::Rules(system) => {
                Learner::Rules(Box::new(Online::new(&*system, forgetting, scale)?))
            }
        };
        let learner = match (covariance, learner) {
            (Covariance::Scale(_), learner) => learner,
            (Covariance::Matrices(each), Learner::Grid(online)) => {
                Learner::Grid(Box::new(online.with_covariances(&each)?))
            }
            (Covariance::Matrices(each), Learner::Rules(online)) => {
                Learner::Rules(Box::new(online.with_covariances(&each)?))
            }
        };
        Ok(Self { learner, forgetting })
    }

    /// Take samples in their order: one point and its target, or rows of them.
    ///
    /// Parameters
    /// ----------
    /// x : array_like of shape (inputs,) or (n, inputs)
    ///     The inputs.
    /// y : array_like
    ///     The wanted outputs: a number or shape (outputs,) for a point, (n,) or (n, outputs) for
    ///     rows.
    fn learn(&mut self, x: &Bound<'_, PyAny>, y: &Bound<'_, PyAny>) -> Result<()> {
        let (x, y) = (Floats::new(x, "x")?, Floats::new(y, "y")?);
        let (inputs, outputs) = either!(&self.learner, online => {
            (online.interface().inputs().len(), online.interface().outputs().len())
        });
        let (points, wanted) = match x.shape() {
            [_] => (x.as_slice()?, y.as_slice()?),
            _ => (x.rows("x", inputs)?, rows_of_targets(&y, outputs)?),
        };
        check::same_length("numbers in x", points.len() / inputs * inputs, points.len())?;
        check::same_length("numbers in y", points.len() / inputs * outputs, wanted.len())?;
        for (point, wanted) in points.chunks_exact(inputs).zip(wanted.chunks_exact(outputs)) {
            either!(&mut self.learner, online => online.learn(point, wanted))?;
        }
        Ok(())
    }

    /// The system with what was learned so far.
    #[getter]
    fn system<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(match &self.learner {
            Learner::Grid(online) => Bound::new(py, PyTsk(online.system()?))?.into_any(),
            Learner::Rules(online) => Bound::new(py, PySystem(online.system()?))?.into_any(),
        })
    }

    /// The covariance matrix of each output's consequents.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> Result<Vec<Bound<'py, PyArrayDyn<f64>>>> {
        let filters = either!(&self.learner, online => online.filters());
        filters.iter().map(|filter| square(py, filter)).collect()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> Result<Bound<'py, PyTuple>> {
        let (py, own) = (slf.py(), slf.borrow());
        let keywords = PyDict::new(py);
        keywords.set_item("forgetting", own.forgetting)?;
        keywords.set_item("covariance", own.covariance(py)?)?;
        let arguments = PyTuple::new(py, [own.system(py)?])?;
        Ok(rebuild(&slf.get_type(), arguments, &keywords)?)
    }
}

/// The covariance that a learner begins with.
enum Covariance {
    Scale(f64),
    Matrices(Vec<Vec<f64>>),
}

impl Covariance {
    /// Large, for consequents of which nothing is known.
    const USUAL: f64 = 1e6;

    fn new(given: Option<&Bound<'_, PyAny>>) -> Result<Self> {
        let Some(given) = given else { return Ok(Self::Scale(Self::USUAL)) };
        if let Ok(scale) = given.extract() {
            return Ok(Self::Scale(scale));
        }
        let matrices = given
            .try_iter()?
            .map(|matrix| Ok(Floats::new(&matrix?, "covariance")?.as_slice()?.to_vec()));
        Ok(Self::Matrices(matrices.collect::<Result<_>>()?))
    }

    fn scale(&self) -> f64 {
        if let Self::Scale(scale) = self { *scale } else { Self::USUAL }
    }
}

fn square<'py>(
    py: Python<'py>,
    filter: &RecursiveLeastSquares,
) -> Result<Bound<'py, PyArrayDyn<f64>>> {
    array(py, filter.covariance().to_vec(), &[filter.unknowns(), filter.unknowns()])
}

/// The running least-squares solution of f ≈ θ·a for rows a that come one after the other.
///
/// Parameters
/// ----------
/// unknowns : int
///     The numbers of a row.
/// targets : int, optional
///     The targets of a row.
/// forgetting : float, optional
///     λ, above 0 and up to 1: the weight of a row falls by this factor with each that follows.
/// covariance : float or array_like of shape (unknowns, unknowns), optional
///     P at first; a number stands for that multiple of the unit matrix.
/// solution : array_like of shape (targets, unknowns), optional
///     θ at first; zeros by default.
///
/// Notes
/// -----
/// With the gain k = Pa/(λ + aᵀPa): θ ← θ + k(f − aᵀθ), P ← (P − k aᵀP)/λ.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> line = fz.RecursiveLeastSquares(2)
/// >>> for x in range(4):
/// ...     line.update([x, 1], 2 * x + 1)
/// >>> line.solution.round(3)
/// array([[2., 1.]])
#[pyclass(name = "RecursiveLeastSquares", module = "fuzzyrs")]
pub struct PyRecursiveLeastSquares(RecursiveLeastSquares);

#[pymethods]
impl PyRecursiveLeastSquares {
    #[new]
    #[pyo3(signature = (unknowns, targets = None, *, forgetting = 1.0, covariance = None,
                        solution = None))]
    fn new(
        #[pyo3(from_py_with = whole)] unknowns: usize,
        #[pyo3(from_py_with = whole_or_none)] targets: Option<usize>,
        forgetting: f64,
        covariance: Option<&Bound<'_, PyAny>>,
        solution: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let scale = covariance.and_then(|given| given.extract().ok());
        let start = scale.unwrap_or(Covariance::USUAL);
        let mut own =
            RecursiveLeastSquares::new(unknowns, targets.unwrap_or(1), forgetting, start)?;
        if let (Some(matrix), None) = (covariance, scale) {
            own = own.with_covariance(
                Floats::new(matrix, "covariance")?.rows("covariance", unknowns)?,
            )?;
        }
        if let Some(solution) = solution {
            own =
                own.starting_from(Floats::new(solution, "solution")?.rows("solution", unknowns)?)?;
        }
        Ok(Self(own))
    }

    /// Take a row and its target, a number or one for each.
    fn update(&mut self, row: &Bound<'_, PyAny>, target: &Bound<'_, PyAny>) -> Result<()> {
        let (row, target) = (Floats::new(row, "row")?, Floats::new(target, "target")?);
        Ok(self.0.update(row.vector("row")?, target.as_slice()?)?)
    }

    /// What the solution so far gives for a row, one number for each target.
    fn predict<'py>(&self, row: &Bound<'py, PyAny>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        let numbers = self.0.predict(Floats::new(row, "row")?.vector("row")?)?;
        array(row.py(), numbers, &[self.0.targets()])
    }

    /// θ, of shape (targets, unknowns).
    #[getter]
    fn solution<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        array(py, self.0.solution().to_vec(), &[self.0.targets(), self.0.unknowns()])
    }

    /// P, of shape (unknowns, unknowns).
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        square(py, &self.0)
    }

    /// λ.
    #[getter]
    fn forgetting(&self) -> f64 {
        self.0.forgetting()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> Result<Bound<'py, PyTuple>> {
        let (py, own) = (slf.py(), slf.borrow());
        let keywords = PyDict::new(py);
        keywords.set_item("forgetting", own.0.forgetting())?;
        keywords.set_item("covariance", own.covariance(py)?)?;
        keywords.set_item("solution", own.solution(py)?)?;
        let arguments = PyTuple::new(py, [own.0.unknowns(), own.0.targets()])?;
        Ok(rebuild(&slf.get_type(), arguments, &keywords)?)
    }
}
