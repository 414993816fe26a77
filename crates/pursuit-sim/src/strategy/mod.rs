//! How robots steer: given strategies and learned controllers.

mod evasive_turn;
mod fuzzy;
mod mixed;
mod pd;
mod regulator;
mod table;

pub use evasive_turn::EvasiveTurn;
pub use fuzzy::FuzzyController;
pub use mixed::MixedTableController;
pub use pd::Pd;
pub use regulator::{FuzzyRegulator, FuzzySystem, Gains, Regulator, THESIS_READINGS};
pub(crate) use regulator::{scaled_output, thesis_system};
pub use table::TableController;

use fuzzy_core::inference::{Inference, TskGrid};
use fuzzy_core::math::{Numbers, Real};

use crate::observation::Observation;

/// What decides a robot's steering angle. The robot's own limit is applied afterwards.
#[derive(Debug, Clone, PartialEq)]
pub enum Controller {
    /// Steer by δ: the pursuer straight to the evader, the evader straight away from the pursuer
    /// (6.3, 6.4).
    Classical,
    /// Steer as far as the robot can to the side where δ points (4.6 as Table 4.6 has it).
    BangBang,
    /// Steer in proportion to δ and δ̇.
    Pd(Pd),
    /// Flee in two parts; for evaders.
    EvasiveTurn(EvasiveTurn),
    /// Steer as a fuzzy system of δ and δ̇ says.
    Fuzzy(Box<FuzzyController>),
    /// Look the angle up by the state that δ and δ̇ fall into.
    Table(TableController),
    /// Draw the angle by the state that both robots' δ fall into.
    MixedTable(MixedTableController),
    /// Steer by the sum of two controllers.
    Parallel(Box<(Controller, Controller)>),
}

impl Controller {
    /// Whether it works out the other robot's angle too, for which both must look along one line.
    pub fn reads_both_angles(&self) -> bool {
        match self {
            Self::MixedTable(_) => true,
            Self::Parallel(both) => both.0.reads_both_angles() || both.1.reads_both_angles(),
            _ => false,
        }
    }
}

/// A controller at work, in one game or in eight.
pub(crate) enum Player<'a, R> {
    Classical,
    BangBang,
    Pd(Pd),
    EvasiveTurn(EvasiveTurn),
    Fuzzy { grid: &'a TskGrid, controller: &'a FuzzyController, prepared: Vec<R>, scratch: Vec<R> },
    Table(&'a TableController),
    MixedTable(&'a MixedTableController),
    Parallel(Box<(Player<'a, R>, Player<'a, R>)>),
}

/// Beyond the limit of every robot (rad).
const HARD_OVER: f64 = std::f64::consts::FRAC_PI_2;

impl<'a, R: Real> Player<'a, R>
where
    [R]: Numbers<R>,
{
    pub(crate) fn new(controller: &'a Controller) -> Self {
        match controller {
            Controller::Classical => Self::Classical,
            Controller::BangBang => Self::BangBang,
            Controller::Pd(pd) => Self::Pd(*pd),
            Controller::EvasiveTurn(strategy) => Self::EvasiveTurn(*strategy),
            Controller::Fuzzy(fuzzy) => Self::fuzzy(fuzzy),
            Controller::Table(table) => Self::Table(table),
            Controller::MixedTable(table) => Self::MixedTable(table),
            Controller::Parallel(both) => {
                Self::Parallel(Box::new((Self::new(&both.0), Self::new(&both.1))))
            }
        }
    }

    pub(crate) fn fuzzy(controller: &'a FuzzyController) -> Self {
        let grid = controller.system().grid();
        let mut prepared = vec![0.0; grid.prepared_count()];
        grid.prepare(controller.system().parameters(), &mut prepared);
        Self::Fuzzy {
            grid,
            controller,
            prepared: prepared.into_iter().map(R::splat).collect(),
            scratch: vec![R::splat(0.0); grid.scratch_count()],
        }
    }

    /// Lets one lane of a fuzzy controller play with other, prepared numbers.
    pub(crate) fn set_lane(&mut self, lane: usize, numbers: &[f64]) {
        if let Self::Fuzzy { prepared, .. } = self {
            for (number, &value) in prepared.iter_mut().zip(numbers) {
                number.set_lane(lane, value);
            }
        }
    }

    /// The steering angle wanted.
    #[inline(always)]
    pub(crate) fn steer(&mut self, seen: &Observation<R>) -> R {
        match self {
            Self::Classical => seen.angle,
            Self::BangBang => {
                let (zero, most) = (R::splat(0.0), R::splat(HARD_OVER));
                R::select(seen.angle.abs().le(zero), zero, most.copysign(seen.angle))
            }
            Self::Pd(pd) => pd.output(seen.angle, seen.rate),
            Self::EvasiveTurn(strategy) => strategy.steer(seen),
            Self::Fuzzy { grid, controller, prepared, scratch } => {
                controller.steer(grid, prepared, scratch, seen)
            }
            Self::Table(table) => {
                seen.angle.zip_with(seen.rate, |angle, rate| table.steering(angle, rate))
            }
            Self::MixedTable(table) => table.steer(seen),
            Self::Parallel(both) => both.0.steer_one_of_two(seen) + both.1.steer_one_of_two(seen),
        }
    }

    /// [`steer`](Self::steer) behind a call, so that it can stand within itself.
    #[inline(never)]
    fn steer_one_of_two(&mut self, seen: &Observation<R>) -> R {
        self.steer(seen)
    }
}
