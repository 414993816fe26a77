//! Q_CF: a value for every coupling (section 8.5).

use fuzzy_core::learn::coupling::{CouplingTable, CouplingTableSettings, RateCount};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Control, Rng, check};

use super::robots::Robots;
use super::{CoupledRobotsTraining, CouplingTask, CouplingTechnique, Diary, LearnedCoupling};
use crate::error::Result;
use crate::reward::Closing;
use crate::rollout::ManyOutcome;
use crate::training::stream;

/// What a coupling is rewarded for: (8.30), which the scan lost.
///
/// r_total is the sum of all pursuers' rewards (8.29), f the step of the last capture, or the last
/// step if an evader got away. r_total tells how many were caught and from how far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CouplingReward {
    /// r_total/(f·T)²: of the readings tried the nearest to Tables 8.9 and 8.13.
    OverSquaredTime,
    /// r_total/f: the simplest; long distances count as much as speed.
    OverSteps,
    /// 1/f: the speed alone.
    InverseSteps,
}

impl CouplingReward {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::OverSquaredTime => "r_over_T2",
            Self::OverSteps => "r_over_f",
            Self::InverseSteps => "inv_f",
        }
    }

    /// The reward with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::OverSquaredTime, Self::OverSteps, Self::InverseSteps];
        Ok(check::named("reward of couplings", name, choices, Self::name)?)
    }

    /// r_CF for this r_total, f and T (s). A game that ends where it begins counts as one step.
    fn of(self, total: f64, steps: u32, time_step: f64) -> f64 {
        let steps = f64::from(steps.max(1));
        match self {
            Self::OverSquaredTime => total / (steps * time_step * (steps * time_step)),
            Self::OverSteps => total / steps,
            Self::InverseSteps => 1.0 / steps,
        }
    }
}

/// Settings of stage one as the thesis has it: a table Q_CF with a value for each of the n!
/// couplings.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | episodes | games played | 200 (Tables 8.7 and 8.11) |
/// | steps | time steps after which a game is given up | 600 (Tables 8.7 and 8.11) |
/// | robots | how the robots steer and learn | [`CoupledRobotsTraining`] |
/// | reward | r_CF | [`CouplingReward::OverSquaredTime`] |
/// | temperature | θ_CF, the same in all episodes | 1 (Table 8.7; Table 8.11 has 20) |
/// | learning_rate, learning_rate_decay | α = rate/kᵈᵉᶜᵃʸ | 1, 0.7 (Table 8.7) |
/// | rate_count | what k counts | visits of the coupling; the thesis has the episodes |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct CouplingTraining {
    pub episodes: u32,
    pub steps: u32,
    pub robots: CoupledRobotsTraining,
    pub reward: CouplingReward,
    pub temperature: f64,
    pub learning_rate: f64,
    pub learning_rate_decay: f64,
    pub rate_count: RateCount,
}

impl Default for CouplingTraining {
    fn default() -> Self {
        Self {
            episodes: 200,
            steps: 600,
            robots: CoupledRobotsTraining::default(),
            reward: CouplingReward::OverSquaredTime,
            temperature: 1.0,
            learning_rate: 1.0,
            learning_rate_decay: 0.7,
            rate_count: RateCount::Visits,
        }
    }
}

impl CouplingTechnique for CouplingTraining {
    fn learn(&self, task: &CouplingTask<'_>, control: &Control) -> Result<LearnedCoupling> {
        check::at_least("episodes", self.episodes as usize, 1)?;
        check::at_least("steps", self.steps as usize, 1)?;
        task.start.check(task.game)?;
        let (rate, decay) = (self.learning_rate, self.learning_rate_decay);
        let learning_rate = Schedule::power("learning rate of the couplings", rate, decay)?;
        learning_rate.check("learning rate of the couplings", "above 0 and at most 1", |rate| {
            rate > 0.0 && rate <= 1.0
        })?;
        let mut table = CouplingTable::new(CouplingTableSettings {
            size: task.game.size(),
            temperature: self.temperature,
            learning_rate,
            rate_count: self.rate_count,
        })?;
        let mut robots = Robots::new(&self.robots, task)?;
        let (mut rng, mut diary) = (Rng::new(task.seed, stream::COUPLINGS), Diary::default());
        let time_step = task.game.time_step();
        for episode in 1..=self.episodes {
            let choice = table.choose(&mut rng);
            let coupling = &table.couplings()[choice];
            let outcome = robots.play(task, coupling, episode, self.steps, control)?;
            let total = total_reward(task, &outcome)?;
            table.learn(choice, self.reward.of(total, outcome.steps(), time_step))?;
            diary.note(outcome, time_step);
        }
        let best = table.best().to_vec();
        Ok(diary.learned(best, table.values(), table.visits(), time_step))
    }
}

/// r_total of (8.29): each pair's reward is relative to its own largest gain (8.27), and sums to
/// what it gained from the first distance to the last.
fn total_reward(task: &CouplingTask<'_>, outcome: &ManyOutcome) -> Result<f64> {
    let pairs = outcome.coupling.iter().zip(&outcome.pairs).enumerate();
    pairs
        .map(|(pursuer, (&evader, played))| {
            let closing = Closing::new(&task.game.pair(pursuer, evader)?);
            Ok(closing.reward(played.first_distance, played.last_distance))
        })
        .sum()
}
