//! [`Tsk`] as a document.

use serde::{Deserialize, Serialize};

use super::parts::{NoRuleFiresDocument, VariableDocument};
use super::{FORMAT, VERSION, read, write};
use crate::error::{Error, Result};
use crate::inference::{Inference, Order, Outside, Tsk};
use crate::variable::Variable;

const TSK: &str = "tsk";

/// A [`Tsk`] as a document, also as a part of other documents.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TskDocument {
    format: String,
    version: u32,
    #[serde(rename = "type")]
    kind: String,
    name: String,
    inputs: Vec<VariableDocument>,
    output: String,
    order: u8,
    no_rule_fires: NoRuleFiresDocument,
    // Documents from before there was a choice have none.
    #[serde(default = "keep")]
    outside: String,
    consequents: Vec<f64>,
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
            inputs: system.inputs().iter().map(VariableDocument::from).collect(),
            output: system.output().to_owned(),
            order: match system.order() {
                Order::Zero => 0,
                Order::One => 1,
            },
            no_rule_fires: system.no_rule_fires().into(),
            outside: system.interface().outside().name().to_owned(),
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
        let outside = Outside::from_name(&document.outside)?;
        Self::new(&document.name, inputs, order, document.consequents)?
            .with_output(&document.output)?
            .when_no_rule_fires(document.no_rule_fires.into())
            .map(|system| system.with_outside(outside))
    }
}

fn keep() -> String {
    Outside::Keep.name().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::NoRuleFires;
    use crate::membership::Shape;

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
