//! File formats, one module each.

pub mod json;

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::{Error, Result};

/// Writes a file so that it is either the old one or the new one, never half of it, even if the
/// machine stops meanwhile. A link is replaced by the file.
pub fn write_atomically(path: &Path, text: &str) -> Result<()> {
    /// Two writers of one process must not share a file.
    static WRITES: AtomicU64 = AtomicU64::new(0);
    let failed = |error: std::io::Error| Error::File {
        action: "write",
        path: path.to_owned(),
        reason: error.to_string(),
    };
    let mut beside = path.as_os_str().to_owned();
    let number = WRITES.fetch_add(1, Ordering::Relaxed);
    beside.push(format!(".{}-{number}.part", std::process::id()));
    let beside = Path::new(&beside);
    let write = || {
        let mut file = File::create(beside)?;
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
        fs::rename(beside, path)
    };
    write().map_err(|error| {
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
