//! Learning from an expert: what it does, and what the learner is to do (Algorithms 4.3.1, 4.4.1).

use fuzzy_core::{Control, Inference, NoRuleFires, Rng, Shape, Tsk, Variable, check};

use super::{Trained, check_starts};
use crate::error::Result;
use crate::game::one_on_one::{OneOnOne, Start};
use crate::observation::Observation;
use crate::rollout::{MOST_RECORDED, drive, seconds};
use crate::strategy::{Controller, FuzzyController, Pd, Player};

/// What the learner is to do in stage 2, while it steers in parallel with the expert.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// What both together did: the learner is to replace both, with about twice the gain of the
    /// expert. This is what makes it better than the expert.
    Sum,
    /// What the expert did: the learner stays like it.
    Expert,
}

impl Target {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sum => "sum",
            Self::Expert => "expert",
        }
    }

    /// The target with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::Sum, Self::Expert];
        Ok(check::named("target of stage 2", name, choices, Self::name)?)
    }
}

/// What the learner is taught, and where.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | expert | gains K_p and K_d (s) of the PD controller that teaches | 0.99, 0.02 (4.8) |
/// | starts | positions of the evader (m), one game each | those of Table 4.6 and their mirror images |
/// | steps | time steps after which a game is given up; at most 10⁷ in all games together | 600 |
/// | repetitions | how often stage 2 is done | 1 (Algorithm 4.3.1) |
/// | target | what is learned in stage 2 | [`Target::Sum`] |
///
/// Without the mirror images δ never goes below −0.02 rad: the learner hardly sees an evader to
/// its right.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct Lessons {
    pub expert: (f64, f64),
    pub starts: Vec<(f64, f64)>,
    pub steps: u32,
    pub repetitions: u32,
    pub target: Target,
}

impl Default for Lessons {
    fn default() -> Self {
        let table_4_6 = [(3.0, 3.0), (-2.0, 4.0), (2.0, 5.0), (-1.0, 5.0)];
        let mirrored = table_4_6.map(|(x, y): (f64, f64)| (x, -y));
        Self {
            expert: (0.99, 0.02),
            starts: [table_4_6, mirrored].concat(),
            steps: 600,
            repetitions: 1,
            target: Target::Sum,
        }
    }
}

impl Lessons {
    /// An expert at work in this game, or what does not fit.
    fn school<'a>(&'a self, game: &'a OneOnOne, evader: &'a Controller) -> Result<School<'a>> {
        check::at_least("steps", self.steps as usize, 1)?;
        check_starts(&self.starts)?;
        let most = f64::from(self.steps) * self.starts.len() as f64;
        check::within("samples of a lesson, starts times steps", most, "at most 1e7", |samples| {
            samples <= f64::from(MOST_RECORDED)
        })?;
        Ok(School { lessons: self, game, expert: Pd::new(self.expert.0, self.expert.1)?, evader })
    }

    /// Stage 1, and stage 2 as often as it is to be repeated: after each lesson `tune` makes a
    /// controller from it, and says how the tuning went.
    pub(super) fn teach(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        control: &Control,
        mut tune: impl FnMut(&Lesson) -> Result<(Tsk, Vec<f64>)>,
    ) -> Result<Trained> {
        let school = self.school(game, evader)?;
        let mut learning_time = 0.0;
        let mut history = Vec::new();
        let mut learner: Option<FuzzyController> = None;
        for repetition in 0..=self.repetitions {
            let lesson = school.record(learner.as_ref(), control)?;
            learning_time += lesson.time;
            let (tuned, errors) = tune(&lesson)?;
            learner = Some(FuzzyController::new(tuned, f64::INFINITY, f64::INFINITY)?);
            let stage = if repetition == 0 { "1".to_owned() } else { format!("2.{repetition}") };
            history.push((format!("stage {stage}: mean squared error"), errors));
        }
        // There is a learner: stage 1 is not repeated, it is always done.
        let learner = learner.ok_or(fuzzy_core::Error::OutOfOrder("no stage was done"))?;
        Ok(Trained {
            controller: Controller::Fuzzy(Box::new(learner)),
            evader: None,
            learning_time,
            history,
        })
    }
}

/// An expert at work.
struct School<'a> {
    lessons: &'a Lessons,
    game: &'a OneOnOne,
    expert: Pd,
    evader: &'a Controller,
}

/// What was recorded.
#[derive(Debug, Default)]
pub(super) struct Lesson {
    /// δ and δ̇, sample by sample.
    pub points: Vec<f64>,
    /// The steering that the learner is to give, not held within the robot's limit.
    pub targets: Vec<f64>,
    /// The time played (s).
    pub time: f64,
}

impl School<'_> {
    /// Lets the expert pursue from every start, with the learner in parallel if there is one.
    ///
    /// The steering is recorded as the controllers say it. Held within the robot's limit it would
    /// teach that small and large errors want the same.
    fn record(&self, learner: Option<&FuzzyController>, control: &Control) -> Result<Lesson> {
        let mut lesson = Lesson::default();
        for &(x, y) in &self.lessons.starts {
            let mut partner = learner.map(Player::<f64>::fuzzy);
            let steer = |seen: &_| self.steer(&mut partner, seen, &mut lesson);
            let (start, mut evader) = (Start::evader_at(x, y), Player::new(self.evader));
            let outcome = drive(self.game, steer, &mut evader, start, self.lessons.steps, |_| ())?;
            lesson.time += seconds(outcome.steps, self.game.time_step());
            control.advance(1)?;
        }
        Ok(lesson)
    }

    /// The expert's steering, with its partner's if there is one; and a sample of the lesson.
    fn steer(
        &self,
        partner: &mut Option<Player<'_, f64>>,
        seen: &Observation,
        lesson: &mut Lesson,
    ) -> f64 {
        let alone = self.expert.output(seen.angle, seen.rate);
        let both = partner.as_mut().map_or(alone, |partner| alone + partner.steer(seen));
        lesson.points.extend([seen.angle, seen.rate]);
        lesson.targets.push(match self.lessons.target {
            Target::Sum => both,
            Target::Expert => alone,
        });
        both
    }
}

/// The terms of each input (Table 4.1).
const TERMS: [&str; 5] = ["HN", "LN", "Z", "LP", "HP"];

/// A system of δ and δ̇ with five Gaussians each, evenly over what the lesson has of them, and the
/// consequents of Table 4.2. It steers straight ahead where no rule fires.
///
/// Means and widths differ from even ones by up to `jitter` widths, as `rng` draws them.
pub(super) fn even_system(lesson: &Lesson, jitter: f64, rng: &mut Rng) -> Result<Tsk> {
    let variable = |name: &str, input: usize| -> Result<Variable> {
        let values = || lesson.points.iter().skip(input).step_by(2).copied();
        let (low, high) = (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max));
        if low >= high {
            return Err(constant(name, low));
        }
        Ok(Variable::evenly(name, (low, high), Shape::GaussianWidth, &TERMS)?)
    };
    let inputs = vec![variable("angle", 0)?, variable("rate", 1)?];
    let system = Tsk::zero_order("pursuer", inputs, table_4_2())?
        .with_output("steering")?
        .when_no_rule_fires(NoRuleFires::Value(0.0))?;
    let mut parameters = system.parameters().to_vec();
    for gaussian in parameters[..system.grid().first_consequent()].chunks_exact_mut(2) {
        let width = gaussian[1];
        gaussian.iter_mut().for_each(|p| *p += jitter * width * rng.uniform_in(-1.0, 1.0));
    }
    Ok(system.with_parameters(&parameters)?)
}

/// The first consequents (rad): a fifth for each step from HN to HP, of both inputs together.
fn table_4_2() -> Vec<f64> {
    (0..5).flat_map(|i| (0..5).map(move |j| 0.2 * f64::from(i + j - 4))).collect()
}

fn constant(input: &str, value: f64) -> crate::error::Error {
    fuzzy_core::Error::Unsuitable {
        what: format!("what the expert saw as \"{input}\""),
        reason: format!("it is {value} in every sample; let it play from more starts"),
    }
    .into()
}
