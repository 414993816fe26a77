//! Minimax-Q(λ): one table of joint actions for both robots (8.3).

use fuzzy_core::learn::rl::{Discretiser, MinimaxQ, MinimaxQSettings, Play, Ties, Trace};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Control, Error, Rng, check};

use super::duel::{Played, Players, Schooling, Views};
use super::temporal::Schooled;
use super::{Technique, Trained, stream, thesis_starts};
use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::strategy::{Controller, MixedTableController, Player};
use crate::vehicle::Vehicle;

/// Settings of minimax-Q(λ) on a grid of both robots' angles.
///
/// A state is (δ of the pursuer, δ of the evader); the table has a value for every pair of their
/// steering angles. Independent Q(λ), which the thesis compares it with, is
/// [`QLambdaTraining`](super::QLambdaTraining) in both robots.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | episodes | games played | 200 (8.3) |
/// | steps | time steps after which a game is given up | 6000 (8.3) |
/// | discount | γ | 0.5 (8.3) |
/// | trace_decay | λ | 0.3 (8.3) |
/// | learning_rate, learning_rate_decay | α = rate/iᵈᵉᶜᵃʸ in game i | 1, 0.7 (8.4) |
/// | exploration, exploration_decay | ε = rate/iᵈᵉᶜᵃʸ in game i, of each robot | 1, 1 (8.5) |
/// | points | grid points of each δ on \[−1, 1\] | 11 (8.3) |
/// | actions, evader_actions | steering angles from −u_max to u_max | 11, 21 (8.3) |
/// | play | how the greedy joint action is read | [`Play::Answer`]: the text leaves the evader's open; of the pure readings it is the one whose games are as the printed figures have them |
/// | ties | which of equally good actions | [`Ties::Random`]: with the first, nearly no game ends in a capture |
/// | bootstrap_at_capture | whether the value of the state after a capture counts | true, as in [`QLambdaTraining`](super::QLambdaTraining) |
/// | starts | positions of the evader, drawn evenly for each game | [`thesis_starts`] |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct MinimaxQTraining {
    pub episodes: u32,
    pub steps: u32,
    pub discount: f64,
    pub trace_decay: f64,
    pub learning_rate: f64,
    pub learning_rate_decay: f64,
    pub exploration: f64,
    pub exploration_decay: f64,
    pub points: usize,
    pub actions: usize,
    pub evader_actions: usize,
    pub play: Play,
    pub ties: Ties,
    pub bootstrap_at_capture: bool,
    pub starts: Vec<(f64, f64)>,
}

impl Default for MinimaxQTraining {
    fn default() -> Self {
        Self {
            episodes: 200,
            steps: 6000,
            discount: 0.5,
            trace_decay: 0.3,
            learning_rate: 1.0,
            learning_rate_decay: 0.7,
            exploration: 1.0,
            exploration_decay: 1.0,
            points: 11,
            actions: 11,
            evader_actions: 21,
            play: Play::Answer,
            ties: Ties::Random,
            bootstrap_at_capture: true,
            starts: thesis_starts(),
        }
    }
}

impl Technique for MinimaxQTraining {
    /// The table learns what the given evader does, rounded to the evader's steering angles.
    fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        let mut table = self.table(game)?;
        table.given = Some((Player::new(evader), *game.evader()));
        let schooled = self.school(table, game, seed, control)?;
        schooled.graduated(|table| Ok((table.pursuer(seed)?, None, Vec::new())))
    }

    /// One table is learned for both robots, so their settings must be the same.
    fn train_both(
        &self,
        evader: &Self,
        game: &OneOnOne,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        if self != evader {
            let what = "settings of the evader".to_owned();
            let reason = "minimax-Q learns one table for both robots; give both the same settings";
            return Err(Error::Unsuitable { what, reason: reason.to_owned() }.into());
        }
        let schooled = self.school(self.table(game)?, game, seed, control)?;
        schooled
            .graduated(|table| Ok((table.pursuer(seed)?, Some(table.evader(seed)?), Vec::new())))
    }
}

impl MinimaxQTraining {
    fn school<'a>(
        &self,
        mut table: JointTable<'a>,
        game: &OneOnOne,
        seed: u64,
        control: &Control,
    ) -> Result<Schooled<JointTable<'a>>> {
        check::at_least("episodes", self.episodes as usize, 1)?;
        let schooling =
            Schooling { episodes: self.episodes, steps: self.steps, starts: &self.starts };
        schooling.check()?;
        let mut played = Played::default();
        let end = schooling.play(game, &mut table, seed, &mut played, control);
        Ok(Schooled { agents: table, played, end })
    }

    /// A table that has learned nothing.
    fn table<'a>(&self, game: &OneOnOne) -> Result<JointTable<'a>> {
        check::at_least("actions", self.actions, 2)?;
        check::at_least("actions of the evader", self.evader_actions, 2)?;
        let axis = (-1.0, 1.0, self.points);
        let states = Discretiser::new(&[axis, axis])?;
        let steering = |robot: &Vehicle, actions: usize| {
            let most = robot.max_steering();
            Discretiser::new(&[(-most, most, actions)])
        };
        let learning = (self.learning_rate, self.learning_rate_decay);
        let learning = Schedule::power("learning rate", learning.0, learning.1)?;
        let expected = "above 0 and at most 1";
        learning.check("learning rate", expected, |rate| rate > 0.0 && rate <= 1.0)?;
        let exploring = (self.exploration, self.exploration_decay);
        Ok(JointTable {
            learner: MinimaxQ::new(MinimaxQSettings {
                states: states.states(),
                actions: self.actions,
                opponent_actions: self.evader_actions,
                discount: self.discount,
                trace_decay: self.trace_decay,
                trace: Trace::ReplacingState,
                play: self.play,
                ties: self.ties,
            })?,
            states,
            steering: (
                steering(game.pursuer(), self.actions)?,
                steering(game.evader(), self.evader_actions)?,
            ),
            schedules: (learning, Schedule::power("exploration rate", exploring.0, exploring.1)?),
            rates: (0.0, 0.0),
            bootstrap_at_capture: self.bootstrap_at_capture,
            given: None,
            last: None,
            next: None,
        })
    }
}

/// A state, and the actions of both robots in it.
type Chosen = (usize, (usize, usize));

/// A table that steers both robots; or one of them, and watches the other.
struct JointTable<'a> {
    learner: MinimaxQ,
    states: Discretiser,
    /// The steering angles of the pursuer and of the evader (rad).
    steering: (Discretiser, Discretiser),
    /// α and ε by game, and at present.
    schedules: (Schedule, Schedule),
    rates: (f64, f64),
    bootstrap_at_capture: bool,
    /// An evader that does not learn.
    given: Option<(Player<'a, f64>, Vehicle)>,
    /// What the next reward is for.
    last: Option<Chosen>,
    /// The state reached and what was chosen there.
    next: Option<Chosen>,
}

impl JointTable<'_> {
    #[inline]
    fn state(&self, seen: &Views) -> usize {
        self.states.state(&[seen.0.angle, seen.1.angle])
    }

    /// What the pursuer does without exploration.
    fn pursuer(&self, seed: u64) -> Result<Controller> {
        let mut probabilities = Vec::new();
        for state in 0..self.states.states() {
            probabilities.extend(self.learner.strategies(state)?.0);
        }
        self.controller(&self.steering.0, probabilities, Rng::new(seed, stream::STRATEGY))
    }

    /// What the evader does, whose own angle comes first.
    fn evader(&self, seed: u64) -> Result<Controller> {
        let points = self.states.axes()[0].2;
        let mut probabilities = Vec::new();
        for state in 0..self.states.states() {
            let mirrored = state % points * points + state / points;
            probabilities.extend(self.learner.strategies(mirrored)?.1);
        }
        let rng = Rng::new(seed, stream::STRATEGY + stream::EVADERS);
        self.controller(&self.steering.1, probabilities, rng)
    }

    fn controller(
        &self,
        steering: &Discretiser,
        probabilities: Vec<f64>,
        mut rng: Rng,
    ) -> Result<Controller> {
        let angles = (0..steering.states()).flat_map(|action| steering.centre(action)).collect();
        let states = self.states.clone();
        let table = MixedTableController::new(states, angles, probabilities, rng.bits())?;
        Ok(Controller::MixedTable(table))
    }
}

impl Players for JointTable<'_> {
    fn begin(&mut self, game: u64) {
        self.rates = (self.schedules.0.at(game), self.schedules.1.at(game));
        (self.last, self.next) = (None, None);
    }

    #[inline]
    fn steer(&mut self, seen: &Views, rngs: &mut [Rng; 2]) -> Result<(f64, f64)> {
        let state = self.state(seen);
        let mut chosen = match self.next.take() {
            Some((reached, chosen)) if reached == state => chosen,
            _ => self.learner.choose(state, self.rates.1, &mut rngs[0])?,
        };
        let mut given = None;
        if let Some((evader, robot)) = &mut self.given {
            let steering = robot.limit(evader.steer(&seen.1));
            chosen.1 = self.steering.1.state(&[steering]);
            given = Some(steering);
        }
        self.last = Some((state, chosen));
        let angle = |steering: &Discretiser, action| steering.coordinate(0, action);
        let evader = given.unwrap_or_else(|| angle(&self.steering.1, chosen.1));
        Ok((angle(&self.steering.0, chosen.0), evader))
    }

    #[inline]
    fn learn(
        &mut self,
        reward: f64,
        seen: &Views,
        captured: bool,
        rngs: &mut [Rng; 2],
    ) -> Result<()> {
        let reached = self.state(seen);
        // The next actions are chosen before the values change, as Algorithm 6.4.1 is printed.
        let chosen = self.learner.choose(reached, self.rates.1, &mut rngs[0])?;
        if let Some((state, actions)) = self.last.take() {
            let ahead = (!captured || self.bootstrap_at_capture).then_some(reached);
            self.learner.learn(state, actions, reward, ahead, self.rates.0)?;
        }
        self.next = Some((reached, chosen));
        Ok(())
    }
}
