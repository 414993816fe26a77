//! Variables and choices, which documents have in common.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::inference::NoRuleFires;
use crate::membership::{MembershipFunction, Shape};
use crate::variable::Variable;

/// A [`Variable`].
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct VariableDocument {
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

/// A [`NoRuleFires`].
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum NoRuleFiresDocument {
    Error,
    Nan,
    Previous,
    Value(f64),
}

impl From<&Variable> for VariableDocument {
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

impl TryFrom<VariableDocument> for Variable {
    type Error = Error;

    fn try_from(document: VariableDocument) -> Result<Self> {
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

impl From<NoRuleFires> for NoRuleFiresDocument {
    fn from(choice: NoRuleFires) -> Self {
        match choice {
            NoRuleFires::Error => Self::Error,
            NoRuleFires::Nan => Self::Nan,
            NoRuleFires::Previous => Self::Previous,
            NoRuleFires::Value(value) => Self::Value(value),
        }
    }
}

impl From<NoRuleFiresDocument> for NoRuleFires {
    fn from(document: NoRuleFiresDocument) -> Self {
        match document {
            NoRuleFiresDocument::Error => Self::Error,
            NoRuleFiresDocument::Nan => Self::Nan,
            NoRuleFiresDocument::Previous => Self::Previous,
            NoRuleFiresDocument::Value(value) => Self::Value(value),
        }
    }
}
