//! fuzzyrs's own JSON documents: one object with a version, fields in a fixed order, numbers
//! written so that reading them gives the same bits.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::inference::{NoRuleFires, Order, Tsk};
use crate::membership::{MembershipFunction, Shape};
use crate::variable::Variable;

/// The version of the documents that this library writes and reads.
pub const VERSION: u32 = 1;
/// What the field "format" of every document says.
pub const FORMAT: &str = "fuzzyrs";
const TSK: &str = "tsk";

#[derive(Deserialize)]
struct Header {
    format: Option<String>,
    version: Option<serde_json::Value>,
    #[serde(rename = "type")]
    kind: Option<String>,
}

/// A [`Tsk`] as a document, also as a part of other documents.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TskDocument {
    format: String,
    version: u32,
    #[serde(rename = "type")]
    kind: String,
    name: String,
    inputs: Vec<InputDocument>,
    output: String,
    order: u8,
    no_rule_fires: NoRuleFiresDocument,
    consequents: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct InputDocument {
    name: String,
    universe: [f64; 2],
    terms: Vec<TermDocument>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TermDocument {
    name: String,
    shape: String,
    parameters: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum NoRuleFiresDocument {
    Error,
    Nan,
    Value(f64),
}

impl Tsk {
    /// The system as a JSON document.
    pub fn to_json(&self) -> Result<String> {
        write(&TskDocument::from(self))
    }

    /// The system that a JSON document describes.
    pub fn from_json(text: &str) -> Result<Self> {
        read::<TskDocument>(text, TSK)?.try_into()
    }
}

impl From<&Tsk> for TskDocument {
    fn from(system: &Tsk) -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            kind: TSK.to_owned(),
            name: system.name().to_owned(),
            inputs: system.inputs().iter().map(InputDocument::from).collect(),
            output: system.output().to_owned(),
            order: match system.order() {
                Order::Zero => 0,
                Order::One => 1,
            },
            no_rule_fires: match system.no_rule_fires() {
                NoRuleFires::Error => NoRuleFiresDocument::Error,
                NoRuleFires::Nan => NoRuleFiresDocument::Nan,
                NoRuleFires::Value(value) => NoRuleFiresDocument::Value(value),
            },
            consequents: system.consequents().to_vec(),
        }
    }
}

impl TryFrom<TskDocument> for Tsk {
    type Error = Error;

    fn try_from(document: TskDocument) -> Result<Self> {
        let inputs =
            document.inputs.into_iter().map(Variable::try_from).collect::<Result<Vec<_>>>()?;
        let order = match document.order {
            0 => Order::Zero,
            1 => Order::One,
            other => {
                return Err(Error::Unsupported {
                    what: "order",
                    found: other.to_string(),
                    supported: "0 and 1".to_owned(),
                });
            }
        };
        Self::new(&document.name, inputs, order, document.consequents)?
            .with_output(&document.output)?
            .when_no_rule_fires(match document.no_rule_fires {
                NoRuleFiresDocument::Error => NoRuleFires::Error,
                NoRuleFiresDocument::Nan => NoRuleFires::Nan,
                NoRuleFiresDocument::Value(value) => NoRuleFires::Value(value),
            })
    }
}

impl From<&Variable> for InputDocument {
    fn from(variable: &Variable) -> Self {
        let universe = variable.universe();
        Self {
            name: variable.name().to_owned(),
            universe: [universe.low(), universe.high()],
            terms: variable
                .terms()
                .iter()
                .map(|term| TermDocument {
                    name: term.name.clone(),
                    shape: term.function.shape().name().to_owned(),
                    parameters: term.function.parameters().to_vec(),
                })
                .collect(),
        }
    }
}

impl TryFrom<InputDocument> for Variable {
    type Error = Error;

    fn try_from(document: InputDocument) -> Result<Self> {
        let [low, high] = document.universe;
        let mut variable = Self::new(&document.name, low, high)?;
        for term in document.terms {
            let shape = Shape::from_name(&term.shape)?;
            let function = MembershipFunction::new(shape, &term.parameters)?;
            variable = variable.with_term(&term.name, function)?;
        }
        Ok(variable)
    }
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

fn invalid(error: serde_json::Error) -> Error {
    Error::Format { format: "fuzzyrs JSON", reason: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn system() -> Tsk {
        let x = Variable::evenly("x", (-1.0, 0.1), Shape::GaussianWidth, &["a", "b"]).unwrap();
        Tsk::new("s", vec![x], Order::One, vec![1.0 / 3.0, 0.1, -1e-300, 2e17])
            .unwrap()
            .when_no_rule_fires(NoRuleFires::Value(0.5))
            .unwrap()
    }

    #[test]
    fn a_system_survives_the_round_trip_to_the_bit() {
        let text = system().to_json().unwrap();
        assert_eq!(Tsk::from_json(&text).unwrap(), system());
        assert_eq!(Tsk::from_json(&text).unwrap().to_json().unwrap(), text);
    }

    #[test]
    fn foreign_and_future_documents_are_told_apart() {
        let text = system().to_json().unwrap();
        let message = |text: &str| Tsk::from_json(text).unwrap_err().to_string();
        assert!(message("{}").contains("the field \"format\" is missing"));
        assert!(message("[1, 2").contains("not a valid fuzzyrs JSON document"));
        assert_eq!(
            message(&text.replace("\"version\": 1", "\"version\": 2")),
            "document version \"2\" is not supported; this version reads 1"
        );
        assert!(message(&text.replace("\"tsk\"", "\"mamdani\"")).contains("document type"));
        assert!(message(&text.replace("\"order\": 1", "\"order\": 3")).contains("order \"3\""));
        assert!(message(&text.replace("\"output\"", "\"outptu\"")).contains("outptu"));
        assert!(message(&text.replace("gaussian_width", "gausian_width")).contains("did you mean"));
    }

    #[test]
    fn every_truncation_is_an_error() {
        let text = system().to_json().unwrap();
        for end in 0..text.trim_end().len() {
            assert!(Tsk::from_json(&text[..end]).is_err(), "{}", &text[..end]);
        }
    }
}
