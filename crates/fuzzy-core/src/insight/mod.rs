//! Insight into fuzzy systems: why one answers what it answers, and what is odd about it.

mod conclusions;
#[cfg(test)]
mod examples;
mod explain;
mod findings;
mod gaps;
mod report;
mod sets;
mod table;
mod validate;
mod words;

pub use explain::{ExplainedInput, ExplainedOutput, ExplainedRule, Explanation};
pub use findings::{Finding, Kind};
pub use sets::Premise;
pub use words::RuleText;

use crate::error::Result;
use crate::inference::{Rules, System, Tsk};
use words::{SystemWords, tsk_rule};

/// Systems that explain their answers and tell what is odd about them.
///
/// ```
/// use fuzzy_core::{Insight, Logic, Output, Shape, System, Variable};
///
/// let speed = Variable::evenly("speed", (0.0, 10.0), Shape::Triangular, &["slow", "fast"])?;
/// let brake = Output::sugeno("brake", vec![])?;
/// let rules = "if speed is slow then brake = 0\nif speed is fast then brake = speed/10";
/// let system = System::from_text("car", vec![speed], vec![brake], rules, Logic::default())?;
///
/// let explanation = system.explain(&[8.0])?;
/// assert_eq!(explanation.rules[1].words.text, "if speed is fast then brake = 0.1*speed");
/// assert_eq!(explanation.rules[1].strength, 0.8);
/// assert!((explanation.outputs[0].parts.contributions[1] - 0.8 * 0.8).abs() < 1e-15);
/// assert!(system.validate().is_empty());
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
pub trait Insight: Rules {
    /// The rules in words.
    fn rule_texts(&self) -> Vec<RuleText>;

    /// What happens at a point.
    ///
    /// The values are those of evaluation, to the bit; where no rule fires they are what stands
    /// for the output then, or NaN where that would be an error or the output before.
    fn explain(&self, x: &[f64]) -> Result<Explanation> {
        explain::explain(self, x)
    }

    /// What is odd about the definition: what can never matter, what contradicts itself, and
    /// where no rule fires; see [`Kind`]. What looks odd may be meant, so none of it is an error.
    fn validate(&self) -> Vec<Finding>;
}

impl Insight for System {
    fn rule_texts(&self) -> Vec<RuleText> {
        let words = SystemWords::new(self);
        (0..self.rules().len()).map(|rule| words.rule(rule)).collect()
    }

    fn validate(&self) -> Vec<Finding> {
        validate::system(self)
    }
}

impl Insight for Tsk {
    fn rule_texts(&self) -> Vec<RuleText> {
        (0..self.rule_count()).map(|rule| tsk_rule(self, rule)).collect()
    }

    fn validate(&self) -> Vec<Finding> {
        validate::tsk(self)
    }
}
