//! What can go wrong, in the user's words.

use crate::training::Trained;

/// The result of a fallible operation of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// An error of the games and of the techniques that learn to play them.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Something of the fuzzy-logic library.
    #[error(transparent)]
    Core(#[from] fuzzy_core::Error),
    /// A controller that does not read what the game shows.
    #[error(
        "a controller of this game reads 2 inputs, the angle to the other robot and its rate of \
         change; \"{name}\" has {inputs}"
    )]
    ControllerInputs {
        /// The controller's name.
        name: String,
        /// The inputs that it has.
        inputs: usize,
    },
    /// The game left the numbers that a computer has.
    #[error("the game diverged at {time} s: {what} is no longer finite")]
    Diverged {
        /// The simulated time.
        time: f64,
        /// The quantity.
        what: &'static str,
    },
    /// Learning took values beyond all use; what was learned before is not lost.
    #[error("{source} (after {} games; what was learned before is kept)", so_far.games())]
    LearningDiverged {
        /// What came up.
        source: fuzzy_core::Error,
        /// What was learned before.
        so_far: Box<Trained>,
    },
}

impl Error {
    /// The name of the variant, a stable handle for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Core(error) => error.kind(),
            Self::ControllerInputs { .. } => "controller_inputs",
            Self::Diverged { .. } => "diverged",
            Self::LearningDiverged { source, .. } => source.kind(),
        }
    }

    /// The error with a place before its message, if it is one of the fuzzy-logic library.
    pub(crate) fn at(self, place: String) -> Self {
        match self {
            Self::Core(error) => Self::Core(error.at(place)),
            other => other,
        }
    }

    /// The same with what was learned before, if it is that learning diverged.
    pub(crate) fn keeping(self, so_far: impl FnOnce() -> Result<Trained>) -> Self {
        match self {
            Self::Core(source @ fuzzy_core::Error::LearningDiverged { .. }) => match so_far() {
                Ok(so_far) => Self::LearningDiverged { source, so_far: Box::new(so_far) },
                Err(error) => error,
            },
            other => other,
        }
    }

    /// Every [`kind`](Self::kind) that this crate adds; for the tests of bindings.
    pub const KINDS: [&'static str; 2] = ["controller_inputs", "diverged"];
}
