//! The threshold under which as many rows find a column as under any.

/// No row, or no column.
const NONE: usize = usize::MAX;
/// Columns that a word of bits has.
const WORD: usize = u64::BITS as usize;

/// The least of the finite costs such that as many pairs fit together below or at it as of all
/// finite costs; −∞ if none is finite.
pub(super) fn threshold(costs: &[f64], size: usize) -> f64 {
    let mut candidates: Vec<f64> = costs.iter().copied().filter(|cost| cost.is_finite()).collect();
    let mut sure = Matching::new(size);
    let most = sure.clone().complete(costs, f64::MAX, 0).pairs();
    while candidates.len() > 1 {
        let middle = (candidates.len() - 1) / 2;
        let (_, &mut pivot, _) = candidates.select_nth_unstable_by(middle, f64::total_cmp);
        let matching = sure.clone().complete(costs, pivot, most);
        if matching.pairs() == most {
            candidates.truncate(middle + 1);
        } else {
            candidates.drain(..=middle);
            // These pairs fit below a higher threshold too.
            sure = matching;
        }
    }
    candidates.first().copied().unwrap_or(f64::NEG_INFINITY)
}

/// Pairs of rows and columns below a threshold, of each at most one.
#[derive(Clone)]
struct Matching {
    size: usize,
    column_of: Vec<usize>,
    row_of: Vec<usize>,
}

impl Matching {
    fn new(size: usize) -> Self {
        Self { size, column_of: vec![NONE; size], row_of: vec![NONE; size] }
    }

    fn pairs(&self) -> usize {
        self.column_of.iter().filter(|&&column| column != NONE).count()
    }

    /// Adds pairs below or at a threshold until no more fit, or until it is sure that there won't
    /// be `wanted` (Berge's augmenting paths).
    fn complete(mut self, costs: &[f64], threshold: f64, wanted: usize) -> Self {
        let edges = Edges::new(costs, self.size, threshold);
        let mut search = Search::new(self.size);
        let mut failures = 0;
        for row in 0..self.size {
            if self.column_of[row] != NONE || search.augment(&mut self, &edges, row) {
                continue;
            }
            failures += 1;
            if self.size - failures < wanted {
                break;
            }
        }
        self
    }
}

/// The columns of each row below or at a threshold, as bits.
struct Edges {
    words: usize,
    bits: Vec<u64>,
}

impl Edges {
    fn new(costs: &[f64], size: usize, threshold: f64) -> Self {
        let pack = |group: &[f64]| {
            let bits = group.iter().enumerate();
            bits.fold(0, |word, (bit, &cost)| word | u64::from(cost <= threshold) << bit)
        };
        let rows = costs.chunks_exact(size);
        let bits = rows.flat_map(|row| row.chunks(WORD).map(pack)).collect();
        Self { words: size.div_ceil(WORD), bits }
    }

    fn of(&self, row: usize) -> &[u64] {
        &self.bits[row * self.words..][..self.words]
    }
}

/// A search for augmenting paths, breadth first.
struct Search {
    /// The columns not seen yet. Those of a search that failed stay seen: no later path leads
    /// through them.
    unseen: Vec<u64>,
    before: Vec<usize>,
    waiting: Vec<usize>,
    seen: Vec<usize>,
}

impl Search {
    fn new(size: usize) -> Self {
        let mut unseen = vec![u64::MAX; size.div_ceil(WORD)];
        if let Some(last) = unseen.last_mut() {
            *last >>= (WORD - size % WORD) % WORD;
        }
        Self { unseen, before: vec![NONE; size], waiting: Vec::new(), seen: Vec::new() }
    }

    /// Gives a row a column, moving others to other columns; whether there was a way.
    fn augment(&mut self, matching: &mut Matching, edges: &Edges, start: usize) -> bool {
        self.waiting.clear();
        self.waiting.push(start);
        self.seen.clear();
        let mut next = 0;
        while let Some(&row) = self.waiting.get(next) {
            next += 1;
            for (word, &edges) in edges.of(row).iter().enumerate() {
                let mut new = self.unseen[word] & edges;
                self.unseen[word] &= !new;
                while new != 0 {
                    let column = word * WORD + new.trailing_zeros() as usize;
                    new &= new - 1;
                    self.before[column] = row;
                    self.seen.push(column);
                    match matching.row_of[column] {
                        NONE => {
                            self.forget(word, new);
                            self.turn(matching, column);
                            return true;
                        }
                        other => self.waiting.push(other),
                    }
                }
            }
        }
        false
    }

    /// Makes the columns of a search that succeeded unseen again.
    fn forget(&mut self, word: usize, rest: u64) {
        self.unseen[word] |= rest;
        for &column in &self.seen {
            self.unseen[column / WORD] |= 1 << (column % WORD);
        }
    }

    /// Assigns along the path that ends in a free column.
    fn turn(&self, matching: &mut Matching, mut column: usize) {
        while column != NONE {
            let row = self.before[column];
            matching.row_of[column] = row;
            column = std::mem::replace(&mut matching.column_of[row], column);
        }
    }
}
