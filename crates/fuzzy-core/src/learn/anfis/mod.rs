//! ANFIS: the adaptive-network-based fuzzy inference system (Jang 1993), which fits a system to
//! samples by two steps in turn.
//!
//! - **Consequents** are found by [least squares](LeastSquares), since outputs are linear in them
//!   (2.18).
//! - **Premises**, the parameters of the inputs' membership functions, follow the gradient of the
//!   squared error (2.25–2.34): [`PremiseStep`]. After every step parameters are brought back to
//!   valid ones: widths stay positive, vertices in order.
//!
//! [`fit`] does so for many epochs and keeps the best; [`Online`] learns from one sample after the
//! other. Whatever is [`Adaptive`](crate::inference::Adaptive) can be fitted: a [`Tsk`](crate::Tsk)
//! grid of order 0 or 1, and a [`System`](crate::System) whose outputs are all Sugeno's, with
//! membership functions of any shape.

mod consequents;
mod normal;
mod online;
mod premise;
#[cfg(test)]
mod tests;
mod train;

pub use consequents::{LeastSquares, Solver};
pub use online::Online;
pub use premise::{PremiseStep, SampleOrder};
pub use train::{AnfisSettings, History, Stop, Trained, fit};
