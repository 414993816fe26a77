//! A fuzzy controller as a chromosome (Figure 6.4).

use fuzzy_core::check;
use fuzzy_core::{MembershipFunction, NoRuleFires, Tsk, Variable};

use crate::error::Result;
use crate::strategy::FuzzyController;

/// The ranges that genes are drawn from. The thesis does not print them; its tuned consequents
/// reach ±1.48, so theirs must go to 1.5 at least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeneRanges {
    /// The width of a Gaussian.
    pub width: (f64, f64),
    /// The mean of a Gaussian.
    pub mean: (f64, f64),
    /// The consequent of a rule (rad).
    pub consequent: (f64, f64),
}

impl Default for GeneRanges {
    fn default() -> Self {
        Self { width: (0.1, 1.0), mean: (-1.0, 1.0), consequent: (-1.5, 1.5) }
    }
}

const TERMS: [&str; 3] = ["N", "Z", "P"];
/// Gaussians of both inputs together.
const GAUSSIANS: usize = 2 * TERMS.len();
pub(super) const RULES: usize = TERMS.len() * TERMS.len();
/// The genes of a controller.
pub(super) const GENES: usize = 2 * GAUSSIANS + RULES;

impl GeneRanges {
    /// The ranges of all genes: six widths, six means, nine consequents.
    pub(super) fn bounds(&self) -> Result<Vec<(f64, f64)>> {
        check::positive("smallest width", self.width.0)?;
        let mut bounds = vec![self.width; GAUSSIANS];
        bounds.extend([self.mean; GAUSSIANS]);
        bounds.extend([self.consequent; RULES]);
        Ok(bounds)
    }
}

/// Writes genes into a parameter vector, where mean and width of a term stand side by side.
pub(super) fn decode(genes: &[f64], parameters: &mut [f64]) {
    let (widths, rest) = genes.split_at(GAUSSIANS);
    let (means, consequents) = rest.split_at(GAUSSIANS);
    for (pair, (&mean, &width)) in parameters.chunks_exact_mut(2).zip(means.iter().zip(widths)) {
        pair.copy_from_slice(&[mean, width]);
    }
    parameters[2 * GAUSSIANS..].copy_from_slice(consequents);
}

/// The parameter vectors of chromosomes, one after the other.
pub(super) fn express(chromosomes: &[f64]) -> Vec<f64> {
    let mut parameters = vec![0.0; chromosomes.len()];
    let rows = parameters.chunks_exact_mut(GENES);
    chromosomes.chunks_exact(GENES).zip(rows).for_each(|(genes, row)| decode(genes, row));
    parameters
}

/// The controller of a robot (6.5, 6.6), whose inputs are held within ±1, the universe of
/// Figure 6.10.
pub(super) fn template(name: &str) -> Result<FuzzyController> {
    FuzzyController::new(nine_rules(name, 0.5, vec![0.0; RULES])?, 1.0, 1.0)
}

/// A system of δ and δ̇ with three Gaussians each, means −1, 0 and 1; where no rule fires it says 0.
pub(super) fn nine_rules(name: &str, width: f64, consequents: Vec<f64>) -> Result<Tsk> {
    let variable = |name: &str| -> Result<Variable> {
        let mut variable = Variable::new(name, -1.0, 1.0)?;
        for (term, mean) in TERMS.into_iter().zip([-1.0, 0.0, 1.0]) {
            let function = MembershipFunction::gaussian_width(mean, width)?;
            variable = variable.with_term(term, function)?;
        }
        Ok(variable)
    };
    let inputs = vec![variable("angle")?, variable("rate")?];
    Ok(Tsk::zero_order(name, inputs, consequents)?
        .with_output("steering")?
        .when_no_rule_fires(NoRuleFires::Value(0.0))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn genes_reach_their_parameters() {
        let genes: Vec<f64> = (1..=GENES as u32).map(f64::from).collect();
        let mut parameters = vec![0.0; GENES];
        decode(&genes, &mut parameters);
        let controller = template("pursuer").unwrap().with_parameters(&parameters).unwrap();
        let system = controller.system();
        let term = |input: usize, term: usize| &system.inputs()[input].terms()[term].function;
        assert_eq!(term(0, 0).parameters(), [7.0, 1.0]);
        assert_eq!(term(1, 2).parameters(), [12.0, 6.0]);
        assert_eq!(system.consequents(), &genes[12..]);
    }
}
