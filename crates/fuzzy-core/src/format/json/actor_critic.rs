//! The state of an actor-critic learner as a document.

use serde::{Deserialize, Serialize};

use super::{FORMAT, VERSION, read, write};
use crate::error::Result;
use crate::learn::rl::TdActorCritic;
use crate::learn::rl::qlfis::{ActorCriticState, SavedCritic};
use crate::rng::{Rng, RngState};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ActorCriticDocument<Made, Learned> {
    format: String,
    version: u32,
    #[serde(rename = "type")]
    kind: String,
    state: ActorCriticState<Made, Learned>,
    rng: RngState,
}

impl<C: SavedCritic> TdActorCritic<C> {
    /// The whole state of learning as a JSON document, from which it continues with the same
    /// bits: what was learned, the traces, a step that has not been learned from, and the random
    /// numbers to come.
    ///
    /// ```
    /// use fuzzy_core::learn::rl::{Agent, Qlfis, TdSettings};
    /// use fuzzy_core::{Rng, Shape, Tsk, Variable};
    ///
    /// let x = Variable::evenly("x", (-1.0, 1.0), Shape::Gaussian, &["N", "P"])?;
    /// let system = Tsk::zero_order("s", vec![x], vec![0.0, 0.5])?;
    /// let systems = std::slice::from_ref(&system);
    /// let mut agent = Qlfis::fuzzy(systems, &system, TdSettings::qlfis())?;
    /// let (mut rng, mut action) = (Rng::new(7, 0), [0.0]);
    /// agent.act(&[0.3], &mut action, &mut rng);
    /// let (mut again, mut its_rng) = Qlfis::from_json(&agent.to_json(&rng)?)?;
    /// for (agent, rng) in [(&mut agent, &mut rng), (&mut again, &mut its_rng)] {
    ///     agent.learn(1.0, &[0.2], true, rng)?;
    ///     agent.act(&[0.2], &mut action, rng);
    /// }
    /// assert_eq!(agent.to_json(&rng)?, again.to_json(&its_rng)?);
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn to_json(&self, rng: &Rng) -> Result<String> {
        write(&ActorCriticDocument {
            format: FORMAT.to_owned(),
            version: VERSION,
            kind: C::KIND.to_owned(),
            state: self.state(),
            rng: rng.state(),
        })
    }

    /// The learner and the random numbers whose state a JSON document holds.
    pub fn from_json(text: &str) -> Result<(Self, Rng)> {
        let document: ActorCriticDocument<C::Made, C::Learned> = read(text, C::KIND)?;
        Ok((Self::restored(document.state)?, Rng::from_state(document.rng)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::{Inference, Tsk};
    use crate::learn::rl::{Agent, NeuralActorCritic, Qlfis, TdSettings};
    use crate::membership::Shape;
    use crate::variable::Variable;

    fn system() -> Tsk {
        let inputs = ["x", "y"].map(|name| {
            Variable::evenly(name, (-1.0, 1.0), Shape::GaussianWidth, &["N", "Z", "P"]).unwrap()
        });
        Tsk::zero_order("s", inputs.to_vec(), (0..9).map(f64::from).collect()).unwrap()
    }

    fn live(agent: &mut impl Agent, rng: &mut Rng, steps: usize) {
        let (mut world, mut action) = (rng.clone(), [0.0]);
        for _ in 0..steps {
            let mut draw = || world.uniform_in(-1.0, 1.0);
            let (x, next, reward) = ([draw(), draw()], [draw(), draw()], draw());
            agent.act(&x, &mut action, rng);
            agent.learn(reward, &next, true, rng).unwrap();
        }
    }

    /// Whether a learner continues with the same bits, between episodes and steps and within.
    fn continues<C: SavedCritic>(mut agent: TdActorCritic<C>) {
        let (mut rng, mut action) = (Rng::new(9, 0), [0.0]);
        agent.begin_episode(3);
        live(&mut agent, &mut rng, 40);
        agent.act(&[0.2, -0.3], &mut action, &mut rng);
        let text = agent.to_json(&rng).unwrap();
        let (mut again, mut its_rng) = TdActorCritic::<C>::from_json(&text).unwrap();
        assert_eq!(again.to_json(&its_rng).unwrap(), text);
        for (agent, rng) in [(&mut agent, &mut rng), (&mut again, &mut its_rng)] {
            agent.learn(0.5, &[0.1, 0.1], true, rng).unwrap();
            live(agent, rng, 40);
            agent.begin_episode(4);
            live(agent, rng, 40);
        }
        assert_eq!(again.to_json(&its_rng).unwrap(), agent.to_json(&rng).unwrap());
        for end in (0..text.trim_end().len()).step_by(7) {
            assert!(TdActorCritic::<C>::from_json(&text[..end]).is_err());
        }
    }

    #[test]
    fn learning_continues_with_the_same_bits() {
        let (s, mut rng) = (system(), Rng::new(0, 0));
        let actors = std::slice::from_ref(&s);
        continues(Qlfis::fuzzy(actors, &s, TdSettings::qlfis()).unwrap());
        continues(Qlfis::fuzzy(actors, &s, TdSettings::fuzzy_actor_critic()).unwrap());
        continues(NeuralActorCritic::neural(actors, 5, TdSettings::neural(), &mut rng).unwrap());
    }

    #[test]
    fn states_that_cannot_be_are_refused() {
        let s = system();
        let mut agent = Qlfis::fuzzy(std::slice::from_ref(&s), &s, TdSettings::qlfis()).unwrap();
        agent.act(&[0.2, -0.3], &mut [0.0], &mut Rng::new(0, 0));
        let text = agent.to_json(&Rng::new(0, 0)).unwrap();
        let refused = |path: &str, value: serde_json::Value| {
            let mut document: serde_json::Value = serde_json::from_str(&text).unwrap();
            *document.pointer_mut(path).unwrap() = value;
            Qlfis::from_json(&document.to_string()).unwrap_err().to_string()
        };
        let short = serde_json::json!([1.0]);
        assert!(refused("/state/critic/learned/values", short.clone()).contains("21"));
        assert!(refused("/state/actors/0/learned/traces", short.clone()).contains("traces"));
        assert!(refused("/state/last/observation", short).contains("last observation"));
        assert!(refused("/state/actors", serde_json::json!([])).contains("actors"));
        let mut values = s.parameters().to_vec();
        values[1] = -1.0;
        assert!(refused("/state/critic/learned/values", values.into()).contains("positive"));
        let wrong = serde_json::json!(2.0);
        assert!(refused("/state/configuration/settings/discount", wrong).contains("discount"));
        let message = NeuralActorCritic::from_json(&text).unwrap_err().to_string();
        assert!(message.contains("fuzzy_actor_critic"), "{message}");
    }
}
