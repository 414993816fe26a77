//! The consequents that fit best under given premises.

use super::normal::Normal;
use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::inference::{Adaptive, Answer};
use crate::learn::data::{DataSet, Eight};
use crate::learn::least_squares::{Triangle, cholesky};
use crate::math::{LANES, Lanes, Real};

/// How least squares are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// By the normal equations (AᵀA + ρI)θ = Aᵀf and Cholesky's factorisation; where they are
    /// singular or nearly so, as [`Orthogonal`](Self::Orthogonal) does. The fast way.
    Cholesky,
    /// By Householder's reflections with column pivoting. Exact to more digits where columns are
    /// nearly dependent. Where they are dependent, or samples fewer than unknowns, and ρ = 0, the
    /// solution of least norm.
    Orthogonal,
}

impl Solver {
    /// Every solver.
    pub const ALL: [Self; 2] = [Self::Cholesky, Self::Orthogonal];

    /// The name that messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cholesky => "cholesky",
            Self::Orthogonal => "orthogonal",
        }
    }

    /// The solver with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("solver", name, Self::ALL, Self::name)
    }
}

/// Least squares of the consequents: θ = argmin ‖Aθ − f‖² + ρ‖θ‖² (2.18), each output by itself.
///
/// A row of A has the shares of the conclusions (order 0), or each share times (x; 1) (order 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastSquares {
    /// ρ ≥ 0: keeps consequents small that the samples say little about.
    pub ridge: f64,
    /// How it is solved.
    pub solver: Solver,
}

impl Default for LeastSquares {
    /// No ridge, Cholesky.
    fn default() -> Self {
        Self { ridge: 0.0, solver: Solver::Cholesky }
    }
}

impl LeastSquares {
    pub(super) fn check(&self) -> Result<()> {
        check::within("ridge", self.ridge, "zero or more", |ridge| ridge >= 0.0)?;
        Ok(())
    }
}

/// The most unknowns of one output: the normal matrix is square in them.
const MOST_UNKNOWNS: usize = 5000;

/// Working space to fit the consequents of a system again and again.
pub(super) struct ConsequentFit {
    settings: LeastSquares,
    outputs: Vec<Normal>,
    shares: Vec<Lanes>,
    rest: Vec<Answer<Lanes>>,
    scratch: Vec<Lanes>,
}

impl ConsequentFit {
    pub fn new<S: Adaptive>(system: &S, settings: LeastSquares) -> Result<Self> {
        let mut outputs = Vec::new();
        let mut count = 0;
        for (slots, (name, _)) in
            system.consequent_slots()?.into_iter().zip(system.interface().outputs())
        {
            let unknowns: usize = slots.iter().map(|slot| slot.count).sum();
            let what = format!("consequents of output \"{name}\"");
            let expected = format!("at most {MOST_UNKNOWNS} to be fitted by least squares");
            check::within(&what, unknowns as f64, &expected, |n| n <= MOST_UNKNOWNS as f64)?;
            count += slots.len();
            outputs.push(Normal::new(slots)?);
        }
        let zero = Lanes::splat(0.0);
        Ok(Self {
            settings,
            rest: vec![Answer { value: zero, strength: zero }; outputs.len()],
            outputs,
            shares: vec![zero; count],
            scratch: vec![zero; system.scratch_count()],
        })
    }

    /// Puts the consequents that fit best into the parameter vector of which `prepared` is made.
    pub fn solve<S: Adaptive>(
        &mut self,
        system: &S,
        prepared: &S::Prepared<f64>,
        data: &DataSet,
        parameters: &mut [f64],
        control: &Control,
    ) -> Result<()> {
        let by_rows = self.settings.solver == Solver::Orthogonal;
        if !by_rows {
            for eight in data.eights() {
                watch(control, eight)?;
                self.fire(system, prepared, eight);
                let mut shares = self.shares.as_slice();
                let each = self.outputs.iter_mut().zip(&self.rest).zip(eight.targets);
                for ((normal, rest), &target) in each {
                    let (own, others) = shares.split_at(normal.slots().len());
                    normal.add(eight.x, own, target - rest.value);
                    shares = others;
                }
            }
        }
        for output in 0..self.outputs.len() {
            let solution = match by_rows {
                true => None,
                false => self.solve_normal(output)?,
            };
            let solution = match solution {
                Some(solution) => solution,
                None => self.solve_rows(output, system, prepared, data, control)?,
            };
            if solution.iter().any(|value| !value.is_finite()) {
                return Err(Error::Unsuitable {
                    what: format!("output \"{}\"", system.interface().outputs()[output].0),
                    reason: "its least squares overflow; scale the samples".to_owned(),
                });
            }
            for (place, value) in self.outputs[output].places().zip(solution) {
                parameters[place] = value;
            }
        }
        Ok(())
    }

    /// Writes the shares of eight samples; zeros in lanes that don't count.
    fn fire<S: Adaptive>(&mut self, system: &S, prepared: &S::Prepared<f64>, eight: Eight<'_>) {
        system.shares(prepared, eight.x, &mut self.scratch, &mut self.shares, &mut self.rest);
        if eight.used < LANES {
            let lane = |lane| if lane < eight.used { 1.0 } else { 0.0 };
            let counts = Lanes::new(std::array::from_fn(lane));
            self.shares.iter_mut().for_each(|share| *share = *share * counts);
        }
    }

    /// `None` where the normal equations are too inexact.
    fn solve_normal(&mut self, output: usize) -> Result<Option<Vec<f64>>> {
        let (mut gram, rhs) = self.outputs[output].take()?;
        gram.iter_mut().step_by(rhs.len() + 1).for_each(|value| *value += self.settings.ridge);
        Ok(cholesky(&mut gram, &rhs))
    }

    /// By reflections of the rows.
    fn solve_rows<S: Adaptive>(
        &mut self,
        output: usize,
        system: &S,
        prepared: &S::Prepared<f64>,
        data: &DataSet,
        control: &Control,
    ) -> Result<Vec<f64>> {
        let unknowns = self.outputs[output].unknowns();
        let first: usize = self.outputs[..output].iter().map(|normal| normal.slots().len()).sum();
        let mut triangle = Triangle::new(unknowns)?;
        let mut row = vec![0.0; unknowns];
        if self.settings.ridge > 0.0 {
            for k in 0..unknowns {
                row[k] = self.settings.ridge.sqrt();
                triangle.add(&row, 0.0);
                row[k] = 0.0;
            }
        }
        for eight in data.eights() {
            watch(control, eight)?;
            self.fire(system, prepared, eight);
            let target = eight.targets[output] - self.rest[output].value;
            for lane in 0..eight.used {
                let mut rest = row.as_mut_slice();
                for (slot, share) in self.outputs[output].slots().iter().zip(&self.shares[first..])
                {
                    let (own, others) = rest.split_at_mut(slot.count);
                    write_regressors(own, share.to_array()[lane], |k| eight.x[k].to_array()[lane]);
                    rest = others;
                }
                triangle.add(&row, target.to_array()[lane]);
            }
        }
        Ok(triangle.solve())
    }
}

/// A conclusion's part of a row of the design matrix: its share, or its share times (x; 1).
pub(super) fn write_regressors(own: &mut [f64], share: f64, x: impl Fn(usize) -> f64) {
    let last = own.len() - 1;
    own[last] = share;
    own[..last].iter_mut().enumerate().for_each(|(k, value)| *value = share * x(k));
}

/// Looks now and then whether a stop was asked for.
pub(super) fn watch(control: &Control, eight: Eight<'_>) -> Result<()> {
    const SAMPLES: usize = 8192;
    if eight.first.is_multiple_of(SAMPLES) { control.check() } else { Ok(()) }
}
