//! Learners: they propose parameters, or values of actions, from what they are told.
//!
//! None of them knows a game. A learner is driven by its caller: `ask` and `tell` for populations,
//! `choose` and `learn` for rewards.

pub mod anfis;
pub mod assignment;
pub mod coupling;
pub mod data;
pub mod genetic;
mod least_squares;
pub mod recursive;
pub mod rl;
pub mod schedule;
