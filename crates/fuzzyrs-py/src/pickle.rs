//! Pickling of objects that are made with keywords.

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// What `__reduce__` returns for an object that its class makes from these arguments.
pub fn rebuild<'py, T: PyClass>(
    object: &Bound<'py, T>,
    arguments: Bound<'py, PyTuple>,
    keywords: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyTuple>> {
    let py = object.py();
    let partial = py.import("functools")?.getattr("partial")?;
    let make = partial.call((object.as_any().get_type(),), Some(keywords))?;
    (make, arguments).into_pyobject(py)
}
