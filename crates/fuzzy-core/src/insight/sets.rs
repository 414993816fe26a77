//! What a rule's parts look like: the propositions of its antecedent and the sets that it implies.

use crate::check;
use crate::error::{Error, Result};
use crate::hedge::Hedge;
use crate::inference::{Inference, System, all_hedges};
use crate::output::{Defuzzifier, Method, Sampling};
use crate::rule::{Antecedent, Consequent, Hedges, Name};
use crate::variable::Term;

/// The hedge of [`Antecedent::Not`].
const NOT: &str = "not";
/// Where the implied set of an output without samples is looked at: its corners may be anywhere.
const UNSAMPLED: Sampling = Sampling::Endpoints(1001);

/// A proposition of a rule's antecedent, such as `service is not very poor`.
#[derive(Debug, Clone)]
pub struct Premise<'a> {
    /// The number of the input.
    pub input: usize,
    /// The words before the term; the last is applied first.
    pub hedges: Vec<String>,
    /// The term.
    pub term: &'a Term,
    meanings: Vec<Hedge>,
}

impl Premise<'_> {
    /// What the input is to be: `not very poor`.
    pub fn words(&self) -> String {
        format!("{}{}", Hedges(&self.hedges), Name(&self.term.name))
    }

    /// How well a number fits, hedges included.
    pub fn degree(&self, x: f64) -> f64 {
        let own = self.term.function.degree(x);
        self.meanings.iter().rev().fold(own, |degree, hedge| hedge.apply(degree))
    }
}

impl System {
    /// The propositions of a rule's antecedent, in their order. Hedges that reach more than one
    /// proposition belong to none.
    pub fn premises(&self, rule: usize) -> Result<Vec<Premise<'_>>> {
        let mut premises = Vec::new();
        self.check_rule(rule)?;
        self.collect(&self.rules()[rule].antecedent, &[], &mut premises)?;
        Ok(premises)
    }

    /// The set (y, degree) that a rule of this strength implies about a Mamdani output, at the
    /// samples of the output; none if it says nothing about it or the output has no such sets.
    /// Two sets of one rule are joined as those of two rules.
    pub fn implied_set(
        &self,
        rule: usize,
        output: usize,
        strength: f64,
    ) -> Result<Option<Vec<(f64, f64)>>> {
        self.check_rule(rule)?;
        check_index("the number of the output", output, self.outputs().len())?;
        let output = &self.outputs()[output];
        let Method::Mamdani { variable, implication, aggregation, defuzzifier, sampling } =
            output.method()
        else {
            return Ok(None);
        };
        let mut set: Option<Vec<(f64, f64)>> = None;
        for conclusion in &self.rules()[rule].conclusions {
            let Consequent::Term { hedges, term } = &conclusion.value else { continue };
            if conclusion.output != output.name() || *defuzzifier == Defuzzifier::Height {
                continue;
            }
            let (term, meanings) = (variable.term(term)?, self.meanings(hedges)?);
            let shown = if *sampling == Sampling::Exact { UNSAMPLED } else { *sampling };
            let points = shown.points(variable);
            let set = set.get_or_insert_with(|| points.iter().map(|&y| (y, 0.0)).collect());
            for (y, degree) in set {
                let own = term.function.degree(*y);
                let own = meanings.iter().rev().fold(own, |degree, hedge| hedge.apply(degree));
                *degree = aggregation.apply(*degree, implication.apply(strength, own));
            }
        }
        Ok(set)
    }

    /// Collects the propositions under hedges that belong to the antecedent alone.
    fn collect<'a>(
        &'a self,
        antecedent: &'a Antecedent,
        outer: &[&str],
        premises: &mut Vec<Premise<'a>>,
    ) -> Result<()> {
        let under = |hedge: &'a str| outer.iter().copied().chain([hedge]).collect::<Vec<_>>();
        match antecedent {
            Antecedent::Is { variable, hedges, term } => {
                let inputs = self.interface().inputs();
                let own = inputs.iter().enumerate().find(|(_, input)| input.name() == variable);
                let Some((input, variable)) = own else { return Ok(()) };
                let words = outer.iter().map(|&hedge| hedge.to_owned());
                let hedges: Vec<String> = words.chain(hedges.iter().cloned()).collect();
                let meanings = self.meanings(&hedges)?;
                premises.push(Premise { input, hedges, term: variable.term(term)?, meanings });
                Ok(())
            }
            Antecedent::And(operands) | Antecedent::Or(operands) => {
                operands.iter().try_for_each(|operand| self.collect(operand, &[], premises))
            }
            Antecedent::Not(of) => self.collect(of, &under(NOT), premises),
            Antecedent::Hedged { hedge, of } => self.collect(of, &under(hedge), premises),
        }
    }

    fn meanings(&self, hedges: &[String]) -> Result<Vec<Hedge>> {
        let known = all_hedges(&self.logic().hedges);
        let meaning = |name: &String| {
            let found = known.iter().find(|hedge| hedge.name() == name).cloned();
            found.ok_or_else(|| Error::unknown_name("hedge", name, known.iter().map(Hedge::name)))
        };
        hedges.iter().map(meaning).collect()
    }

    fn check_rule(&self, rule: usize) -> Result<()> {
        check_index("the number of the rule", rule, self.rules().len())
    }
}

/// Nothing, if there is a thing with this number, counted from 0.
fn check_index(what: &str, index: usize, count: usize) -> Result<()> {
    let expected = format!("less than {count}");
    check::within(what, index as f64, &expected, |_| index < count).map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::super::examples::{tip, variable};
    use super::*;
    use crate::{Logic, Output, Shape};

    fn system(rules: &str) -> System {
        let terms: [(&str, Shape, &[f64]); 2] =
            [("low", Shape::Ramp, &[1.0, 0.0]), ("high", Shape::Ramp, &[0.0, 1.0])];
        let inputs = ["x", "y"].map(|name| variable(name, (0.0, 1.0), &terms));
        let output = Output::mamdani(tip()).unwrap();
        let hedges = vec![Hedge::custom("rather", "x^1.5").unwrap()];
        let logic = Logic { hedges, ..Logic::default() };
        System::from_text("s", inputs.into(), vec![output], rules, logic).unwrap()
    }

    #[test]
    fn premises_carry_the_hedges_that_are_theirs_alone() {
        let rules = "if not (x is very low) and very (rather y is high or x is high) \
                     then tip is cheap";
        let system = system(rules);
        let premises = system.premises(0).unwrap();
        let words: Vec<(usize, String)> = premises.iter().map(|p| (p.input, p.words())).collect();
        let expected = [(0, "not very low"), (1, "rather high"), (0, "high")];
        assert_eq!(words, expected.map(|(input, words)| (input, words.to_owned())));
        assert_eq!(premises[0].degree(0.5), 0.75);
        assert_eq!(premises[1].degree(0.25), 0.125);
        assert!(system.premises(1).unwrap_err().to_string().contains("less than 1"));
    }

    #[test]
    fn a_rule_implies_a_clipped_set() {
        let system = system("if x is low then tip is very cheap and tip is average");
        let set = system.implied_set(0, 0, 0.5).unwrap().unwrap();
        assert_eq!(set.len(), 101);
        let at = |y: f64| set.iter().find(|point| (point.0 - y).abs() < 1e-9).unwrap().1;
        assert!((at(3.0) - 0.36).abs() < 1e-12);
        assert_eq!((at(4.5), at(15.0), at(25.5)), (0.5, 0.5, 0.0));
        assert!(system.implied_set(0, 1, 0.5).is_err());
        let aggregated = super::super::Insight::explain(&system, &[0.5, 0.0]).unwrap();
        assert_eq!(aggregated.outputs[0].parts.set, set);
    }
}
