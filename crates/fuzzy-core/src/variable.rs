//! Linguistic variables: a universe of discourse and the terms that cover it.

use crate::check;
use crate::error::{Error, Result};
use crate::membership::{MembershipFunction, Shape};

/// The interval that a variable lives on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Universe {
    low: f64,
    high: f64,
}

impl Universe {
    /// The interval from `low` to `high`, low < high, both finite.
    pub fn new(low: f64, high: f64) -> Result<Self> {
        let (low, high) = check::interval("the universe", low, high)?;
        Ok(Self { low, high })
    }

    /// The lower end.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// The upper end.
    pub fn high(&self) -> f64 {
        self.high
    }
}

/// A named membership function.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// The linguistic value, such as "negative".
    pub name: String,
    /// What the name means.
    pub function: MembershipFunction,
}

/// A named quantity with its universe and terms.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    name: String,
    universe: Universe,
    terms: Vec<Term>,
}

impl Variable {
    /// A variable on [low, high] that has no terms yet.
    pub fn new(name: &str, low: f64, high: f64) -> Result<Self> {
        check::name("variable", name)?;
        Ok(Self { name: name.to_owned(), universe: Universe::new(low, high)?, terms: Vec::new() })
    }

    /// The variable with one more term.
    pub fn with_term(mut self, name: &str, function: MembershipFunction) -> Result<Self> {
        check::name("term", name)?;
        if self.terms.iter().any(|term| term.name == name) {
            return Err(Error::DuplicateName {
                kind: "term",
                name: name.to_owned(),
                place: format!("variable \"{}\"", self.name),
            });
        }
        self.terms.push(Term { name: name.to_owned(), function });
        Ok(self)
    }

    /// A variable whose terms, one for each name, peak at even distances from `low` to `high`.
    ///
    /// Neighbours cross at 0.5. Triangular, trapezoidal, pi-shaped and cosine terms also add up
    /// to 1 everywhere. Trapezoidal, pi-shaped and two-sided Gaussian terms are 1 over half of
    /// the distance between peaks; a bell has the slope 2. The other shapes make no even
    /// partition and are refused.
    pub fn evenly(
        name: &str,
        (low, high): (f64, f64),
        shape: Shape,
        term_names: &[&str],
    ) -> Result<Self> {
        check::at_least(&format!("terms of an even partition of \"{name}\""), term_names.len(), 2)?;
        let mut variable = Self::new(name, low, high)?;
        let step = (high - low) / (term_names.len() - 1) as f64;
        for (index, term) in term_names.iter().enumerate() {
            let peak = low + step * index as f64;
            let parameters =
                even_parameters(shape, peak, step).ok_or_else(|| no_even_partition(shape))?;
            variable = variable.with_term(term, MembershipFunction::new(shape, &parameters)?)?;
        }
        Ok(variable)
    }

    /// The variable's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The interval that it lives on.
    pub fn universe(&self) -> Universe {
        self.universe
    }

    /// Its terms, in their order.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The term with this name.
    pub fn term(&self, name: &str) -> Result<&Term> {
        Ok(&self.terms[self.position(name)?])
    }

    /// The number of the term with this name.
    pub fn position(&self, name: &str) -> Result<usize> {
        self.terms.iter().position(|term| term.name == name).ok_or_else(|| {
            Error::unknown_name("term", name, self.terms.iter().map(|term| term.name.as_str()))
        })
    }

    /// The degrees of all terms at each of many numbers, row by row with one column for each
    /// term.
    pub fn degrees(&self, points: &[f64], degrees: &mut [f64]) -> Result<()> {
        let width = self.terms.len();
        check::same_length("degrees", points.len() * width, degrees.len())?;
        for (row, &x) in degrees.chunks_exact_mut(width.max(1)).zip(points) {
            for (degree, term) in row.iter_mut().zip(&self.terms) {
                *degree = term.function.degree(x);
            }
        }
        Ok(())
    }

    /// The parameters of all terms, one after the other.
    pub fn parameters(&self) -> Vec<f64> {
        self.terms.iter().flat_map(|term| term.function.parameters().to_vec()).collect()
    }

    /// The number of [`parameters`](Self::parameters).
    pub fn parameter_count(&self) -> usize {
        self.terms.iter().map(|term| term.function.parameters().len()).sum()
    }

    /// The same variable with other parameters of its terms, one after the other.
    pub(crate) fn with_parameters(&self, parameters: &[f64]) -> Result<Self> {
        let mut rest = parameters;
        let mut terms = Vec::with_capacity(self.terms.len());
        for term in &self.terms {
            let (own, others) = rest.split_at(term.function.parameters().len());
            rest = others;
            let function = MembershipFunction::new(term.function.shape(), own)?;
            terms.push(Term { name: term.name.clone(), function });
        }
        Ok(Self { name: self.name.clone(), universe: self.universe, terms })
    }
}

/// The parameters of a function that peaks at `peak` and is ½ half a step away from it; `None`
/// for shapes that cannot.
fn even_parameters(shape: Shape, peak: f64, step: f64) -> Option<Vec<f64>> {
    use std::f64::consts::{FRAC_1_SQRT_2, LN_2};
    // exp(−z²) = ½ at z = √ln 2.
    let width = 0.5 * step / LN_2.sqrt();
    let (left, right) = (peak - 0.25 * step, peak + 0.25 * step);
    Some(match shape {
        Shape::Gaussian => vec![peak, width * FRAC_1_SQRT_2],
        Shape::GaussianWidth => vec![peak, width],
        Shape::TwoSidedGaussian => {
            let sigma = 0.5 * width * FRAC_1_SQRT_2;
            vec![left, sigma, right, sigma]
        }
        Shape::Bell => vec![peak, 0.5 * step, 2.0],
        Shape::Triangular => vec![peak - step, peak, peak + step],
        Shape::Trapezoidal | Shape::PiShape => {
            vec![peak - 0.75 * step, left, right, peak + 0.75 * step]
        }
        Shape::Cosine => vec![peak, 2.0 * step],
        // √(1 − z²) = ½ at z = √¾.
        Shape::SemiEllipse => {
            let radius = step / 3.0_f64.sqrt();
            vec![peak - radius, peak + radius]
        }
        // exp(−10z) = ½ at z = ln 2/10.
        Shape::Spike => vec![peak, 5.0 * step / LN_2],
        _ => return None,
    })
}

/// The shapes that make an even partition.
fn even_shapes() -> impl Iterator<Item = Shape> {
    Shape::ALL.into_iter().filter(|&shape| even_parameters(shape, 0.0, 1.0).is_some())
}

fn no_even_partition(shape: Shape) -> Error {
    let known: Vec<&str> = even_shapes().map(Shape::name).collect();
    Error::UnknownName {
        kind: "shape of an even partition",
        name: shape.name().to_owned(),
        hint: format!("; known: {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_partitions_cross_at_one_half() {
        for shape in even_shapes() {
            let variable =
                Variable::evenly("x", (-2.0, 4.0), shape, &["a", "b", "c", "d"]).unwrap();
            for pair in variable.terms().windows(2) {
                let middle = variable.terms().iter().position(|t| t.name == pair[0].name).unwrap();
                let x = -2.0 + 2.0 * (middle as f64 + 0.5);
                for term in pair {
                    assert!((term.function.degree(x) - 0.5).abs() < 1e-12, "{shape:?}");
                }
            }
        }
    }

    #[test]
    fn unknown_and_repeated_terms_are_named() {
        let variable =
            Variable::evenly("angle", (-1.0, 1.0), Shape::Triangular, &["left", "right"]).unwrap();
        let error = variable.term("rigth").unwrap_err();
        assert_eq!(error.to_string(), "unknown term \"rigth\"; did you mean \"right\"?");
        let triangle = MembershipFunction::triangular(0.0, 1.0, 2.0).unwrap();
        let error = variable.with_term("left", triangle).unwrap_err();
        assert!(error.to_string().contains("appears twice in variable \"angle\""));
        assert!(Variable::new("a.b", 0.0, 1.0).is_err());
        assert!(Variable::new("a", 1.0, 1.0).is_err());
    }
}
