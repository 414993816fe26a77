//! Rules such as `if food is rancid or service is not very good then tip is cheap with 0.5`.
//!
//! ```text
//! rule       = "if" antecedent "then" conclusion {("and" | ",") conclusion} ["with" number] [";"]
//! antecedent = conjunction {"or" conjunction}
//! conjunction = prefixed {"and" prefixed}
//! prefixed   = ("not" | hedge) prefixed | "(" antecedent ")" | input "is" term
//! conclusion = output "is" term | output "=" formula
//! term       = {"not" | hedge} name
//! ```
//!
//! Names are letters, digits and `_`, or anything between quotes: `"room temperature"`, where a
//! quote inside is doubled or follows a backslash. A name that is one of the words `if then and or
//! not is with` needs quotes; these words may be in large letters. A formula is an
//! [`expression`](crate::expression) over the inputs; the number behind `with` is the rule's
//! weight.
//!
//! In a text of several rules each begins on a line of its own with `if`. A line continues the one
//! before if it is indented and doesn't begin with `if`, or if a parenthesis is open. Blank lines
//! are skipped, and so is everything from `#` to the end of a line.

mod display;
mod parser;
mod table;
#[cfg(test)]
mod tests;
mod vocabulary;

use crate::check;
use crate::error::{Error, Result};
use crate::expression::Expression;
pub(crate) use display::{Hedges, Name, Sentence};
pub use parser::parse_rules;
pub use table::rule_table;
pub use vocabulary::Vocabulary;

/// The most characters of a text of rules.
pub const MAX_CHARACTERS: usize = 1_000_000;
/// The most propositions of an antecedent.
pub const MAX_PROPOSITIONS: usize = 10_000;
/// The most parentheses, hedges and `not`s around one another in an antecedent.
pub const MAX_NESTING: usize = 64;

const KEYWORDS: [&str; 7] = ["if", "then", "and", "or", "not", "is", "with"];
/// The hedge that is also a keyword, and that every vocabulary has.
const NOT: &str = "not";

/// The condition of a rule, as the tree that its text or its operators made; nothing is rearranged.
#[derive(Debug, Clone, PartialEq)]
pub enum Antecedent {
    /// `variable is hedges term`.
    Is {
        /// The input.
        variable: String,
        /// The words before the term; the last is applied first.
        hedges: Vec<String>,
        /// The input's term.
        term: String,
    },
    /// All of two or more conditions, joined from left to right.
    And(Vec<Antecedent>),
    /// Any of two or more conditions, joined from left to right.
    Or(Vec<Antecedent>),
    /// The opposite of a condition.
    Not(Box<Antecedent>),
    /// A condition whose degree a hedge changes.
    Hedged {
        /// The hedge.
        hedge: String,
        /// The condition.
        of: Box<Antecedent>,
    },
}

/// What a rule says about one output.
#[derive(Debug, Clone, PartialEq)]
pub struct Conclusion {
    /// The output.
    pub output: String,
    /// What it is.
    pub value: Consequent,
}

/// What an output is to be.
#[derive(Debug, Clone, PartialEq)]
pub enum Consequent {
    /// `is hedges term`.
    Term {
        /// The words before the term; the last is applied first.
        hedges: Vec<String>,
        /// The output's term.
        term: String,
    },
    /// `= formula` over the inputs, in their order.
    Formula(Expression),
}

/// One rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// When it fires.
    pub antecedent: Antecedent,
    /// What it says then; one or more.
    pub conclusions: Vec<Conclusion>,
    /// What its firing strength is multiplied by, from 0 to 1.
    pub weight: f64,
}

impl Rule {
    /// A rule of weight 1.
    pub fn new(antecedent: Antecedent, conclusions: Vec<Conclusion>) -> Self {
        Self { antecedent, conclusions, weight: 1.0 }
    }

    /// The rule with another weight, from 0 to 1.
    pub fn with_weight(mut self, weight: f64) -> Result<Self> {
        self.weight = check::fraction("the weight of a rule", weight)?;
        Ok(self)
    }

    /// The rule that a text means. `number` is what messages call it.
    ///
    /// ```
    /// use fuzzy_core::{Rule, Vocabulary};
    ///
    /// let food = ("food".to_owned(), vec!["rancid".to_owned(), "delicious".to_owned()]);
    /// let tip = ("tip".to_owned(), vec!["cheap".to_owned(), "generous".to_owned()]);
    /// let words = Vocabulary::new(vec![food], vec![tip], vec!["very".to_owned()])?;
    /// let rule = Rule::parse("IF (food is very delicious) THEN tip is generous", &words, 1)?;
    /// assert_eq!(rule.to_string(), "if food is very delicious then tip is generous");
    ///
    /// let error = Rule::parse("if food is rancd then tip is cheap", &words, 3).unwrap_err();
    /// let message = error.to_string();
    /// assert!(message.starts_with("rule 3, column 12: unknown term \"rancd\" of \"food\"; did you"));
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn parse(text: &str, vocabulary: &Vocabulary, number: usize) -> Result<Self> {
        parser::parse_rule(text, vocabulary, number)
    }
}

impl Antecedent {
    /// `variable is term`.
    pub fn is(variable: &str, term: &str) -> Self {
        Self::Is { variable: variable.to_owned(), hedges: Vec::new(), term: term.to_owned() }
    }

    /// Both conditions. What is an `and` already is continued, so a long chain is no deep tree.
    pub fn and(self, other: Self) -> Result<Self> {
        let mut operands = Vec::new();
        for side in [self, other] {
            match side {
                Self::And(chain) => operands.extend(chain),
                single => operands.push(single),
            }
        }
        Self::And(operands).checked()
    }

    /// Either condition. What is an `or` already is continued, so a long chain is no deep tree.
    pub fn or(self, other: Self) -> Result<Self> {
        let mut operands = Vec::new();
        for side in [self, other] {
            match side {
                Self::Or(chain) => operands.extend(chain),
                single => operands.push(single),
            }
        }
        Self::Or(operands).checked()
    }

    /// The opposite of the condition.
    #[allow(clippy::should_implement_trait)] // A result is no operator's.
    pub fn not(self) -> Result<Self> {
        Self::Not(Box::new(self)).checked()
    }

    /// The condition under a hedge.
    pub fn hedged(self, hedge: &str) -> Result<Self> {
        Self::Hedged { hedge: hedge.to_owned(), of: Box::new(self) }.checked()
    }

    /// The condition, if it is not nested too deeply.
    fn checked(self) -> Result<Self> {
        if !self.fits(MAX_NESTING) {
            let most = format!("at most {MAX_NESTING}");
            return Err(Error::wrong_shape("levels of an antecedent", most, "more"));
        }
        let count = self.propositions();
        if count > MAX_PROPOSITIONS {
            let most = format!("at most {MAX_PROPOSITIONS}");
            return Err(Error::wrong_shape("propositions of an antecedent", most, count));
        }
        Ok(self)
    }

    /// The number of its propositions.
    fn propositions(&self) -> usize {
        match self {
            Self::Is { .. } => 1,
            Self::Not(of) | Self::Hedged { of, .. } => of.propositions(),
            Self::And(operands) | Self::Or(operands) => {
                operands.iter().map(Self::propositions).sum()
            }
        }
    }

    /// Whether its text has at most so many levels of parentheses, hedges and `not`s.
    ///
    /// It looks no deeper than that.
    fn fits(&self, levels: usize) -> bool {
        let deeper = |of: &Self| levels > 0 && of.fits(levels - 1);
        match self {
            Self::Is { .. } => true,
            Self::Not(of) | Self::Hedged { of, .. } => deeper(of),
            Self::And(operands) | Self::Or(operands) => operands.iter().all(|operand| {
                if self.parenthesises(operand) { deeper(operand) } else { operand.fits(levels) }
            }),
        }
    }

    /// Whether an operand of this chain stands in parentheses.
    fn parenthesises(&self, operand: &Self) -> bool {
        match operand {
            Self::Or(_) => true,
            Self::And(_) => matches!(self, Self::And(_)),
            _ => false,
        }
    }
}
