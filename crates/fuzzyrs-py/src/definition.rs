//! What a system is made of, from what Python hands in: outputs, hedges and rules.

use fuzzy_core::Output;
use fuzzy_core::hedge::Hedge;
use fuzzy_core::rule::{Rule, parse_rules};
use pyo3::prelude::*;
use pyo3::types::{PyMapping, PyString};

use crate::errors::{Error, Result};
use crate::membership::PyVariable;
use crate::output::PyOutput;
use crate::rules::PyRule;

/// One output or several.
pub fn read_outputs(outputs: &Bound<'_, PyAny>, inputs: &[&str]) -> Result<Vec<Output>> {
    if let Some(output) = read_output(outputs, inputs)? {
        return Ok(vec![output]);
    }
    let wrong = |object: &Bound<'_, PyAny>| {
        let came = object.get_type();
        Error::WrongType(format!("outputs must be Output or Variable objects, got {came}"))
    };
    let several = outputs.try_iter().map_err(|_| wrong(outputs))?;
    several
        .map(|object| {
            let object = object?;
            read_output(&object, inputs)?.ok_or_else(|| wrong(&object))
        })
        .collect()
}

fn read_output(object: &Bound<'_, PyAny>, inputs: &[&str]) -> Result<Option<Output>> {
    if let Ok(output) = object.cast::<PyOutput>() {
        return output.get().with_inputs(inputs).map(Some);
    }
    match object.cast::<PyVariable>() {
        Ok(variable) => Ok(Some(Output::mamdani(variable.get().0.clone())?)),
        Err(_) => Ok(None),
    }
}

/// Hedges of one's own, by name.
pub fn read_hedges(hedges: Option<&Bound<'_, PyMapping>>) -> Result<Vec<Hedge>> {
    let Some(hedges) = hedges else { return Ok(Vec::new()) };
    let mut read = Vec::new();
    for item in hedges.items()? {
        let (name, formula): (String, String) = item.extract()?;
        read.push(Hedge::custom(&name, &formula)?);
    }
    Ok(read)
}

/// Rules from a text, or from texts and rules.
pub fn read_rules(
    rules: &Bound<'_, PyAny>,
    words: &fuzzy_core::rule::Vocabulary,
) -> Result<Vec<Rule>> {
    if rules.is_instance_of::<PyString>() {
        return Ok(parse_rules(&rules.extract::<String>()?, words)?);
    }
    if let Ok(rule) = rules.cast::<PyRule>() {
        return Ok(vec![rule.get().0.clone()]);
    }
    let mut read = Vec::new();
    let several = rules.try_iter().map_err(|_| {
        Error::WrongType("rules must be text, a Rule, or a sequence of them".to_owned())
    })?;
    for (index, rule) in several.enumerate() {
        let rule = rule?;
        if let Ok(rule) = rule.cast::<PyRule>() {
            read.push(rule.get().0.clone());
        } else if rule.is_instance_of::<PyString>() {
            read.push(Rule::parse(&rule.extract::<String>()?, words, index + 1)?);
        } else {
            let came = rule.get_type();
            return Err(Error::WrongType(format!(
                "rules must be text or Rule objects, got {came}"
            )));
        }
    }
    Ok(read)
}
