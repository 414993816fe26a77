//! Pickling of objects that are made with keywords.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// What `__reduce__` returns for an object that `make`, its class or a method of it, makes from
/// these arguments.
pub fn rebuild<'py>(
    make: &Bound<'py, PyAny>,
    arguments: Bound<'py, PyTuple>,
    keywords: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyTuple>> {
    let py = make.py();
    let partial = py.import("functools")?.getattr("partial")?;
    (partial.call((make,), Some(keywords))?, arguments).into_pyobject(py)
}
