//! Linear least squares, θ = argmin ‖Aθ − f‖² + ρ‖θ‖²: by the normal equations, and by orthogonal
//! transformations where these are too inexact.
//!
//! Plain loops in a fixed order, so that the numbers are the same on every machine.

use crate::check;
use crate::error::Result;
use crate::math::{LANES, Lanes, Real};

/// A pivot of the normal matrix that keeps no larger share of its column than this says that the
/// column nearly follows from those before.
const LEAST_PIVOT: f64 = 1e-10;

/// Solves Gθ = b for the normal matrix G = AᵀA + ρI, row by row with its upper half at least, and
/// b = Aᵀf, by Cholesky's factorisation G = UᵀU. `None` if G is singular or nearly so. G is
/// overwritten.
pub(super) fn cholesky(gram: &mut [f64], rhs: &[f64]) -> Option<Vec<f64>> {
    let count = rhs.len();
    let diagonal: Vec<f64> = gram.iter().step_by(count + 1).copied().collect();
    let mut solution = rhs.to_vec();
    for (k, whole) in diagonal.into_iter().enumerate() {
        let (above, below) = gram.split_at_mut((k + 1) * count);
        let own = &mut above[k * count + k..];
        // Neither zero nor NaN is a pivot.
        if own[0].is_nan() || own[0] <= LEAST_PIVOT * whole {
            return None;
        }
        let scale = 1.0 / own[0].sqrt();
        own.iter_mut().for_each(|value| *value *= scale);
        for (below, row) in (k + 1..).zip(below.chunks_exact_mut(count)) {
            add_multiple(&mut row[below..], -own[below - k], &own[below - k..]);
        }
        let (known, rest) = solution[k..].split_at_mut(1);
        known[0] /= own[0];
        add_multiple(rest, -known[0], &own[1..]);
    }
    solve_upper(gram, count, &mut solution);
    Some(solution)
}

/// Least squares by Householder's reflections: rows of A come in any number, and what is kept is
/// the triangle R of A = QR beside Qᵀf.
#[derive(Debug, Clone)]
pub(super) struct Triangle {
    unknowns: usize,
    rows: usize,
    /// R and, as a last column, Qᵀf; row by row.
    triangle: Vec<f64>,
    /// Rows that are not in the triangle yet, column by column.
    waiting: Vec<f64>,
    waiting_rows: usize,
}

/// The rows that are reflected into the triangle together.
const WAITING: usize = 64;

impl Triangle {
    /// No rows yet.
    pub fn new(unknowns: usize) -> Result<Self> {
        Ok(Self {
            unknowns,
            rows: 0,
            triangle: check::zeros("the triangle of least squares", unknowns, unknowns + 1)?,
            waiting: check::zeros("the rows of least squares", WAITING, unknowns + 1)?,
            waiting_rows: 0,
        })
    }

    /// Takes one row of A and its number of f.
    pub fn add(&mut self, row: &[f64], target: f64) {
        let numbers = row.iter().copied().chain([target]);
        for (column, number) in self.waiting.chunks_exact_mut(WAITING).zip(numbers) {
            column[self.waiting_rows] = number;
        }
        self.waiting_rows += 1;
        self.rows += 1;
        if self.waiting_rows == WAITING {
            self.reflect();
        }
    }

    /// Brings the waiting rows into the triangle, column by column.
    fn reflect(&mut self) {
        let (width, used) = (self.unknowns + 1, self.waiting_rows);
        for k in 0..self.unknowns {
            let (own, others) = self.waiting[k * WAITING..].split_at_mut(WAITING);
            let own = &own[..used];
            let row = &mut self.triangle[k * width + k..][..width - k];
            // The reflection maps (rₖₖ, own) to (±norm, 0); v = (first, own) is its normal.
            let below = dot(own, own);
            if below == 0.0 {
                continue;
            }
            let norm = row[0].mul_add(row[0], below).sqrt();
            let image = -norm.copysign(row[0]);
            let first = row[0] - image;
            let scale = 2.0 / first.mul_add(first, below);
            row[0] = image;
            for (entry, column) in row[1..].iter_mut().zip(others.chunks_exact_mut(WAITING)) {
                let column = &mut column[..used];
                let along = scale * first.mul_add(*entry, dot(own, column));
                *entry = (-along).mul_add(first, *entry);
                add_multiple(column, -along, own);
            }
        }
        self.waiting_rows = 0;
    }

    /// The solution; of several the one of least norm.
    pub fn solve(mut self) -> Vec<f64> {
        self.reflect();
        let (count, width) = (self.unknowns, self.unknowns + 1);
        let column = |k: usize| (0..count).map(move |row| (row, k));
        let at = |(row, k): (usize, usize)| self.triangle[row * width + k];
        let mut columns: Vec<Vec<f64>> = (0..width).map(|k| column(k).map(at).collect()).collect();
        let mut target = columns.pop().unwrap_or_default();
        let (order, rank) = pivot(&mut columns, &mut target, self.rows.max(count));
        let mut solution = vec![0.0; count];
        for (place, value) in order.into_iter().zip(least_norm(&columns, rank, target)) {
            solution[place] = value;
        }
        solution
    }
}

/// Reflects columns into a triangle, each time the longest of those that are left: AP = QR. The
/// target goes along. Returns the order of the columns and the numerical rank.
fn pivot(columns: &mut [Vec<f64>], target: &mut [f64], size: usize) -> (Vec<usize>, usize) {
    let count = columns.len();
    let mut order: Vec<usize> = (0..count).collect();
    let mut largest = 0.0_f64;
    for k in 0..count {
        let length = |column: &[f64]| dot(&column[k..], &column[k..]);
        let mut longest = (k, length(&columns[k]));
        for (index, column) in columns.iter().enumerate().skip(k + 1) {
            let length = length(column);
            if length > longest.1 {
                longest = (index, length);
            }
        }
        let norm = longest.1.sqrt();
        largest = largest.max(norm);
        if norm <= size as f64 * f64::EPSILON * largest {
            return (order, k);
        }
        columns.swap(k, longest.0);
        order.swap(k, longest.0);
        let (before, after) = columns.split_at_mut(k + 1);
        let own = &mut before[k];
        let normal = Normal::of(&mut own[k..]);
        after.iter_mut().for_each(|column| normal.reflect(&mut column[k..]));
        normal.reflect(&mut target[k..]);
        own[k + 1..].fill(0.0);
    }
    (order, count)
}

/// Of the solutions of the first `rank` equations of a triangle that stands column by column the
/// shortest: with Tᵀ = Q(R; 0) for these rows T it is Q(y; 0), where Rᵀy = f.
fn least_norm(columns: &[Vec<f64>], rank: usize, mut target: Vec<f64>) -> Vec<f64> {
    let count = columns.len();
    let mut rows: Vec<Vec<f64>> =
        (0..rank).map(|row| columns.iter().map(|column| column[row]).collect()).collect();
    let mut normals = Vec::with_capacity(rank);
    for k in 0..rank {
        let (before, after) = rows.split_at_mut(k + 1);
        let normal = Normal::of(&mut before[k][k..]);
        after.iter_mut().for_each(|row| normal.reflect(&mut row[k..]));
        normals.push(normal);
    }
    target.truncate(rank);
    for k in 0..rank {
        let known = dot(&rows[k][..k], &target[..k]);
        target[k] = (target[k] - known) / rows[k][k];
    }
    target.resize(count, 0.0);
    for (k, normal) in normals.iter().enumerate().rev() {
        normal.reflect(&mut target[k..]);
    }
    target
}

/// The normal of a mirror.
struct Normal {
    vector: Vec<f64>,
    scale: f64,
}

impl Normal {
    /// The mirror that maps this vector to one with a first component only, which replaces its
    /// first; the others are left as they were.
    fn of(vector: &mut [f64]) -> Self {
        let length = dot(vector, vector).sqrt();
        let image = -length.copysign(vector[0]);
        let mut normal = vector.to_vec();
        normal[0] -= image;
        let square = dot(&normal, &normal);
        vector[0] = image;
        Self { vector: normal, scale: if square > 0.0 { 2.0 / square } else { 0.0 } }
    }

    fn reflect(&self, vector: &mut [f64]) {
        add_multiple(vector, -self.scale * dot(&self.vector, vector), &self.vector);
    }
}

/// Solves Uθ = y for the upper half U of a square matrix that stands row by row; θ replaces y.
fn solve_upper(upper: &[f64], count: usize, solution: &mut [f64]) {
    for (k, row) in upper.chunks_exact(count).enumerate().rev() {
        let (unknown, known) = solution[k..].split_at_mut(1);
        unknown[0] = (unknown[0] - dot(&row[k + 1..], known)) / row[k];
    }
}

/// Σ aᵢbᵢ, eight at a time.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let zero = Lanes::splat(0.0);
    let pairs = a.iter().zip(b);
    let sum = pairs.fold(zero, |sum, (&a, &b)| Lanes::new(a).mul_add(Lanes::new(b), sum));
    let rest = rest_a.iter().zip(rest_b);
    rest.fold(sum.to_array().iter().sum(), |sum: f64, (a, b)| a.mul_add(*b, sum))
}

/// target + factor·vector.
pub(super) fn add_multiple(target: &mut [f64], factor: f64, vector: &[f64]) {
    for (target, &number) in target.iter_mut().zip(vector) {
        *target = factor.mul_add(number, *target);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;

    fn random(count: usize, seed: u64) -> Vec<f64> {
        let mut rng = Rng::new(seed, 0);
        (0..count).map(|_| rng.uniform_in(-1.0, 1.0)).collect()
    }

    fn triangle(a: &[f64], f: &[f64]) -> Vec<f64> {
        let unknowns = a.len() / f.len();
        let mut triangle = Triangle::new(unknowns).unwrap();
        a.chunks(unknowns).zip(f).for_each(|(row, &f)| triangle.add(row, f));
        triangle.solve()
    }

    fn normal_equations(a: &[f64], f: &[f64]) -> Option<Vec<f64>> {
        let unknowns = a.len() / f.len();
        let (mut gram, mut rhs) = (vec![0.0; unknowns * unknowns], vec![0.0; unknowns]);
        for (row, &f) in a.chunks(unknowns).zip(f) {
            for (i, &value) in row.iter().enumerate() {
                add_multiple(&mut gram[i * unknowns..][..unknowns], value, row);
                rhs[i] += value * f;
            }
        }
        cholesky(&mut gram, &rhs)
    }

    fn near(a: &[f64], b: &[f64], tolerance: f64) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance)
    }

    #[test]
    fn a_solution_that_fits_is_found() {
        for (rows, unknowns) in [(1, 1), (5, 5), (64, 9), (65, 9), (200, 33)] {
            let (a, wanted) = (random(rows * unknowns, 1), random(unknowns, 2));
            let f: Vec<f64> = a.chunks(unknowns).map(|row| dot(row, &wanted)).collect();
            assert!(near(&triangle(&a, &f), &wanted, 1e-9), "{rows} {unknowns}");
            assert!(near(&normal_equations(&a, &f).unwrap(), &wanted, 1e-6));
        }
    }

    #[test]
    fn the_residual_is_at_right_angles_to_every_column() {
        let (rows, unknowns) = (150, 12);
        let (a, f) = (random(rows * unknowns, 3), random(rows, 4));
        for solution in [triangle(&a, &f), normal_equations(&a, &f).unwrap()] {
            for column in 0..unknowns {
                let along = a.chunks(unknowns).zip(&f);
                let along: f64 =
                    along.map(|(row, f)| row[column] * (f - dot(row, &solution))).sum();
                assert!(along.abs() < 1e-12, "{along}");
            }
        }
    }

    #[test]
    fn of_many_solutions_the_shortest_is_taken() {
        // Fewer rows than unknowns; then a column twice and one of zeros.
        let solution = triangle(&[1.0, 2.0, 2.0], &[9.0]);
        assert!(near(&solution, &[1.0, 2.0, 2.0], 1e-14));
        let a = [1.0, 1.0, 0.0, 0.5, 2.0, 2.0, 0.0, -1.0, 3.0, 3.0, 0.0, 4.0];
        let f = [2.5, 3.0, 10.0];
        assert!(near(&triangle(&a, &f), &[1.0, 1.0, 0.0, 1.0], 1e-14));
        assert_eq!(normal_equations(&a, &f), None);
        assert_eq!(triangle(&[0.0, 0.0], &[3.0]), [0.0, 0.0]);
    }

    #[test]
    fn reflections_hold_where_normal_equations_fail() {
        // Columns that differ by 1e-9 only.
        let column = random(40, 5);
        let other = random(40, 6);
        let a: Vec<f64> =
            column.iter().zip(&other).flat_map(|(c, o)| [*c, 1e-9_f64.mul_add(*o, *c)]).collect();
        let f: Vec<f64> = a.chunks(2).map(|row| row[0] - 2.0 * row[1]).collect();
        assert_eq!(normal_equations(&a, &f), None);
        assert!(near(&triangle(&a, &f), &[1.0, -2.0], 1e-5));
    }
}
