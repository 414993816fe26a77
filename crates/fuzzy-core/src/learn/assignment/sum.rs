//! The assignment with the least sum, by shortest augmenting paths.

/// No row, or no column.
const NONE: usize = usize::MAX;

/// The column of each row, for finite costs.
pub(super) fn least(costs: &[f64], size: usize) -> Vec<usize> {
    let mut search = Search::new(costs, size);
    search.take_free_pairs();
    for row in 0..size {
        if search.column_of[row] == NONE {
            search.augment(row);
        }
    }
    search.column_of
}

/// A partial assignment, and prices under which no cost is less than its row's and its column's
/// together, and those of assigned pairs are equal to them.
struct Search<'a> {
    costs: &'a [f64],
    size: usize,
    row_prices: Vec<f64>,
    column_prices: Vec<f64>,
    column_of: Vec<usize>,
    row_of: Vec<usize>,
    /// Of each column from the row that a path begins in, as far as is known.
    distances: Vec<f64>,
    /// The row before each column on the shortest path.
    before: Vec<usize>,
    /// The columns whose distance is not known yet, and the others.
    open: Vec<usize>,
    closed: Vec<usize>,
}

impl<'a> Search<'a> {
    /// No pairs; each row's price is its least cost, then each column's what is left.
    fn new(costs: &'a [f64], size: usize) -> Self {
        let rows = costs.chunks_exact(size);
        let row_prices: Vec<f64> =
            rows.clone().map(|row| row.iter().copied().fold(f64::INFINITY, f64::min)).collect();
        let mut column_prices = vec![f64::INFINITY; size];
        for (row, price) in rows.zip(&row_prices) {
            for (least, cost) in column_prices.iter_mut().zip(row) {
                *least = least.min(cost - price);
            }
        }
        Self {
            costs,
            size,
            row_prices,
            column_prices,
            column_of: vec![NONE; size],
            row_of: vec![NONE; size],
            distances: vec![0.0; size],
            before: vec![NONE; size],
            open: Vec::with_capacity(size),
            closed: Vec::with_capacity(size),
        }
    }

    fn row(&self, row: usize) -> &'a [f64] {
        &self.costs[row * self.size..][..self.size]
    }

    /// Assigns rows to columns that the prices allow and that nobody has yet.
    fn take_free_pairs(&mut self) {
        for row in 0..self.size {
            let (costs, price) = (self.row(row), self.row_prices[row]);
            let allowed = |column: &usize| {
                let column = *column;
                self.row_of[column] == NONE && costs[column] - price <= self.column_prices[column]
            };
            if let Some(column) = (0..self.size).find(allowed) {
                (self.column_of[row], self.row_of[column]) = (column, row);
            }
        }
    }

    /// Finds the shortest path from a row without a column to a column without a row, and assigns
    /// along it.
    fn augment(&mut self, start: usize) {
        self.distances.fill(f64::INFINITY);
        self.open.clear();
        self.open.extend(0..self.size);
        self.closed.clear();
        let (mut row, mut reached) = (start, 0.0);
        let mut end = NONE;
        while end == NONE {
            let place = self.extend(row, reached);
            let column = self.open.swap_remove(place);
            self.closed.push(column);
            reached = self.distances[column];
            row = self.row_of[column];
            end = if row == NONE { column } else { NONE };
        }
        self.raise_prices(start, reached);
        while end != NONE {
            let row = self.before[end];
            self.row_of[end] = row;
            // What the row had is free for the row before it; the first had none.
            end = std::mem::replace(&mut self.column_of[row], end);
        }
    }

    /// Goes on from a row, and returns the place of the nearest open column; of several, one
    /// without a row.
    fn extend(&mut self, row: usize, reached: f64) -> usize {
        let (costs, price) = (self.row(row), self.row_prices[row]);
        let (mut nearest, mut place) = (f64::INFINITY, 0);
        for (at, &column) in self.open.iter().enumerate() {
            let distance = reached + (costs[column] - price - self.column_prices[column]);
            let known = &mut self.distances[column];
            if distance < *known {
                *known = distance;
                self.before[column] = row;
            }
            if *known < nearest || (*known == nearest && self.row_of[column] == NONE) {
                (nearest, place) = (*known, at);
            }
        }
        place
    }

    /// Makes the pairs along the shortest paths equal to their prices.
    fn raise_prices(&mut self, start: usize, reached: f64) {
        for &column in &self.closed {
            let slack = reached - self.distances[column];
            self.column_prices[column] -= slack;
            if self.row_of[column] != NONE {
                self.row_prices[self.row_of[column]] += slack;
            }
        }
        self.row_prices[start] += reached;
    }
}
