//! The tests of the crate from outside, in one program: each program of its own would compile the
//! evaluation of systems again.

#![allow(clippy::unwrap_used)]

mod common;
mod expression;
mod gradient;
mod json;
mod membership;
mod memory;
mod rule_texts;
mod system;
mod system_json;
