//! The one door from Python into long work in Rust.

use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use fuzzy_core::Control;
use pyo3::prelude::*;

use crate::control::PyControl;
use crate::errors::{Error, Result};

/// How often signals are looked at and progress is told.
const TICK: Duration = Duration::from_millis(50);

/// Who watches the work.
#[derive(Default)]
pub struct Watch {
    control: Arc<Control>,
    progress: Option<Py<PyAny>>,
}

impl Watch {
    pub fn new(control: Option<&Bound<'_, PyControl>>, progress: Option<Py<PyAny>>) -> Self {
        let control = control.map(|control| Arc::clone(&control.get().0)).unwrap_or_default();
        Self { control, progress }
    }
}

/// Runs work on a thread of its own with the GIL released. Meanwhile the calling thread answers
/// Ctrl-C and calls `progress` with the pieces of work done; Rust itself never calls Python. If
/// either raises, the work is stopped and the exception goes to the caller.
pub fn enter<T, E>(
    py: Python<'_>,
    watch: &Watch,
    work: impl FnOnce(&Control) -> std::result::Result<T, E> + Send,
) -> Result<T>
where
    T: Send,
    E: Into<Error> + Send,
{
    let control = &*watch.control;
    py.detach(|| {
        thread::scope(|scope| {
            let (done, finished) = channel();
            let worker = thread::Builder::new()
                .spawn_scoped(scope, move || {
                    let result = work(control);
                    // The receiver outlives the worker; a failure could only mean nobody waits.
                    let _ = done.send(());
                    result
                })
                .map_err(|error| fuzzy_core::Error::Threads {
                    threads: 1,
                    reason: error.to_string(),
                })?;
            let mut interruption = None;
            while let Err(RecvTimeoutError::Timeout) = finished.recv_timeout(TICK) {
                if interruption.is_none() {
                    interruption = Python::attach(|py| look_up(py, watch)).err();
                    if interruption.is_some() {
                        control.cancel();
                    }
                }
            }
            let result = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            if let Some(exception) = interruption {
                // The work was stopped for this; the caller's handle is as good as before.
                control.reset();
                return Err(Error::Python(exception));
            }
            let result = result.map_err(Into::into)?;
            Python::attach(|py| tell(py, watch))?;
            Ok(result)
        })
    })
}

fn look_up(py: Python<'_>, watch: &Watch) -> PyResult<()> {
    py.check_signals()?;
    tell(py, watch)
}

fn tell(py: Python<'_>, watch: &Watch) -> PyResult<()> {
    if let Some(progress) = &watch.progress {
        progress.call1(py, (watch.control.done(),))?;
    }
    Ok(())
}
