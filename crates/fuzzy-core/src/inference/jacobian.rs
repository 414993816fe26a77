//! Derivatives of the outputs of any system, to its inputs or its parameters.
//!
//! They are taken with dual numbers, eight directions at a time, through the very formulas that
//! give the outputs; so what is differentiable has the exact derivative, and min, max and the
//! defuzzifiers that pick a point have that of the branch which was taken.

use super::Answer;
use super::evaluate::Inference;
use super::rows::in_blocks;
use crate::error::Result;
use crate::math::{Dual, Real};

/// The directions that one pass takes.
const DIRECTIONS: usize = 8;
type Slopes = Dual<f64, DIRECTIONS>;

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

/// The working space of a pass.
struct Pass {
    x: Vec<Slopes>,
    scratch: Vec<Slopes>,
    answers: Vec<Answer<Slopes>>,
}

impl Pass {
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
