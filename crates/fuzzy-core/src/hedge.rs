//! Hedges: words that change how strongly a term applies, such as "very".
//!
//! | Hedge | of a degree x | Source |
//! |---|---|---|
//! | `not` | 1 − x | Zadeh (1965) |
//! | `very` | x² | Zadeh (1972), concentration |
//! | `extremely` | x³ | MATLAB's Fuzzy Logic Toolbox; Negnevitsky (2005) |
//! | `plus` | x^1.25 | Zadeh (1972) |
//! | `minus` | x^0.75 | Zadeh (1972) |
//! | `slightly` | x^1.7 | Negnevitsky (2005) |
//! | `somewhat`, `more_or_less` | √x | Zadeh (1972), dilation |
//! | `indeed` | 2x² up to ½, 1 − 2(1 − x)² above | Zadeh (1972), contrast intensification |
//! | `seldom` | √(x/2) up to ½, 1 − √((1 − x)/2) above | fuzzylite; the inverse of `indeed` |
//! | `any` | 1 | fuzzylite |
//!
//! `very very` is x⁴, as everywhere: each hedge changes what the words behind it mean.
//!
//! Sources: L. A. Zadeh, *Fuzzy sets* (1965) and *A fuzzy-set-theoretic interpretation of
//! linguistic hedges* (1972); M. Negnevitsky, *Artificial Intelligence*, 2nd edition (2005), chapter 4.

use crate::check;
use crate::error::{Error, Result};
use crate::expression::Expression;
use crate::math::{Real, total};

/// The hedge that can't be redefined.
const NOT: &str = "not";

/// A named change of degrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Hedge {
    name: String,
    effect: Effect,
}

#[derive(Debug, Clone, PartialEq)]
enum Effect {
    Not,
    Very,
    Extremely,
    Plus,
    Minus,
    Slightly,
    Somewhat,
    Indeed,
    Seldom,
    Any,
    Custom(Expression),
}

const BUILT_IN: [(&str, Effect); 11] = [
    ("not", Effect::Not),
    ("very", Effect::Very),
    ("extremely", Effect::Extremely),
    ("plus", Effect::Plus),
    ("minus", Effect::Minus),
    ("slightly", Effect::Slightly),
    ("somewhat", Effect::Somewhat),
    ("more_or_less", Effect::Somewhat),
    ("indeed", Effect::Indeed),
    ("seldom", Effect::Seldom),
    ("any", Effect::Any),
];

/// The degrees at which a custom hedge is tried: multiples of 1/1024.
const TRIALS: u32 = 1024;
/// How far rounding may carry a custom hedge out of [0, 1].
const TOLERANCE: f64 = 1e-9;

impl Hedge {
    /// Every built-in hedge.
    pub fn built_in() -> Vec<Self> {
        BUILT_IN.map(|(name, effect)| Self { name: name.to_owned(), effect }).into()
    }

    /// The built-in hedge with this name.
    pub fn named(name: &str) -> Result<Self> {
        let known = BUILT_IN.iter().map(|&(known, _)| known);
        let found = Self::built_in().into_iter().find(|hedge| hedge.name == name);
        found.ok_or_else(|| Error::unknown_name("hedge", name, known))
    }

    /// A hedge from a formula in the degree `x`, whose values at degrees are degrees.
    ///
    /// The formula is tried at 1025 degrees; what rounding adds outside \[0, 1\] is cut off.
    ///
    /// ```
    /// use fuzzy_core::Hedge;
    ///
    /// let rather = Hedge::custom("rather", "x^1.5")?;
    /// assert_eq!(rather.apply(0.25), 0.125);
    /// let error = Hedge::custom("twice", "2*x").unwrap_err();
    /// assert!(error.to_string().contains("must be between 0 and 1"));
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn custom(name: &str, formula: &str) -> Result<Self> {
        check::name("hedge", name)?;
        if name == NOT {
            let reason = "it is 1 - x in every system; choose another name".to_owned();
            return Err(Error::Unsuitable { what: format!("a hedge called \"{NOT}\""), reason });
        }
        let formula = Expression::parse(formula, &["x"])?;
        for trial in 0..=TRIALS {
            let degree = f64::from(trial) / f64::from(TRIALS);
            let what = format!("the hedge \"{name}\" at the degree {degree}");
            let is_degree = |value| (-TOLERANCE..=1.0 + TOLERANCE).contains(&value);
            check::within(&what, formula.evaluate(&[degree]), "between 0 and 1", is_degree)?;
        }
        Ok(Self { name: name.to_owned(), effect: Effect::Custom(formula) })
    }

    /// The word.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The formula of a custom hedge.
    pub fn formula(&self) -> Option<&str> {
        match &self.effect {
            Effect::Custom(formula) => Some(formula.source()),
            _ => None,
        }
    }

    /// The changed degree, in \[0, 1\] for a degree in \[0, 1\]; NaN stays NaN.
    #[inline]
    pub fn apply<R: Real>(&self, degree: R) -> R {
        let x = degree;
        let one = R::splat(1.0);
        let changed = match &self.effect {
            Effect::Not => one - x,
            Effect::Very => x * x,
            Effect::Extremely => x * x * x,
            Effect::Plus => x * x.sqrt().sqrt(),
            Effect::Minus => x.sqrt() * x.sqrt().sqrt(),
            Effect::Slightly => total::pow(x, R::splat(1.7)),
            Effect::Somewhat => x.sqrt(),
            Effect::Indeed => halves(x, |x| R::splat(2.0) * x * x),
            Effect::Seldom => halves(x, |x| (R::splat(0.5) * x).sqrt()),
            Effect::Any => one,
            Effect::Custom(formula) => clamped(formula.evaluate(&[x])),
        };
        R::select(x.le(x), changed, x)
    }
}

/// f(x) up to ½ and 1 − f(1 − x) above.
#[inline(always)]
fn halves<R: Real>(x: R, function: impl Fn(R) -> R) -> R {
    let one = R::splat(1.0);
    let lower = x.le(R::splat(0.5));
    let value = function(R::select(lower, x, one - x));
    R::select(lower, value, one - value)
}

#[inline(always)]
fn clamped<R: Real>(x: R) -> R {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    R::select(x.lt(zero), zero, R::select(one.lt(x), one, x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Lanes;

    #[test]
    fn built_in_hedges_follow_their_formulas() {
        let formulas = [
            ("not", "1 - x"),
            ("very", "x^2"),
            ("extremely", "x^3"),
            ("plus", "x^1.25"),
            ("minus", "x^0.75"),
            ("slightly", "x^1.7"),
            ("somewhat", "x^0.5"),
            ("more_or_less", "sqrt(x)"),
            ("indeed", "if(x <= 0.5, 2*x^2, 1 - 2*(1 - x)^2)"),
            ("seldom", "if(x <= 0.5, (x/2)^0.5, 1 - sqrt((1 - x)/2))"),
            ("any", "1"),
        ];
        assert_eq!(formulas.map(|(name, _)| name), BUILT_IN.map(|(name, _)| name));
        for (name, formula) in formulas {
            let custom = Hedge::custom(&format!("my {name}"), formula).unwrap();
            let hedge = Hedge::named(name).unwrap();
            for trial in 0..=1000 {
                let x = f64::from(trial) / 1000.0;
                let (degree, expected) = (hedge.apply(x), custom.apply(x));
                assert!((0.0..=1.0).contains(&degree), "{name} {x}: {degree}");
                assert!((degree - expected).abs() < 1e-15, "{name} {x}: {degree} {expected}");
                assert_eq!(hedge.apply(Lanes::splat(x)).to_array()[5].to_bits(), degree.to_bits());
            }
            assert!(hedge.apply(f64::NAN).is_nan() && custom.apply(f64::NAN).is_nan());
        }
    }

    #[test]
    fn indeed_and_seldom_undo_each_other() {
        let (indeed, seldom) = (Hedge::named("indeed").unwrap(), Hedge::named("seldom").unwrap());
        for trial in 0..=100 {
            let x = f64::from(trial) / 100.0;
            assert!((indeed.apply(seldom.apply(x)) - x).abs() < 1e-15);
        }
    }

    #[test]
    fn custom_hedges_are_tried() {
        let message = |formula| Hedge::custom("odd", formula).unwrap_err().to_string();
        let end = "must be between 0 and 1, got";
        assert_eq!(
            message("2*x"),
            format!("the hedge \"odd\" at the degree 0.5009765625 {end} 1.001953125")
        );
        assert_eq!(message("x - 0.5"), format!("the hedge \"odd\" at the degree 0 {end} -0.5"));
        assert_eq!(message("ln(x)"), "the hedge \"odd\" at the degree 0 must be finite, got -inf");
        assert!(message("sqrt(x - 0.5)").contains("must be finite, got NaN"));
        assert!(message("y^2").contains("unknown name \"y\""));
        assert!(Hedge::custom("", "x").is_err());
        // Rounding may leave the interval a little, degrees never do.
        let rounded = Hedge::custom("rounded", "x*(1 + 1e-12)").unwrap();
        assert_eq!(rounded.apply(1.0), 1.0);
        assert_eq!(Hedge::custom("rounded", "x - 1e-12").unwrap().apply(0.0), 0.0);
    }

    #[test]
    fn names_and_formulas_can_be_read() {
        let very = Hedge::custom("very", " x ^ 1.5 ").unwrap();
        assert_eq!((very.name(), very.formula()), ("very", Some("x ^ 1.5")));
        assert_eq!(Hedge::named("very").unwrap().formula(), None);
        let message = Hedge::named("vrey").unwrap_err().to_string();
        assert_eq!(message, "unknown hedge \"vrey\"; did you mean \"very\"?");
    }
}
