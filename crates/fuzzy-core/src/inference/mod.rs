//! From inputs to outputs: the inference methods.

mod batch;
mod grid;
mod tsk;

pub use grid::TskGrid;
pub(crate) use tsk::CONSTANT;
pub use tsk::{NoRuleFires, Order, Tsk};
