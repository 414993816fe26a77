//! Steps of the premise parameters down the gradient of the squared error.

use super::consequents::watch;
use super::train::Fitted;
use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::inference::{Adaptive, Answer, Interface};
use crate::learn::data::{DataSet, Eight};
use crate::math::{LANES, Lanes, Real};
use crate::rng::Rng;

/// How the premise parameters p move after the consequents of an epoch have been fitted.
///
/// With e = f − d for an output f and its target d, and E = ½Σe² over the outputs of a sample,
/// ∂E/∂p = Σ e·∂f/∂p; for the thesis's Gaussian exp(−((x − m)/σ)²) the sequential step is
/// (2.25–2.34) with the learning rate η: m ← m + η(d − f)·Σₗ(Kₗ − f)/Σw · wₗ · 2(x − m)/σ².
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PremiseStep {
    /// They stay: one epoch of least squares is all there is to do.
    Fixed,
    /// p ← p − rate · (mean of ∂E/∂p over the samples).
    Batch {
        /// The learning rate, above 0.
        rate: f64,
    },
    /// p ← p − rate · ∂E/∂p after each sample, the consequents staying as they are.
    Sequential {
        /// The learning rate η, above 0.
        rate: f64,
        /// Which sample comes after which.
        order: SampleOrder,
    },
    /// p ← p − k·g/‖g‖ with the gradient g over all samples, the step that MATLAB's `anfis` takes
    /// (Jang 1993, equation 20): k is its length in the space of all premise parameters.
    ///
    /// k grows by the factor `increase` when the error has fallen four times in a row, and shrinks
    /// by `decrease` when it has risen and fallen twice in turn; after either, not for four epochs.
    Normalised {
        /// The initial length k, above 0.
        step: f64,
        /// The factor to grow, at least 1.
        increase: f64,
        /// The factor to shrink, above 0 and at most 1.
        decrease: f64,
    },
}

/// The order of the samples in a sequential sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleOrder {
    /// As they stand in the data.
    AsGiven,
    /// Drawn anew for each epoch.
    Shuffled,
}

impl Default for PremiseStep {
    /// MATLAB's: normalised, 0.01, 1.1, 0.9.
    fn default() -> Self {
        Self::Normalised { step: 0.01, increase: 1.1, decrease: 0.9 }
    }
}

impl PremiseStep {
    pub(super) fn check(&self) -> Result<()> {
        match *self {
            Self::Fixed => {}
            Self::Batch { rate } | Self::Sequential { rate, .. } => {
                check::positive("learning rate", rate)?;
            }
            Self::Normalised { step, increase, decrease } => {
                check::positive("step", step)?;
                check::within("increase of the step", increase, "at least 1", |f| f >= 1.0)?;
                let expected = "above 0 and at most 1";
                check::within("decrease of the step", decrease, expected, |f| f > 0.0 && f <= 1.0)?;
            }
        }
        Ok(())
    }

    /// Whether a step follows the gradient over all samples.
    pub(super) fn takes_gradient(&self) -> bool {
        matches!(self, Self::Batch { .. } | Self::Normalised { .. })
    }
}

/// The length of a normalised step, which follows the errors of the epochs.
#[derive(Debug, Clone)]
pub(super) struct StepLength {
    length: f64,
    changed: usize,
}

impl StepLength {
    /// How many errors a decision looks back.
    const BACK: usize = 4;

    pub fn new(length: f64) -> Self {
        Self { length, changed: 0 }
    }

    pub fn get(&self) -> f64 {
        self.length
    }

    /// Takes note of the errors of all epochs so far.
    pub fn follow(&mut self, errors: &[f64], increase: f64, decrease: f64) {
        let now = errors.len() - 1;
        if now < self.changed + Self::BACK {
            return;
        }
        let falls: Vec<bool> =
            errors[now - Self::BACK..].windows(2).map(|pair| pair[1] < pair[0]).collect();
        let factor = match falls.as_slice() {
            [true, true, true, true] => increase,
            [false, true, false, true] => decrease,
            _ => return,
        };
        self.length *= factor;
        self.changed = now;
    }
}

/// Working space for errors and gradients over all samples.
pub(super) struct BatchPass<S: Adaptive> {
    premise: S::Premise<Lanes>,
    scratch: Vec<Lanes>,
    answers: Vec<Answer<Lanes>>,
    derivatives: Vec<Lanes>,
    sums: Vec<Lanes>,
}

impl<S: Adaptive> BatchPass<S> {
    pub fn new(system: &S) -> Self {
        let (zero, outputs) = (Lanes::splat(0.0), system.interface().outputs().len());
        let count = system.premise_count();
        Self {
            premise: system.premise(),
            scratch: vec![zero; system.scratch_count()],
            answers: vec![Answer { value: zero, strength: zero }; outputs],
            derivatives: vec![zero; outputs * count],
            sums: vec![zero; count],
        }
    }

    /// The root of the mean squared error over all samples and outputs.
    pub fn error(
        &mut self,
        system: &S,
        prepared: &S::Prepared<f64>,
        data: &DataSet,
        control: &Control,
    ) -> Result<f64> {
        let mut squares = Lanes::splat(0.0);
        for eight in data.eights() {
            watch(control, eight)?;
            system.infer(prepared, eight.x, &mut self.scratch, &mut self.answers);
            check_answers(system.interface(), &self.answers, eight)?;
            for (answer, &target) in self.answers.iter().zip(eight.targets) {
                let error = counted(answer.value - target, eight.used);
                squares = error.mul_add(error, squares);
            }
        }
        Ok(root_mean(squares, data))
    }

    /// The same, and the mean over the samples of the gradient of ½Σe².
    pub fn error_and_gradient(
        &mut self,
        system: &S,
        fitted: &Fitted<S>,
        data: &DataSet,
        gradient: &mut [f64],
        control: &Control,
    ) -> Result<f64> {
        let mut squares = Lanes::splat(0.0);
        self.sums.fill(squares);
        system.set_premise(&mut self.premise, &fitted.parameters);
        for eight in data.eights() {
            watch(control, eight)?;
            let (answers, derivatives) = (&mut self.answers, &mut self.derivatives);
            let (parameters, prepared) = (&fitted.parameters, &fitted.prepared);
            system.differentiate(
                parameters,
                prepared,
                &mut self.premise,
                eight.x,
                answers,
                derivatives,
            );
            check_answers(system.interface(), &self.answers, eight)?;
            let each = self.answers.iter().zip(eight.targets);
            for ((answer, &target), row) in
                each.zip(self.derivatives.chunks_exact(gradient.len().max(1)))
            {
                let error = counted(answer.value - target, eight.used);
                squares = error.mul_add(error, squares);
                for (sum, &derivative) in self.sums.iter_mut().zip(row) {
                    *sum = error.mul_add(derivative, *sum);
                }
            }
        }
        for (mean, sum) in gradient.iter_mut().zip(&self.sums) {
            *mean = sum.to_array().iter().sum::<f64>() / data.len() as f64;
        }
        Ok(root_mean(squares, data))
    }
}

fn root_mean(squares: Lanes, data: &DataSet) -> f64 {
    let total: f64 = squares.to_array().iter().sum();
    (total / (data.len() * data.outputs()) as f64).sqrt()
}

/// An error, with zeros in lanes that have no sample of their own.
#[inline(always)]
fn counted(error: Lanes, used: usize) -> Lanes {
    if used == LANES {
        return error;
    }
    let mut error = error;
    (used..LANES).for_each(|lane| error.set_lane(lane, 0.0));
    error
}

/// Nothing, if every output is a number at these samples.
fn check_answers(interface: &Interface, answers: &[Answer<Lanes>], eight: Eight<'_>) -> Result<()> {
    for (index, answer) in answers.iter().enumerate() {
        let all_finite = answer.value.abs().le(Lanes::splat(f64::MAX));
        if Lanes::bits(all_finite) != 0xFF {
            return name_sample(interface, index, answer, eight);
        }
    }
    Ok(())
}

/// The error about the first sample without an output.
#[cold]
fn name_sample(
    interface: &Interface,
    index: usize,
    answer: &Answer<Lanes>,
    eight: Eight<'_>,
) -> Result<()> {
    let each = answer.value.to_array().into_iter().zip(answer.strength.to_array());
    for (lane, (value, strength)) in each.enumerate().take(eight.used) {
        if value.is_finite() {
            continue;
        }
        let x: Vec<f64> = eight.x.iter().map(|input| input.to_array()[lane]).collect();
        let (name, _) = &interface.outputs()[index];
        let (system, point) = (
            format!("\"{}\" about \"{name}\"", interface.name()),
            format!("sample {} {x:?}", eight.first + lane),
        );
        return Err(match strength == 0.0 {
            true => Error::NoRuleFires { system, point },
            false => Error::NotFinite { what: format!("the output of {system} at {point}"), value },
        });
    }
    Ok(())
}

/// Working space for sweeps that take one sample after the other.
pub(super) struct Sweep<S: Adaptive> {
    premise: S::Premise<f64>,
    answers: Vec<Answer<f64>>,
    derivatives: Vec<f64>,
    /// The samples' inputs and targets, row by row.
    rows: Vec<f64>,
    order: Vec<usize>,
    rng: Rng,
}

impl<S: Adaptive> Sweep<S> {
    pub fn new(system: &S, data: &DataSet, seed: u64) -> Self {
        let outputs = system.interface().outputs().len();
        let mut rows = Vec::with_capacity(data.len() * (data.inputs() + outputs));
        for eight in data.eights() {
            for lane in 0..eight.used {
                let numbers = eight.x.iter().chain(eight.targets);
                rows.extend(numbers.map(|number| number.to_array()[lane]));
            }
        }
        Self {
            premise: system.premise(),
            answers: vec![Answer { value: 0.0, strength: 0.0 }; outputs],
            derivatives: vec![0.0; outputs * system.premise_count()],
            rows,
            order: (0..data.len()).collect(),
            rng: Rng::new(seed, 0),
        }
    }

    /// One step after each sample. Samples at which no rule fires change nothing.
    pub fn run(
        &mut self,
        system: &S,
        fitted: &mut Fitted<S>,
        rate: f64,
        order: SampleOrder,
        control: &Control,
    ) -> Result<()> {
        if order == SampleOrder::Shuffled {
            for last in (1..self.order.len()).rev() {
                self.order.swap(last, self.rng.below(last + 1));
            }
        }
        let inputs = system.interface().inputs().len();
        let (width, count) = (inputs + self.answers.len(), fitted.premise_count());
        for (step, &index) in self.order.iter().enumerate() {
            if step.is_multiple_of(1024) {
                control.check()?;
            }
            let (x, targets) = self.rows[index * width..][..width].split_at(inputs);
            system.set_premise(&mut self.premise, &fitted.parameters);
            let (answers, derivatives) = (&mut self.answers, &mut self.derivatives);
            let (parameters, prepared) = (&fitted.parameters, &fitted.prepared);
            system.differentiate(parameters, prepared, &mut self.premise, x, answers, derivatives);
            for ((answer, target), row) in
                self.answers.iter().zip(targets).zip(self.derivatives.chunks_exact(count.max(1)))
            {
                if answer.strength > 0.0 {
                    fitted.add_to_premise(-rate * (answer.value - target), row);
                }
            }
            fitted.settle(system)?;
        }
        Ok(())
    }
}
