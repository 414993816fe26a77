//! A handle on running work.

use std::sync::Arc;

use fuzzy_core::Control;
use pyo3::prelude::*;

/// A handle on running work: stop it from another thread, see how far it is.
///
/// Pass one to `train`, `play_many` or `fit_genetic`. Work that is stopped raises
/// `CancelledError`. Ctrl-C needs no handle.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> control = fz.Control()
/// >>> control.cancel()
/// >>> control.cancelled
/// True
#[pyclass(name = "Control", module = "fuzzyrs", frozen)]
#[derive(Default)]
pub struct PyControl(pub Arc<Control>);

#[pymethods]
impl PyControl {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Ask the work to stop at its next check.
    fn cancel(&self) {
        self.0.cancel();
    }

    /// Whether a stop was asked for.
    #[getter]
    fn cancelled(&self) -> bool {
        self.0.is_cancelled()
    }

    /// Pieces of work done: episodes, generations or games.
    #[getter]
    fn done(&self) -> u64 {
        self.0.done()
    }
}
