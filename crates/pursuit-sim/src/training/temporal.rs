//! Techniques that learn at every step of a game, from the temporal difference.

use fuzzy_core::learn::rl::Agent;
use fuzzy_core::{Control, Rng};

use super::duel::{Apprentice, Played, Schooling};
use super::{Technique, Trained, stream};
use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::strategy::{Controller, Player};
use crate::vehicle::Vehicle;

/// What the history of the parameters is called which would have left their bounds, if any would; a
/// number for each robot that learned.
const HELD: &str = "parameters held within their bounds";

/// A technique whose learner sits in one robot and acts while it learns.
pub(super) trait Temporal {
    /// The learner.
    type Agent: Agent;

    /// The games to learn from.
    fn schooling(&self) -> Schooling<'_>;

    /// A learner in this robot, of which it is told the name. The stream of random numbers is for
    /// what it begins with.
    fn apprentice(
        &self,
        robot: &Vehicle,
        name: &str,
        rng: &mut Rng,
    ) -> Result<Apprentice<Self::Agent>>;

    /// What was learned, without exploration.
    fn controller(&self, agent: &Self::Agent) -> Result<Controller>;

    /// How often a step was cut short so that a parameter stays within its bounds.
    fn held(&self, agent: &Self::Agent) -> u64;
}

impl<T: Temporal> Technique for T {
    fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        school(self, game, evader, seed, control)?
            .graduated(|agent| Ok((self.controller(agent)?, None, vec![self.held(agent)])))
    }

    fn train_both(
        &self,
        evader: &Self,
        game: &OneOnOne,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        school_both(self, evader, game, seed, control)?.graduated(|agents| {
            let held = vec![self.held(&agents.0), evader.held(&agents.1)];
            Ok((self.controller(&agents.0)?, Some(evader.controller(&agents.1)?), held))
        })
    }
}

/// Learners after their games.
pub(super) struct Schooled<A> {
    /// The pursuer's, or the pursuer's and the evader's.
    pub agents: A,
    pub played: Played,
    /// Whether all games were played.
    pub end: Result<()>,
}

impl<A> Schooled<A> {
    /// The learners and their games, if all were played.
    pub fn finished(self) -> Result<(A, Played)> {
        self.end.map(|()| (self.agents, self.played))
    }

    /// What was learned; an error of a divergence has it too.
    pub fn graduated(
        self,
        learned: impl FnOnce(&A) -> Result<(Controller, Option<Controller>, Vec<u64>)>,
    ) -> Result<Trained> {
        let Self { agents, played, end } = self;
        let trained = || {
            let (controller, evader, held) = learned(&agents)?;
            let learning_time = played.time();
            let mut history = played.histories();
            if held.iter().any(|&times| times > 0) {
                let held = held.into_iter().map(|times| times as f64).collect();
                history.push((HELD.to_owned(), held));
            }
            Ok(Trained { controller, evader, learning_time, history })
        };
        match end {
            Ok(()) => trained(),
            Err(error) => Err(error.keeping(trained)),
        }
    }
}

/// Lets the pursuer learn against this evader, and returns its learner.
pub(super) fn school<T: Temporal>(
    technique: &T,
    game: &OneOnOne,
    evader: &Controller,
    seed: u64,
    control: &Control,
) -> Result<Schooled<T::Agent>> {
    let schooling = technique.schooling();
    schooling.check()?;
    let mut pursuer = pursuer_of(technique, game, seed)?;
    let (mut evader, mut played) = (Player::new(evader), Played::default());
    let end = schooling.play(game, &mut (&mut pursuer, &mut evader), seed, &mut played, control);
    Ok(Schooled { agents: pursuer.agent, played, end })
}

/// A learner in the pursuer.
fn pursuer_of<T: Temporal>(
    technique: &T,
    game: &OneOnOne,
    seed: u64,
) -> Result<Apprentice<T::Agent>> {
    technique.apprentice(game.pursuer(), PURSUER, &mut Rng::new(seed, stream::FIRST_WEIGHTS))
}

/// Lets both robots learn at once, and returns their learners.
pub(super) fn school_both<T: Temporal>(
    pursuer: &T,
    evader: &T,
    game: &OneOnOne,
    seed: u64,
    control: &Control,
) -> Result<Schooled<(T::Agent, T::Agent)>> {
    let schooling = pursuer.schooling();
    schooling.check()?;
    schooling.same_as(&evader.schooling())?;
    let mut rng = Rng::new(seed, stream::FIRST_WEIGHTS + stream::EVADERS);
    let mut evader = evader.apprentice(game.evader(), EVADER, &mut rng)?;
    let mut pursuer = pursuer_of(pursuer, game, seed)?;
    let mut played = Played::default();
    let end = schooling.play(game, &mut (&mut pursuer, &mut evader), seed, &mut played, control);
    Ok(Schooled { agents: (pursuer.agent, evader.agent), played, end })
}

/// What the fuzzy systems of the robots are called.
pub(super) const PURSUER: &str = "pursuer";
pub(super) const EVADER: &str = "evader";
