//! Rust errors as Python exceptions. The classes live in `fuzzyrs.errors`, where they can inherit
//! the fitting built-in ones.

use pyo3::exceptions::PySystemError;
use pyo3::prelude::*;

use crate::training::PyTrained;

/// The result of a binding's work in Rust.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// An error of either crate, or of a conversion.
#[derive(Debug)]
pub enum Error {
    /// From the games or the fuzzy-logic library.
    Library(pursuit_sim::Error),
    /// An argument of a type that does not fit.
    WrongType(String),
    /// From Python itself.
    Python(PyErr),
}

impl From<fuzzy_core::Error> for Error {
    fn from(error: fuzzy_core::Error) -> Self {
        Self::Library(error.into())
    }
}

impl From<pursuit_sim::Error> for Error {
    fn from(error: pursuit_sim::Error) -> Self {
        Self::Library(error)
    }
}

impl From<PyErr> for Error {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

const WRONG_TYPE: &str = "wrong_type";

/// Every kind of error that can reach Python.
pub fn kinds() -> Vec<&'static str> {
    let mut kinds = fuzzy_core::Error::KINDS.to_vec();
    kinds.extend(pursuit_sim::Error::KINDS);
    kinds.push(WRONG_TYPE);
    kinds
}

impl From<Error> for PyErr {
    fn from(error: Error) -> Self {
        let mut so_far = None;
        let (kind, message) = match error {
            Error::Library(error) => {
                let told = (error.kind(), error.to_string());
                if let pursuit_sim::Error::LearningDiverged { so_far: trained, .. } = error {
                    so_far = Some(PyTrained(*trained));
                }
                told
            }
            Error::WrongType(message) => (WRONG_TYPE, message),
            Error::Python(error) => return error,
        };
        Python::attach(|py| {
            let exception = py
                .import("fuzzyrs.errors")
                .and_then(|module| module.call_method1("from_kind", (kind, &message)))
                .and_then(|exception| {
                    so_far.map(|so_far| exception.setattr("so_far", so_far)).transpose()?;
                    Ok(exception)
                });
            match exception {
                Ok(exception) => PyErr::from_value(exception),
                Err(_) => PySystemError::new_err(message),
            }
        })
    }
}
