//! One estimate for each pair instead of one for each coupling.

use fuzzy_core::learn::assignment::Objective;
use fuzzy_core::learn::coupling::{Exploration, PairEstimates, PairSettings};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Control, Rng, check};

use super::robots::Robots;
use super::{
    CoupledRobotsTraining, CouplingTask, CouplingTechnique, Diary, LearnedCoupling, Steering,
};
use crate::error::Result;
use crate::rollout::{Outcome, seconds};
use crate::training::stream;

/// How pairs are found out about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PairExploration {
    /// By first estimates that are lower than any capture time.
    Optimistic,
    /// By noise on the estimates.
    Softmax,
}

impl PairExploration {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Optimistic => "optimistic",
            Self::Softmax => "softmax",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::Optimistic, Self::Softmax];
        Ok(check::named("exploration of pairs", name, choices, Self::name)?)
    }
}

/// The first estimate of a pair's capture time: no capture comes earlier, whoever steers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstEstimate {
    /// (D − ℓ)/(V_p + V_e) with the first distance D: as if both drove straight at each other.
    Reach,
    /// 0: nothing is known of positions and speeds, so every pair is tried.
    Zero,
}

impl FirstEstimate {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reach => "reach",
            Self::Zero => "zero",
        }
    }

    /// The one with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        Ok(check::named("first estimate", name, [Self::Reach, Self::Zero], Self::name)?)
    }

    /// The estimates of all pairs (s).
    fn of(self, task: &CouplingTask<'_>) -> Result<Vec<f64>> {
        let size = task.game.size();
        let mut estimates = check::zeros("the estimates", size, size)?;
        if self == Self::Reach {
            for (index, estimate) in estimates.iter_mut().enumerate() {
                let (pursuer, evader) = (index / size, index % size);
                let start = task.start.pair(pursuer, evader);
                let (dx, dy) = (start.evader.x - start.pursuer.x, start.evader.y - start.pursuer.y);
                let way = dx.mul_add(dx, dy * dy).sqrt() - task.game.capture_radius();
                let robots = (&task.game.pursuers()[pursuer], &task.game.evaders()[evader]);
                *estimate = way.max(0.0) / (robots.0.speed() + robots.1.speed());
            }
        }
        Ok(estimates)
    }
}

/// Settings of pairwise learning: n² estimates of capture times, n of which are observed in every
/// episode, and an exact assignment before each.
///
/// An evader that gets away costs a time step more than the longest time. With optimistic
/// exploration, and in the coupling that is learned, as few pairs as possible go together whose
/// estimate is above the longest time. The coupling that is learned has only pairs that were tried.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | episodes, steps | as in [`CouplingTraining`](super::CouplingTraining) | 200, 600 |
/// | robots | how the robots steer and learn | [`CoupledRobotsTraining`] |
/// | objective | what is small: the last capture, or the sum of all | the bottleneck: the game ends at the last capture |
/// | exploration | how pairs are found out about | optimistic |
/// | first_estimate | of every pair | [`FirstEstimate::Reach`] |
/// | confidence | how far estimates are doubted if exploration is optimistic (s), see [`Exploration::Optimistic`]; those of robots that don't learn never, as all their games are alike | 100 |
/// | temperature, temperature_decay | of softmax: θ/mᵈᵉᶜᵃʸ in episode m (s) | 100, 0.5 |
/// | learning_rate, learning_rate_decay | α = rate/kᵈᵉᶜᵃʸ at the k-th visit of a pair | 1, 0.7, as for Q_CF |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct PairwiseTraining {
    pub episodes: u32,
    pub steps: u32,
    pub robots: CoupledRobotsTraining,
    pub objective: Objective,
    pub exploration: PairExploration,
    pub first_estimate: FirstEstimate,
    pub confidence: f64,
    pub temperature: f64,
    pub temperature_decay: f64,
    pub learning_rate: f64,
    pub learning_rate_decay: f64,
}

impl Default for PairwiseTraining {
    fn default() -> Self {
        Self {
            episodes: 200,
            steps: 600,
            robots: CoupledRobotsTraining::default(),
            objective: Objective::Bottleneck,
            exploration: PairExploration::Optimistic,
            first_estimate: FirstEstimate::Reach,
            confidence: 100.0,
            temperature: 100.0,
            temperature_decay: 0.5,
            learning_rate: 1.0,
            learning_rate_decay: 0.7,
        }
    }
}

impl CouplingTechnique for PairwiseTraining {
    fn learn(&self, task: &CouplingTask<'_>, control: &Control) -> Result<LearnedCoupling> {
        check::at_least("episodes", self.episodes as usize, 1)?;
        check::at_least("steps", self.steps as usize, 1)?;
        task.start.check(task.game)?;
        let time_step = task.game.time_step();
        let longest = seconds(self.steps, time_step);
        let (rate, decay) = (self.learning_rate, self.learning_rate_decay);
        let learning_rate = Schedule::power("learning rate of the pairs", rate, decay)?;
        learning_rate.check("learning rate of the pairs", "above 0 and at most 1", |rate| {
            rate > 0.0 && rate <= 1.0
        })?;
        let mut pairs = PairEstimates::new(PairSettings {
            first: self.first_estimate.of(task)?,
            limit: longest,
            objective: self.objective,
            exploration: match self.exploration {
                PairExploration::Optimistic if self.robots.steering == Steering::Classical => {
                    Exploration::Optimistic { confidence: 0.0 }
                }
                PairExploration::Optimistic => {
                    Exploration::Optimistic { confidence: self.confidence }
                }
                PairExploration::Softmax => {
                    Exploration::softmax(self.temperature, self.temperature_decay)?
                }
            },
            learning_rate,
        })?;
        let mut robots = Robots::new(&self.robots, task)?;
        let (mut rng, mut diary) = (Rng::new(task.seed, stream::COUPLINGS), Diary::default());
        let escape = longest + time_step;
        let cost = |played: &Outcome| played.capture_time(time_step).unwrap_or(escape);
        for episode in 1..=self.episodes {
            let coupling = pairs.choose(&mut rng)?;
            let outcome = robots.play(task, &coupling, episode, self.steps, control)?;
            let costs: Vec<f64> = outcome.pairs.iter().map(cost).collect();
            pairs.learn(&coupling, &costs)?;
            diary.note(outcome, time_step);
        }
        let best = pairs.best()?;
        Ok(diary.learned(best, pairs.estimates(), pairs.visits(), time_step))
    }
}
