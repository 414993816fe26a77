//! Formulas that a user writes, such as `2*error + sin(rate)^2 - if(error > 0, 1, 0)`.
//!
//! ```text
//! formula  = sum [("<" | "<=" | ">" | ">=") sum]
//! sum      = product {("+" | "-") product}
//! product  = factor {("*" | "/") factor}
//! factor   = "-" factor | operand ["^" factor]
//! operand  = number | name | function "(" formula {"," formula} ")" | "(" formula ")"
//! number   = digits with or without a point, such as 1, .5 or 1e-3
//! name     = letters, digits and "_", or anything between quotes: "room temperature"
//! function = abs | sqrt | exp | ln | sin | cos | tan | atan2 | min | max | sign | if
//! ```
//!
//! White space means nothing, nor does anything from `#` to the end of a line.
//!
//! As in mathematics −x² is −(x²) and x^y^z is x^(y^z). Comparisons are 1 or 0. `if(c, a, b)` is b
//! where c is 0 and a elsewhere; `min` and `max` take two numbers or more, the other functions as
//! many as usual. The constants are `pi` and `e`, and a variable of such a name hides the constant.
//!
//! NaN and infinity go their way as IEEE 754 has it: √−1 and ln −1 are NaN, 1/0 is ∞, ln 0 is −∞,
//! 0⁰ is 1, a comparison with NaN does not hold. `min`, `max` and `if` don't hide a NaN, except in
//! the branch that `if` doesn't take.

mod affine;
mod function;
mod parser;
#[cfg(test)]
mod tests;

use crate::error::{Error, Result};
use crate::lexer::{Reader, tokens};
use crate::math::Real;
use function::Function;
pub(crate) use parser::formula;

/// The most characters of a formula.
pub const MAX_CHARACTERS: usize = 10_000;
/// The most parentheses, functions, signs and powers around one another, and the most
/// intermediate results that a formula may have to keep at a time.
pub const MAX_NESTING: usize = 64;
/// Few formulas keep more intermediate results than this.
const SMALL_STACK: usize = 8;

/// A formula over numbered variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    source: String,
    /// The formula in postfix order.
    code: Vec<Step>,
    /// The number of intermediate results that it keeps at most.
    stack: usize,
    variables: usize,
}

/// One step of a computation with a stack.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    Constant(f64),
    Variable(usize),
    /// Replaces as many numbers as the function takes by its value.
    Apply(Function),
}

impl Expression {
    /// The formula that a text means; only these variables are known.
    ///
    /// ```
    /// use fuzzy_core::Expression;
    ///
    /// let names = ["error", "room temperature"];
    /// let formula = Expression::parse("2*error + 'room temperature'^2", &names)?;
    /// assert_eq!(formula.evaluate(&[1.5, 3.0]), 12.0);
    ///
    /// let error = Expression::parse("2*eror", &["error"]).unwrap_err();
    /// let message = "formula, column 3: unknown name \"eror\"; did you mean \"error\"?";
    /// assert_eq!(error.to_string(), message);
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self> {
        if text.chars().nth(MAX_CHARACTERS).is_some() {
            return Err(Error::Expression {
                column: MAX_CHARACTERS + 1,
                reason: format!("a formula has at most {MAX_CHARACTERS} characters"),
            });
        }
        let tokens = tokens(text);
        let mut reader = Reader::new(text, &tokens);
        let parsed = formula(&mut reader, variables).and_then(|expression| match reader.peek() {
            None => Ok(expression),
            Some(_) => Err(reader.expected("an operator or the end", &[])),
        });
        parsed.map_err(|fault| Error::Expression {
            column: text[..fault.at].chars().count() + 1,
            reason: fault.reason,
        })
    }

    /// The value at a point that has one number for each variable.
    ///
    /// A variable that the point lacks is NaN.
    pub fn evaluate<R: Real>(&self, variables: &[R]) -> R {
        let value = if self.stack <= SMALL_STACK {
            self.run::<R, SMALL_STACK>(variables)
        } else {
            self.run::<R, MAX_NESTING>(variables)
        };
        // Processors differ in the sign and the payload of the NaN that they make.
        R::select(value.le(value), value, R::splat(f64::NAN))
    }

    fn run<R: Real, const STACK: usize>(&self, variables: &[R]) -> R {
        let mut stack = [R::splat(f64::NAN); STACK];
        let mut height = 0;
        for step in &self.code {
            let (first, value) = match *step {
                Step::Constant(value) => (height, R::splat(value)),
                Step::Variable(index) => {
                    (height, variables.get(index).copied().unwrap_or(R::splat(f64::NAN)))
                }
                Step::Apply(function) => {
                    let first = height - function.arity();
                    (first, function.apply(&stack[first..height]))
                }
            };
            stack[first] = value;
            height = first + 1;
        }
        stack[0]
    }

    /// The text of the formula, on one line and without comments.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// The number of variables that it was written for.
    pub fn variable_count(&self) -> usize {
        self.variables
    }
}
