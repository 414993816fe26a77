//! Learning from reward.

mod agent;
mod discretiser;
mod policy;
mod q_lambda;
pub mod qlfis;
mod table_agent;
mod trace;

pub use agent::Agent;
pub use discretiser::Discretiser;
pub use policy::{epsilon_greedy, greedy};
pub use q_lambda::{QLambda, QLambdaSettings};
pub use qlfis::{NeuralActorCritic, Qlfis, TdActorCritic, TdSettings, Tune};
pub(crate) use table_agent::TableAgentState;
pub use table_agent::{TableAgent, TableAgentSettings};
pub use trace::{Trace, Traces};
