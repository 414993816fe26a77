//! Rules in words.

use std::collections::HashMap;

use crate::inference::{Inference, Order, System, Tsk};
use crate::output::{Method, Value};
use crate::rule::{Antecedent, Conclusion, Consequent, Name, Sentence};

/// A rule in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RuleText {
    /// The whole rule. A formula that it concludes stands in it with its present numbers.
    pub text: String,
    /// What it concludes, with the name of the output: `tip is cheap`.
    pub conclusions: Vec<(String, String)>,
}

/// The rules of a system in words, with the formulas that they brought along.
pub struct SystemWords<'a> {
    system: &'a System,
    inputs: Vec<&'a str>,
    /// The terms of each Sugeno output.
    values: HashMap<&'a str, HashMap<&'a str, &'a Value>>,
}

impl<'a> SystemWords<'a> {
    pub fn new(system: &'a System) -> Self {
        let inputs = system.interface().inputs().iter().map(|input| input.name()).collect();
        let values = system.outputs().iter().filter_map(|output| match output.method() {
            Method::Sugeno { terms, .. } => {
                let terms = terms.iter().map(|(name, value)| (&**name, value)).collect();
                Some((output.name(), terms))
            }
            _ => None,
        });
        Self { system, inputs, values: values.collect() }
    }

    /// The rule with this number, counted from 0.
    pub fn rule(&self, index: usize) -> RuleText {
        let rule = &self.system.rules()[index];
        let (outputs, texts): (Vec<String>, Vec<String>) = rule
            .conclusions
            .iter()
            .map(|conclusion| (conclusion.output.clone(), self.conclusion(index, conclusion)))
            .unzip();
        rule_text(&rule.antecedent, outputs, texts, rule.weight)
    }

    /// What the rule with this number says about an output. A formula of its own became a term
    /// that bears the rule's number, and is written out.
    pub fn conclusion(&self, rule: usize, conclusion: &Conclusion) -> String {
        let own = match &conclusion.value {
            Consequent::Term { term, .. } if is_own_formula(term, rule) => {
                self.values.get(&*conclusion.output).and_then(|terms| terms.get(&**term))
            }
            _ => None,
        };
        let Some(value) = own else { return conclusion.to_string() };
        let formula = match value {
            Value::Constant(constant) => number(*constant),
            Value::Linear(coefficients) => linear(coefficients, &self.inputs),
            Value::Formula(formula) => formula.source().to_owned(),
        };
        equation(&conclusion.output, &formula)
    }
}

/// Whether a term is the formula that the rule with this number, counted from 0, brought along.
pub fn is_own_formula(term: &str, rule: usize) -> bool {
    term.strip_prefix("rule").and_then(|number| number.parse().ok()) == Some(rule + 1)
}

/// The rule of a grid with this number, counted from 0.
pub fn tsk_rule(system: &Tsk, rule: usize) -> RuleText {
    let terms = system.rule_terms(rule);
    let names: Vec<&str> = system.inputs().iter().map(|input| input.name()).collect();
    let mut conditions: Vec<Antecedent> =
        names.iter().zip(terms).map(|(input, term)| Antecedent::is(input, term)).collect();
    let antecedent = match conditions.len() {
        1 => conditions.remove(0),
        _ => Antecedent::And(conditions),
    };
    let size = system.grid().consequent_size();
    let own = &system.consequents()[rule * size..][..size];
    let formula = match system.order() {
        Order::Zero => number(own[0]),
        Order::One => linear(own, &names),
    };
    let text = equation(system.output(), &formula);
    rule_text(&antecedent, vec![system.output().to_owned()], vec![text], 1.0)
}

fn rule_text(
    antecedent: &Antecedent,
    outputs: Vec<String>,
    conclusions: Vec<String>,
    weight: f64,
) -> RuleText {
    let text = Sentence { antecedent, conclusions: &conclusions, weight }.to_string();
    RuleText { text, conclusions: outputs.into_iter().zip(conclusions).collect() }
}

fn equation(output: &str, formula: &str) -> String {
    format!("{} = {formula}", Name(output))
}

/// `2*x - y + 0.5` from the coefficients of the inputs and then the constant.
fn linear(coefficients: &[f64], inputs: &[&str]) -> String {
    let mut text = String::new();
    for (index, &coefficient) in coefficients.iter().enumerate().filter(|(_, c)| **c != 0.0) {
        let sign = match (text.is_empty(), coefficient < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let size = coefficient.abs();
        let summand = match inputs.get(index) {
            None => number(size),
            Some(input) if size == 1.0 => Name(input).to_string(),
            Some(input) => format!("{}*{}", number(size), Name(input)),
        };
        text = text + sign + &summand;
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

/// A number in full, without a point if it is whole.
pub fn number(value: f64) -> String {
    // Adding 0 makes 0 of −0.
    let text = format!("{:?}", value + 0.0);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Shape, Variable};

    fn inputs(names: [&str; 2]) -> Vec<Variable> {
        let evenly = |name| Variable::evenly(name, (-1.0, 1.0), Shape::Triangular, &["N", "P"]);
        names.map(|name| evenly(name).unwrap()).into()
    }

    #[test]
    fn a_grid_has_rules_in_words() {
        let constants = vec![0.0, -0.25, 1.0, 1e-300];
        let system = Tsk::zero_order("s", inputs(["angle", "rate"]), constants).unwrap();
        let system = system.with_output("steering").unwrap();
        let texts: Vec<String> = (0..4).map(|rule| tsk_rule(&system, rule).text).collect();
        assert_eq!(texts[1], "if angle is N and rate is P then steering = -0.25");
        assert_eq!(texts[2], "if angle is P and rate is N then steering = 1");
        assert!(texts[3].ends_with("steering = 1e-300"));
        let conclusions = tsk_rule(&system, 2).conclusions;
        assert_eq!(conclusions, [("steering".to_owned(), "steering = 1".to_owned())]);
    }

    #[test]
    fn linear_consequents_are_formulas_that_can_be_read_again() {
        use crate::Expression;
        let names = ["x", "room temperature"];
        let coefficients = [-1.0, 2.5, -0.5];
        let text = linear(&coefficients, &names);
        assert_eq!(text, "-x + 2.5*\"room temperature\" - 0.5");
        let read = Expression::parse(&text, &names).unwrap();
        assert_eq!(read.affine().unwrap(), coefficients);
        assert_eq!(linear(&[0.0, 0.0, 0.0], &names), "0");
        assert_eq!(linear(&[0.0, 1.0, 0.0], &["x", "y"]), "y");
        let system = Tsk::new("s", inputs(["x", "y"]), Order::One, [1.0, -2.0, 0.5].repeat(4));
        assert!(tsk_rule(&system.unwrap(), 0).text.ends_with("then output = x - 2*y + 0.5"));
    }
}
