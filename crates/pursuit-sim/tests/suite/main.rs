//! The tests of the crate from outside, in one program.

#![allow(clippy::unwrap_used)]

mod chapter_3;
mod chapter_4;
mod classical;
mod couplings;
mod determinism;
mod motion;
mod techniques;
mod two_pursuers;
