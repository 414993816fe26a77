//! From inputs to outputs: the inference methods.

mod adaptive;
mod evaluate;
mod exact;
mod firing;
mod grid;
mod interface;
mod jacobian;
mod kernel;
mod layout;
mod parts;
mod plan;
mod rows;
mod rules;
mod sampled;
mod system;
mod tsk;
mod weighted;

pub use adaptive::Adaptive;
pub use evaluate::Inference;
pub use grid::{Fired, TskGrid};
pub use interface::{Answer, Interface, NoRuleFires, Outside};
pub use jacobian::{Tangent, Wrt};
pub use kernel::{Kernel, Parameter};
pub use layout::ConsequentSlot;
pub use parts::Parts;
pub use rules::Rules;
pub(crate) use system::all_hedges;
pub use system::{Logic, System, vocabulary};
pub(crate) use tsk::CONSTANT;
pub use tsk::{Order, Tsk};
