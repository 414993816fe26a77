//! The names that rules may use.

use std::collections::HashSet;

use super::{Antecedent, Consequent, MAX_NESTING, NOT, Rule};
use crate::check;
use crate::error::{Error, Result, hint};
use crate::expression::Expression;
use crate::lexer::shown;

/// The inputs and outputs of a system with their terms, and its hedges.
#[derive(Debug, Clone, PartialEq)]
pub struct Vocabulary {
    inputs: Vec<Words>,
    outputs: Vec<Words>,
    hedges: Vec<String>,
}

/// A variable's name and those of its terms.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Words {
    pub name: String,
    terms: Vec<String>,
}

/// What is wrong; its place is the caller's to say.
type Reason = String;

impl Vocabulary {
    /// The vocabulary of these inputs and outputs, each with the names of its terms, and of these
    /// hedges. `not` is always one.
    pub fn new(
        inputs: Vec<(String, Vec<String>)>,
        outputs: Vec<(String, Vec<String>)>,
        mut hedges: Vec<String>,
    ) -> Result<Self> {
        let names = inputs.iter().chain(&outputs).map(|(name, _)| name);
        distinct("variable", names, "the inputs and outputs")?;
        for (variable, terms) in inputs.iter().chain(&outputs) {
            distinct("term", terms, &format!("variable \"{variable}\""))?;
        }
        distinct("hedge", &hedges, "the hedges")?;
        if !hedges.iter().any(|hedge| hedge == NOT) {
            hedges.push(NOT.to_owned());
        }
        let words = |variables: Vec<_>| {
            variables.into_iter().map(|(name, terms)| Words { name, terms }).collect()
        };
        Ok(Self { inputs: words(inputs), outputs: words(outputs), hedges })
    }

    /// Nothing, if the rule can be applied: its names are known, its formulas are over these
    /// inputs, its weight lies in \[0, 1\], and its text would parse. `number` is what messages
    /// call it.
    ///
    /// A parsed rule is all that already.
    pub fn check(&self, rule: &Rule, number: usize) -> Result<()> {
        self.examine(rule).map_err(|reason| Error::Rule {
            rule: number,
            line: None,
            column: None,
            reason,
        })
    }

    fn examine(&self, rule: &Rule) -> Result<(), Reason> {
        if !rule.antecedent.fits(MAX_NESTING) {
            return Err(too_deep());
        }
        self.antecedent(&rule.antecedent)?;
        if rule.conclusions.is_empty() {
            return Err("a rule needs at least one conclusion".to_owned());
        }
        for conclusion in &rule.conclusions {
            let output = self.output(&conclusion.output)?;
            match &conclusion.value {
                Consequent::Term { hedges, term } => self.term(output, hedges, term)?,
                Consequent::Formula(formula) => self.formula(output, formula)?,
            }
        }
        weight(rule.weight)
    }

    fn antecedent(&self, antecedent: &Antecedent) -> Result<(), Reason> {
        match antecedent {
            Antecedent::Is { variable, hedges, term } => {
                self.term(self.input(variable)?, hedges, term)
            }
            Antecedent::And(operands) | Antecedent::Or(operands) => {
                if operands.len() < 2 {
                    return Err("\"and\" and \"or\" join two conditions or more".to_owned());
                }
                operands.iter().try_for_each(|operand| self.antecedent(operand))
            }
            Antecedent::Not(of) => self.antecedent(of),
            Antecedent::Hedged { hedge, of } => {
                self.hedge(hedge)?;
                self.antecedent(of)
            }
        }
    }

    fn term(&self, variable: &Words, hedges: &[String], term: &str) -> Result<(), Reason> {
        if hedges.len() > MAX_NESTING {
            return Err(format!("more than {MAX_NESTING} hedges before \"{}\"", shown(term)));
        }
        hedges.iter().try_for_each(|hedge| self.hedge(hedge))?;
        variable.term(term)
    }

    fn formula(&self, output: &Words, formula: &Expression) -> Result<(), Reason> {
        match Expression::parse(formula.source(), &self.input_names()) {
            Ok(parsed) if parsed == *formula => Ok(()),
            Ok(_) => Err(format!("the formula of \"{}\" is over other inputs", output.name)),
            Err(error) => Err(format!("\"{}\": {error}", output.name)),
        }
    }

    /// The names of the inputs, in their order.
    pub(super) fn input_names(&self) -> Vec<&str> {
        names(&self.inputs)
    }

    /// The input with this name.
    pub(super) fn input(&self, name: &str) -> Result<&Words, Reason> {
        if self.outputs.iter().any(|output| output.name == name) {
            return Err(format!("\"{name}\" is an output; an antecedent needs an input"));
        }
        find("input", name, &self.inputs)
    }

    /// The output with this name.
    pub(super) fn output(&self, name: &str) -> Result<&Words, Reason> {
        if self.inputs.iter().any(|input| input.name == name) {
            return Err(format!("\"{name}\" is an input; a conclusion needs an output"));
        }
        find("output", name, &self.outputs)
    }

    /// Nothing, if the hedge is known.
    pub(super) fn hedge(&self, name: &str) -> Result<(), Reason> {
        if self.has_hedge(name) {
            return Ok(());
        }
        let known: Vec<&str> = self.hedges.iter().map(String::as_str).collect();
        Err(unknown("hedge", name, &known))
    }

    /// Whether the hedge is known.
    pub(super) fn has_hedge(&self, name: &str) -> bool {
        self.hedges.iter().any(|hedge| hedge == name)
    }
}

impl Words {
    /// Nothing, if the term is known.
    pub fn term(&self, name: &str) -> Result<(), Reason> {
        if self.has_term(name) {
            return Ok(());
        }
        let known: Vec<&str> = self.terms.iter().map(String::as_str).collect();
        let (name, hint) = (shown(name), hint(name, &known));
        Err(format!("unknown term \"{name}\" of \"{}\"{hint}", self.name))
    }

    /// Whether the term is known.
    pub fn has_term(&self, name: &str) -> bool {
        self.terms.iter().any(|term| term == name)
    }
}

/// Nothing, if the weight lies in [0, 1].
pub(super) fn weight(weight: f64) -> Result<(), Reason> {
    if (0.0..=1.0).contains(&weight) {
        return Ok(());
    }
    Err(format!("the weight must be between 0 and 1, got {weight}"))
}

pub(super) fn too_deep() -> Reason {
    format!("the antecedent is nested more than {MAX_NESTING} levels deep")
}

fn find<'a>(kind: &str, name: &str, variables: &'a [Words]) -> Result<&'a Words, Reason> {
    let found = variables.iter().find(|variable| variable.name == name);
    found.ok_or_else(|| unknown(kind, name, &names(variables)))
}

fn unknown(kind: &str, name: &str, known: &[&str]) -> Reason {
    format!("unknown {kind} \"{}\"{}", shown(name), hint(name, known))
}

fn names(variables: &[Words]) -> Vec<&str> {
    variables.iter().map(|variable| variable.name.as_str()).collect()
}

/// Nothing, if the names can be used and differ.
fn distinct<'a>(
    kind: &'static str,
    names: impl IntoIterator<Item = &'a String>,
    place: &str,
) -> Result<()> {
    let mut known = HashSet::new();
    for name in names {
        check::name(kind, name)?;
        if !known.insert(name) {
            return Err(Error::DuplicateName { kind, name: name.clone(), place: place.to_owned() });
        }
    }
    Ok(())
}
