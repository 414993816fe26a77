//! [`System`] as a document; its rules stand in it as people write them.

use serde::{Deserialize, Serialize};

use super::parts::{NoRuleFiresDocument, VariableDocument};
use super::{FORMAT, VERSION, read, write};
use crate::error::{Error, Result};
use crate::hedge::Hedge;
use crate::inference::{Inference, Logic, Outside, System, vocabulary};
use crate::norm::{Aggregation, SNorm, TNorm};
use crate::output::{Defuzzifier, Method, Output, Sampling, Value, Weighting};
use crate::rule::Rule;
use crate::variable::Variable;

/// A [`System`] as a document, also as a part of other documents.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SystemDocument {
    format: String,
    version: u32,
    #[serde(rename = "type")]
    kind: String,
    name: String,
    inputs: Vec<VariableDocument>,
    outputs: Vec<OutputDocument>,
    conjunction: String,
    disjunction: String,
    hedges: Vec<HedgeDocument>,
    outside: String,
    rules: Vec<String>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HedgeDocument {
    name: String,
    formula: String,
}

#[derive(Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "snake_case", deny_unknown_fields)]
enum OutputDocument {
    Mamdani {
        variable: VariableDocument,
        implication: String,
        aggregation: String,
        defuzzifier: String,
        sampling: String,
        #[serde(skip_serializing_if = "Option::is_none")]
        samples: Option<usize>,
        no_rule_fires: NoRuleFiresDocument,
    },
    Sugeno {
        name: String,
        terms: Vec<ValueDocument>,
        aggregation: String,
        defuzzifier: String,
        no_rule_fires: NoRuleFiresDocument,
    },
    Tsukamoto {
        variable: VariableDocument,
        defuzzifier: String,
        no_rule_fires: NoRuleFiresDocument,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ValueDocument {
    name: String,
    value: AnyValue,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum AnyValue {
    Constant(f64),
    Linear(Vec<f64>),
    Formula(String),
}

impl System {
    /// What the field "type" of its document says.
    pub const DOCUMENT_TYPE: &'static str = "system";

    /// The system as a JSON document.
    pub fn to_json(&self) -> Result<String> {
        write(&SystemDocument::from(self))
    }

    /// The system that a JSON document describes.
    pub fn from_json(text: &str) -> Result<Self> {
        read::<SystemDocument>(text, Self::DOCUMENT_TYPE)?.try_into()
    }
}

impl From<&System> for SystemDocument {
    fn from(system: &System) -> Self {
        let (interface, logic) = (system.interface(), system.logic());
        let hedge = |hedge: &Hedge| HedgeDocument {
            name: hedge.name().to_owned(),
            formula: hedge.formula().unwrap_or_default().to_owned(),
        };
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            kind: System::DOCUMENT_TYPE.to_owned(),
            name: interface.name().to_owned(),
            inputs: interface.inputs().iter().map(VariableDocument::from).collect(),
            outputs: system.outputs().iter().map(OutputDocument::from).collect(),
            conjunction: logic.conjunction.name().to_owned(),
            disjunction: logic.disjunction.name().to_owned(),
            hedges: logic.hedges.iter().map(hedge).collect(),
            outside: interface.outside().name().to_owned(),
            rules: system.rules().iter().map(ToString::to_string).collect(),
        }
    }
}

impl TryFrom<SystemDocument> for System {
    type Error = Error;

    fn try_from(document: SystemDocument) -> Result<Self> {
        let inputs =
            document.inputs.into_iter().map(Variable::try_from).collect::<Result<Vec<_>>>()?;
        let names: Vec<&str> = inputs.iter().map(Variable::name).collect();
        let outputs = document.outputs.into_iter().map(|output| output.read(&names));
        let outputs = outputs.collect::<Result<Vec<_>>>()?;
        let hedges = document.hedges.iter().map(|hedge| Hedge::custom(&hedge.name, &hedge.formula));
        let logic = Logic {
            conjunction: TNorm::from_name(&document.conjunction)?,
            disjunction: SNorm::from_name(&document.disjunction)?,
            hedges: hedges.collect::<Result<Vec<_>>>()?,
        };
        let outside = Outside::from_name(&document.outside)?;
        let words = vocabulary(&inputs, &outputs, &logic.hedges)?;
        let rules = document.rules.iter().zip(1..);
        let rules = rules.map(|(text, number)| Rule::parse(text, &words, number));
        let rules = rules.collect::<Result<Vec<_>>>()?;
        Ok(Self::new(&document.name, inputs, outputs, rules, logic)?.with_outside(outside))
    }
}

impl From<&Output> for OutputDocument {
    fn from(output: &Output) -> Self {
        let no_rule_fires = output.no_rule_fires().into();
        match output.method() {
            Method::Mamdani { variable, implication, aggregation, defuzzifier, sampling } => {
                Self::Mamdani {
                    variable: variable.into(),
                    implication: implication.name().to_owned(),
                    aggregation: aggregation.name().to_owned(),
                    defuzzifier: defuzzifier.name().to_owned(),
                    sampling: sampling.name().to_owned(),
                    samples: sampling.count(),
                    no_rule_fires,
                }
            }
            Method::Sugeno { terms, aggregation, weighting } => Self::Sugeno {
                name: output.name().to_owned(),
                terms: terms.iter().map(ValueDocument::from).collect(),
                aggregation: aggregation.name().to_owned(),
                defuzzifier: weighting.name().to_owned(),
                no_rule_fires,
            },
            Method::Tsukamoto { variable, weighting } => Self::Tsukamoto {
                variable: variable.into(),
                defuzzifier: weighting.name().to_owned(),
                no_rule_fires,
            },
        }
    }
}

impl From<&(String, Value)> for ValueDocument {
    fn from((name, value): &(String, Value)) -> Self {
        let value = match value {
            Value::Constant(constant) => AnyValue::Constant(*constant),
            Value::Linear(coefficients) => AnyValue::Linear(coefficients.clone()),
            Value::Formula(formula) => AnyValue::Formula(formula.source().to_owned()),
        };
        Self { name: name.clone(), value }
    }
}

impl ValueDocument {
    fn read(self, inputs: &[&str]) -> Result<(String, Value)> {
        let value = match self.value {
            AnyValue::Constant(constant) => Value::Constant(constant),
            AnyValue::Linear(coefficients) => Value::Linear(coefficients),
            AnyValue::Formula(formula) => Value::parse(&formula, inputs)?,
        };
        Ok((self.name, value))
    }
}

impl OutputDocument {
    fn read(self, inputs: &[&str]) -> Result<Output> {
        match self {
            Self::Mamdani {
                variable,
                implication,
                aggregation,
                defuzzifier,
                sampling,
                samples,
                no_rule_fires,
            } => Output::mamdani_with(
                variable.try_into()?,
                TNorm::from_name(&implication)?,
                Aggregation::from_name(&aggregation)?,
                Defuzzifier::from_name(&defuzzifier)?,
                Sampling::from_name(&sampling, samples.unwrap_or_default())?,
            )?
            .when_no_rule_fires(no_rule_fires.into()),
            Self::Sugeno { name, terms, aggregation, defuzzifier, no_rule_fires } => {
                let terms = terms.into_iter().map(|term| term.read(inputs));
                Output::sugeno_with(
                    &name,
                    terms.collect::<Result<Vec<_>>>()?,
                    Aggregation::from_name(&aggregation)?,
                    Weighting::from_name(&defuzzifier)?,
                )?
                .when_no_rule_fires(no_rule_fires.into())
            }
            Self::Tsukamoto { variable, defuzzifier, no_rule_fires } => {
                Output::tsukamoto(variable.try_into()?, Weighting::from_name(&defuzzifier)?)?
                    .when_no_rule_fires(no_rule_fires.into())
            }
        }
    }
}
