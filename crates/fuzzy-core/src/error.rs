//! What can go wrong, in the user's words.

use std::path::PathBuf;

/// The result of a fallible operation of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// An error of the fuzzy-logic library. Every message says what, what was expected and what came.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number that has to be finite is NaN or infinite.
    #[error("{what} must be finite, got {value}")]
    NotFinite {
        /// The quantity, with its place where it is one of many.
        what: String,
        /// The value that came.
        value: f64,
    },
    /// A number lies outside its range.
    #[error("{what} must be {expected}, got {value}")]
    OutOfRange {
        /// The quantity.
        what: String,
        /// The range in words, such as "positive".
        expected: String,
        /// The value that came.
        value: f64,
    },
    /// Membership-function vertices are in the wrong order.
    #[error("the vertices of {function} must not decrease, got {vertices:?}")]
    CrossedVertices {
        /// The function, such as "a triangular membership function".
        function: String,
        /// The vertices that came.
        vertices: Vec<f64>,
    },
    /// Things that are right by themselves do not go together.
    #[error("{what} does not fit: {reason}")]
    Unsuitable {
        /// The thing.
        what: String,
        /// Why, and what to do.
        reason: String,
    },
    /// A number of things does not fit.
    #[error("{what}: expected {expected}, got {actual}")]
    WrongShape {
        /// What was counted.
        what: String,
        /// The number or shape expected.
        expected: String,
        /// The number or shape that came.
        actual: String,
    },
    /// Two things that must differ carry one name.
    #[error("{kind} \"{name}\" appears twice in {place}; names must differ")]
    DuplicateName {
        /// What carries the name.
        kind: &'static str,
        /// The name.
        name: String,
        /// Where.
        place: String,
    },
    /// A name that cannot stand in a parameter path or a file.
    #[error("the {kind} name {name:?} is not usable; use at least one character and no dot")]
    BadName {
        /// What was to be named.
        kind: &'static str,
        /// The name that came.
        name: String,
    },
    /// A name that is not known.
    #[error("unknown {kind} \"{name}\"{hint}")]
    UnknownName {
        /// What was looked up.
        kind: &'static str,
        /// The name that came.
        name: String,
        /// ": did you mean …?" or the list of known names.
        hint: String,
    },
    /// No rule of a system fires, so its output is undefined.
    #[error(
        "no rule of {system} fires at {point}, or the sets that rules conclude are empty; widen \
         its membership functions, or choose what \
         happens then (a value, the previous output or NaN) when building the system"
    )]
    NoRuleFires {
        /// The system, and its output if there are several, in quotes.
        system: String,
        /// The input, as text.
        point: String,
    },
    /// A formula cannot be understood.
    #[error("formula, column {column}: {reason}")]
    Expression {
        /// Where in the text, in characters from 1.
        column: usize,
        /// What is wrong there.
        reason: String,
    },
    /// A rule cannot be understood, or does not fit the variables.
    #[error("rule {rule}{}: {reason}", place(*line, *column))]
    Rule {
        /// Which rule, from 1.
        rule: usize,
        /// The line, from 1, if the rule came from a text of several.
        line: Option<usize>,
        /// Where in the line, in characters from 1, if the rule came from a text.
        column: Option<usize>,
        /// What is wrong there.
        reason: String,
    },
    /// A text is not the document it should be.
    #[error("not a valid {format} document: {reason}")]
    Format {
        /// The format's name.
        format: &'static str,
        /// What is wrong and where.
        reason: String,
    },
    /// A document of another version or kind.
    #[error("{what} \"{found}\" is not supported; this version reads {supported}")]
    Unsupported {
        /// The field that does not fit.
        what: &'static str,
        /// What the document says.
        found: String,
        /// What is supported.
        supported: String,
    },
    /// A file could not be read or written.
    #[error("cannot {action} {}: {reason}", path.display())]
    File {
        /// "read" or "write".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// What is wrong with one of many things.
    #[error("{place}: {error}")]
    At {
        /// Which of them.
        place: String,
        /// What is wrong with it.
        error: Box<Self>,
    },
    /// A learner's numbers grow beyond all use; what it had learned stays.
    #[error(
        "learning diverged: {what} would be {value:e}; smaller learning rates, or rewards and \
         observations on a smaller scale, help"
    )]
    LearningDiverged {
        /// The quantity.
        what: &'static str,
        /// What it would have become.
        value: f64,
    },
    /// The caller asked the computation to stop.
    #[error("stopped on request before the work was done")]
    Cancelled,
    /// `tell` without an `ask`, or the like.
    #[error("{0}")]
    OutOfOrder(&'static str),
    /// Something would need more memory than there is.
    #[error("{what} would need {numbers} numbers, more than there is memory for")]
    Memory {
        /// The thing.
        what: String,
        /// Its size, as text.
        numbers: String,
    },
    /// A pool of threads could not be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// The number wanted.
        threads: usize,
        /// What the system says.
        reason: String,
    },
}

impl Error {
    /// The name of the variant, a stable handle for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NotFinite { .. } => "not_finite",
            Self::OutOfRange { .. } => "out_of_range",
            Self::CrossedVertices { .. } => "crossed_vertices",
            Self::Unsuitable { .. } => "unsuitable",
            Self::WrongShape { .. } => "wrong_shape",
            Self::DuplicateName { .. } => "duplicate_name",
            Self::BadName { .. } => "bad_name",
            Self::UnknownName { .. } => "unknown_name",
            Self::NoRuleFires { .. } => "no_rule_fires",
            Self::Expression { .. } => "expression",
            Self::Rule { .. } => "rule",
            Self::Format { .. } => "format",
            Self::Unsupported { .. } => "unsupported",
            Self::File { .. } => "file",
            Self::At { error, .. } => error.kind(),
            Self::LearningDiverged { .. } => "learning_diverged",
            Self::Cancelled => "cancelled",
            Self::OutOfOrder(_) => "out_of_order",
            Self::Memory { .. } => "memory",
            Self::Threads { .. } => "threads",
        }
    }

    /// Every [`kind`](Self::kind); for the tests of bindings.
    pub const KINDS: [&'static str; 19] = [
        "not_finite",
        "out_of_range",
        "crossed_vertices",
        "unsuitable",
        "wrong_shape",
        "duplicate_name",
        "bad_name",
        "unknown_name",
        "no_rule_fires",
        "expression",
        "rule",
        "format",
        "unsupported",
        "file",
        "learning_diverged",
        "cancelled",
        "out_of_order",
        "memory",
        "threads",
    ];

    /// The error with a place before its message.
    pub fn at(self, place: String) -> Self {
        Self::At { place, error: Box::new(self) }
    }

    /// An [`UnknownName`](Self::UnknownName) that proposes the nearest known name, or lists them.
    ///
    /// ```
    /// let error = fuzzy_core::Error::unknown_name("term", "smal", ["small", "large"]);
    /// assert_eq!(error.to_string(), "unknown term \"smal\"; did you mean \"small\"?");
    /// ```
    pub fn unknown_name<'a>(
        kind: &'static str,
        name: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let known: Vec<&str> = known.into_iter().collect();
        let hint = hint(name, &known);
        Self::UnknownName { kind, name: name.to_owned(), hint }
    }

    /// A [`WrongShape`](Self::WrongShape) from anything that prints.
    pub fn wrong_shape(
        what: impl Into<String>,
        expected: impl ToString,
        actual: impl ToString,
    ) -> Self {
        Self::WrongShape {
            what: what.into(),
            expected: expected.to_string(),
            actual: actual.to_string(),
        }
    }
}

/// ", line 2, column 5", as far as it is known.
fn place(line: Option<usize>, column: Option<usize>) -> String {
    let line = line.map_or_else(String::new, |line| format!(", line {line}"));
    let column = column.map_or_else(String::new, |column| format!(", column {column}"));
    line + &column
}

/// The end of a message about an unknown name: the nearest known name, or all of them.
pub(crate) fn hint(name: &str, known: &[&str]) -> String {
    match nearest(name, known) {
        Some(nearest) => format!("; did you mean \"{nearest}\"?"),
        None if known.is_empty() => "; none is defined".to_owned(),
        None if known.len() > MOST_LISTED => {
            format!("; known: {}, …", known[..MOST_LISTED].join(", "))
        }
        None => format!("; known: {}", known.join(", ")),
    }
}

/// The known name that was probably meant, in small or large letters.
pub(crate) fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    // Comparing takes time and memory in proportion to both lengths.
    let is_short = |name: &str| name.chars().nth(LONGEST_COMPARED).is_none();
    if !is_short(name) {
        return None;
    }
    let name = name.to_lowercase();
    let near = known.iter().copied().filter(|&known| is_short(known)).filter_map(|candidate| {
        let distance = strsim::damerau_levenshtein(&name, &candidate.to_lowercase());
        let size = candidate.chars().count();
        // Names that share no letter are not near, however short.
        let near = distance <= 1 + size / 4 && distance < size.max(name.chars().count());
        near.then_some((distance, candidate))
    });
    near.min().map(|(_, candidate)| candidate)
}

/// A message lists no more names.
const MOST_LISTED: usize = 30;
/// Longer names are not proposed, nor is anything for them.
const LONGEST_COMPARED: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_proposed() {
        assert_eq!(nearest("smal", &["large", "smell", "small"]), Some("small"));
        assert_eq!(nearest("temprature", &["temperature", "t"]), Some("temperature"));
        assert_eq!(nearest("TEMPERATUR", &["temperature", "t"]), Some("temperature"));
        assert_eq!(nearest("x", &["X"]), Some("X"));
        assert_eq!(nearest("x", &["y", "abc"]), None);
        assert_eq!(nearest("tal", &["small"]), None);
        assert_eq!(nearest(&"a".repeat(101), &[&"a".repeat(102)]), None);
        assert_eq!(nearest(&"a".repeat(1_000_000), &["a"]), None);
    }

    #[test]
    fn names_are_listed_where_none_is_near() {
        assert_eq!(hint("q", &["small", "large"]), "; known: small, large");
        assert_eq!(hint("q", &[]), "; none is defined");
        assert!(hint("q", &["abc"; 31]).ends_with("abc, abc, …"));
    }

    #[test]
    fn places_are_told_as_far_as_they_are_known() {
        let at = |line, column| {
            Error::Rule { rule: 2, line, column, reason: "why".to_owned() }.to_string()
        };
        assert_eq!(at(None, None), "rule 2: why");
        assert_eq!(at(None, Some(3)), "rule 2, column 3: why");
        assert_eq!(at(Some(7), Some(3)), "rule 2, line 7, column 3: why");
    }
}
