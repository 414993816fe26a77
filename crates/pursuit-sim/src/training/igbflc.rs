//! The iterative genetic based fuzzy logic controller for pursuit (section 4.4).

use fuzzy_core::learn::data::DataSet;
use fuzzy_core::learn::genetic::{Elite, Genetic, SquaredError, Stop};
use fuzzy_core::{Control, Error as CoreError, Inference, Rng, Tsk};

use super::imitation::{Lesson, even_system};
use super::{Lessons, Operators, Trained, stream};
use crate::error::Result;
use crate::game::one_on_one::OneOnOne;
use crate::strategy::Controller;

/// Settings of IGBFLC for pursuit: a genetic algorithm tunes all parameters of a fuzzy
/// controller to what a PD controller does, and then to what both do in parallel.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | lessons | what is taught, and where | [`Lessons`] |
/// | iterations | generations in each stage | 100 (Table 4.3) |
/// | population | individuals | 80 (Table 4.3) |
/// | operators | how they breed | [`Operators::Modern`] |
///
/// The default operators are not the thesis's: with those, 4 of 20 seeds reach the printed capture
/// times.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct IgbflcTraining {
    pub lessons: Lessons,
    pub iterations: u32,
    pub population: usize,
    pub operators: Operators,
}

impl Default for IgbflcTraining {
    fn default() -> Self {
        Self {
            lessons: Lessons::default(),
            iterations: 100,
            population: 80,
            operators: Operators::Modern,
        }
    }
}

impl IgbflcTraining {
    /// Learns to pursue this evader.
    pub fn train(
        &self,
        game: &OneOnOne,
        evader: &Controller,
        seed: u64,
        control: &Control,
    ) -> Result<Trained> {
        let mut rng = Rng::new(seed, stream::IGBFLC);
        self.lessons.teach(game, evader, control, |lesson| self.tune(lesson, &mut rng, control))
    }

    /// The system with the least squared error (2.19), and the least error of each generation.
    fn tune(&self, lesson: &Lesson, rng: &mut Rng, control: &Control) -> Result<(Tsk, Vec<f64>)> {
        let system = even_system(lesson, 0.0, rng)?;
        let data = DataSet::new(2, &lesson.points, &lesson.targets)?;
        let error = SquaredError::new(&system, &data, |genes, parameters| {
            parameters.copy_from_slice(genes);
            true
        })?;
        let search_rng = Rng::new(rng.bits(), stream::IGBFLC);
        let settings = self.operators.settings(self.population);
        let mut search = Genetic::with_rng(ranges(&system, lesson), settings, search_rng)?;
        let stop = Stop::after(self.iterations);
        search.run_below(stop, Elite::Remembered, control, |population, bar, fitness| {
            error.evaluate_below(population, bar, fitness)
        })?;
        let best = search.best().ok_or(CoreError::OutOfOrder("no individual has an error"))?;
        Ok((error.system(&best.genes)?, search.history().best.clone()))
    }
}

/// Where genes are drawn from: means within half a step of the even ones, widths from a half to
/// one and a half of theirs, consequents within the recorded steering widened by a quarter to
/// both sides.
fn ranges(system: &Tsk, lesson: &Lesson) -> Vec<(f64, f64)> {
    let mut ranges = Vec::new();
    for input in system.inputs() {
        let (low, high) = (input.universe().low(), input.universe().high());
        let half = 0.5 * (high - low) / (input.terms().len() - 1) as f64;
        for term in input.terms() {
            let (mean, width) = (term.function.parameters()[0], term.function.parameters()[1]);
            ranges.extend([(mean - half, mean + half), (0.5 * width, 1.5 * width)]);
        }
    }
    let least = lesson.targets.iter().copied().fold(f64::MAX, f64::min);
    let most = lesson.targets.iter().copied().fold(f64::MIN, f64::max);
    let margin = 0.25 * (most - least);
    ranges.resize(system.parameters().len(), (least - margin, most + margin));
    ranges
}
