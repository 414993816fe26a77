//! Samples to be fitted, and fitting a system to them by a genetic algorithm.

use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::inference::{Inference, Interface, Order, Tsk, TskGrid};
use crate::learn::genetic::{Elite, Genetic, GeneticSettings};
use crate::math::{LANES, Lanes, Real};

/// Pairs of an input vector and the wanted outputs, laid out for evaluation eight at a time.
#[derive(Debug, Clone)]
pub struct DataSet {
    inputs: usize,
    outputs: usize,
    points: Vec<Lanes>,
    targets: Vec<Lanes>,
    count: usize,
}

/// Eight samples in lanes.
#[derive(Debug, Clone, Copy)]
pub struct Eight<'a> {
    /// The inputs.
    pub x: &'a [Lanes],
    /// The wanted outputs.
    pub targets: &'a [Lanes],
    /// The number of the first sample.
    pub first: usize,
    /// How many lanes have samples of their own; the last sample fills the others.
    pub used: usize,
}

impl DataSet {
    /// The samples whose inputs are the rows of `points`, with one target each.
    pub fn new(inputs: usize, points: &[f64], targets: &[f64]) -> Result<Self> {
        Self::with_outputs(inputs, points, 1, targets)
    }

    /// The samples whose inputs are the rows of `points` and whose targets, one for each of the
    /// outputs, are the rows of `targets`.
    pub fn with_outputs(
        inputs: usize,
        points: &[f64],
        outputs: usize,
        targets: &[f64],
    ) -> Result<Self> {
        check::at_least("inputs of the samples", inputs, 1)?;
        check::at_least("outputs of the samples", outputs, 1)?;
        let count = targets.len() / outputs;
        check::at_least("samples", count, 1)?;
        check::same_length(
            "numbers in the targets of the samples",
            count * outputs,
            targets.len(),
        )?;
        check::same_length("numbers in the inputs of the samples", count * inputs, points.len())?;
        check::all_finite("inputs of the samples", points)?;
        check::all_finite("targets of the samples", targets)?;
        let blocks = count.div_ceil(LANES);
        // The last sample also fills the lanes left over; the error ignores them.
        let sample = |block: usize, lane: usize| (block * LANES + lane).min(count - 1);
        let lanes = |block: usize, number: &dyn Fn(usize) -> f64| {
            Lanes::new(std::array::from_fn(|lane| number(sample(block, lane))))
        };
        let lay_out = |rows: &[f64], width: usize| {
            let column = |block, k| lanes(block, &|row| rows[row * width + k]);
            let block = |block| (0..width).map(move |k| (block, k));
            (0..blocks).flat_map(block).map(|(block, k)| column(block, k)).collect()
        };
        let (points, targets) = (lay_out(points, inputs), lay_out(targets, outputs));
        Ok(Self { inputs, outputs, points, targets, count })
    }

    /// The number of inputs.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// The number of targets of each sample.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// The samples in their order, eight at a time.
    pub fn eights(&self) -> impl ExactSizeIterator<Item = Eight<'_>> {
        let blocks = self.points.chunks_exact(self.inputs);
        let blocks = blocks.zip(self.targets.chunks_exact(self.outputs)).enumerate();
        blocks.map(|(block, (x, targets))| {
            let first = block * LANES;
            Eight { x, targets, first, used: (self.count - first).min(LANES) }
        })
    }

    /// The inputs of the sample with this number, which must be below [`len`](Self::len).
    pub fn point(&self, row: usize) -> Vec<f64> {
        let block = &self.points[row / LANES * self.inputs..][..self.inputs];
        block.iter().map(|x| x.to_array()[row % LANES]).collect()
    }

    /// The samples as a system takes them in: an error about the first input that it refuses,
    /// else a copy with inputs brought into their universes where it asks for that.
    pub fn admitted(mut self, interface: &Interface) -> Result<Self> {
        check::same_length("inputs of the samples", interface.inputs().len(), self.inputs)?;
        for row in 0..self.count {
            interface.check_rows(&self.point(row), Some(row))?;
        }
        self.points.chunks_exact_mut(self.inputs).for_each(|x| interface.admit(x));
        Ok(self)
    }

    /// The number of samples.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none; never, since an empty set cannot be made.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Nothing, or the error of the first sample that a system has no answer for.
    fn first_failure(&self, system: &Tsk) -> Result<()> {
        for row in 0..self.count {
            system.evaluate(&self.point(row))?;
        }
        Ok(())
    }

    /// The mean squared error (2.19) of a grid with these prepared numbers; where no rule fires
    /// its output is `fallback`. `scratch` must have the grid's scratch count. For samples with one
    /// target.
    pub fn mean_squared_error(
        &self,
        grid: &TskGrid,
        prepared: &[f64],
        fallback: f64,
        scratch: &mut [Lanes],
    ) -> f64 {
        let mut sum = Lanes::splat(0.0);
        let mut last = Lanes::splat(0.0);
        for (x, &target) in self.points.chunks_exact(self.inputs).zip(&self.targets) {
            sum = sum + last;
            let error = grid.infer(prepared, x, scratch).average(fallback) - target;
            last = error * error;
        }
        let in_last = self.count - (self.targets.len() - 1) * LANES;
        let total: f64 = sum.to_array().iter().chain(&last.to_array()[..in_last]).sum();
        total / self.count as f64
    }
}

/// The bounds of a system's parameters for a search: its own for the terms; for constants the
/// range of the targets widened by its size to both sides; for the coefficient of an input twice
/// the slope that would cross the range of the targets within the input's universe, and the
/// constants widened by what such slopes can add.
pub fn default_bounds(system: &Tsk, targets: &[f64]) -> Vec<(f64, f64)> {
    let low = targets.iter().copied().fold(f64::INFINITY, f64::min);
    let high = targets.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let size = if high > low { high - low } else { high.abs().max(1.0) };
    let mut consequent: Vec<(f64, f64)> = Vec::new();
    let mut reach = size;
    if system.order() == Order::One {
        for universe in system.inputs().iter().map(|input| input.universe()) {
            let slope = 2.0 * size / (universe.high() - universe.low());
            consequent.push((-slope, slope));
            reach += slope * universe.low().abs().max(universe.high().abs());
        }
    }
    consequent.push((low - reach, high + reach));
    let terms = system.parameter_info();
    let terms = terms.iter().take(system.grid().first_consequent()).map(|p| (p.low, p.high));
    terms.chain(consequent.into_iter().cycle()).take(system.parameters().len()).collect()
}

/// The result of [`fit_genetic`].
#[derive(Debug, Clone)]
pub struct Fit {
    /// The best system found.
    pub system: Tsk,
    /// The best mean squared error of each generation.
    pub history: Vec<f64>,
}

/// Fits all parameters of a system to samples by a genetic algorithm that minimises the mean
/// squared error. `bounds` has a range for each parameter; the system's own vector takes part in
/// the first generation if it lies within.
///
/// Individuals whose vertices cross, or that give no number at some sample, never win; if there
/// is no other, the error says why the system itself has none.
pub fn fit_genetic(
    system: &Tsk,
    data: &DataSet,
    bounds: Vec<(f64, f64)>,
    settings: GeneticSettings,
    generations: u32,
    seed: u64,
    control: &Control,
) -> Result<Fit> {
    check::same_length("inputs of the samples", system.inputs().len(), data.inputs)?;
    check::same_length("targets of each sample", 1, data.outputs)?;
    check::same_length("bounds", system.parameters().len(), bounds.len())?;
    check::at_least("generations", generations as usize, 1)?;
    let grid = system.grid();
    let mut search = Genetic::new(bounds, settings, seed)?;
    let within = |(&value, &(low, high)): (&f64, &(f64, f64))| (low..=high).contains(&value);
    if system.parameters().iter().zip(search.bounds()).all(within) {
        search.start_from([system.parameters()])?;
    }
    let fallback = system.no_rule_fires().fallback();
    let mut prepared = vec![0.0; grid.prepared_count()];
    let mut scratch = vec![Lanes::splat(0.0); grid.scratch_count()];
    let evaluate = |population: &[f64], fitness: &mut [f64]| -> Result<()> {
        for (vector, fitness) in population.chunks_exact(grid.parameter_count()).zip(fitness) {
            *fitness = if grid.is_valid(vector) {
                grid.prepare(vector, &mut prepared);
                data.mean_squared_error(grid, &prepared, fallback, &mut scratch)
            } else {
                f64::NAN
            };
        }
        Ok(())
    };
    let history = search.run(generations, Elite::Remembered, control, evaluate)?;
    match search.best() {
        Some(best) => Ok(Fit { system: system.with_parameters(&best.genes)?, history }),
        None => {
            data.first_failure(system)?;
            Err(Error::OutOfRange {
                what: "number of valid individuals; the best fitness found".to_owned(),
                expected: "a number (widen the bounds, or keep vertices in order)".to_owned(),
                value: f64::NAN,
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rng, Shape, Variable};

    fn system() -> Tsk {
        let inputs = ["x", "y"].map(|name| {
            Variable::evenly(name, (-1.0, 1.0), Shape::Triangular, &["N", "Z", "P"]).unwrap()
        });
        Tsk::zero_order("fitted", inputs.to_vec(), vec![0.0; 9]).unwrap()
    }

    fn samples(count: usize) -> (Vec<f64>, Vec<f64>) {
        let mut rng = Rng::new(2, 0);
        let points: Vec<f64> = (0..2 * count).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        let targets = points.chunks(2).map(|p| p[0] - 0.5 * p[1]).collect();
        (points, targets)
    }

    #[test]
    fn the_error_counts_every_sample_once() {
        let system = system();
        let (points, targets) = samples(121);
        for count in [1, 7, 8, 9, 121] {
            let data = DataSet::new(2, &points[..2 * count], &targets[..count]).unwrap();
            let mut prepared = vec![0.0; system.grid().prepared_count()];
            system.grid().prepare(system.parameters(), &mut prepared);
            let mut scratch = vec![Lanes::splat(0.0); system.grid().scratch_count()];
            let ours = data.mean_squared_error(system.grid(), &prepared, 0.0, &mut scratch);
            let expected = targets[..count].iter().map(|t| t * t).sum::<f64>() / count as f64;
            assert!((ours - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn a_plane_is_fitted() {
        let system = system();
        let (points, targets) = samples(100);
        let data = DataSet::new(2, &points, &targets).unwrap();
        // Only the consequents move; the rest is pinned by empty ranges.
        let first = system.grid().first_consequent();
        let bounds = system
            .parameters()
            .iter()
            .enumerate()
            .map(|(i, &p)| if i < first { (p, p) } else { (-1.5, 1.5) })
            .collect();
        let settings = GeneticSettings { population: 80, crossover: 0.4, mutation: 0.1 };
        let fit = fit_genetic(&system, &data, bounds, settings, 600, 3, &Control::new()).unwrap();
        assert!(fit.history[599] < 0.5 * fit.history[0], "{:?}", fit.history.last());
        assert!(fit.history.is_sorted_by(|a, b| a >= b));
        assert_eq!(fit.system.parameters()[..first], system.parameters()[..first]);
    }

    #[test]
    fn bad_samples_are_refused() {
        assert!(DataSet::new(2, &[0.0; 4], &[0.0; 3]).is_err());
        assert!(DataSet::new(2, &[], &[]).is_err());
        assert!(DataSet::new(1, &[f64::NAN], &[0.0]).is_err());
        assert!(DataSet::new(1, &[0.0], &[f64::INFINITY]).is_err());
    }
}
