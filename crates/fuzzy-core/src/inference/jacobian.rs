//! Derivatives of the outputs of any system, to its inputs or its parameters.
//!
//! They are taken with dual numbers, eight directions at a time, through the very formulas that
//! give the outputs; so what is differentiable has the exact derivative, and min, max and the
//! defuzzifiers that pick a point have that of the branch which was taken.

use super::evaluate::Inference;
use super::rows::in_blocks;
use super::{Answer, Kernel};
use crate::error::Result;
use crate::math::{Dual, Numbers, Real};

/// The directions that one pass takes.
const DIRECTIONS: usize = 8;
/// A number with its derivatives in these directions.
pub(super) type Slopes<R = f64> = Dual<R, DIRECTIONS>;

/// What a derivative is taken with respect to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wrt {
    /// The inputs of the system.
    Inputs,
    /// Its flat parameter vector.
    Parameters,
}

impl Wrt {
    /// The number of derivatives of each output.
    pub fn count<S: Inference>(self, system: &S) -> usize {
        match self {
            Self::Inputs => system.interface().inputs().len(),
            Self::Parameters => system.parameters().len(),
        }
    }
}

/// [`Inference::jacobian_batch`] with dual numbers.
pub(super) fn with_duals<S: Inference>(
    system: &S,
    wrt: Wrt,
    points: &[f64],
    derivatives: &mut [f64],
    threads: usize,
) -> Result<()> {
    let interface = system.interface();
    let (outputs, count) = (interface.outputs().len(), wrt.count(system));
    in_blocks(interface, points, derivatives, outputs * count, threads, |rows, results, first| {
        interface.check_rows(rows, Some(first))?;
        for from in (0..count).step_by(DIRECTIONS) {
            let directions = from..count.min(from + DIRECTIONS);
            let place = |row: usize, output: usize| (row * outputs + output) * count;
            let put = |row: usize, answers: &[Answer<Slopes>], results: &mut [f64]| {
                settle(system, first + row, &rows[row * interface.inputs().len()..], answers)?;
                for (output, answer) in answers.iter().enumerate() {
                    let target = &mut results[place(row, output)..][directions.clone()];
                    target.copy_from_slice(&slopes(answer)[..target.len()]);
                }
                Ok(())
            };
            match wrt {
                Wrt::Inputs => by_inputs(system, rows, from, results, put)?,
                Wrt::Parameters => by_parameters(system, rows, from, results, put)?,
            }
        }
        Ok(())
    })
}

/// Gives `put` the answers at every row, with slopes to the inputs that begin at `from`.
fn by_inputs<S: Inference>(
    system: &S,
    rows: &[f64],
    from: usize,
    results: &mut [f64],
    put: impl Fn(usize, &[Answer<Slopes>], &mut [f64]) -> Result<()>,
) -> Result<()> {
    let mut pass = Pass::new(system);
    for (row, x) in rows.chunks_exact(system.interface().inputs().len()).enumerate() {
        pass.x.clear();
        pass.x.extend(seeded(x, from));
        system.interface().admit(&mut pass.x);
        system.infer(system.prepared(), &pass.x, &mut pass.scratch, &mut pass.answers);
        put(row, &pass.answers, results)?;
    }
    Ok(())
}

/// The same with slopes to the parameters that begin at `from`.
fn by_parameters<S: Inference>(
    system: &S,
    rows: &[f64],
    from: usize,
    results: &mut [f64],
    put: impl Fn(usize, &[Answer<Slopes>], &mut [f64]) -> Result<()>,
) -> Result<()> {
    let mut pass = Pass::new(system);
    let parameters: Vec<Slopes> = seeded(system.parameters(), from).collect();
    let prepared = system.prepare(&parameters);
    for (row, x) in rows.chunks_exact(system.interface().inputs().len()).enumerate() {
        pass.x.clear();
        pass.x.extend(x.iter().map(|&value| Slopes::splat(value)));
        system.interface().admit(&mut pass.x);
        system.infer(&prepared, &pass.x, &mut pass.scratch, &mut pass.answers);
        put(row, &pass.answers, results)?;
    }
    Ok(())
}

/// Numbers of which those from `from` on are the variables of the pass.
fn seeded(numbers: &[f64], from: usize) -> impl Iterator<Item = Slopes> {
    numbers.iter().enumerate().map(move |(index, &value)| {
        match index.checked_sub(from).filter(|&direction| direction < DIRECTIONS) {
            Some(direction) => Slopes::variable(value, direction),
            None => Slopes::splat(value),
        }
    })
}

/// The working space of a pass over one point or eight.
struct Pass<R> {
    x: Vec<Slopes<R>>,
    scratch: Vec<Slopes<R>>,
    answers: Vec<Answer<Slopes<R>>>,
}

impl<R: Real> Pass<R> {
    fn new<S: Inference>(system: &S) -> Self {
        let zero = Slopes::splat(0.0);
        let nothing = Answer { value: zero, strength: zero };
        Self {
            x: Vec::with_capacity(system.interface().inputs().len()),
            scratch: vec![zero; system.scratch_count()],
            answers: vec![nothing; system.interface().outputs().len()],
        }
    }
}

/// The derivatives of all outputs to the first parameters, for one point or eight after the other
/// under one parameter vector.
pub struct Tangent<S: Inference, R: Real> {
    count: usize,
    prepared: Vec<S::Prepared<Slopes>>,
    pass: Pass<R>,
}

impl<S: Inference, R: Real> Tangent<S, R>
where
    [Slopes]: Numbers<Slopes<R>>,
    Slopes<R>: Kernel<Slopes>,
{
    /// For the first `count` parameters, at first those that the system has.
    pub(super) fn new(system: &S, count: usize) -> Self {
        let mut tangent = Self { count, prepared: Vec::new(), pass: Pass::new(system) };
        tangent.set(system, system.parameters());
        tangent
    }

    /// Takes another parameter vector.
    pub(super) fn set(&mut self, system: &S, parameters: &[f64]) {
        self.prepared.clear();
        for from in (0..self.count).step_by(DIRECTIONS) {
            let parameters: Vec<Slopes> = seeded(parameters, from).collect();
            self.prepared.push(system.prepare(&parameters));
        }
    }

    /// Writes the derivatives at an admitted point, output by output.
    pub(super) fn differentiate(&mut self, system: &S, x: &[R], derivatives: &mut [R]) {
        let Pass { x: point, scratch, answers } = &mut self.pass;
        point.clear();
        point.extend(x.iter().copied().map(Slopes::constant));
        for (group, prepared) in self.prepared.iter().enumerate() {
            system.infer(prepared, point, scratch, answers);
            let first = group * DIRECTIONS;
            let zero = R::splat(0.0);
            for (answer, row) in answers.iter().zip(derivatives.chunks_exact_mut(self.count)) {
                let fires = zero.lt(answer.strength.value);
                for (derivative, &slope) in row[first..].iter_mut().zip(&answer.value.slopes) {
                    *derivative = R::select(fires, slope, zero);
                }
            }
        }
    }
}

/// Nothing, if the outputs at this point are what they may be.
fn settle<S: Inference>(
    system: &S,
    row: usize,
    rest: &[f64],
    answers: &[Answer<Slopes>],
) -> Result<()> {
    let interface = system.interface();
    for (index, answer) in answers.iter().enumerate() {
        let plain = Answer { value: answer.value.value, strength: answer.strength.value };
        let point = || format!("point {row} {:?}", &rest[..interface.inputs().len()]);
        interface.check_answer(index, plain, point)?;
    }
    Ok(())
}

/// The derivatives of an answer; zero where no rule fires.
fn slopes(answer: &Answer<Slopes>) -> [f64; DIRECTIONS] {
    if answer.strength.value > 0.0 { answer.value.slopes } else { [0.0; DIRECTIONS] }
}
