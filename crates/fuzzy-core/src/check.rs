//! Checks at the door: constructors use them so that hot loops need none.

use crate::error::{Error, Result};

/// The value, if it is neither NaN nor infinite.
pub fn finite(what: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::NotFinite { what: what.to_owned(), value })
    }
}

/// Nothing, if every value is finite; otherwise the error names the first that is not.
pub fn all_finite(what: &str, values: &[f64]) -> Result<()> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => {
            Err(Error::NotFinite { what: format!("{what}[{index}]"), value: values[index] })
        }
    }
}

/// The value, if it is finite and above zero.
pub fn positive(what: &str, value: f64) -> Result<f64> {
    within(what, value, "positive", |v| v > 0.0)
}

/// The value, if it lies in [0, 1].
pub fn fraction(what: &str, value: f64) -> Result<f64> {
    within(what, value, "between 0 and 1", |v| (0.0..=1.0).contains(&v))
}

/// The value, if it is finite and the condition holds; `expected` says the condition in words.
pub fn within(
    what: &str,
    value: f64,
    expected: &str,
    condition: impl Fn(f64) -> bool,
) -> Result<f64> {
    if condition(finite(what, value)?) {
        Ok(value)
    } else {
        Err(Error::OutOfRange { what: what.to_owned(), expected: expected.to_owned(), value })
    }
}

/// The count, if it is at least `least`.
pub fn at_least(what: &str, count: usize, least: usize) -> Result<usize> {
    if count >= least {
        return Ok(count);
    }
    let expected = format!("at least {least}");
    Err(Error::OutOfRange { what: what.to_owned(), expected, value: count as f64 })
}

/// The interval, if low < high and both they and their distance are finite.
pub fn interval(what: &str, low: f64, high: f64) -> Result<(f64, f64)> {
    finite(&format!("lower end of {what}"), low)?;
    let upper = format!("upper end of {what}");
    within(&upper, high, &format!("above {low}"), |high| high > low)?;
    finite(&format!("size of {what}"), high - low)?;
    Ok((low, high))
}

/// Zeros for a table of so many rows and columns, or an error where memory does not suffice.
pub fn zeros(what: &str, rows: usize, columns: usize) -> Result<Vec<f64>> {
    filled(what, rows, columns, 0.0)
}

/// A table of so many rows and columns with one value everywhere, or an error where memory does
/// not suffice.
pub fn filled<T: Clone>(what: &str, rows: usize, columns: usize, value: T) -> Result<Vec<T>> {
    let mut table = Vec::new();
    let count = rows.checked_mul(columns);
    let reserved = count.is_some_and(|count| table.try_reserve_exact(count).is_ok());
    match count {
        Some(count) if reserved => table.resize(count, value),
        _ => {
            let numbers = format!("{rows} × {columns}");
            return Err(Error::Memory { what: what.to_owned(), numbers });
        }
    }
    Ok(table)
}

/// The one of some choices that goes by a name; an error proposes the nearest.
pub fn named<T: Copy, const N: usize>(
    kind: &'static str,
    name: &str,
    choices: [T; N],
    name_of: impl Fn(T) -> &'static str,
) -> Result<T> {
    let found = choices.into_iter().find(|&choice| name_of(choice) == name);
    found.ok_or_else(|| Error::unknown_name(kind, name, choices.map(name_of)))
}

/// Nothing, if both numbers agree.
pub fn same_length(what: &str, expected: usize, actual: usize) -> Result<()> {
    if expected == actual { Ok(()) } else { Err(Error::wrong_shape(what, expected, actual)) }
}

/// Nothing, if the text can name something in a parameter path such as `angle.N.mean`.
pub fn name(kind: &'static str, name: &str) -> Result<()> {
    if name.trim().is_empty() || name.contains(['.', '\n']) {
        return Err(Error::BadName { kind, name: name.to_owned() });
    }
    Ok(())
}
