//! Many points at once: eight in lock-step, blocks of them on several threads.

use super::Tsk;
use crate::check;
use crate::error::{Error, Result};
use crate::math::{LANES, Lanes, Real};
use crate::parallel;

/// Rows that one thread takes at a time; fixed, so that it cannot depend on the threads.
const BLOCK: usize = 4096;

impl Tsk {
    /// The outputs at the rows of `points` (row-major, one row for each point), on up to
    /// `threads` threads (0: one for each core).
    ///
    /// Equal to [`evaluate`](Self::evaluate) on every row, to the bit. On one thread nothing is
    /// allocated that grows with the number of rows.
    pub fn evaluate_batch(
        &self,
        points: &[f64],
        outputs: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        self.run_batch(points, outputs, 1, threads, |rows, outputs, first| {
            self.evaluate_rows(rows, outputs, first)
        })
    }

    /// The derivatives of the output to the parameters at the rows of `points`; row-major, one
    /// row for each point, equal to [`gradient`](Self::gradient) to the bit.
    pub fn gradient_batch(
        &self,
        points: &[f64],
        derivatives: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        let width = self.parameters().len();
        self.run_batch(points, derivatives, width, threads, |rows, derivatives, first| {
            self.gradient_rows(rows, derivatives, first)
        })
    }

    /// Cuts the rows into blocks and gives each, with the results' part of `width` numbers a row
    /// and the number of its first row, to `work`.
    fn run_batch(
        &self,
        points: &[f64],
        results: &mut [f64],
        width: usize,
        threads: usize,
        work: impl Fn(&[f64], &mut [f64], usize) -> Result<()> + Sync + Send,
    ) -> Result<()> {
        let inputs = self.inputs().len();
        let rows = points.len() / inputs;
        check::same_length("numbers in the rows of points", rows * inputs, points.len())?;
        check::same_length("numbers in the result", rows * width, results.len())?;
        if threads == 1 || rows <= BLOCK {
            return work(points, results, 0);
        }
        let blocks: Vec<_> = points
            .chunks(BLOCK * inputs)
            .zip(results.chunks_mut(BLOCK * width))
            .enumerate()
            .map(|(index, (rows, results))| (index * BLOCK, rows, results))
            .collect();
        parallel::map(threads, blocks, |(first, rows, results)| work(rows, results, first))?;
        Ok(())
    }

    fn evaluate_rows(&self, points: &[f64], outputs: &mut [f64], first: usize) -> Result<()> {
        let mut scratch = vec![Lanes::splat(0.0); self.grid.scratch_count()];
        let fallback = self.no_rule_fires().fallback();
        self.for_each_eight(points, first, |row, x| {
            let fired = self.grid.infer(self.prepared.as_slice(), x, &mut scratch);
            let average = fired.average(fallback);
            self.check_outputs(average, fired.strength, points, row, first)?;
            let results = average.to_array();
            let outputs = &mut outputs[row..];
            match outputs.first_chunk_mut::<LANES>() {
                Some(outputs) => *outputs = results,
                None => {
                    outputs.iter_mut().zip(results).for_each(|(output, result)| *output = result)
                }
            }
            Ok(())
        })
    }

    fn gradient_rows(&self, points: &[f64], derivatives: &mut [f64], first: usize) -> Result<()> {
        let width = self.parameters().len();
        let fallback = self.no_rule_fires().fallback();
        let mut scratch = vec![Lanes::splat(0.0); self.grid.gradient_scratch_count()];
        let mut lanes = vec![Lanes::splat(0.0); width];
        self.for_each_eight(points, first, |row, x| {
            let (parameters, prepared) = (self.parameters.as_slice(), self.prepared.as_slice());
            let fired = self.grid.gradient(parameters, prepared, x, &mut scratch, &mut lanes);
            let average = fired.average(fallback);
            self.check_outputs(average, fired.strength, points, row, first)?;
            let rows = derivatives[row * width..].chunks_exact_mut(width);
            for (lane, row) in rows.take(LANES).enumerate() {
                for (derivative, lanes) in row.iter_mut().zip(&lanes) {
                    *derivative = lanes.to_array()[lane];
                }
            }
            Ok(())
        })
    }

    /// Gives `work` eight rows at a time: the number of the first and the inputs in lanes. The
    /// last row also fills the lanes left over. `first` is the number of the first row for
    /// messages.
    #[inline(always)]
    fn for_each_eight(
        &self,
        points: &[f64],
        first: usize,
        mut work: impl FnMut(usize, &[Lanes]) -> Result<()>,
    ) -> Result<()> {
        // Some rows are turned into columns well before they are read: a vector load right
        // after scalar stores would have to wait for them.
        const AHEAD: usize = 8;
        let inputs = self.inputs().len();
        let mut x = vec![Lanes::splat(0.0); AHEAD * inputs];
        let mut padded = vec![0.0; LANES * inputs];
        for (block, rows) in points.chunks(AHEAD * LANES * inputs).enumerate() {
            let first_row = block * AHEAD * LANES;
            check_rows(self, rows, first + first_row)?;
            let eights = rows.chunks_exact(LANES * inputs);
            let (rest, count) = (eights.remainder(), eights.len());
            for (eight, x) in eights.zip(x.chunks_exact_mut(inputs)) {
                transpose(eight, x);
            }
            for (eight, x) in x.chunks_exact(inputs).take(count).enumerate() {
                work(first_row + eight * LANES, x)?;
            }
            if !rest.is_empty() {
                let last = rest.len() / inputs - 1;
                for (lane, row) in padded.chunks_exact_mut(inputs).enumerate() {
                    row.copy_from_slice(&rest[lane.min(last) * inputs..][..inputs]);
                }
                transpose(&padded, &mut x[..inputs]);
                work(first_row + count * LANES, &x[..inputs])?;
            }
        }
        Ok(())
    }

    /// Nothing, if the outputs are finite or may be what they are.
    #[inline(always)]
    fn check_outputs(
        &self,
        outputs: Lanes,
        strengths: Lanes,
        points: &[f64],
        row: usize,
        first: usize,
    ) -> Result<()> {
        if Lanes::bits(outputs.abs().le(Lanes::splat(f64::MAX))) == 0xFF {
            return Ok(());
        }
        let inputs = self.inputs().len();
        let rows = points[row * inputs..].chunks_exact(inputs).enumerate();
        let each = outputs.to_array().into_iter().zip(strengths.to_array());
        for ((lane, point), (output, strength)) in rows.zip(each) {
            if !output.is_finite() {
                let place = || format!("point {} {point:?}", first + row + lane);
                self.settle_special(output, strength, place)?;
            }
        }
        Ok(())
    }
}

/// Turns eight rows into columns.
#[inline(always)]
fn transpose(rows: &[f64], columns: &mut [Lanes]) {
    let width = columns.len();
    for (k, column) in columns.iter_mut().enumerate() {
        *column = Lanes::new(std::array::from_fn(|lane| rows[lane * width + k]));
    }
}

/// Nothing, if all numbers are finite; otherwise an error that names the first that is not.
fn check_rows(system: &Tsk, rows: &[f64], first: usize) -> Result<()> {
    // Without an early exit, so that the loop is vectorised.
    if !rows.iter().fold(false, |bad, value| bad | !value.is_finite()) {
        return Ok(());
    }
    let inputs = system.inputs().len();
    let index = rows.iter().position(|value| !value.is_finite()).unwrap_or(0);
    let name = system.inputs()[index % inputs].name();
    let what = format!("input \"{name}\" of point {}", first + index / inputs);
    Err(Error::NotFinite { what, value: rows[index] })
}

#[cfg(test)]
mod tests {
    use crate::{MembershipFunction, NoRuleFires, Order, Rng, Shape, Tsk, Variable};

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
                let points = points(3 * super::BLOCK + 13, inputs);
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
