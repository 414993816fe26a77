//! Explanations as tables.

use std::fmt::{Display, Formatter, Result};

use super::explain::{ExplainedOutput, Explanation};
use super::table::{Table, escaped, short};

/// The most rules that a report shows. Where there are more, those that don't fire are left out.
const MOST_RULES: usize = 20;
/// The most terms of an input that a report shows, unless they have a degree above 0.
const MOST_TERMS: usize = 9;

impl Explanation {
    /// The report as HTML, every name escaped.
    pub fn to_html(&self) -> String {
        let tables: String = self.tables().iter().map(Table::to_html).collect();
        format!("<div>\n<p><b>{}</b></p>\n{tables}</div>\n", escaped(&self.system))
    }

    fn tables(&self) -> [Table; 3] {
        [self.inputs_table(), self.rules_table(), self.outputs_table()]
    }

    fn inputs_table(&self) -> Table {
        let names = self.inputs.iter().map(|input| input.name.clone()).collect();
        let degrees = self.inputs.iter().map(|input| degrees(&input.degrees));
        let mut table = Table::default().texts("input", names);
        if self.inputs.iter().any(|input| input.given != input.value) {
            table = table.numbers("given", self.inputs.iter().map(|input| input.given));
        }
        let values = self.inputs.iter().map(|input| input.value);
        table.numbers("value", values).texts("degrees", degrees.collect())
    }

    fn rules_table(&self) -> Table {
        let mut shown = self.strongest(MOST_RULES);
        if shown.len() < self.rules.len() {
            shown.retain(|&rule| self.rules[rule].strength > 0.0);
        }
        let of_shown = |all: &[f64]| shown.iter().map(|&rule| all[rule]).collect::<Vec<f64>>();
        let texts = shown.iter().map(|&rule| self.rules[rule].words.text.clone()).collect();
        let strengths = shown.iter().map(|&rule| self.rules[rule].strength);
        let mut table = Table::default()
            .numbers("rule", shown.iter().map(|&rule| (rule + 1) as f64))
            .numbers("strength", strengths);
        for output in &self.outputs {
            let head = |what: &str| match self.outputs.len() {
                1 => what.to_owned(),
                _ => format!("{} {what}", output.name),
            };
            let columns = [
                ("share", &output.parts.shares),
                ("concludes", &output.parts.concluded),
                ("adds", &output.parts.contributions),
            ];
            for (what, numbers) in columns {
                if numbers.iter().any(|number| !number.is_nan()) {
                    table = table.numbers(&head(what), of_shown(numbers));
                }
            }
        }
        let mut table = table.texts("", texts);
        if let hidden @ 1.. = self.rules.len() - shown.len() {
            table.note = Some(format!("and {hidden} more rules, none stronger than these"));
        }
        table
    }

    fn outputs_table(&self) -> Table {
        let value = |output: &ExplainedOutput| match output.value.is_nan() {
            true => "nan".to_owned(),
            false => short(output.value),
        };
        let remark = |output: &ExplainedOutput| output.remark().unwrap_or_default();
        Table::default()
            .texts("output", self.outputs.iter().map(|output| output.name.clone()).collect())
            .texts("value", self.outputs.iter().map(value).collect())
            .texts("", self.outputs.iter().map(remark).collect())
    }

    /// The numbers of the strongest rules, in the order of the rules; of equally strong ones the
    /// first.
    pub fn strongest(&self, most: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.rules.len()).collect();
        order.sort_by(|&a, &b| self.rules[b].strength.total_cmp(&self.rules[a].strength));
        order.truncate(most);
        order.sort_unstable();
        order
    }
}

/// `cold 0, warm 0.25`; zeros of many terms are counted at the end.
fn degrees(terms: &[(String, f64)]) -> String {
    let shown = |(_, degree): &&(String, f64)| terms.len() <= MOST_TERMS || *degree > 0.0;
    let mut texts: Vec<String> = terms
        .iter()
        .filter(shown)
        .map(|(term, degree)| format!("{term} {}", short(*degree)))
        .collect();
    if let hidden @ 1.. = terms.len() - texts.len() {
        texts.push(format!("{hidden} others 0"));
    }
    texts.join(", ")
}

impl Display for Explanation {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "{}", self.system)?;
        self.tables().iter().try_for_each(|table| write!(f, "\n{table}"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Insight;
    use super::super::examples::{tip, tipper, variable};
    use crate::output::Output;
    use crate::{Logic, Outside, Shape, System};

    #[test]
    fn the_report_is_a_table() {
        let expected = "\
tipper

input    value  degrees
service      2  poor 0.41111, good 0.13534, excellent 6.6584e-7
food         1  rancid 1, delicious 0

rule   strength      share       adds
   1          1    0.79848      3.994  if service is poor or food is rancid then tip is cheap
   2    0.13534    0.20152     3.0228  if service is good then tip is average
   3  6.6584e-7  1.0531e-6  2.6222e-5  if service is excellent or food is delicious then tip is generous

output  value
tip     7.0169
";
        let text = tipper().explain(&[2.0, 1.0]).unwrap().to_string();
        assert_eq!(text, expected);
    }

    #[test]
    fn only_the_strongest_rules_are_shown() {
        let x = variable("x", (0.0, 1.0), &[("high", Shape::Ramp, &[0.0, 1.0])]);
        let rule = |k: usize| format!("if x is high then tip is cheap with {}", k as f64 / 30.0);
        let rules: Vec<String> = (1..=30).rev().map(rule).collect();
        let output = Output::mamdani(tip()).unwrap();
        let rules = rules.join("\n");
        let system =
            System::from_text("s", vec![x], vec![output], &rules, Logic::default()).unwrap();
        let explanation = system.explain(&[1.0]).unwrap();
        assert_eq!(explanation.strongest(3), [0, 1, 2]);
        let text = explanation.to_string();
        assert!(text.contains("and 10 more rules, none stronger than these"), "{text}");
        assert!(text.contains("\n  20 ") && !text.contains("\n  21 "), "{text}");
        let silent = system.explain(&[0.0]).unwrap().to_string();
        assert!(silent.contains("and 30 more rules"), "{silent}");
    }

    #[test]
    fn the_zeros_of_many_terms_are_counted() {
        let terms = |count: usize| {
            let all: Vec<(String, f64)> =
                (0..count).map(|k| (format!("t{k}"), if k == 5 { 0.25 } else { 0.0 })).collect();
            super::degrees(&all)
        };
        assert_eq!(terms(10), "t5 0.25, 9 others 0");
        assert!(terms(9).starts_with("t0 0, t1 0"));
    }

    #[test]
    fn names_are_escaped_in_html() {
        let x = variable("<x>", (0.0, 1.0), &[("a&b", Shape::Ramp, &[0.0, 1.0])]);
        let output = Output::mamdani(tip()).unwrap();
        let rules = "if \"<x>\" is \"a&b\" then tip is cheap";
        let system = System::from_text("<s>", vec![x], vec![output], rules, Logic::default());
        let html = system.unwrap().explain(&[1.0]).unwrap().to_html();
        for raw in ["<x>", "<s>", "a&b"] {
            assert!(!html.contains(raw), "{html}");
        }
        assert!(html.contains("if &quot;&lt;x&gt;&quot; is &quot;a&amp;b&quot; then"), "{html}");
    }

    #[test]
    fn what_came_is_shown_where_it_is_not_what_is_taken() {
        let text = tipper().with_outside(Outside::Clamp).explain(&[12.0, 3.0]).unwrap().to_string();
        assert!(text.contains("input    given  value  degrees\nservice     12     10  "), "{text}");
    }
}
