//! Rules as text that parses to the same rules, with no more parentheses than a reader needs.

use std::fmt::{Display, Formatter, Result};

use super::{Antecedent, Conclusion, Consequent, KEYWORDS, NOT, Rule};
use crate::lexer::{is_word, quote};

/// A name with quotes if it needs them.
pub(crate) struct Name<'a>(pub &'a str);

impl Display for Name<'_> {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let keyword = KEYWORDS.iter().any(|keyword| keyword.eq_ignore_ascii_case(self.0));
        if is_word(self.0) && !keyword { f.write_str(self.0) } else { f.write_str(&quote(self.0)) }
    }
}

/// The words before a name, each with a blank behind it.
pub(crate) struct Hedges<'a>(pub &'a [String]);

impl Display for Hedges<'_> {
    fn fmt(&self, f: &mut Formatter) -> Result {
        self.0.iter().try_for_each(|hedge| match hedge.as_str() {
            NOT => write!(f, "{NOT} "),
            hedge => write!(f, "{} ", Name(hedge)),
        })
    }
}

impl Display for Antecedent {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Is { variable, hedges, term } => {
                write!(f, "{} is {}{}", Name(variable), Hedges(hedges), Name(term))
            }
            Self::And(operands) => self.chain(f, operands, " and "),
            Self::Or(operands) => self.chain(f, operands, " or "),
            Self::Not(of) => {
                f.write_str("not ")?;
                of.reached(f)
            }
            Self::Hedged { hedge, of } => {
                write!(f, "{} ", Name(hedge))?;
                of.reached(f)
            }
        }
    }
}

impl Antecedent {
    fn chain(&self, f: &mut Formatter, operands: &[Self], connective: &str) -> Result {
        operands.iter().enumerate().try_for_each(|(index, operand)| {
            if index > 0 {
                f.write_str(connective)?;
            }
            if self.parenthesises(operand) {
                write!(f, "({operand})")
            } else {
                write!(f, "{operand}")
            }
        })
    }

    /// What a hedge or `not` reaches: the parentheses show how far.
    fn reached(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Not(_) | Self::Hedged { .. } => write!(f, "{self}"),
            _ => write!(f, "({self})"),
        }
    }
}

impl Display for Conclusion {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "{} ", Name(&self.output))?;
        match &self.value {
            Consequent::Term { hedges, term } => write!(f, "is {}{}", Hedges(hedges), Name(term)),
            Consequent::Formula(formula) => write!(f, "= {}", formula.source()),
        }
    }
}

impl Display for Rule {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write_rule(f, &self.antecedent, &self.conclusions, self.weight)
    }
}

/// A rule whose conclusions are written by somebody else.
pub(crate) struct Sentence<'a> {
    pub antecedent: &'a Antecedent,
    pub conclusions: &'a [String],
    pub weight: f64,
}

impl Display for Sentence<'_> {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write_rule(f, self.antecedent, self.conclusions, self.weight)
    }
}

fn write_rule(
    f: &mut Formatter,
    antecedent: &Antecedent,
    conclusions: &[impl Display],
    weight: f64,
) -> Result {
    write!(f, "if {antecedent} then ")?;
    for (index, conclusion) in conclusions.iter().enumerate() {
        let connective = if index > 0 { " and " } else { "" };
        write!(f, "{connective}{conclusion}")?;
    }
    // Adding 0 makes 0 of −0.
    if weight == 1.0 { Ok(()) } else { write!(f, " with {:?}", weight + 0.0) }
}
