//! What validation finds.

use std::fmt::{Display, Formatter};

/// What is odd about a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// An interval or point of a universe where every term has the degree 0. Of an input only if
    /// no rule about some output fires there, at least at some values of the others.
    Gap,
    /// Points where no rule about an output fires.
    NoRuleFires,
    /// An input that no rule asks for.
    UnusedInput,
    /// A term that no rule asks for or concludes.
    UnusedTerm,
    /// A term with no degree above 0 in its universe.
    OutsideUniverse,
    /// A term of a Mamdani output that has the degree 0 at every sample.
    UnseenTerm,
    /// A rule that says what another says already.
    DuplicateRule,
    /// Rules with one antecedent that conclude different terms of one output.
    Contradiction,
    /// A rule of weight 0.
    ZeroWeight,
    /// A rule whose antecedent is 0 everywhere in the universes.
    NeverFires,
    /// A term of an output that only rules conclude which never fire.
    UnreachableTerm,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 11] = [
        Self::Gap,
        Self::NoRuleFires,
        Self::UnusedInput,
        Self::UnusedTerm,
        Self::OutsideUniverse,
        Self::UnseenTerm,
        Self::DuplicateRule,
        Self::Contradiction,
        Self::ZeroWeight,
        Self::NeverFires,
        Self::UnreachableTerm,
    ];

    /// The kind's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gap => "gap",
            Self::NoRuleFires => "no_rule_fires",
            Self::UnusedInput => "unused_input",
            Self::UnusedTerm => "unused_term",
            Self::OutsideUniverse => "outside_universe",
            Self::UnseenTerm => "unseen_term",
            Self::DuplicateRule => "duplicate_rule",
            Self::Contradiction => "contradiction",
            Self::ZeroWeight => "zero_weight",
            Self::NeverFires => "never_fires",
            Self::UnreachableTerm => "unreachable_term",
        }
    }
}

/// Something odd about a system: what, where, and what can be done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What sort of thing it is.
    pub kind: Kind,
    /// What it is in words.
    pub message: String,
}

impl Finding {
    pub(super) fn new(kind: Kind, message: String) -> Self {
        Self { kind, message }
    }
}

impl Display for Finding {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}
