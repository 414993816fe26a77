//! Walking over the rows of a batch: eight in lock-step, blocks of them on several threads.

use super::Interface;
use crate::check;
use crate::error::Result;
use crate::math::{LANES, Lanes, Real};
use crate::parallel;

/// Rows that one thread takes at a time; fixed, so that it cannot depend on the threads.
pub(super) const BLOCK: usize = 4096;

/// Cuts the rows of `points` into blocks and gives each to `work`, with the results' part of
/// `width` numbers a row and the number of its first row.
pub(super) fn in_blocks(
    interface: &Interface,
    points: &[f64],
    results: &mut [f64],
    width: usize,
    threads: usize,
    work: impl Fn(&[f64], &mut [f64], usize) -> Result<()> + Sync + Send,
) -> Result<()> {
    let inputs = interface.inputs().len();
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

/// Gives `work` eight rows at a time: the number of the first and the inputs in lanes, checked
/// and brought into their universes as the interface says. The last row also fills the lanes
/// left over. `first` is the number of the first row for messages.
#[inline(always)]
pub(super) fn for_each_eight(
    interface: &Interface,
    points: &[f64],
    first: usize,
    mut work: impl FnMut(usize, &[Lanes]) -> Result<()>,
) -> Result<()> {
    // Some rows are turned into columns well before they are read: a vector load right
    // after scalar stores would have to wait for them.
    const AHEAD: usize = 8;
    let inputs = interface.inputs().len();
    let mut x = vec![Lanes::splat(0.0); AHEAD * inputs];
    let mut padded = vec![0.0; LANES * inputs];
    for (block, rows) in points.chunks(AHEAD * LANES * inputs).enumerate() {
        let first_row = block * AHEAD * LANES;
        interface.check_rows(rows, Some(first + first_row))?;
        let eights = rows.chunks_exact(LANES * inputs);
        let (rest, count) = (eights.remainder(), eights.len());
        for (eight, x) in eights.zip(x.chunks_exact_mut(inputs)) {
            transpose(eight, x);
            interface.admit(x);
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
            interface.admit(&mut x[..inputs]);
            work(first_row + count * LANES, &x[..inputs])?;
        }
    }
    Ok(())
}

/// Turns eight rows into columns.
#[inline(always)]
fn transpose(rows: &[f64], columns: &mut [Lanes]) {
    let width = columns.len();
    for (k, column) in columns.iter_mut().enumerate() {
        *column = Lanes::new(std::array::from_fn(|lane| rows[lane * width + k]));
    }
}
