//! The iterative adaptive-network-based fuzzy inference system for pursuit (section 4.3).

use fuzzy_core::learn::anfis::{
    self, AnfisSettings, LeastSquares, PremiseStep, SampleOrder, Solver,
};
use fuzzy_core::learn::data::DataSet;
use fuzzy_core::{Control, Rng, Tsk, check};

use super::imitation::{Lesson, even_system};
use super::{Lessons, Trained, stream};
use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::strategy::Controller;

/// Settings of IANFIS (Algorithm 4.3.1): ANFIS tunes a fuzzy controller to what a PD controller
/// does, and then to what both do in parallel.
///
/// The consequents come from least squares (2.18) before each of the epochs' gradient sweeps,
/// sample by sample (2.25–2.34); the epoch with the least error is kept.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | lessons | what is taught, and where | [`Lessons`] |
/// | epochs | epochs in each stage, 1 at least | 30; not printed, one suffices |
/// | rate | η, the learning rate of the gradient | 0.01; not printed |
/// | ridge | what is added to the diagonal of AᵀA, which rules that never fire make singular | 0.001 |
/// | jitter | how far the first means and widths are from even ones, in widths | 0.05 |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct IanfisTraining {
    pub lessons: Lessons,
    pub epochs: u32,
    pub rate: f64,
    pub ridge: f64,
    pub jitter: f64,
}

impl Default for IanfisTraining {
    fn default() -> Self {
        Self { lessons: Lessons::default(), epochs: 30, rate: 0.01, ridge: 1e-3, jitter: 0.05 }
    }
}

impl IanfisTraining {
    /// Learns to pursue this evader.
    pub fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        check::within("jitter", self.jitter, "from 0 to below 1", |j| (0.0..1.0).contains(&j))?;
        let mut rng = Rng::new(seed, stream::IANFIS);
        self.lessons.teach(game, evader, control, |lesson| self.tune(lesson, &mut rng, control))
    }

    /// The system after the best epoch, and the mean squared error of each.
    fn tune(&self, lesson: &Lesson, rng: &mut Rng, control: &Control) -> Result<(Tsk, Vec<f64>)> {
        let system = even_system(lesson, self.jitter, rng)?;
        let data = DataSet::new(2, &lesson.points, &lesson.targets)?;
        let settings = AnfisSettings {
            epochs: self.epochs,
            consequents: Some(LeastSquares { ridge: self.ridge, solver: Solver::Cholesky }),
            premise: PremiseStep::Sequential { rate: self.rate, order: SampleOrder::Shuffled },
            patience: None,
            seed: rng.bits(),
        };
        let trained = anfis::fit(&system, &data, None, &settings, control)?;
        if let anfis::Stop::Cancelled = trained.stopped {
            return Err(fuzzy_core::Error::Cancelled.into());
        }
        let errors = trained.history.training.iter().map(|error| error * error).collect();
        Ok((trained.system, errors))
    }
}
