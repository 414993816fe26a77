//! Learning from reward.

mod agent;
mod discretiser;
mod policy;
mod q_lambda;
mod table_agent;
mod trace;

pub use agent::Agent;
pub use discretiser::Discretiser;
pub use policy::{epsilon_greedy, greedy};
pub use q_lambda::{QLambda, QLambdaSettings};
pub use table_agent::{TableAgent, TableAgentSettings};
pub use trace::{Trace, Traces};
