//! Learning from reward.

mod actor_critic;
mod agent;
mod bound;
mod discretiser;
mod generators;
mod matrix_game;
mod mdp;
mod minimax_q;
mod model_building;
mod policy;
mod q_lambda;
pub mod qlfis;
mod table;
mod table_agent;
mod trace;
mod trial;
mod visits;

pub use actor_critic::{ActorCritic, ActorCriticSettings};
pub use agent::Agent;
pub use bound::{Bound, Scale};
pub use discretiser::Discretiser;
pub use matrix_game::MatrixGame;
pub use mdp::{Mdp, Optimum};
pub use minimax_q::{MinimaxQ, MinimaxQSettings, Play, Strategies};
pub use model_building::{Counts, ModelBuilding, ModelBuildingSettings};
pub use policy::{
    Policy, Ties, epsilon_greedy, greedy, greedy_at_random, softmax, softmax_probabilities,
};
pub use q_lambda::{Cut, QLambda, QLambdaSettings};
pub use qlfis::{NeuralActorCritic, Qlfis, TdActorCritic, TdSettings, Tune};
pub(crate) use table_agent::TableAgentState;
pub use table_agent::{Exploring, TableAgent, TableAgentSettings};
pub use trace::{Trace, Traces};
pub use trial::{Learner, Per, Trial, TrialSettings};
pub use visits::Visits;
