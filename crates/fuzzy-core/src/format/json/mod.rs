//! fuzzyrs's own JSON documents: one object with a version, fields in a fixed order, numbers
//! written so that reading them gives the same bits.

mod actor_critic;
mod genetic;
mod parts;
mod system;
mod table_agent;
mod tsk;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize};

use crate::error::{Error, Result};

pub use system::SystemDocument;
pub use tsk::TskDocument;

/// The version of the documents that this library writes and reads.
pub const VERSION: u32 = 1;
/// What the field "format" of every document says.
pub const FORMAT: &str = "fuzzyrs";

#[derive(Deserialize)]
struct Header {
    format: Option<String>,
    version: Option<serde_json::Value>,
    #[serde(rename = "type")]
    kind: Option<String>,
}

/// A document as text.
pub fn write(document: &impl Serialize) -> Result<String> {
    let mut text = serde_json::to_string_pretty(document).map_err(invalid)?;
    text.push('\n');
    Ok(text)
}

/// The document of this type that a text holds.
pub fn read<T: DeserializeOwned>(text: &str, kind: &'static str) -> Result<T> {
    let found = document_type(text)?;
    if found == kind {
        return serde_json::from_str(text).map_err(invalid);
    }
    Err(Error::Unsupported { what: "document type", found, supported: kind.to_owned() })
}

/// The type of a document of this library and version, said in plain words before any other
/// field is looked at.
pub fn document_type(text: &str) -> Result<String> {
    let header: Header = serde_json::from_str(text).map_err(invalid)?;
    if header.format.as_deref() != Some(FORMAT) {
        let reason = match header.format {
            None => "the field \"format\" is missing".to_owned(),
            Some(other) => format!("its format is \"{other}\""),
        };
        return Err(Error::Format { format: "fuzzyrs JSON", reason });
    }
    let version = header.version.unwrap_or(serde_json::Value::Null);
    if version != serde_json::json!(VERSION) {
        return Err(Error::Unsupported {
            what: "document version",
            found: version.to_string(),
            supported: VERSION.to_string(),
        });
    }
    Ok(header.kind.unwrap_or_default())
}

/// Numbers of which those that are not finite were written as null.
pub(crate) fn null_as_nan<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<f64>, D::Error> {
    let numbers = Vec::<Option<f64>>::deserialize(deserializer)?;
    Ok(numbers.into_iter().map(|number| number.unwrap_or(f64::NAN)).collect())
}

fn invalid(error: serde_json::Error) -> Error {
    Error::Format { format: "fuzzyrs JSON", reason: error.to_string() }
}
