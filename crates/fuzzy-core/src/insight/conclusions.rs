//! Rules that say the same, or contradict each other.

use std::collections::HashMap;

use super::findings::{Finding, Kind};
use super::words::SystemWords;
use crate::inference::System;
use crate::rule::Antecedent;

/// Rules with the same antecedent, but for the order of what `and` and `or` join, that say the
/// same or different things about an output. Each is compared with the first alone, so that the
/// time grows with the number of rules and no faster. Rules of weight 0 say nothing.
pub fn repeated(system: &System) -> Vec<Finding> {
    let words = SystemWords::new(system);
    let mut antecedents: HashMap<String, usize> = HashMap::new();
    let mut first: HashMap<(usize, &str), (String, usize)> = HashMap::new();
    let mut known: HashMap<(usize, String), usize> = HashMap::new();
    let mut findings = Vec::new();
    for (index, rule) in system.rules().iter().enumerate().filter(|(_, rule)| rule.weight > 0.0) {
        let number = antecedents.len();
        let antecedent = *antecedents.entry(canonical(&rule.antecedent)).or_insert(number);
        for conclusion in &rule.conclusions {
            let text = words.conclusion(index, conclusion);
            let before = *known.entry((antecedent, text.clone())).or_insert(index);
            let place = first.entry((antecedent, &conclusion.output));
            let (other, by) = place.or_insert_with(|| (text.clone(), index));
            if before != index {
                findings.push(duplicate(&text, index, before));
            } else if *other != text && *by != index {
                findings.push(contradiction((&text, index), (other, *by)));
            }
        }
    }
    findings
}

fn duplicate(text: &str, rule: usize, before: usize) -> Finding {
    let message = format!(
        "rule {} says \"{text}\" under the same condition as rule {}; delete one of them",
        rule + 1,
        before + 1
    );
    Finding::new(Kind::DuplicateRule, message)
}

fn contradiction((text, rule): (&str, usize), (other, before): (&str, usize)) -> Finding {
    let message = format!(
        "rule {} says \"{text}\" under the condition under which rule {} says \"{other}\"; keep \
         one of them, or make their conditions differ",
        rule + 1,
        before + 1
    );
    Finding::new(Kind::Contradiction, message)
}

/// A text that two antecedents share if they are the same but for the order and the
/// parentheses of what `and` and `or` join, and for where a hedge of one proposition stands.
fn canonical(antecedent: &Antecedent) -> String {
    match antecedent {
        Antecedent::Is { variable, hedges, term } => {
            let own = format!("{variable:?} is {term:?}");
            hedges.iter().rev().fold(own, |of, hedge| hedged(hedge, &of))
        }
        Antecedent::Not(of) => hedged("not", &canonical(of)),
        Antecedent::Hedged { hedge, of } => hedged(hedge, &canonical(of)),
        Antecedent::And(_) | Antecedent::Or(_) => {
            let mut operands = Vec::new();
            collect(antecedent, antecedent, &mut operands);
            operands.sort_unstable();
            let word = if matches!(antecedent, Antecedent::And(_)) { "and" } else { "or" };
            format!("{word}({})", operands.join(", "))
        }
    }
}

fn hedged(hedge: &str, of: &str) -> String {
    format!("{hedge:?}({of})")
}

/// Collects what a chain joins, through chains of the same kind inside it.
fn collect(chain: &Antecedent, part: &Antecedent, operands: &mut Vec<String>) {
    match (chain, part) {
        (Antecedent::And(_), Antecedent::And(parts))
        | (Antecedent::Or(_), Antecedent::Or(parts)) => {
            parts.iter().for_each(|part| collect(chain, part, operands));
        }
        _ => operands.push(canonical(part)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::{tip, variable};
    use super::*;
    use crate::{Logic, Output, Shape};

    fn findings(rules: &str) -> Vec<(Kind, String)> {
        let terms: [(&str, Shape, &[f64]); 2] =
            [("low", Shape::Ramp, &[1.0, 0.0]), ("high", Shape::Ramp, &[0.0, 1.0])];
        let inputs = ["x", "y", "z"].map(|name| variable(name, (0.0, 1.0), &terms));
        let outputs = vec![Output::mamdani(tip()).unwrap(), Output::sugeno("p", vec![]).unwrap()];
        let rules = format!("{rules}\nif z is high then tip is cheap, p = 1");
        let system =
            System::from_text("s", inputs.into(), outputs, &rules, Logic::default()).unwrap();
        repeated(&system).into_iter().map(|found| (found.kind, found.message)).collect()
    }

    fn kinds(rules: &str) -> Vec<Kind> {
        findings(rules).into_iter().map(|(kind, _)| kind).collect()
    }

    #[test]
    fn the_order_of_what_is_joined_makes_no_difference() {
        let rules = "if x is low and (y is low or z is not very low) then tip is cheap\n\
                     if (not z is very low or y is low) and x is low then tip is cheap";
        let found = findings(rules);
        let message = "rule 2 says \"tip is cheap\" under the same condition as rule 1; delete \
                       one of them";
        assert_eq!(found, [(Kind::DuplicateRule, message.to_owned())]);
        let chains = "if (x is low and y is low) and z is low then tip is cheap\n\
                      if x is low and (z is low and y is low) then tip is cheap";
        assert_eq!(kinds(chains), [Kind::DuplicateRule]);
    }

    #[test]
    fn different_conclusions_of_one_condition_contradict_each_other() {
        let rules = "if x is low then tip is cheap and p = 2*x\n\
                     if x is low then tip is generous and p = x + x";
        let found = findings(rules);
        assert_eq!(found.len(), 2, "{found:?}");
        let message = "rule 2 says \"tip is generous\" under the condition under which rule 1 \
                       says \"tip is cheap\"; keep one of them, or make their conditions differ";
        assert_eq!(found[0], (Kind::Contradiction, message.to_owned()));
        // Both formulas are 2·x.
        assert_eq!(found[1].0, Kind::DuplicateRule);
    }

    #[test]
    fn what_differs_is_left_alone() {
        for rules in [
            "if x is low and y is low then tip is cheap\nif x is low or y is low then tip is cheap",
            "if x is low then tip is cheap\nif x is very low then tip is average",
            "if x is low then tip is cheap\nif x is low then p = 1",
            "if x is low then tip is cheap and tip is average",
            "if x is low then tip is cheap\nif x is low then tip is generous with 0",
            "if x is low and x is low then tip is cheap\nif x is low then tip is cheap",
        ] {
            assert_eq!(kinds(rules), [], "{rules}");
        }
    }
}
