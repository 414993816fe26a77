//! Zero-sum games of two players given as a matrix: what each can be sure of, and how.

use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};

/// The value of a matrix game and a pair of optimal mixed strategies.
///
/// The row player picks a row, the column player a column, at the same time; the first gets the
/// payoff there and the second loses it. With mixed strategies, probabilities x of the rows and y
/// of the columns, max over x of min over y of xᵀAy equals the minimum of the maximum (von Neumann
/// 1928): the value of the game. Littman (1994) gives it to the states of a Markov game.
///
/// A linear programme finds them. Payoffs are first brought into \[1, 2\], so that the value is
/// positive; then max Σw subject to Bw ≤ 1, w ≥ 0 has the optimum 1/value, w·value is the column
/// player's strategy and the dual solution, scaled alike, the row player's. The simplex method
/// solves it in a table of the matrix's size: it holds the columns that are not in the basis only.
/// The entering column is that of the largest reduced cost (Dantzig); while steps make no progress
/// that of the lowest index (Bland 1977), so that it cannot cycle.
///
/// Scratch is allocated once for games of one size.
///
/// ```
/// use fuzzy_core::learn::rl::MatrixGame;
///
/// // Rock, paper, scissors.
/// let mut game = MatrixGame::new(3, 3)?;
/// let value = game.solve(&[0.0, -1.0, 1.0, 1.0, 0.0, -1.0, -1.0, 1.0, 0.0])?;
/// assert!(value.abs() < 1e-12);
/// assert!(game.row_strategy().iter().all(|p| (p - 1.0 / 3.0).abs() < 1e-12));
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct MatrixGame {
    rows: usize,
    columns: usize,
    payoffs: Vec<f64>,
    /// The payoffs in \[1, 2\], row by row, at first; a row for each basic variable, a column for
    /// each other.
    table: Vec<f64>,
    /// The right-hand side of each row, and at the end the reduced costs.
    bounds: Vec<f64>,
    costs: Vec<f64>,
    /// Which variable belongs to each row and to each column: w₀, w₁, … and then the rows' slacks.
    basic: Vec<usize>,
    free: Vec<usize>,
    row_strategy: Vec<f64>,
    column_strategy: Vec<f64>,
}

/// Reduced costs and pivots below count as zero; payoffs are at most 2.
const ZERO: f64 = 1e-11;
/// What the strategies secure may differ by that share of the payoffs' range.
const LARGEST_GAP: f64 = 1e-9;
/// So often the table is made anew, if rounding made the gap larger.
const REFRESHES: usize = 3;

impl MatrixGame {
    /// Games of so many rows and columns, one at least of each.
    pub fn new(rows: usize, columns: usize) -> Result<Self> {
        check::at_least("rows of a matrix game", rows, 1)?;
        check::at_least("columns of a matrix game", columns, 1)?;
        let table = check::zeros("the table of a matrix game", rows, columns)?;
        Ok(Self {
            rows,
            columns,
            payoffs: table.clone(),
            table,
            bounds: vec![0.0; rows],
            costs: vec![0.0; columns],
            basic: vec![0; rows],
            free: vec![0; columns],
            row_strategy: vec![0.0; rows],
            column_strategy: vec![0.0; columns],
        })
    }

    /// Probabilities of the rows that secure the value of the game solved last against every
    /// column.
    pub fn row_strategy(&self) -> &[f64] {
        &self.row_strategy
    }

    /// Probabilities of the columns that concede no more than the value to any row.
    pub fn column_strategy(&self) -> &[f64] {
        &self.column_strategy
    }

    /// Solves the game with these payoffs, row by row, and returns its value.
    ///
    /// The strategies secure the value to within 10⁻⁹ of the payoffs' range. If rounding prevents
    /// that, or a payoff is not finite, it is an error.
    pub fn solve(&mut self, payoffs: &[f64]) -> Result<f64> {
        self.solve_watched(payoffs, &Control::new())
    }

    /// [`solve`](Self::solve) that can be stopped from outside, for large games.
    pub fn solve_watched(&mut self, payoffs: &[f64], control: &Control) -> Result<f64> {
        check::same_length("payoffs of a matrix game", self.table.len(), payoffs.len())?;
        check::all_finite("payoffs", payoffs)?;
        let columns = self.columns;
        self.solve_by(|row, column| payoffs[row * columns + column], control)
    }

    /// The same for finite payoffs that a function tells.
    pub(super) fn solve_by(
        &mut self,
        payoff: impl Fn(usize, usize) -> f64,
        control: &Control,
    ) -> Result<f64> {
        for (row, entries) in self.payoffs.chunks_exact_mut(self.columns).enumerate() {
            entries.iter_mut().enumerate().for_each(|(column, x)| *x = payoff(row, column));
        }
        let least = self.payoffs.iter().copied().fold(f64::INFINITY, f64::min);
        let most = self.payoffs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let range = check::finite("range of the payoffs", most - least)?;
        if range == 0.0 {
            // Every strategy is optimal.
            self.row_strategy.fill(1.0 / self.rows as f64);
            self.column_strategy.fill(1.0 / self.columns as f64);
            return Ok(least);
        }
        self.payoffs.iter_mut().for_each(|x| *x = (*x - least) / range + 1.0);
        self.begin();
        for _ in 0..=REFRESHES {
            self.maximise(control)?;
            let (secured, conceded) = self.read_strategies();
            if conceded - secured <= LARGEST_GAP {
                return Ok((0.5 * (secured + conceded) - 1.0).mul_add(range, least));
            }
            self.refresh();
        }
        Err(unsolved("rounding errors grew too large"))
    }

    /// The table in which all slacks are basic.
    fn begin(&mut self) {
        self.table.copy_from_slice(&self.payoffs);
        self.bounds.fill(1.0);
        self.costs.fill(1.0);
        let columns = self.columns;
        self.free.iter_mut().enumerate().for_each(|(column, variable)| *variable = column);
        self.basic.iter_mut().enumerate().for_each(|(row, variable)| *variable = columns + row);
    }

    /// The simplex method, up to an optimum or as far as rounding lets it get: whether that is near
    /// enough is seen by the strategies.
    fn maximise(&mut self, control: &Control) -> Result<()> {
        let mut stalled = false;
        // Dantzig's rule takes a few times the number of rows in practice. Among entries of all
        // magnitudes repairs and steps may undo each other.
        for _ in 0..100 * (self.rows + self.columns) {
            control.check()?;
            let Some(entering) = self.entering(stalled) else {
                // Only a table made anew may have a row to repair.
                let Some((row, column)) = self.repairing() else { return Ok(()) };
                self.pivot(row, column);
                continue;
            };
            // A column without pivot is one of rounding errors.
            let Some((leaving, ratio)) = self.leaving(entering, stalled) else { return Ok(()) };
            stalled = self.costs[entering] * ratio <= ZERO;
            self.pivot(leaving, entering);
        }
        Ok(())
    }

    /// Makes the table of the present basis anew from the payoffs, without the rounding errors of
    /// the way to it: by the largest pivots that lead there.
    fn refresh(&mut self) {
        let (rows, columns) = (self.rows, self.columns);
        let mut wanted = vec![false; rows + columns];
        self.basic.iter().for_each(|&variable| wanted[variable] = true);
        self.begin();
        loop {
            let mut largest = (ZERO, None);
            for row in (0..rows).filter(|&row| !wanted[self.basic[row]]) {
                for column in (0..columns).filter(|&column| wanted[self.free[column]]) {
                    let size = self.table[row * columns + column].abs();
                    if size > largest.0 {
                        largest = (size, Some((row, column)));
                    }
                }
            }
            let Some((row, column)) = largest.1 else { return };
            self.pivot(row, column);
        }
    }

    /// The column whose variable enters the basis; none at the optimum.
    fn entering(&self, stalled: bool) -> Option<usize> {
        let growing = self.costs.iter().enumerate().filter(|&(_, &cost)| cost > ZERO);
        if stalled {
            return growing.map(|(column, _)| column).min_by_key(|&column| self.free[column]);
        }
        growing.max_by(|a, b| a.1.total_cmp(b.1)).map(|(column, _)| column)
    }

    /// The row whose variable leaves, and how far the entering one grows. Of several that bound it
    /// alike the first, or that of the lowest index (Bland): any preference for large or small
    /// payoffs there would prefer some optimal strategies, whatever the order of the rows.
    fn leaving(&self, entering: usize, stalled: bool) -> Option<(usize, f64)> {
        let pivots = self.table.iter().skip(entering).step_by(self.columns);
        let rows = pivots.zip(&self.bounds).enumerate();
        let ratios = rows
            .filter(|(_, (pivot, _))| **pivot > ZERO)
            .map(|(row, (pivot, bound))| (row, bound.max(0.0) / pivot));
        let least = ratios.clone().map(|(_, ratio)| ratio).fold(f64::INFINITY, f64::min);
        let mut alike = ratios.filter(|&(_, ratio)| ratio <= least + ZERO);
        if stalled { alike.min_by_key(|&(row, _)| self.basic[row]) } else { alike.next() }
    }

    /// A step of the dual simplex method: the row whose variable is most below zero, and the column
    /// whose reduced cost allows least.
    fn repairing(&self) -> Option<(usize, usize)> {
        let below = self.bounds.iter().enumerate().filter(|&(_, &bound)| bound < -ZERO);
        let (row, _) = below.min_by(|a, b| a.1.total_cmp(b.1))?;
        let entries = self.table[row * self.columns..][..self.columns].iter().zip(&self.costs);
        let ratios = entries.map(|(entry, cost)| cost.min(0.0) / entry).enumerate();
        let usable = ratios.filter(|&(column, _)| self.table[row * self.columns + column] < -ZERO);
        let (column, _) = usable.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((row, column))
    }

    /// Exchanges the variables of a row and a column.
    fn pivot(&mut self, row: usize, column: usize) {
        let columns = self.columns;
        let (above, rest) = self.table.split_at_mut(row * columns);
        let (own, below) = rest.split_at_mut(columns);
        let inverse = 1.0 / own[column];
        own.iter_mut().for_each(|x| *x *= inverse);
        own[column] = inverse;
        self.bounds[row] *= inverse;
        let bound = self.bounds[row];

        let eliminate = |entries: &mut [f64]| {
            let factor = entries[column];
            entries[column] = 0.0;
            entries.iter_mut().zip(&*own).for_each(|(x, own)| *x = (-factor).mul_add(*own, *x));
            factor
        };
        let (before, after) = self.bounds.split_at_mut(row);
        for (entries, other) in above.chunks_exact_mut(columns).zip(before) {
            *other = (-eliminate(entries)).mul_add(bound, *other);
        }
        for (entries, other) in below.chunks_exact_mut(columns).zip(&mut after[1..]) {
            *other = (-eliminate(entries)).mul_add(bound, *other);
        }
        eliminate(&mut self.costs);
        std::mem::swap(&mut self.basic[row], &mut self.free[column]);
    }

    /// Reads both strategies from the last table: the column player's from the right-hand sides,
    /// the row player's, the dual solution, from the reduced costs of the slacks. Returns what the
    /// row player secures and what the column player concedes.
    fn read_strategies(&mut self) -> (f64, f64) {
        self.row_strategy.fill(0.0);
        self.column_strategy.fill(0.0);
        for (&variable, &bound) in self.basic.iter().zip(&self.bounds) {
            if variable < self.columns {
                self.column_strategy[variable] = bound.max(0.0);
            }
        }
        for (&variable, &cost) in self.free.iter().zip(&self.costs) {
            if variable >= self.columns {
                self.row_strategy[variable - self.columns] = (-cost).max(0.0);
            }
        }
        for strategy in [&mut self.row_strategy, &mut self.column_strategy] {
            let total: f64 = strategy.iter().sum();
            strategy.iter_mut().for_each(|p| *p /= total);
        }
        let mut conceded = f64::NEG_INFINITY;
        let rows = self.payoffs.chunks_exact(self.columns);
        for payoffs in rows.clone() {
            let each = payoffs.iter().zip(&self.column_strategy);
            conceded = conceded.max(each.fold(0.0, |sum, (payoff, p)| p.mul_add(*payoff, sum)));
        }
        let secured = (0..self.columns).map(|column| {
            let each = rows.clone().zip(&self.row_strategy);
            each.fold(0.0, |sum, (payoffs, p)| p.mul_add(payoffs[column], sum))
        });
        (secured.fold(f64::INFINITY, f64::min), conceded)
    }
}

#[cold]
fn unsolved(reason: &str) -> Error {
    Error::Unsuitable {
        what: "matrix of payoffs".to_owned(),
        reason: format!("{reason}; bring payoffs to one order of magnitude"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The value, and both strategies after the checks that any solution must pass.
    fn solved(rows: usize, columns: usize, payoffs: &[f64]) -> (f64, Vec<f64>, Vec<f64>) {
        let mut game = MatrixGame::new(rows, columns).unwrap();
        let value = game.solve(payoffs).unwrap();
        let (x, y) = (game.row_strategy().to_vec(), game.column_strategy().to_vec());
        for strategy in [&x, &y] {
            assert!((strategy.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(strategy.iter().all(|&p| p >= 0.0));
        }
        let most = payoffs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = payoffs.iter().copied().fold(f64::INFINITY, f64::min);
        let (range, size) = (most - least, most.abs().max(least.abs()));
        let against = |column: usize| -> f64 {
            (0..rows).map(|row| x[row] * payoffs[row * columns + column]).sum()
        };
        let of = |row: usize| -> f64 {
            (0..columns).map(|column| y[column] * payoffs[row * columns + column]).sum()
        };
        let secured = (0..columns).map(against).fold(f64::INFINITY, f64::min);
        let conceded = (0..rows).map(of).fold(f64::NEG_INFINITY, f64::max);
        let rounding = 1e-14 * size;
        assert!(conceded - secured <= 1.001e-9 * range + rounding, "{secured} {conceded}");
        assert!(value >= secured - rounding && value <= conceded + rounding);
        (value, x, y)
    }

    fn near(values: &[f64], expected: &[f64]) -> bool {
        values.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-12)
    }

    #[test]
    fn games_with_known_solutions() {
        let (value, x, y) = solved(2, 2, &[3.0, -1.0, -2.0, 1.0]);
        // (ad − bc)/(a + d − b − c) and its strategies.
        assert!((value - 1.0 / 7.0).abs() < 1e-12);
        assert!(near(&x, &[3.0 / 7.0, 4.0 / 7.0]) && near(&y, &[2.0 / 7.0, 5.0 / 7.0]));
        // A saddle point: row 1, column 0.
        let (value, x, y) = solved(2, 3, &[1.0, 5.0, -2.0, 2.0, 3.0, 4.0]);
        assert!((value - 2.0).abs() < 1e-12 && near(&x, &[0.0, 1.0]) && near(&y, &[1.0, 0.0, 0.0]));
        // One row, one column, and payoffs that are all the same.
        assert!((solved(1, 3, &[4.0, -1.0, 2.0]).0 + 1.0).abs() < 1e-12);
        assert!((solved(3, 1, &[4.0, -1.0, 2.0]).0 - 4.0).abs() < 1e-12);
        assert_eq!(solved(2, 2, &[0.3; 4]).0, 0.3);
    }

    #[test]
    fn large_games_and_sizes_are_solved() {
        let mut rng = crate::Rng::new(3, 0);
        for (rows, columns) in [(11, 21), (60, 40), (40, 90)] {
            let payoffs: Vec<f64> = (0..rows * columns).map(|_| rng.normal()).collect();
            solved(rows, columns, &payoffs);
        }
        let payoffs: Vec<f64> = (0..11 * 21).map(|_| 1e-200 * rng.normal()).collect();
        solved(11, 21, &payoffs);
        let payoffs: Vec<f64> = (0..11 * 21).map(|_| 1e200 + 1e199 * rng.normal()).collect();
        solved(11, 21, &payoffs);
    }

    #[test]
    fn repairs_that_undo_steps_end() {
        // Found by chance: entries of thirty orders of magnitude.
        let mut rng = crate::Rng::new(17_854_690_414_921_038_284, 0);
        let payoffs: Vec<f64> =
            (0..48).map(|_| rng.normal() * 10.0_f64.powi(rng.below(30) as i32 - 15)).collect();
        solved(8, 6, &payoffs);
    }

    #[test]
    fn what_is_no_game_is_refused() {
        assert!(MatrixGame::new(0, 2).is_err() && MatrixGame::new(2, 0).is_err());
        assert!(MatrixGame::new(usize::MAX, 2).is_err());
        let mut game = MatrixGame::new(2, 2).unwrap();
        assert!(game.solve(&[1.0; 3]).is_err());
        assert!(game.solve(&[1.0, f64::NAN, 0.0, 0.0]).is_err());
        assert!(game.solve(&[1e308, -1e308, 0.0, 0.0]).is_err());
        let control = Control::new();
        control.cancel();
        let stopped = game.solve_watched(&[1.0, 0.0, 0.0, 1.0], &control);
        assert_eq!(stopped, Err(Error::Cancelled));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5000))]
        #[test]
        fn degenerate_games_are_solved(
            rows in 1_usize..9,
            columns in 1_usize..9,
            seed in any::<u64>(),
            levels in 1_usize..5,
        ) {
            // Few different payoffs: many ties, equal rows and equal columns.
            let mut rng = crate::Rng::new(seed, 0);
            let payoffs: Vec<f64> =
                (0..rows * columns).map(|_| rng.below(levels) as f64 - 1.0).collect();
            solved(rows, columns, &payoffs);
        }

        #[test]
        fn games_of_all_magnitudes_are_solved(
            rows in 1_usize..9,
            columns in 1_usize..9,
            seed in any::<u64>(),
        ) {
            let mut rng = crate::Rng::new(seed, 0);
            let payoffs: Vec<f64> = (0..rows * columns)
                .map(|_| rng.normal() * 10.0_f64.powi(rng.below(30) as i32 - 15))
                .collect();
            solved(rows, columns, &payoffs);
        }

        #[test]
        fn a_game_and_its_mirror_have_opposite_values(
            rows in 1_usize..9,
            columns in 1_usize..9,
            seed in any::<u64>(),
        ) {
            let mut rng = crate::Rng::new(seed, 0);
            let payoffs: Vec<f64> = (0..rows * columns).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
            let mirror: Vec<f64> = (0..columns)
                .flat_map(|column| (0..rows).map(move |row| (row, column)))
                .map(|(row, column)| -payoffs[row * columns + column])
                .collect();
            let (value, ..) = solved(rows, columns, &payoffs);
            let (other, ..) = solved(columns, rows, &mirror);
            prop_assert!((value + other).abs() < 1e-11);
        }
    }
}
