//! Rules from a table, as control books print them.

use super::{Antecedent, Conclusion, Consequent, Rule};
use crate::error::{Error, Result};
use crate::variable::Variable;

/// One rule for each combination of the inputs' terms that has a conclusion: "if x is a and y is
/// b then output is c". The table is flat, with the last input's term changing fastest.
///
/// ```
/// use fuzzy_core::{Shape, Variable, rule_table};
///
/// let x = Variable::evenly("x", (-1.0, 1.0), Shape::Triangular, &["N", "P"])?;
/// let y = Variable::evenly("y", (-1.0, 1.0), Shape::Triangular, &["N", "P"])?;
/// let rules = rule_table(&[x, y], "u", &[Some("down"), None, Some("stay"), Some("up")])?;
/// assert_eq!(rules.len(), 3);
/// assert_eq!(rules[1].to_string(), "if x is P and y is N then u is stay");
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
pub fn rule_table(
    inputs: &[Variable],
    output: &str,
    conclusions: &[Option<&str>],
) -> Result<Vec<Rule>> {
    let counts = inputs.iter().map(|input| input.terms().len());
    let cells = counts.clone().try_fold(1, |product: usize, count| product.checked_mul(count));
    if cells != Some(conclusions.len()) || inputs.is_empty() {
        let shape = counts.map(|count| count.to_string()).collect::<Vec<_>>().join(" × ");
        let what = "conclusions of the rule table";
        return Err(Error::wrong_shape(what, shape, conclusions.len()));
    }
    let mut rules = Vec::new();
    for (cell, term) in conclusions.iter().enumerate() {
        let Some(term) = term else { continue };
        let value = Consequent::Term { hedges: Vec::new(), term: (*term).to_owned() };
        let conclusion = Conclusion { output: output.to_owned(), value };
        rules.push(Rule::new(antecedent(inputs, cell), vec![conclusion]));
    }
    Ok(rules)
}

/// All of the terms that meet in a cell.
fn antecedent(inputs: &[Variable], cell: usize) -> Antecedent {
    let mut rest = cell;
    let mut parts = Vec::with_capacity(inputs.len());
    for input in inputs.iter().rev() {
        let terms = input.terms();
        parts.push(Antecedent::is(input.name(), &terms[rest % terms.len()].name));
        rest /= terms.len();
    }
    parts.reverse();
    match parts.pop() {
        Some(only) if parts.is_empty() => only,
        Some(last) => {
            parts.push(last);
            Antecedent::And(parts)
        }
        None => Antecedent::And(parts),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;

    #[test]
    fn cells_follow_the_grid() {
        let x = Variable::evenly("x", (0.0, 1.0), Shape::Triangular, &["a", "b"]).unwrap();
        let y = Variable::evenly("y", (0.0, 1.0), Shape::Triangular, &["c", "d", "e"]).unwrap();
        let cells = ["1", "2", "3", "4", "5", "6"].map(Some);
        let rules = rule_table(&[x.clone(), y.clone()], "u", &cells).unwrap();
        assert_eq!(rules[4].to_string(), "if x is b and y is d then u is \"5\"");
        let one = rule_table(std::slice::from_ref(&x), "u", &cells[..2]).unwrap();
        assert_eq!(one[1].to_string(), "if x is b then u is \"2\"");
        let message = rule_table(&[x, y], "u", &cells[..5]).unwrap_err().to_string();
        assert_eq!(message, "conclusions of the rule table: expected 2 × 3, got 5");
        assert!(rule_table(&[], "u", &[Some("a")]).is_err());
    }
}
