//! Samples to be fitted.

use crate::check;
use crate::error::Result;
use crate::inference::{Answer, Inference};
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
    /// Samples of one output, whose inputs are the rows of `points`.
    pub fn new(inputs: usize, points: &[f64], targets: &[f64]) -> Result<Self> {
        Self::with_outputs(inputs, 1, points, targets)
    }

    /// Samples of several outputs: inputs are the rows of `points`, outputs those of `targets`.
    pub fn with_outputs(
        inputs: usize,
        outputs: usize,
        points: &[f64],
        targets: &[f64],
    ) -> Result<Self> {
        check::at_least("inputs of the samples", inputs, 1)?;
        check::at_least("outputs of the samples", outputs, 1)?;
        let count = targets.len() / outputs;
        check::at_least("samples", count, 1)?;
        let numbers = |of: &str| format!("numbers in the {of} of the samples");
        check::same_length(&numbers("targets"), count * outputs, targets.len())?;
        check::same_length(&numbers("inputs"), count * inputs, points.len())?;
        check::all_finite("inputs of the samples", points)?;
        check::all_finite("targets of the samples", targets)?;
        let (points, targets) = (in_lanes(points, inputs), in_lanes(targets, outputs));
        Ok(Self { inputs, outputs, points, targets, count })
    }

    /// The number of samples.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none; never, since an empty set cannot be made.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The number of inputs.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// The number of outputs.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// The inputs of one sample.
    pub fn point(&self, sample: usize) -> Vec<f64> {
        let block = &self.points[sample / LANES * self.inputs..][..self.inputs];
        block.iter().map(|x| x.to_array()[sample % LANES]).collect()
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

    /// The least and the greatest target of an output.
    pub fn target_range(&self, output: usize) -> (f64, f64) {
        let targets = self.targets.iter().skip(output).step_by(self.outputs);
        targets.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), lanes| {
            let numbers = lanes.to_array();
            (numbers.into_iter().fold(low, f64::min), numbers.into_iter().fold(high, f64::max))
        })
    }

    /// The same samples as a system takes them, or the error of the first that it refuses: with
    /// the system's inputs and outputs, and each input in its universe if that is asked for.
    pub fn admitted(&self, system: &impl Inference) -> Result<Self> {
        let interface = system.interface();
        check::same_length("inputs of the samples", interface.inputs().len(), self.inputs)?;
        check::same_length("outputs of the samples", interface.outputs().len(), self.outputs)?;
        for sample in 0..self.count {
            let checked = interface.check_point(&self.point(sample));
            checked.map_err(|error| error.at(format!("sample {sample}")))?;
        }
        let mut admitted = self.clone();
        admitted.points.chunks_exact_mut(self.inputs).for_each(|x| interface.admit(x));
        Ok(admitted)
    }

    /// The mean squared error (2.19) of a system with these prepared parameters, over all outputs
    /// of [admitted](Self::admitted) samples. Where no rule fires an output is the
    /// [fallback](crate::NoRuleFires::fallback), so the error may be NaN. `scratch` must have the
    /// system's scratch count, `answers` as many as there are outputs.
    pub fn mean_squared_error<S: Inference>(
        &self,
        system: &S,
        prepared: &S::Prepared<f64>,
        scratch: &mut [Lanes],
        answers: &mut [Answer<Lanes>],
    ) -> f64 {
        self.mean_squared_error_below(f64::INFINITY, system, prepared, scratch, answers)
    }

    /// The same, but +∞ as soon as it turns out to be no less than a bar.
    pub(crate) fn mean_squared_error_below<S: Inference>(
        &self,
        bar: f64,
        system: &S,
        prepared: &S::Prepared<f64>,
        scratch: &mut [Lanes],
        answers: &mut [Answer<Lanes>],
    ) -> f64 {
        self.mean_below(bar, |x, targets| {
            system.infer(prepared, x, scratch, answers);
            answers.iter().zip(targets).fold(Lanes::splat(0.0), |sum, (answer, &target)| {
                let error = answer.value - target;
                sum + error * error
            })
        })
    }

    /// The mean over all targets of what `each` says, zero or more, about the inputs and targets of
    /// eight samples at a time; +∞ as soon as it turns out to be no less than a bar.
    #[inline(always)]
    pub fn mean_below(&self, bar: f64, mut each: impl FnMut(&[Lanes], &[Lanes]) -> Lanes) -> f64 {
        /// So many eights are added up between two looks at the bar.
        const BETWEEN_LOOKS: usize = 2;
        let targets = (self.count * self.outputs) as f64;
        let mut sum = Lanes::splat(0.0);
        let mut last = Lanes::splat(0.0);
        let each_targets = self.targets.chunks_exact(self.outputs);
        for (number, (x, y)) in self.points.chunks_exact(self.inputs).zip(each_targets).enumerate()
        {
            sum = sum + last;
            // What is still to come, rounding included, makes this no smaller.
            if number % BETWEEN_LOOKS == 0 && sum.to_array().iter().sum::<f64>() / targets >= bar {
                return f64::INFINITY;
            }
            last = each(x, y);
        }
        let in_last = self.count - (self.count.div_ceil(LANES) - 1) * LANES;
        sum.to_array().iter().chain(&last.to_array()[..in_last]).sum::<f64>() / targets
    }
}

/// Rows of `width` numbers, eight rows side by side. The last row also fills the lanes left over;
/// the error ignores them.
fn in_lanes(numbers: &[f64], width: usize) -> Vec<Lanes> {
    let count = numbers.len() / width;
    let lanes = |block: usize, column: usize| {
        let row = |lane: usize| (block * LANES + lane).min(count - 1);
        Lanes::new(std::array::from_fn(|lane| numbers[row(lane) * width + column]))
    };
    let blocks = 0..count.div_ceil(LANES);
    blocks
        .flat_map(|block| (0..width).map(move |column| (block, column)))
        .map(|(block, column)| lanes(block, column))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Outside, Rng, Shape, Tsk, Variable};

    fn system() -> Tsk {
        let inputs = ["x", "y"].map(|name| {
            Variable::evenly(name, (-1.0, 1.0), Shape::Triangular, &["N", "Z", "P"]).unwrap()
        });
        Tsk::zero_order("constant", inputs.to_vec(), vec![0.0; 9]).unwrap()
    }

    fn error(system: &Tsk, data: &DataSet) -> f64 {
        let zero = Lanes::splat(0.0);
        let mut scratch = vec![zero; system.scratch_count()];
        let mut answers = [Answer { value: zero, strength: zero }];
        data.mean_squared_error(system, system.prepared(), &mut scratch, &mut answers)
    }

    #[test]
    fn the_error_counts_every_sample_once() {
        let mut rng = Rng::new(2, 0);
        let points: Vec<f64> = (0..242).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        let targets: Vec<f64> = points.chunks(2).map(|p| p[0] - 0.5 * p[1]).collect();
        for count in [1, 7, 8, 9, 121] {
            let data = DataSet::new(2, &points[..2 * count], &targets[..count]).unwrap();
            let expected = targets[..count].iter().map(|t| t * t).sum::<f64>() / count as f64;
            assert!((error(&system(), &data) - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn an_error_is_given_up_only_if_it_is_not_below_the_bar() {
        let mut rng = Rng::new(4, 0);
        let points: Vec<f64> = (0..2 * 121).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        let targets: Vec<f64> = points.chunks(2).map(|p| p[0] * p[1]).collect();
        let data = DataSet::new(2, &points, &targets).unwrap();
        let mean = |bar| data.mean_below(bar, |_, y| y[0] * y[0]);
        let exact = mean(f64::INFINITY);
        for bar in [f64::INFINITY, exact * 2.0, exact.next_up()] {
            assert_eq!(mean(bar), exact);
        }
        assert_eq!(mean(exact / 3.0), f64::INFINITY);
    }

    #[test]
    fn samples_are_taken_as_the_system_takes_inputs() {
        let data = DataSet::new(2, &[0.0, 0.0, 3.0, 0.5], &[1.0, 1.0]).unwrap();
        assert!(error(&system(), &data.admitted(&system()).unwrap()).is_nan());
        let clamping = system().with_outside(Outside::Clamp);
        assert_eq!(error(&clamping, &data.admitted(&clamping).unwrap()), 1.0);
        let refusing = system().with_outside(Outside::Error);
        let message = data.admitted(&refusing).unwrap_err().to_string();
        assert_eq!(message, "sample 1: input \"x\" must be from -1 to 1, got 3");
    }

    #[test]
    fn bad_samples_are_refused() {
        assert!(DataSet::new(2, &[0.0; 4], &[0.0; 3]).is_err());
        assert!(DataSet::new(2, &[], &[]).is_err());
        assert!(DataSet::new(1, &[f64::NAN], &[0.0]).is_err());
        assert!(DataSet::new(1, &[0.0], &[f64::INFINITY]).is_err());
        assert!(DataSet::with_outputs(1, 2, &[0.0], &[0.0; 3]).is_err());
        assert!(DataSet::with_outputs(1, 0, &[0.0], &[0.0]).is_err());
    }
}
