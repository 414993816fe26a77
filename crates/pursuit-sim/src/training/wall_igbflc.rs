//! The iterative genetic based fuzzy logic controller that follows a wall (chapter 3).

use fuzzy_core::learn::data::DataSet;
use fuzzy_core::learn::genetic::{Elite, Gene, Genetic, Stop};
use fuzzy_core::math::{Lanes, Real};
use fuzzy_core::{Control, Inference, Rng, check};

use super::{Operators, stream};
use crate::error::Result;
use crate::game::wall_following::{WallFollowing, WallRun};
use crate::rollout::MOST_RECORDED;
use crate::strategy::{
    FuzzyRegulator, FuzzySystem, Gains, Regulator, scaled_output, thesis_system,
};
use crate::vehicle::Pose;

/// The ranges that genes are drawn from. A trapezoid has its vertices at a = x₀ + p₁, b = a + p₂,
/// c = b + p₃ and d = c + p₄ (Figure 3.5), with x₀ = −1.2, −0.8, −0.5, −0.3 and 0.2 for its five
/// terms.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | shift | p₁ | 0 to 0.2 |
/// | width | p₂, p₃ and p₄, zero or more | 0.2 to 0.4 |
/// | gain | the scaling factors | 1 to 2 |
///
/// The thesis prints none of them. All 45 widths of its Tables 3.2–3.4 lie between 0.201 and
/// 0.379, and all shifts below 0.2; the range of the scaling factors is ours.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub struct WallGeneRanges {
    pub shift: (f64, f64),
    pub width: (f64, f64),
    pub gain: (f64, f64),
}

impl Default for WallGeneRanges {
    fn default() -> Self {
        Self { shift: (0.0, 0.2), width: (0.2, 0.4), gain: (1.0, 2.0) }
    }
}

/// x₀ of the five terms of a variable.
const FEET: [f64; 5] = [-1.2, -0.8, -0.5, -0.3, 0.2];
/// Trapezoids of the two inputs and the output together.
const TRAPEZOIDS: usize = 3 * FEET.len();
const GAINS: usize = 3;
const RULES: usize = FEET.len() * FEET.len();

impl WallGeneRanges {
    /// The genes: four for each trapezoid, three scaling factors, a bit for each rule.
    fn genes(&self) -> Result<Vec<Gene>> {
        check::within("smallest width", self.width.0, "zero or more", |width| width >= 0.0)?;
        let trapezoid = [self.shift, self.width, self.width, self.width].map(Gene::from);
        let mut genes = trapezoid.repeat(TRAPEZOIDS);
        genes.extend([Gene::from(self.gain); GAINS]);
        genes.extend([Gene::Bit; RULES]);
        Ok(genes)
    }
}

/// Writes genes into the parameter vector of the controller's system, and returns the gains.
fn decode(genes: &[f64], parameters: &mut [f64]) -> Gains {
    let (trapezoids, rest) = genes.split_at(4 * TRAPEZOIDS);
    let (gains, weights) = rest.split_at(GAINS);
    let (vertices, of_rules) = parameters.split_at_mut(4 * TRAPEZOIDS);
    let feet = FEET.iter().cycle();
    for ((steps, vertices), foot) in
        trapezoids.chunks_exact(4).zip(vertices.chunks_exact_mut(4)).zip(feet)
    {
        let mut vertex = *foot;
        for (step, place) in steps.iter().zip(vertices) {
            vertex += step;
            *place = vertex;
        }
    }
    of_rules.copy_from_slice(weights);
    Gains { error: gains[0], rate: gains[1], output: gains[2] }
}

/// Settings of IGBFLC along a wall (Algorithms 3.3.1 and 3.3.2). Stage 1 tunes a fuzzy controller
/// to what an expert did; stage 2 lets both steer together, tunes the controller to their sum,
/// and is repeated.
///
/// | Name | Meaning | Default |
/// |---|---|---|
/// | population | individuals of each search, at least 4 | 40 (3.4) |
/// | iterations | generations of each search | 15 (3.4) |
/// | operators | how they breed | [`Operators::Averaging`]: the better half is kept, 16 are averages, 4 are drawn anew (3.4) |
/// | repetitions | of stage 2, at most | 2 (3.5) |
/// | until_better | whether to stop once the controller alone beats the expert | false |
/// | duration | time of each run (s) | 600 (Figures 3.8–3.13) |
/// | start | where the robot starts, x and y (m) | (0, 1.45): ours, near the −0.5 m at which the figures' axes begin |
/// | ranges | where genes are drawn from | [`WallGeneRanges`] |
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct WallIgbflcTraining {
    pub population: usize,
    pub iterations: u32,
    pub operators: Operators,
    pub repetitions: u32,
    pub until_better: bool,
    pub duration: f64,
    pub start: (f64, f64),
    pub ranges: WallGeneRanges,
}

impl Default for WallIgbflcTraining {
    fn default() -> Self {
        Self {
            population: 40,
            iterations: 15,
            operators: Operators::Averaging,
            repetitions: 2,
            until_better: false,
            duration: 600.0,
            start: (0.0, 1.45),
            ranges: WallGeneRanges::default(),
        }
    }
}

/// What came out of stage 1, or of a repetition of stage 2.
#[derive(Debug, Clone, PartialEq)]
pub struct WallStage {
    /// The tuned controller.
    pub controller: FuzzyRegulator,
    /// The least mean squared error (3.5) of each generation (rad²).
    pub fitness: Vec<f64>,
    /// ∫|e| dt of the controller alone in the run of the training (m·s); none if it got lost.
    pub iae: Option<f64>,
    /// Whether the controller alone had smaller errors than the expert, by their integral and by
    /// their mean square.
    pub beats_expert: bool,
}

/// What IGBFLC learned along a wall.
#[derive(Debug, Clone, PartialEq)]
pub struct WallTrained {
    /// Stage 1, then the repetitions of stage 2.
    pub stages: Vec<WallStage>,
    /// Which stage has the best controller: of those that beat the expert, or of all if there is
    /// none, the first with the least integral of the absolute error.
    pub best: usize,
}

impl WallTrained {
    /// The best controller.
    pub fn controller(&self) -> &FuzzyRegulator {
        &self.stages[self.best].controller
    }
}

impl WallIgbflcTraining {
    /// Learns from an expert that follows this wall.
    ///
    /// ```
    /// use fuzzy_core::Control;
    /// use pursuit_sim::training::WallIgbflcTraining;
    /// use pursuit_sim::{Pd, Regulator, Wall, WallFollowing};
    ///
    /// let plant = WallFollowing::thesis(Wall::sine()?)?;
    /// let expert = Regulator::Pd(Pd::new(1.2, 1.5)?);
    /// let training = WallIgbflcTraining { duration: 50.0, ..WallIgbflcTraining::default() };
    /// let trained = training.train(&plant, &expert, 1, &Control::new())?;
    /// assert_eq!(trained.stages.len(), 3);
    /// # Ok::<(), pursuit_sim::Error>(())
    /// ```
    pub fn train(
        &self,
        plant: &WallFollowing,
        expert: &Regulator,
        seed: u64,
        control: &Control,
    ) -> Result<WallTrained> {
        let genes = self.ranges.genes()?;
        let settings = self.operators.settings(self.population);
        let steps = self.steps(plant)?;
        let follow = |regulator: &Regulator| {
            control.check()?;
            let start = Pose { x: self.start.0, y: self.start.1, heading: 0.0 };
            plant.follow(regulator, start, steps)
        };
        let experts = follow(expert)?;
        let mut trained = WallTrained { stages: Vec::new(), best: 0 };
        for number in 0..=u64::from(self.repetitions) {
            let together = match trained.stages.last() {
                Some(stage) => {
                    let tuned = Regulator::Fuzzy(Box::new(stage.controller.clone()));
                    follow(&Regulator::Parallel(Box::new((expert.clone(), tuned))))?
                }
                None => experts.clone(),
            };
            let rng = Rng::new(seed, stream::WALL_IGBFLC + number);
            let search = Genetic::with_rng(genes.iter().copied(), settings, rng)?;
            let (controller, fitness) = self.tune(search, &together, control)?;
            let alone = follow(&Regulator::Fuzzy(Box::new(controller.clone())))?;
            let iae = if alone.lost { None } else { Some(alone.measures(0.0)?.iae) };
            let beats_expert = alone.beats(&experts)?;
            trained.add(WallStage { controller, fitness, iae, beats_expert });
            if self.until_better && number > 0 && beats_expert {
                break;
            }
        }
        Ok(trained)
    }

    /// The time steps of a run.
    fn steps(&self, plant: &WallFollowing) -> Result<u32> {
        check::positive("duration", self.duration)?;
        let steps = (self.duration / plant.time_step()).round();
        let what = "number of time steps in the duration";
        let most = f64::from(MOST_RECORDED);
        check::within(what, steps, "from 1 to 1e7", |steps| (1.0..=most).contains(&steps))?;
        Ok(steps as u32)
    }

    /// Searches for the controller that comes nearest to what was said in a run.
    fn tune(
        &self,
        mut search: Genetic,
        run: &WallRun,
        control: &Control,
    ) -> Result<(FuzzyRegulator, Vec<f64>)> {
        let seen = run.error.iter().zip(&run.rate).take(run.wanted.len());
        let points: Vec<f64> = seen.flat_map(|(&error, &rate)| [error, rate]).collect();
        let data = DataSet::new(2, &points, &run.wanted)?;
        let system = thesis_system()?;
        let mut parameters = system.parameters().to_vec();
        let mut scratch = vec![Lanes::splat(0.0); system.scratch_count()];
        let evaluate = |population: &[f64], bar: f64, fitness: &mut [f64]| -> Result<()> {
            for (genes, fitness) in
                population.chunks_exact(4 * TRAPEZOIDS + GAINS + RULES).zip(fitness)
            {
                let gains = decode(genes, &mut parameters);
                let prepared = system.prepare(&parameters);
                *fitness = data.mean_below(bar, |seen, wanted| {
                    let seen = [seen[0], seen[1]];
                    let output = scaled_output(&system, &prepared, gains, seen, &mut scratch);
                    let error = output - wanted[0];
                    error * error
                });
                control.check()?;
            }
            Ok(())
        };
        search.run_below(Stop::after(self.iterations), Elite::Remembered, control, evaluate)?;
        let mut parameters = system.parameters().to_vec();
        let gains = match search.best() {
            Some(best) => decode(&best.genes, &mut parameters),
            None => {
                let reason = "every controller's error overflows; draw smaller gains".to_owned();
                let what = "the ranges of the genes".to_owned();
                return Err(fuzzy_core::Error::Unsuitable { what, reason }.into());
            }
        };
        let system = FuzzySystem::Rules(system.with_parameters(&parameters)?);
        Ok((FuzzyRegulator::new(system, gains)?, search.history().best.clone()))
    }
}

impl WallTrained {
    fn add(&mut self, stage: WallStage) {
        self.stages.push(stage);
        let rank = |stage: &WallStage| (!stage.beats_expert, stage.iae.unwrap_or(f64::INFINITY));
        if rank(&self.stages[self.stages.len() - 1]) < rank(&self.stages[self.best]) {
            self.best = self.stages.len() - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::wall::Wall;
    use crate::strategy::Pd;

    fn expert() -> Regulator {
        Regulator::Pd(Pd::new(1.2, 1.5).unwrap())
    }

    fn plant() -> WallFollowing {
        WallFollowing::thesis(Wall::sine().unwrap()).unwrap()
    }

    fn short() -> WallIgbflcTraining {
        WallIgbflcTraining { duration: 30.0, iterations: 5, ..WallIgbflcTraining::default() }
    }

    #[test]
    fn genes_reach_their_parameters() {
        let genes = WallGeneRanges::default().genes().unwrap();
        assert_eq!(genes.len(), 60 + 3 + 25);
        let mut chromosome = vec![0.25; 88];
        chromosome[20] = 0.125;
        chromosome[60..63].copy_from_slice(&[1.0, 1.5, 2.0]);
        chromosome[63..].fill(0.0);
        chromosome[87] = 1.0;
        let mut parameters = thesis_system().unwrap().parameters().to_vec();
        let gains = decode(&chromosome, &mut parameters);
        assert_eq!(gains, Gains { error: 1.0, rate: 1.5, output: 2.0 });
        assert_eq!(parameters[4..8], [-0.8 + 0.25, -0.8 + 0.5, -0.8 + 0.75, -0.8 + 1.0]);
        assert_eq!(parameters[20], -1.2 + 0.125);
        assert_eq!(parameters[60..].iter().sum::<f64>(), 1.0);
        let system = thesis_system().unwrap().with_parameters(&parameters).unwrap();
        assert_eq!(system.rules()[24].weight, 1.0);
    }

    #[test]
    fn fitness_is_the_error_of_the_controller_that_comes_out() {
        let (training, plant) = (short(), plant());
        let start = Pose { x: 0.0, y: 1.45, heading: 0.0 };
        let run = plant.follow(&expert(), start, 300).unwrap();
        let trained = training.train(&plant, &expert(), 5, &Control::new()).unwrap();
        let stage = &trained.stages[0];
        let mut scratch = vec![0.0; stage.controller.scratch_count()];
        let errors = (0..300).map(|k| {
            stage.controller.output(run.error[k], run.rate[k], &mut scratch) - run.wanted[k]
        });
        let mse = errors.map(|error| error * error).sum::<f64>() / 300.0;
        assert!((mse - stage.fitness[4]).abs() < 1e-12 * mse, "{mse} {:?}", stage.fitness);
        assert!(stage.fitness.is_sorted_by(|a, b| a >= b));
    }

    #[test]
    fn the_best_stage_is_kept() {
        let trained = short().train(&plant(), &expert(), 3, &Control::new()).unwrap();
        let mut again = WallTrained { stages: Vec::new(), best: 0 };
        for (iae, beats_expert) in
            [(None, false), (Some(3.0), false), (Some(4.0), true), (Some(2.0), false)]
        {
            again.add(WallStage { iae, beats_expert, ..trained.stages[0].clone() });
        }
        assert_eq!(again.best, 2);
        again.stages[2].beats_expert = false;
        again.add(WallStage { iae: Some(2.0), ..trained.stages[0].clone() });
        assert_eq!(trained.controller(), &trained.stages[trained.best].controller);
    }

    #[test]
    fn the_stop_rule_ends_with_a_controller_that_beats_the_expert() {
        let training = WallIgbflcTraining {
            repetitions: 10,
            until_better: true,
            ..WallIgbflcTraining::default()
        };
        let trained = training.train(&plant(), &expert(), 1, &Control::new()).unwrap();
        let stages = &trained.stages;
        assert!(stages[trained.best].beats_expert && stages[stages.len() - 1].beats_expert);
        assert!(stages[1..stages.len() - 1].iter().all(|stage| !stage.beats_expert));
    }

    #[test]
    fn bad_settings_are_refused_and_work_stops_on_request() {
        let train = |training: WallIgbflcTraining| {
            training.train(&plant(), &expert(), 0, &Control::new()).unwrap_err().to_string()
        };
        let ranges = WallGeneRanges { width: (-0.1, 0.2), ..WallGeneRanges::default() };
        assert!(train(WallIgbflcTraining { ranges, ..short() }).contains("smallest width"));
        let ranges = WallGeneRanges { gain: (2.0, 1.0), ..WallGeneRanges::default() };
        assert!(train(WallIgbflcTraining { ranges, ..short() }).contains("gene 60"));
        let duration = f64::NAN;
        assert!(train(WallIgbflcTraining { duration, ..short() }).contains("duration"));
        assert!(train(WallIgbflcTraining { duration: 1e9, ..short() }).contains("1e7"));
        assert!(train(WallIgbflcTraining { start: (0.0, 50.0), ..short() }).contains("no wall"));
        assert!(train(WallIgbflcTraining { iterations: 0, ..short() }).contains("generations"));
        let control = Control::new();
        control.cancel();
        let stopped = short().train(&plant(), &expert(), 0, &control);
        assert_eq!(stopped, Err(fuzzy_core::Error::Cancelled.into()));
    }
}
