//! File formats, one module each.

pub mod json;

use std::fs;
use std::path::Path;

use crate::error::{Error, Result};

/// Writes a file so that it is either the old one or the new one, never half of it.
pub fn write_atomically(path: &Path, text: &str) -> Result<()> {
    let failed = |error: std::io::Error| Error::File {
        action: "write",
        path: path.to_owned(),
        reason: error.to_string(),
    };
    let mut beside = path.as_os_str().to_owned();
    beside.push(format!(".{}.part", std::process::id()));
    let beside = Path::new(&beside);
    fs::write(beside, text).and_then(|()| fs::rename(beside, path)).map_err(|error| {
        // Best effort: the reason to report is the first failure.
        let _ = fs::remove_file(beside);
        failed(error)
    })
}

/// Reads a text file.
pub fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).map_err(|error| Error::File {
        action: "read",
        path: path.to_owned(),
        reason: error.to_string(),
    })
}
