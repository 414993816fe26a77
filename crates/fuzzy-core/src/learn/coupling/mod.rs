//! Learning which of n goes with which of n others: a coupling, a permutation.
//!
//! [`CouplingTable`] learns a value for every coupling, as section 8.5 of the thesis does; there
//! are n! of them. [`PairEstimates`] learns what every pair costs, n observations at a time.

mod pairs;
mod table;

pub use pairs::{Exploration, PairEstimates, PairSettings};
pub use table::{CouplingTable, CouplingTableSettings, RateCount};

use crate::check;
use crate::error::{Error, Result};

/// The largest n whose couplings are listed: 8! is 40 320.
pub const MOST_LISTED: usize = 8;

/// All couplings of n with n in lexicographic order, as Table 8.5 has them: entry i of one is the
/// partner of i.
///
/// ```
/// use fuzzy_core::learn::coupling::couplings;
///
/// assert_eq!(couplings(3)?[3], [1, 2, 0]);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
pub fn couplings(size: usize) -> Result<Vec<Vec<usize>>> {
    check::at_least("number of pairs", size, 1)?;
    if size > MOST_LISTED {
        return Err(Error::OutOfRange {
            what: "number of pairs in a table of couplings".to_owned(),
            expected: format!(
                "at most {MOST_LISTED}, there are n! couplings of n pairs (learn pair by pair, \
                 which needs n² values)"
            ),
            value: size as f64,
        });
    }
    let mut all = vec![Vec::new()];
    for _ in 0..size {
        let longer = |start: Vec<usize>| {
            let rest = (0..size).filter(|next| !start.contains(next)).collect::<Vec<_>>();
            rest.into_iter().map(move |next| [start.as_slice(), &[next]].concat())
        };
        all = all.into_iter().flat_map(longer).collect();
    }
    Ok(all)
}

/// Nothing, if a coupling of `size` pairs has every partner once.
pub fn check_coupling(coupling: &[usize], size: usize) -> Result<()> {
    check::same_length("partners of a coupling", size, coupling.len())?;
    let mut taken = vec![false; size];
    for (index, &partner) in coupling.iter().enumerate() {
        let unsuitable = |reason: String| Error::Unsuitable { what: "coupling".to_owned(), reason };
        let Some(taken) = taken.get_mut(partner) else {
            return Err(unsuitable(format!(
                "{index} goes with {partner}; partners are numbered from 0 to {}",
                size - 1
            )));
        };
        if std::mem::replace(taken, true) {
            return Err(unsuitable(format!(
                "partner {partner} is taken twice; a coupling has each partner once"
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn couplings_come_in_the_order_of_table_8_5() {
        let printed = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        assert_eq!(couplings(3).unwrap(), printed);
        assert_eq!(couplings(1).unwrap(), [[0]]);
        let all = couplings(6).unwrap();
        assert_eq!(all.len(), 720);
        assert!(all.is_sorted());
        assert!(all.iter().all(|coupling| check_coupling(coupling, 6).is_ok()));
    }

    #[test]
    fn what_is_no_coupling_is_refused_in_words() {
        let message = |coupling: &[usize]| check_coupling(coupling, 3).unwrap_err().to_string();
        assert_eq!(message(&[0, 1]), "partners of a coupling: expected 3, got 2");
        assert!(message(&[0, 1, 3]).contains("2 goes with 3; partners are numbered from 0 to 2"));
        assert!(message(&[2, 1, 2]).contains("partner 2 is taken twice"));
        let many = couplings(9).unwrap_err().to_string();
        assert!(many.contains("learn pair by pair") && many.contains("got 9"), "{many}");
        assert!(couplings(0).is_err());
    }
}
