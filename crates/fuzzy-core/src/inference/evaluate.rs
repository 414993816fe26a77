//! Evaluation of any system: one point, many points, many parameter vectors.

use super::rows::{for_each_eight, in_blocks};
use super::{Answer, Interface, Kernel, NoRuleFires, Parameter, Wrt, jacobian};
use crate::check;
use crate::error::Result;
use crate::math::{LANES, Lanes, Numbers, Real, Scalar};
use crate::parallel;

/// A fuzzy system: an immutable definition with a flat parameter vector, which answers at points.
///
/// Implementors give [`prepare`](Self::prepare) and [`infer`](Self::infer); evaluation in all its
/// forms follows, to the same bits in each.
pub trait Inference: Clone + Send + Sync {
    /// What [`infer`](Self::infer) reads: numbers made once from a parameter vector.
    type Prepared<N: Real>: Send + Sync;

    /// The names, and what happens at the edges.
    fn interface(&self) -> &Interface;

    /// The flat parameter vector.
    fn parameters(&self) -> &[f64];

    /// The same definition with another parameter vector, checked.
    fn with_parameters(&self, parameters: &[f64]) -> Result<Self>;

    /// Whether a vector of the right length is one of valid parameters.
    fn accepts(&self, parameters: &[f64]) -> bool;

    /// The parameters that the system was made with, prepared.
    fn prepared(&self) -> &Self::Prepared<f64>;

    /// Prepares another vector of valid parameters.
    fn prepare<N: Parameter>(&self, parameters: &[N]) -> Self::Prepared<N>
    where
        [N]: Numbers<N>;

    /// The numbers of working space that [`infer`](Self::infer) needs.
    fn scratch_count(&self) -> usize;

    /// The answers of all outputs at a point of finite numbers.
    fn infer<N: Scalar, R: Kernel<N>>(
        &self,
        prepared: &Self::Prepared<N>,
        x: &[R],
        scratch: &mut [R],
        answers: &mut [Answer<R>],
    ) where
        [N]: Numbers<R>;

    /// The outputs at one point. Where the choice is [`NoRuleFires::Previous`], what stood in
    /// `outputs` remains; NaN means that there is nothing before.
    fn evaluate_into(&self, x: &[f64], outputs: &mut [f64]) -> Result<()> {
        let interface = self.interface();
        interface.check_point(x)?;
        let (inputs, count) = (x.len(), interface.outputs().len());
        check::same_length("outputs", count, outputs.len())?;
        with_scratch(inputs + self.scratch_count(), |scratch| {
            let (admitted, scratch) = scratch.split_at_mut(inputs);
            admitted.copy_from_slice(x);
            interface.admit(admitted);
            let mut few = [NOTHING; FEW_OUTPUTS];
            let mut many = Vec::new();
            let answers = few.get_mut(..count).unwrap_or_else(|| {
                many.resize(count, NOTHING);
                &mut many
            });
            self.infer(self.prepared(), admitted, scratch, answers);
            for (index, (&answer, output)) in answers.iter().zip(outputs).enumerate() {
                interface.settle(index, answer, output, || format!("{x:?}"))?;
            }
            Ok(())
        })
    }

    /// The outputs at the rows of `points` (row-major, one row for each point), row by row, on
    /// up to `threads` threads (0: one for each core).
    ///
    /// Equal to [`evaluate_into`](Self::evaluate_into) on one row after the other, to the bit.
    /// On one thread nothing is allocated that grows with the number of rows.
    fn evaluate_batch(&self, points: &[f64], outputs: &mut [f64], threads: usize) -> Result<()> {
        let interface = self.interface();
        let width = interface.outputs().len();
        let before: Vec<f64> = outputs.iter().take(width).copied().collect();
        in_blocks(interface, points, outputs, width, threads, |rows, outputs, first| {
            evaluate_rows(self, self.prepared(), rows, outputs, first)
        })?;
        fill_with_previous(interface, points, outputs, before)
    }

    /// The outputs of P systems, this one with each of the parameter vectors (row-major, one
    /// row for each vector), at N points: P × N × outputs numbers.
    ///
    /// A vector of invalid parameters is an error that names it. Equal to
    /// [`evaluate_batch`](Self::evaluate_batch) of
    /// [`with_parameters`](Self::with_parameters), to the bit, without making the systems.
    fn evaluate_population(
        &self,
        vectors: &[f64],
        points: &[f64],
        outputs: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        let (interface, width) = (self.interface(), self.parameters().len().max(1));
        let (count, rows) = (vectors.len() / width, points.len() / interface.inputs().len());
        check::same_length("numbers in the parameter vectors", count * width, vectors.len())?;
        let whole = rows * interface.inputs().len();
        check::same_length("numbers in the rows of points", whole, points.len())?;
        let size = rows * interface.outputs().len();
        check::same_length("numbers in the result", count * size, outputs.len())?;
        if size == 0 {
            return Ok(());
        }
        let evaluate = |vector: &[f64], outputs: &mut [f64]| {
            if !self.accepts(vector) {
                // Making the system says what is wrong.
                self.with_parameters(vector)?;
            }
            let before = outputs[..interface.outputs().len()].to_vec();
            evaluate_rows(self, &self.prepare(vector), points, outputs, 0)?;
            fill_with_previous(interface, points, outputs, before)
        };
        let work = |(index, (vector, outputs)): (usize, (&[f64], &mut [f64]))| {
            evaluate(vector, outputs).map_err(|error| error.at(format!("parameter vector {index}")))
        };
        let pairs = vectors.chunks_exact(width).zip(outputs.chunks_exact_mut(size));
        let mut pairs = pairs.enumerate();
        if threads == 1 {
            return pairs.try_for_each(work);
        }
        parallel::map(threads, pairs.collect(), work)?;
        Ok(())
    }

    /// The derivatives of every output at one point: output by output one number for each input
    /// or parameter. Zero where no rule fires, unless that is an error.
    fn jacobian(&self, wrt: Wrt, x: &[f64], derivatives: &mut [f64]) -> Result<()> {
        self.interface().check_point(x)?;
        let count = wrt.count(self) * self.interface().outputs().len();
        check::same_length("derivatives", count, derivatives.len())?;
        self.jacobian_batch(wrt, x, derivatives, 1)
    }

    /// [`jacobian`](Self::jacobian) at the rows of `points`, row by row.
    fn jacobian_batch(
        &self,
        wrt: Wrt,
        points: &[f64],
        derivatives: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        jacobian::with_duals(self, wrt, points, derivatives, threads)
    }
}

const NOTHING: Answer<f64> = Answer { value: 0.0, strength: 0.0 };
/// The most outputs whose answers are kept on the stack.
const FEW_OUTPUTS: usize = 4;

/// Evaluates rows in lanes. `first` is the number of the first for messages.
fn evaluate_rows<S: Inference>(
    system: &S,
    prepared: &S::Prepared<f64>,
    points: &[f64],
    outputs: &mut [f64],
    first: usize,
) -> Result<()> {
    let interface = system.interface();
    let width = interface.outputs().len();
    let zero = Lanes::splat(0.0);
    let mut scratch = vec![zero; system.scratch_count()];
    let mut answers = vec![Answer { value: zero, strength: zero }; width];
    for_each_eight(interface, points, first, |row, x| {
        system.infer(prepared, x, &mut scratch, &mut answers);
        let outputs = &mut outputs[row * width..];
        for (index, &answer) in answers.iter().enumerate() {
            let all_finite = answer.value.abs().le(Lanes::splat(f64::MAX));
            if Lanes::bits(all_finite) != 0xFF {
                settle_lanes(interface, index, answer, points, row, first, outputs)?;
            } else if let (1, Some(outputs)) = (width, outputs.first_chunk_mut::<LANES>()) {
                *outputs = answer.value.to_array();
            } else {
                let rows = outputs.chunks_exact_mut(width);
                rows.zip(answer.value.to_array()).for_each(|(row, value)| row[index] = value);
            }
        }
        Ok(())
    })
}

/// Puts the answers of eight rows into `outputs` where some need a second look.
#[cold]
fn settle_lanes(
    interface: &Interface,
    index: usize,
    answer: Answer<Lanes>,
    points: &[f64],
    row: usize,
    first: usize,
    outputs: &mut [f64],
) -> Result<()> {
    let (inputs, width) = (interface.inputs().len(), interface.outputs().len());
    let previous = interface.outputs()[index].1 == NoRuleFires::Previous;
    let each = answer.value.to_array().into_iter().zip(answer.strength.to_array());
    let rows = outputs.chunks_exact_mut(width).zip(points[row * inputs..].chunks_exact(inputs));
    for (lane, ((value, strength), (outputs, point))) in each.zip(rows).enumerate() {
        if previous && strength == 0.0 {
            // Filled when all rows are there.
            outputs[index] = f64::NAN;
            continue;
        }
        let place = || format!("point {} {point:?}", first + row + lane);
        interface.settle(index, Answer { value, strength }, &mut outputs[index], place)?;
    }
    Ok(())
}

/// Where an output is to stay as it was, puts in the row before; `before` is before the first.
fn fill_with_previous(
    interface: &Interface,
    points: &[f64],
    outputs: &mut [f64],
    before: Vec<f64>,
) -> Result<()> {
    let (inputs, width) = (interface.inputs().len(), interface.outputs().len());
    for (index, (_, no_rule_fires)) in interface.outputs().iter().enumerate() {
        if *no_rule_fires != NoRuleFires::Previous {
            continue;
        }
        let mut last = before.get(index).copied().unwrap_or(f64::NAN);
        for (row, outputs) in outputs.chunks_exact_mut(width).enumerate() {
            let answer = Answer { value: outputs[index], strength: 0.0 };
            let place = || format!("point {row} {:?}", &points[row * inputs..][..inputs]);
            interface.settle(index, answer, &mut last, place)?;
            outputs[index] = last;
        }
    }
    Ok(())
}

/// Runs `work` with that many zeros of working space, on the stack if they are few.
#[inline(always)]
pub(super) fn with_scratch<T>(count: usize, work: impl FnOnce(&mut [f64]) -> T) -> T {
    const FEW: usize = 32;
    const SOME: usize = 160;
    if count <= FEW {
        work(&mut [0.0; FEW][..count])
    } else if count <= SOME {
        work(&mut [0.0; SOME][..count])
    } else {
        work(&mut vec![0.0; count])
    }
}

#[cfg(test)]
mod tests {
    use super::super::rows::BLOCK;
    use crate::{Inference, MembershipFunction, NoRuleFires, Order, Rng, Shape, Tsk, Variable};

    fn random_system(shape: Shape, inputs: usize, order: Order, seed: u64) -> Tsk {
        let mut rng = Rng::new(seed, 0);
        let terms: [&str; 3] = ["N", "Z", "P"];
        let variables: Vec<Variable> = ["a", "b", "c"][..inputs]
            .iter()
            .map(|name| Variable::evenly(name, (-1.0, 1.0), shape, &terms).unwrap())
            .collect();
        let rules = 3_usize.pow(inputs as u32);
        let size = if order == Order::Zero { 1 } else { inputs + 1 };
        let consequents = (0..rules * size).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        Tsk::new("random", variables, order, consequents)
            .unwrap()
            .when_no_rule_fires(NoRuleFires::Value(0.25))
            .unwrap()
    }

    fn points(count: usize, inputs: usize) -> Vec<f64> {
        let mut rng = Rng::new(1, 0);
        (0..count * inputs).map(|_| rng.uniform_in(-3.0, 3.0)).collect()
    }

    #[test]
    fn batch_and_scalar_agree_to_the_bit_on_any_number_of_threads() {
        for shape in [Shape::Gaussian, Shape::Triangular, Shape::Bell] {
            for (inputs, order) in
                [(1, Order::Zero), (2, Order::Zero), (2, Order::One), (3, Order::One)]
            {
                let system = random_system(shape, inputs, order, 5);
                // More than two blocks, so that threads matter, and a last block that is not full.
                let points = points(3 * BLOCK + 13, inputs);
                let rows = points.len() / inputs;
                let scalar: Vec<f64> =
                    points.chunks(inputs).map(|x| system.evaluate(x).unwrap()).collect();
                for threads in [1, 2, 7] {
                    let mut outputs = vec![0.0; rows];
                    system.evaluate_batch(&points, &mut outputs, threads).unwrap();
                    assert!(outputs.iter().zip(&scalar).all(|(a, b)| a.to_bits() == b.to_bits()));
                }
                let width = system.parameters().len();
                let few = &points[..21 * inputs];
                let mut all = vec![0.0; 21 * width];
                system.gradient_batch(few, &mut all, 2).unwrap();
                for (x, row) in few.chunks(inputs).zip(all.chunks(width)) {
                    let mut one = vec![0.0; width];
                    system.gradient(x, &mut one).unwrap();
                    assert!(one.iter().zip(row).all(|(a, b)| a.to_bits() == b.to_bits()));
                }
            }
        }
    }

    #[test]
    fn the_bad_point_is_named() {
        let system = random_system(Shape::Gaussian, 2, Order::Zero, 1);
        let mut points = points(100, 2);
        points[2 * 37 + 1] = f64::NAN;
        let error = system.evaluate_batch(&points, &mut [0.0; 100], 1).unwrap_err();
        assert_eq!(error.to_string(), "input \"b\" of point 37 must be finite, got NaN");
        let error = system.evaluate_batch(&points[1..], &mut [0.0; 99], 1).unwrap_err();
        assert!(error.to_string().contains("expected 198, got 199"), "{error}");

        let gap = Variable::new("x", 0.0, 10.0)
            .unwrap()
            .with_term("low", MembershipFunction::triangular(0.0, 1.0, 2.0).unwrap())
            .unwrap();
        let gap = Tsk::zero_order("gap", vec![gap], vec![3.0]).unwrap();
        let error = gap.evaluate_batch(&[1.0, 1.5, 4.0], &mut [0.0; 3], 1).unwrap_err();
        assert!(error.to_string().contains("fires at point 2 [4.0]"), "{error}");
    }
}
