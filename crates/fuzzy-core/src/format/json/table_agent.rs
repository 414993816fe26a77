//! The state of a [`TableAgent`] as a document.

use serde::{Deserialize, Serialize};

use super::{FORMAT, VERSION, read, write};
use crate::error::{Error, Result};
use crate::learn::rl::{
    Cut, Discretiser, Exploring, TableAgent, TableAgentSettings, TableAgentState, Trace,
};
use crate::learn::schedule::Schedule;
use crate::rng::{Rng, RngState};

const TABLE_AGENT: &str = "table_agent";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TableAgentDocument {
    format: String,
    version: u32,
    #[serde(rename = "type")]
    kind: String,
    state: Whole,
    rng: RngState,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Whole {
    /// What must be the same for learning to continue.
    configuration: Configuration,
    learned: TableAgentState,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Configuration {
    states: Vec<(f64, f64, usize)>,
    actions: Vec<Vec<f64>>,
    discount: f64,
    trace_decay: f64,
    trace: String,
    cut: String,
    learning_rate: Schedule,
    #[serde(default = "epsilon_greedy")]
    exploring: String,
    exploration: Schedule,
}

/// What documents without the field mean.
fn epsilon_greedy() -> String {
    Exploring::EpsilonGreedy.name().to_owned()
}

impl TableAgent {
    /// The whole state of learning as a JSON document, from which it continues with the same
    /// bits: the values, the traces, a step that has not been learned from, and the random
    /// numbers to come.
    pub fn to_json(&self, rng: &Rng) -> Result<String> {
        let settings = self.settings();
        write(&TableAgentDocument {
            format: FORMAT.to_owned(),
            version: VERSION,
            kind: TABLE_AGENT.to_owned(),
            state: Whole {
                configuration: Configuration {
                    states: settings.states.axes(),
                    actions: settings.actions.clone(),
                    discount: settings.discount,
                    trace_decay: settings.trace_decay,
                    trace: settings.trace.name().to_owned(),
                    cut: settings.cut.name().to_owned(),
                    learning_rate: settings.learning_rate,
                    exploring: settings.exploring.name().to_owned(),
                    exploration: settings.exploration,
                },
                learned: self.state(),
            },
            rng: rng.state(),
        })
    }

    /// The agent and the random numbers whose state a JSON document holds.
    pub fn from_json(text: &str) -> Result<(Self, Rng)> {
        let document: TableAgentDocument = read(text, TABLE_AGENT)?;
        let made = document.state.configuration;
        // A document claims no more memory than its text has: the table is as large as its values.
        let states = Discretiser::new(&made.states)?;
        let pairs = states.states().checked_mul(made.actions.len());
        if pairs != Some(document.state.learned.pairs()) {
            let expected = format!("{} states × {} actions", states.states(), made.actions.len());
            let came = document.state.learned.pairs();
            return Err(Error::wrong_shape("values of the table", expected, came));
        }
        let agent = Self::new(TableAgentSettings {
            states,
            actions: made.actions,
            discount: made.discount,
            trace_decay: made.trace_decay,
            trace: Trace::from_name(&made.trace)?,
            cut: Cut::from_name(&made.cut)?,
            learning_rate: made.learning_rate,
            exploring: Exploring::from_name(&made.exploring)?,
            exploration: made.exploration,
        })?;
        Ok((agent.restored(document.state.learned)?, Rng::from_state(document.rng)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::rl::Agent;

    fn agent() -> TableAgent {
        TableAgent::new(TableAgentSettings {
            states: Discretiser::new(&[(-1.0, 1.0, 5)]).unwrap(),
            actions: vec![vec![-0.3], vec![0.1], vec![0.3]],
            discount: 0.9,
            trace_decay: 0.8,
            trace: Trace::ReplacingState,
            cut: Cut::Never,
            learning_rate: Schedule::power("learning rate", 0.5, 0.7).unwrap(),
            exploring: Exploring::Softmax,
            exploration: Schedule::power("exploration rate", 0.3, 0.1).unwrap(),
        })
        .unwrap()
    }

    fn live(agent: &mut TableAgent, rng: &mut Rng) {
        let (mut x, mut action) = (0.9_f64, [0.0]);
        for _ in 0..30 {
            agent.act(&[x], &mut action, rng);
            x = (x + action[0]).clamp(-1.0, 1.0);
            agent.learn(-x.abs(), &[x], true, rng).unwrap();
        }
    }

    #[test]
    fn learning_continues_with_the_same_bits() {
        let (mut agent, mut rng) = (agent(), Rng::new(3, 0));
        agent.begin_episode(2);
        live(&mut agent, &mut rng);
        agent.act(&[0.1], &mut [0.0], &mut rng);
        let text = agent.to_json(&rng).unwrap();
        let (mut again, mut its_rng) = TableAgent::from_json(&text).unwrap();
        for (agent, rng) in [(&mut agent, &mut rng), (&mut again, &mut its_rng)] {
            agent.learn(1.0, &[0.2], true, rng).unwrap();
            live(agent, rng);
        }
        assert_eq!(again.to_json(&its_rng).unwrap(), agent.to_json(&rng).unwrap());
    }

    #[test]
    fn states_that_cannot_be_are_refused() {
        let text = agent().to_json(&Rng::new(0, 0)).unwrap();
        let refused = |path: &str, value: serde_json::Value| {
            let mut document: serde_json::Value = serde_json::from_str(&text).unwrap();
            *document.pointer_mut(path).unwrap() = value;
            TableAgent::from_json(&document.to_string()).unwrap_err().to_string()
        };
        assert!(refused("/state/learned/values", [0.0].into()).contains("values of the table"));
        assert!(refused("/state/learned/traces", serde_json::json!([[15, 1.0]])).contains("15"));
        assert!(refused("/state/learned/last", serde_json::json!([5, 0])).contains("below 5"));
        assert!(refused("/state/learned/next", serde_json::json!([0, 3])).contains("below 3"));
    }
}
