//! How strongly each rule fires, and what each has in the outputs.

use super::evaluate::with_scratch;
use super::parts::Parts;
use super::rows::{for_each_eight, in_blocks};
use super::{Inference, Kernel};
use crate::check;
use crate::error::Result;
use crate::math::{Lanes, Real};

/// A system whose rules can be looked at one by one.
pub trait Rules: Inference {
    /// The number of rules.
    fn rule_count(&self) -> usize;

    /// Writes the firing strength of every rule, its weight included, at a point of finite
    /// numbers that are [admitted](super::Interface::admit). `scratch` is as long as for
    /// [`infer`](Inference::infer).
    fn fire<R: Kernel<f64>>(&self, x: &[R], scratch: &mut [R], strengths: &mut [R]);

    /// What each rule has in each output at an admitted point where rules fire this strongly.
    fn parts(&self, x: &[f64], strengths: &[f64]) -> Vec<Parts>;

    /// The firing strength of every rule at one point, its weight included.
    fn firing_strengths(&self, x: &[f64]) -> Result<Vec<f64>> {
        let interface = self.interface();
        interface.check_point(x)?;
        let mut admitted = x.to_vec();
        interface.admit(&mut admitted);
        let mut strengths = check::zeros("the firing strengths", 1, self.rule_count())?;
        with_scratch(self.scratch_count(), |scratch| {
            self.fire(&admitted, scratch, &mut strengths);
        });
        Ok(strengths)
    }

    /// The firing strengths at the rows of `points` (row-major, one row for each point), row by
    /// row one for each rule, on up to `threads` threads (0: one for each core).
    ///
    /// Equal to [`firing_strengths`](Self::firing_strengths) of each row, to the bit.
    fn firing_strengths_batch(
        &self,
        points: &[f64],
        strengths: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        let (interface, width) = (self.interface(), self.rule_count());
        in_blocks(interface, points, strengths, width, threads, |rows, strengths, first| {
            fire_rows(self, rows, strengths, first)
        })
    }
}

/// The firing strengths at rows in lanes. `first` is the number of the first for messages.
fn fire_rows<S: Rules>(
    system: &S,
    points: &[f64],
    strengths: &mut [f64],
    first: usize,
) -> Result<()> {
    let (zero, width) = (Lanes::splat(0.0), system.rule_count());
    let mut scratch = vec![zero; system.scratch_count()];
    let mut lanes = vec![zero; width];
    for_each_eight(system.interface(), points, first, |row, x| {
        system.fire(x, &mut scratch, &mut lanes);
        for (rule, lanes) in lanes.iter().enumerate() {
            let rows = strengths[row * width..].chunks_exact_mut(width);
            rows.zip(lanes.to_array()).for_each(|(row, strength)| row[rule] = strength);
        }
        Ok(())
    })
}
