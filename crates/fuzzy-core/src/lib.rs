//! Fuzzy systems and the learners that tune them.
//!
//! A fuzzy system is an immutable definition plus one flat vector of parameters. Inference takes
//! both by shared reference, allocates nothing and is deterministic to the bit, one point at a
//! time or eight in lock-step; learners propose new vectors.
//!
//! ```
//! use fuzzy_core::{MembershipFunction, Tsk, Variable};
//!
//! let speed = Variable::new("speed", 0.0, 10.0)?
//!     .with_term("slow", MembershipFunction::triangular(0.0, 0.0, 10.0)?)?
//!     .with_term("fast", MembershipFunction::triangular(0.0, 10.0, 10.0)?)?;
//! let brake = Tsk::zero_order("brake", vec![speed], vec![0.0, 1.0])?;
//! assert_eq!(brake.evaluate(&[2.5])?, 0.25);
//! # Ok::<(), fuzzy_core::Error>(())
//! ```

// Without fused multiply-add in hardware the lanes would round twice where scalars round once.
#[cfg(not(any(target_feature = "fma", target_arch = "aarch64", doc)))]
compile_error!(
    "fuzzyrs needs fused multiply-add. On x86-64 build for x86-64-v3: keep .cargo/config.toml, or \
     pass RUSTFLAGS=\"-C target-cpu=x86-64-v3\""
);

pub mod check;
pub mod control;
pub mod error;
pub mod expression;
pub mod format;
pub mod hedge;
pub mod inference;
pub mod insight;
pub mod learn;
mod lexer;
pub mod math;
pub mod membership;
pub mod norm;
pub mod output;
pub mod parallel;
pub mod parametric;
pub mod rng;
pub mod rule;
pub mod variable;

pub use control::Control;
pub use error::{Error, Result};
pub use expression::Expression;
pub use hedge::Hedge;
pub use inference::{Inference, Logic, NoRuleFires, Order, Outside, Rules, System, Tsk};
pub use insight::{Explanation, Finding, Insight};
pub use membership::{MembershipFunction, Shape};
pub use output::Output;
pub use rng::{Rng, RngState};
pub use rule::{Antecedent, Conclusion, Consequent, Rule, Vocabulary, parse_rules, rule_table};
pub use variable::{Term, Universe, Variable};
