//! The technique of Dai et al. as section 7.3.1 compares it: a neural critic.

use fuzzy_core::Rng;
use fuzzy_core::learn::rl::NeuralActorCritic;

use super::QlfisTraining;
use super::duel::{Apprentice, Schooling};
use super::temporal::Temporal;
use crate::error::Result;
use crate::strategy::Controller;
use crate::vehicle::Vehicle;

/// Settings of a fuzzy actor whose critic is a network of three layers, after Dai et al.
///
/// The network reads δ, δ̇ and the steering angle, now and one step before, and a constant: the
/// thesis says 7-21-1 without saying what the seven are.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | hidden | units of the hidden layer | 21 (7.3.1) |
/// | learning | everything else | as [`QlfisTraining`] (7.3.1), but σₙ = 0.1/i, and η from 0.01 to 0.001: with QLFIS's η the network diverges |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct DaiTraining {
    pub hidden: usize,
    pub learning: QlfisTraining,
}

impl Default for DaiTraining {
    fn default() -> Self {
        let learning = QlfisTraining {
            critic_rate: (0.01, 0.001),
            noise: 0.1,
            noise_decay: 1.0,
            ..QlfisTraining::default()
        };
        Self { hidden: 21, learning }
    }
}

impl Temporal for DaiTraining {
    type Agent = NeuralActorCritic;

    fn schooling(&self) -> Schooling<'_> {
        self.learning.schooling()
    }

    fn apprentice(
        &self,
        robot: &Vehicle,
        name: &str,
        rng: &mut Rng,
    ) -> Result<Apprentice<NeuralActorCritic>> {
        let actor = [self.learning.first_actor(robot, name)?];
        let settings = self.learning.settings()?;
        let agent = NeuralActorCritic::neural(&actor, self.hidden, settings, rng)?;
        self.learning.seat(agent, actor)
    }

    fn controller(&self, agent: &NeuralActorCritic) -> Result<Controller> {
        let actor = agent.actors()?.swap_remove(0);
        Ok(Controller::Fuzzy(Box::new(self.learning.limited(actor)?)))
    }

    fn held(&self, agent: &NeuralActorCritic) -> u64 {
        agent.held()
    }
}
