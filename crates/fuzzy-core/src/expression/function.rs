//! What a formula can compute with.

use crate::math::{Real, total};

/// An operator or a function of one, two or three numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Abs,
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Sign,
    Atan2,
    Min,
    Max,
    If,
}

/// The functions that are called by a name.
pub(super) const NAMED: [(&str, Function); 12] = [
    ("abs", Function::Abs),
    ("sqrt", Function::Sqrt),
    ("exp", Function::Exp),
    ("ln", Function::Ln),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("atan2", Function::Atan2),
    ("min", Function::Min),
    ("max", Function::Max),
    ("sign", Function::Sign),
    ("if", Function::If),
];

/// The numbers that have a name.
pub(super) const CONSTANTS: [(&str, f64); 2] =
    [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

impl Function {
    /// The function with this name.
    pub fn named(name: &str) -> Option<Self> {
        NAMED.iter().find(|(known, _)| *known == name).map(|&(_, function)| function)
    }

    /// Whether it takes two numbers or more.
    pub fn is_variadic(self) -> bool {
        matches!(self, Self::Min | Self::Max)
    }

    /// How many numbers it takes.
    pub fn arity(self) -> usize {
        match self {
            Self::Negate | Self::Abs | Self::Sqrt | Self::Exp | Self::Ln => 1,
            Self::Sin | Self::Cos | Self::Tan | Self::Sign => 1,
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide | Self::Power => 2,
            Self::Less | Self::LessOrEqual | Self::Greater | Self::GreaterOrEqual => 2,
            Self::Atan2 | Self::Min | Self::Max => 2,
            Self::If => 3,
        }
    }

    /// Its value; `arguments` has [`arity`](Self::arity) elements.
    #[inline(always)]
    pub fn apply<R: Real>(self, arguments: &[R]) -> R {
        let x = arguments[0];
        let y = || arguments[1];
        match self {
            Self::Negate => -x,
            Self::Add => x + y(),
            Self::Subtract => x - y(),
            Self::Multiply => x * y(),
            Self::Divide => x / y(),
            Self::Power => total::pow(x, y()),
            Self::Less => truth(x.lt(y())),
            Self::LessOrEqual => truth(x.le(y())),
            Self::Greater => truth(y().lt(x)),
            Self::GreaterOrEqual => truth(y().le(x)),
            Self::Abs => x.abs(),
            Self::Sqrt => x.sqrt(),
            Self::Exp => total::exp(x),
            Self::Ln => total::ln(x),
            Self::Sin => total::sin(x),
            Self::Cos => total::cos(x),
            Self::Tan => total::tan(x),
            Self::Sign => sign(x),
            Self::Atan2 => total::atan2(x, y()),
            Self::Min => smaller(x, y()),
            Self::Max => -smaller(-x, -y()),
            Self::If => choose(x, y(), arguments[2]),
        }
    }
}

#[inline(always)]
fn truth<R: Real>(mask: R::Mask) -> R {
    R::select(mask, R::splat(1.0), R::splat(0.0))
}

/// −1, 0 or 1; NaN stays NaN.
#[inline(always)]
fn sign<R: Real>(x: R) -> R {
    let zero = R::splat(0.0);
    R::select(zero.lt(x), R::splat(1.0), R::select(x.lt(zero), R::splat(-1.0), x))
}

/// The smaller number; NaN if either is.
#[inline(always)]
fn smaller<R: Real>(x: R, y: R) -> R {
    R::select(x.le(y), x, R::select(y.lt(x), y, x + y))
}

/// The third number where the condition is 0, the second where it is another; NaN where the
/// condition is.
#[inline(always)]
fn choose<R: Real>(condition: R, chosen: R, otherwise: R) -> R {
    let zero = R::splat(0.0);
    let fails = condition.le(zero) & zero.le(condition);
    let chosen = R::select(condition.le(condition), chosen, condition);
    R::select(fails, otherwise, chosen)
}
