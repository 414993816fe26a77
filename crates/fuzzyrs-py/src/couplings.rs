//! Who goes for whom: assignment, and what learns it.

use fuzzy_core::learn::assignment::{Objective, assign as best_assignment};
use fuzzy_core::learn::coupling::couplings as all_couplings;
use numpy::{PyArray1, PyArray2, PyArrayDyn, PyArrayMethods};
use pursuit_sim::Prospect;
use pursuit_sim::training::{CoupledGame, CouplingTask, CouplingTechnique, LearnedCoupling};
use pyo3::prelude::*;

use crate::arrays::{Floats, Shape, array, whole};
use crate::control::PyControl;
use crate::enter::{Watch, enter};
use crate::errors::{Error, Result};
use crate::many::{PyManyOnMany, start};
use crate::settings::{PyCouplingTraining, PyPairwiseTraining};

/// What was learned about couplings.
#[pyclass(name = "LearnedCoupling", module = "fuzzyrs", frozen)]
pub struct PyLearnedCoupling {
    learned: LearnedCoupling,
    /// Whether the values are those of pairs, not of couplings.
    pairwise: bool,
    /// The pursuers of the coupling that are not faster than their evaders.
    hopeless: Vec<usize>,
}

#[pymethods]
impl PyLearnedCoupling {
    /// The evader of each pursuer in the best coupling.
    #[getter]
    fn coupling(&self) -> Vec<usize> {
        self.learned.coupling.clone()
    }

    /// The pursuers of that coupling that are not faster than their evaders, and can't be sure to
    /// catch them however they steer. Empty if none is.
    #[getter]
    fn hopeless(&self) -> Vec<usize> {
        self.hopeless.clone()
    }

    /// What was learned: of a CouplingTraining the value of every coupling in the order of
    /// `couplings`, shape (n!,); of a PairwiseTraining the estimated capture time of every pair in
    /// seconds, shape (n, n). Those that were never tried still have their first value.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<f64>>> {
        array(py, self.learned.values.clone(), &self.shape())
    }

    /// How often each of these was tried, in the same shape.
    #[getter]
    fn visits<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArrayDyn<u64>>> {
        Ok(PyArray1::from_slice(py, &self.learned.visits).reshape(self.shape())?)
    }

    /// The coupling of each episode, shape (episodes, n).
    #[getter]
    fn couplings<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArray2<usize>>> {
        let numbers = self.learned.games.iter().flat_map(|game| game.coupling.iter().copied());
        let shape = [self.learned.games.len(), self.learned.coupling.len()];
        Ok(PyArray1::from_iter(py, numbers).reshape(shape)?)
    }

    /// How long the game of each episode took in seconds, shape (episodes,): until the last
    /// capture, or until time was up.
    #[getter]
    fn durations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |game| game.duration)
    }

    /// How many evaders were caught in each episode, shape (episodes,).
    #[getter]
    fn captured<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<usize>> {
        PyArray1::from_iter(py, self.learned.games.iter().map(|game| game.captured))
    }

    /// The time that the robots played while learning, in simulated seconds.
    #[getter]
    fn learning_time(&self) -> f64 {
        self.learned.learning_time
    }

    fn __repr__(&self) -> String {
        let pairs = match self.learned.coupling.as_slice() {
            [first, second, .., last] if self.learned.coupling.len() > 10 => {
                format!("[{first}, {second}, ..., {last}]")
            }
            few => format!("{few:?}"),
        };
        let hopeless = match self.hopeless.len() {
            0 => String::new(),
            count => format!(", {count} of its pairs hopeless"),
        };
        format!("<LearnedCoupling {pairs} after {} episodes{hopeless}>", self.learned.games.len())
    }
}

impl PyLearnedCoupling {
    fn shape(&self) -> Vec<usize> {
        let size = self.learned.coupling.len();
        if self.pairwise { vec![size, size] } else { vec![self.learned.values.len()] }
    }

    fn each<'py>(
        &self,
        py: Python<'py>,
        value: impl Fn(&CoupledGame) -> f64,
    ) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.learned.games.iter().map(value))
    }
}

/// Learn who goes for whom: stage one of section 8.5 of Desouky's thesis.
///
/// In each episode a coupling is tried from the same start, while the robots may learn to steer.
/// Afterwards train the pairs of the coupling that was learned, `game.pair(i, coupling[i])`, with
/// `train`.
///
/// Parameters
/// ----------
/// game : ManyOnMany
///     What is played.
/// settings : CouplingTraining or PairwiseTraining
///     One value for each coupling, of which there are n! (up to n = 8), or one for each pair.
/// pursuer_starts, evader_starts : array_like of shape (n, 2) or (n, 3)
///     Where the robots start, in metres, and their headings in radians (0 by default).
/// seed : int, optional
///     The same seed gives the same result, to the bit, on any number of threads.
/// threads : int, optional
///     On how many threads the pairs of a game are played; 0 for one on each core.
/// control : Control, optional
///     To stop it from another thread.
/// progress : callable, optional
///     Called now and then with the number of pairs that played: n in each episode.
///
/// Returns
/// -------
/// LearnedCoupling
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> game = fz.ManyOnMany.thesis(2)
/// >>> starts = {"pursuer_starts": [(2, 4), (-4, 5)], "evader_starts": [(0, 4), (-1, 0)]}
/// >>> fz.learn_coupling(game, fz.CouplingTraining(), **starts, seed=1).coupling
/// [0, 1]
#[pyfunction]
#[pyo3(signature = (game, settings, *, pursuer_starts, evader_starts, seed = 0, threads = 1,
                    control = None, progress = None))]
#[expect(clippy::too_many_arguments, reason = "keywords of the Python function")]
pub fn learn_coupling(
    py: Python<'_>,
    game: &Bound<'_, PyManyOnMany>,
    settings: &Bound<'_, PyAny>,
    pursuer_starts: &Bound<'_, PyAny>,
    evader_starts: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = whole)] seed: u64,
    #[pyo3(from_py_with = whole)] threads: usize,
    control: Option<&Bound<'_, PyControl>>,
    progress: Option<Py<PyAny>>,
) -> Result<PyLearnedCoupling> {
    let (table, pairs) =
        (settings.cast::<PyCouplingTraining>(), settings.cast::<PyPairwiseTraining>());
    let technique: &(dyn CouplingTechnique + Sync) = match (&table, &pairs) {
        (Ok(table), _) => &table.get().0,
        (_, Ok(pairs)) => &pairs.get().0,
        _ => {
            let came = settings.get_type().name()?;
            let fitting = "CouplingTraining or PairwiseTraining";
            return Err(Error::WrongType(format!("settings must be {fitting}, got {came}")));
        }
    };
    let start = start(pursuer_starts, evader_starts)?;
    let task = CouplingTask { game: &game.get().0, start: &start, seed, threads };
    let watch = Watch::new(control, progress);
    let learned = enter(py, &watch, |control| technique.learn(&task, control))?;
    let mut hopeless = Vec::new();
    for (pursuer, &evader) in learned.coupling.iter().enumerate() {
        if game.get().0.prospect(pursuer, evader)? == Prospect::Hopeless {
            hopeless.push(pursuer);
        }
    }
    Ok(PyLearnedCoupling { learned, pairwise: pairs.is_ok(), hopeless })
}

/// Assign each row of a square table of costs a column of its own.
///
/// Parameters
/// ----------
/// costs : array_like of shape (n, n)
///     Finite, or infinite for pairs to avoid: as few of them as possible are taken.
/// objective : {"sum", "bottleneck"}, optional
///     What is as small as possible: the sum, or the largest cost and with it the sum. Costs that
///     are infinite don't count.
///
/// Returns
/// -------
/// numpy.ndarray of shape (n,)
///     The column of each row.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.assign([[1, 6], [6, 9]]).tolist()
/// [0, 1]
/// >>> fz.assign([[1, 6], [6, 9]], objective="bottleneck").tolist()
/// [1, 0]
#[pyfunction]
#[pyo3(signature = (costs, *, objective = "sum"))]
pub fn assign<'py>(
    py: Python<'py>,
    costs: &Bound<'py, PyAny>,
    objective: &str,
) -> Result<Bound<'py, PyArray1<usize>>> {
    let objective = Objective::from_name(objective)?;
    let floats = Floats::new(costs, "costs")?;
    let size = match *floats.shape() {
        [rows, columns] if rows == columns => rows,
        ref shape => {
            let expected = "an array of shape (n, n)";
            return Err(fuzzy_core::Error::wrong_shape("costs", expected, Shape(shape)).into());
        }
    };
    let costs = floats.as_slice()?;
    let columns = py.detach(|| best_assignment(costs, size, objective))?;
    Ok(PyArray1::from_vec(py, columns))
}

/// All couplings of n pursuers with n evaders, in the order of Table 8.5 of Desouky's thesis.
///
/// Parameters
/// ----------
/// pairs : int
///     n, from 1 to 8.
///
/// Returns
/// -------
/// numpy.ndarray of shape (n!, n)
///     Row by row the evader of each pursuer, from 0.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> fz.couplings(2).tolist()
/// [[0, 1], [1, 0]]
#[pyfunction]
pub fn couplings<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = whole)] pairs: usize,
) -> Result<Bound<'py, PyArray2<usize>>> {
    let all = all_couplings(pairs)?;
    let shape = [all.len(), pairs];
    Ok(PyArray1::from_vec(py, all.concat()).reshape(shape)?)
}
