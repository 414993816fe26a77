//! NumPy arrays in and out.

use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{Error, Result};

/// An array of float64 in C order: the caller's own if it is one, else a copy.
pub struct Floats<'py>(PyReadonlyArrayDyn<'py, f64>);

impl<'py> Floats<'py> {
    /// Anything that NumPy takes for numbers.
    pub fn new(object: &Bound<'py, PyAny>, what: &str) -> Result<Self> {
        if let Ok(array) = object.cast::<PyArrayDyn<f64>>()
            && array.is_c_contiguous()
        {
            return Ok(Self(array.try_readonly().map_err(PyErr::from)?));
        }
        let numpy = object.py().import("numpy")?;
        let array = numpy.call_method1("asarray", (object,)).map_err(|error| {
            Error::WrongType(format!("{what} must be numbers in a regular array: {error}"))
        })?;
        let dtype = array.getattr("dtype")?;
        let kind: String = dtype.getattr("kind")?.extract()?;
        if !matches!(kind.as_str(), "b" | "i" | "u" | "f") {
            return Err(Error::WrongType(format!(
                "{what} must be real numbers, got dtype {dtype}"
            )));
        }
        // Not `ascontiguousarray`, which makes a vector of a single number.
        let options = PyDict::new(object.py());
        options.set_item("dtype", "float64")?;
        options.set_item("order", "C")?;
        let array = numpy.call_method("asarray", (array,), Some(&options))?;
        let array = array.cast::<PyArrayDyn<f64>>().map_err(PyErr::from)?;
        Ok(Self(array.try_readonly().map_err(PyErr::from)?))
    }

    /// The numbers, row by row.
    pub fn as_slice(&self) -> Result<&[f64]> {
        self.0.as_slice().map_err(|error| Error::Python(error.into()))
    }

    /// The shape; of a 0-dimensional input too.
    pub fn shape(&self) -> &[usize] {
        self.0.shape()
    }

    /// The numbers of an (n, columns) array.
    pub fn rows(&self, what: &str, columns: usize) -> Result<&[f64]> {
        match *self.shape() {
            [_, width] if width == columns => self.as_slice(),
            ref shape => {
                let expected = format!("an array of shape (n, {columns})");
                Err(fuzzy_core::Error::wrong_shape(what, expected, Shape(shape)).into())
            }
        }
    }

    /// The numbers of a one-dimensional array.
    pub fn vector(&self, what: &str) -> Result<&[f64]> {
        match self.shape() {
            [_] => self.as_slice(),
            shape => {
                let expected = "a one-dimensional array";
                Err(fuzzy_core::Error::wrong_shape(what, expected, Shape(shape)).into())
            }
        }
    }
}

/// A shape as Python prints it.
pub struct Shape<'a>(pub &'a [usize]);

impl std::fmt::Display for Shape<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sizes: Vec<String> = self.0.iter().map(usize::to_string).collect();
        match sizes.as_slice() {
            [] => write!(formatter, "a single number"),
            [size] => write!(formatter, "shape ({size},)"),
            sizes => write!(formatter, "shape ({})", sizes.join(", ")),
        }
    }
}

/// A new array with these numbers in this shape.
pub fn array<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    shape: &[usize],
) -> Result<Bound<'py, PyArrayDyn<f64>>> {
    Ok(PyArray1::from_vec(py, numbers).reshape(shape.to_vec())?)
}

/// Pairs of numbers from an (n, 2) array or a list of pairs.
pub fn pairs(object: &Bound<'_, PyAny>, what: &str) -> Result<Vec<(f64, f64)>> {
    let floats = Floats::new(object, what)?;
    let numbers = floats.rows(what, 2)?;
    Ok(numbers.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect())
}

/// A whole number that fits into `T`: a count, an index or a seed.
pub fn whole<'py, T>(object: &Bound<'py, PyAny>) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py, Error = PyErr>,
{
    match object.extract::<T>() {
        // Not a whole number at all: Python's message says so and names the argument.
        Err(error) if !error.is_instance_of::<PyTypeError>(object.py()) => {
            Err(Error::from(fuzzy_core::Error::OutOfRange {
                what: "a count, index or seed".to_owned(),
                expected: format!("a whole number from 0 to 2^{} - 1", 8 * size_of::<T>()),
                value: object.extract().unwrap_or(f64::INFINITY),
            })
            .into())
        }
        result => result,
    }
}

/// [`whole`], or nothing for None.
pub fn whole_or_none(object: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    if object.is_none() { Ok(None) } else { whole(object).map(Some) }
}
