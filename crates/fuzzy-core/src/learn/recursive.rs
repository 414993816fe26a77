//! Recursive least squares: the solution of a least-squares problem while its rows still come.

use super::least_squares::{add_multiple, dot};
use crate::check;
use crate::error::{Error, Result};

/// The running solution of f ≈ θᵀa for rows a with one or several targets f.
///
/// With the forgetting factor λ and the covariance P, which begins as a multiple of the unit
/// matrix, every row is one step (Jang 1993, equation 14; Åström and Wittenmark 1995, 2.2):
///
/// - gain k = Pa/(λ + aᵀPa),
/// - θ ← θ + k·(f − aᵀθ),
/// - P ← (P − k·aᵀP)/λ.
///
/// For λ = 1 the result after any number of rows is the minimum of Σ(f − aᵀθ)² + ‖θ‖²/c, where c
/// is the initial covariance; for λ < 1 a row's weight falls by the factor λ with each that
/// follows. In directions that rows no longer excite P then grows as λ⁻ⁿ, so λ should stay near 1.
///
/// ```
/// use fuzzy_core::learn::recursive::RecursiveLeastSquares;
///
/// let mut line = RecursiveLeastSquares::new(2, 1, 1.0, 1e6)?;
/// for x in [0.0, 1.0, 2.0, 3.0] {
///     line.update(&[x, 1.0], &[2.0 * x + 1.0])?;
/// }
/// assert!((line.solution()[0] - 2.0).abs() < 1e-5);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RecursiveLeastSquares {
    forgetting: f64,
    unknowns: usize,
    /// θ, target by target.
    solution: Vec<f64>,
    covariance: Vec<f64>,
    /// Pa, kept so that a step allocates nothing.
    projected: Vec<f64>,
}

impl RecursiveLeastSquares {
    /// Begins with θ = 0 and P = covariance · I, for so many unknowns for each target.
    ///
    /// The forgetting factor lies above 0 and up to 1; the covariance is positive, large where
    /// little is known (1e4 to 1e8 is usual).
    pub fn new(unknowns: usize, targets: usize, forgetting: f64, covariance: f64) -> Result<Self> {
        check::at_least("unknowns", unknowns, 1)?;
        check::at_least("targets", targets, 1)?;
        check::within("forgetting factor", forgetting, "above 0 and at most 1", |factor| {
            factor > 0.0 && factor <= 1.0
        })?;
        check::positive("initial covariance", covariance)?;
        let mut matrix = check::zeros("the covariance", unknowns, unknowns)?;
        matrix.iter_mut().step_by(unknowns + 1).for_each(|value| *value = covariance);
        Ok(Self {
            forgetting,
            unknowns,
            solution: check::zeros("the solution", targets, unknowns)?,
            covariance: matrix,
            projected: vec![0.0; unknowns],
        })
    }

    /// The same with another solution to begin with, target by target.
    pub fn starting_from(mut self, solution: &[f64]) -> Result<Self> {
        check::same_length("numbers of the solution", self.solution.len(), solution.len())?;
        check::all_finite("solution", solution)?;
        self.solution.copy_from_slice(solution);
        Ok(self)
    }

    /// The same with another covariance P to begin with: a symmetric matrix, row by row, whose
    /// diagonal is not negative.
    pub fn with_covariance(mut self, covariance: &[f64]) -> Result<Self> {
        let count = self.unknowns;
        check::same_length("numbers of the covariance", count * count, covariance.len())?;
        check::all_finite("covariance", covariance)?;
        let entry = |i: usize, j: usize| covariance[i * count + j];
        let mirrored = (0..count).all(|i| (0..i).all(|j| entry(i, j) == entry(j, i)));
        if !mirrored || (0..count).any(|i| entry(i, i) < 0.0) {
            return Err(Error::Unsuitable {
                what: "the covariance".to_owned(),
                reason: "it must be symmetric, its diagonal not negative".to_owned(),
            });
        }
        self.covariance.copy_from_slice(covariance);
        Ok(self)
    }

    /// The number of unknowns for each target.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// The number of targets.
    pub fn targets(&self) -> usize {
        self.solution.len() / self.unknowns
    }

    /// The forgetting factor λ.
    pub fn forgetting(&self) -> f64 {
        self.forgetting
    }

    /// θ, target by target.
    pub fn solution(&self) -> &[f64] {
        &self.solution
    }

    /// P, row by row.
    pub fn covariance(&self) -> &[f64] {
        &self.covariance
    }

    /// aᵀθ for each target.
    pub fn predict(&self, row: &[f64]) -> Result<Vec<f64>> {
        self.check_row(row)?;
        Ok(self.solution.chunks_exact(self.unknowns).map(|own| dot(own, row)).collect())
    }

    /// Takes a row with its targets. After an error everything is as it was.
    pub fn update(&mut self, row: &[f64], targets: &[f64]) -> Result<()> {
        self.check_row(row)?;
        check::same_length("targets of the row", self.targets(), targets.len())?;
        check::all_finite("targets of the row", targets)?;
        for (projected, own) in
            self.projected.iter_mut().zip(self.covariance.chunks_exact(self.unknowns))
        {
            *projected = dot(own, row);
        }
        let inverse = 1.0 / (self.forgetting + dot(&self.projected, row));
        let errors = targets.iter().zip(self.solution.chunks_exact(self.unknowns));
        let errors: Vec<f64> =
            errors.map(|(target, own)| (target - dot(own, row)) * inverse).collect();
        // Every number of P grows by at most the factor 1/λ.
        let largest =
            self.covariance.iter().step_by(self.unknowns + 1).fold(0.0_f64, |m, v| m.max(v.abs()));
        let sound = inverse > 0.0 && (largest / self.forgetting).is_finite();
        if !sound || errors.iter().any(|error| !error.is_finite()) {
            return Err(Error::Unsuitable {
                what: "the row".to_owned(),
                reason: "recursive least squares overflows or loses its positive covariance; \
                         scale the rows, or take a smaller covariance or a forgetting factor \
                         nearer 1"
                    .to_owned(),
            });
        }
        for (own, error) in self.solution.chunks_exact_mut(self.unknowns).zip(errors) {
            add_multiple(own, error, &self.projected);
        }
        let (forgotten, projected) = (1.0 / self.forgetting, &self.projected);
        for (own, &factor) in self.covariance.chunks_exact_mut(self.unknowns).zip(projected) {
            // The product first, so that P stays symmetric to the bit.
            for (value, &other) in own.iter_mut().zip(projected) {
                *value = (-(factor * other)).mul_add(inverse, *value) * forgotten;
            }
        }
        Ok(())
    }

    fn check_row(&self, row: &[f64]) -> Result<()> {
        check::same_length("numbers of the row", self.unknowns, row.len())?;
        check::all_finite("row", row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;
    use crate::learn::least_squares::Triangle;

    fn problem(rows: usize, unknowns: usize) -> (Vec<f64>, Vec<f64>) {
        let mut rng = Rng::new(4, 0);
        let a = (0..rows * unknowns).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        (a, (0..rows).map(|_| rng.uniform_in(-1.0, 1.0)).collect())
    }

    #[test]
    fn weighted_least_squares_is_solved_row_by_row() {
        let (rows, unknowns, covariance) = (40, 5, 1e3);
        let (a, f) = problem(rows, unknowns);
        for forgetting in [1.0, 0.95_f64] {
            let mut running =
                RecursiveLeastSquares::new(unknowns, 2, forgetting, covariance).unwrap();
            // A weight w in the sum of squares is a factor √w of the row.
            let mut whole = Triangle::new(unknowns).unwrap();
            let root = |power: usize| forgetting.sqrt().powi(power as i32);
            for k in 0..unknowns {
                let mut unit = vec![0.0; unknowns];
                unit[k] = root(rows) / covariance.sqrt();
                whole.add(&unit, 0.0);
            }
            for (index, (row, &f)) in a.chunks(unknowns).zip(&f).enumerate() {
                running.update(row, &[f, -2.0 * f]).unwrap();
                let weight = root(rows - 1 - index);
                let scaled: Vec<f64> = row.iter().map(|value| value * weight).collect();
                whole.add(&scaled, f * weight);
            }
            let expected = whole.solve();
            for (k, expected) in expected.iter().enumerate() {
                assert!((running.solution()[k] - expected).abs() < 1e-9);
                assert!((running.solution()[unknowns + k] + 2.0 * expected).abs() < 1e-9);
            }
            let p = running.covariance();
            assert!(
                (0..unknowns).all(|i| (0..i).all(|j| p[i * unknowns + j] == p[j * unknowns + i]))
            );
        }
    }

    #[test]
    fn what_cannot_be_is_refused_and_changes_nothing() {
        assert!(RecursiveLeastSquares::new(0, 1, 1.0, 1.0).is_err());
        assert!(RecursiveLeastSquares::new(1, 0, 1.0, 1.0).is_err());
        assert!(RecursiveLeastSquares::new(1, 1, 1.1, 1.0).is_err());
        assert!(RecursiveLeastSquares::new(1, 1, 0.0, 1.0).is_err());
        assert!(RecursiveLeastSquares::new(1, 1, 1.0, f64::NAN).is_err());
        let mut running = RecursiveLeastSquares::new(2, 1, 0.5, 1.0).unwrap();
        running.update(&[1.0, 0.5], &[2.0]).unwrap();
        let before = running.clone();
        assert!(running.update(&[1.0], &[2.0]).is_err());
        assert!(running.update(&[1.0, f64::NAN], &[2.0]).is_err());
        assert!(running.update(&[1.0, 1.0], &[f64::INFINITY]).is_err());
        assert!(running.update(&[1e200, 1.0], &[1.0]).is_err());
        assert_eq!(running.solution(), before.solution());
        assert_eq!(running.covariance(), before.covariance());
        // Nothing excites the second direction, whose covariance doubles with every row.
        let failed = (0..2000).find_map(|_| running.update(&[1.0, 0.0], &[1.0]).err());
        assert!(failed.unwrap().to_string().contains("nearer 1"));
    }
}
