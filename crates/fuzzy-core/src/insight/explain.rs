//! What happens in a system at one point: degrees, firing strengths, and each rule's part.

use std::collections::HashSet;

use super::{Insight, RuleText};
use crate::error::Result;
use crate::inference::{Answer, Interface, NoRuleFires, Parts};

/// What happens in a system at one point.
///
/// Its text is a table for the terminal; [`to_html`](Self::to_html) makes one for a browser.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// The system's name.
    pub system: String,
    /// The inputs with the degrees of their terms.
    pub inputs: Vec<ExplainedInput>,
    /// The rules with their firing strengths.
    pub rules: Vec<ExplainedRule>,
    /// The outputs with each rule's part in them.
    pub outputs: Vec<ExplainedOutput>,
}

/// An input at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct ExplainedInput {
    /// The input's name.
    pub name: String,
    /// The number that came.
    pub given: f64,
    /// The number that the system takes for it: one brought into the universe if the system does
    /// that.
    pub value: f64,
    /// The degree of each term.
    pub degrees: Vec<(String, f64)>,
}

/// A rule at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct ExplainedRule {
    /// The rule in words.
    pub words: RuleText,
    /// Its firing strength, the weight included.
    pub strength: f64,
}

/// An output at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct ExplainedOutput {
    /// The output's name.
    pub name: String,
    /// Its value, not finite where evaluation would have none.
    pub value: f64,
    /// Whether a rule about it fires.
    pub fires: bool,
    /// Whether there is no conclusion: no rule fires, or none leaves anything of its set.
    pub empty: bool,
    /// What is done where none does.
    pub no_rule_fires: NoRuleFires,
    /// What each rule has in it.
    pub parts: Parts,
}

impl ExplainedOutput {
    /// Why the output has no value from rules, and what is done then; none if it has one.
    pub fn remark(&self) -> Option<String> {
        let error = "evaluation raises an error";
        if !self.empty {
            let why = "rules fire, but their result is no finite number";
            return (!self.value.is_finite()).then(|| format!("{why}; {error}"));
        }
        let why = if self.fires { "rules fire, but their sets are empty" } else { "no rule fires" };
        let then = match self.no_rule_fires {
            NoRuleFires::Error => error,
            NoRuleFires::Value(_) => "the value is that for this case",
            NoRuleFires::Nan => "the value is NaN then",
            NoRuleFires::Previous => "the output before stays",
        };
        Some(format!("{why}; {then}"))
    }
}

/// What happens in a system at a point.
pub(super) fn explain<S: Insight>(system: &S, x: &[f64]) -> Result<Explanation> {
    let interface = system.interface();
    let strengths = system.firing_strengths(x)?;
    let mut admitted = x.to_vec();
    interface.admit(&mut admitted);
    let answers = answers(system, &admitted);
    let parts = system.parts(&admitted, &strengths);
    let words = system.rule_texts();
    let speaking: HashSet<&str> = words
        .iter()
        .zip(&strengths)
        .filter(|&(_, &strength)| strength > 0.0)
        .flat_map(|(words, _)| words.conclusions.iter().map(|(output, _)| &**output))
        .collect();
    let outputs = interface.outputs().iter().zip(answers).zip(parts);
    let outputs = outputs.map(|(((name, no_rule_fires), answer), parts)| ExplainedOutput {
        name: name.clone(),
        value: answer.value,
        fires: speaking.contains(&**name),
        empty: answer.strength <= 0.0,
        no_rule_fires: *no_rule_fires,
        parts,
    });
    Ok(Explanation {
        system: interface.name().to_owned(),
        inputs: inputs(interface, x, &admitted),
        outputs: outputs.collect(),
        rules: words
            .into_iter()
            .zip(strengths)
            .map(|(words, strength)| ExplainedRule { words, strength })
            .collect(),
    })
}

/// What evaluation finds at an admitted point, before it complains.
fn answers<S: Insight>(system: &S, x: &[f64]) -> Vec<Answer<f64>> {
    let mut scratch = vec![0.0; system.scratch_count()];
    let nothing = Answer { value: f64::NAN, strength: 0.0 };
    let mut answers = vec![nothing; system.interface().outputs().len()];
    system.infer(system.prepared(), x, &mut scratch, &mut answers);
    answers
}

fn inputs(interface: &Interface, given: &[f64], admitted: &[f64]) -> Vec<ExplainedInput> {
    let inputs = interface.inputs().iter().zip(given).zip(admitted);
    inputs
        .map(|((input, &given), &value)| {
            let degree = |term: &crate::Term| (term.name.clone(), term.function.degree(value));
            let degrees = input.terms().iter().map(degree).collect();
            ExplainedInput { name: input.name().to_owned(), given, value, degrees }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::examples::{mamdani, tip, tipper, tipper_with, variable};
    use super::*;
    use crate::norm::{Aggregation, SNorm, TNorm};
    use crate::output::{Defuzzifier, Output, Sampling, Value, Weighting};
    use crate::{Logic, Outside, Rng, Rules, Shape, System, Tsk, Variable};

    fn points() -> Vec<[f64; 2]> {
        let mut rng = Rng::new(4, 0);
        (0..40).map(|_| [rng.uniform_in(0.0, 10.0), rng.uniform_in(0.0, 10.0)]).collect()
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * b.abs().max(1.0)
    }

    /// Values as evaluation has them, shares that add up to 1, contributions to the value.
    fn check<S: Insight>(system: &S, x: &[f64], adds_up: bool) {
        let mut values = vec![f64::NAN; system.interface().outputs().len()];
        system.evaluate_into(x, &mut values).unwrap();
        let explanation = system.explain(x).unwrap();
        for (output, value) in explanation.outputs.iter().zip(values) {
            assert_eq!(output.value.to_bits(), value.to_bits());
            assert!(output.fires && output.remark().is_none());
            assert!(close(output.parts.shares.iter().sum(), 1.0), "{:?}", output.parts);
            let sum: f64 = output.parts.contributions.iter().sum();
            assert!(if adds_up { close(sum, value) } else { sum.is_nan() }, "{sum} {value}");
        }
    }

    #[test]
    fn parts_of_fuzzy_sets_add_up_under_every_norm() {
        let norms = SNorm::ALL.into_iter().map(Aggregation::Norm).chain([Aggregation::Sum]);
        for (aggregation, implication) in norms.flat_map(|s| TNorm::ALL.map(|t| (s, t))) {
            for sampling in [Sampling::Endpoints(61), Sampling::Midpoints(50)] {
                let output = mamdani(implication, aggregation, Defuzzifier::Centroid, sampling);
                let system = tipper_with(output);
                for x in points() {
                    // A drastic implication may leave no set at all.
                    if system.evaluate(&x).is_ok() {
                        check(&system, &x, true);
                    }
                }
            }
        }
    }

    #[test]
    fn parts_of_exact_centroids_add_up() {
        let max = Aggregation::Norm(SNorm::Max);
        for implication in [TNorm::Min, TNorm::Product] {
            let output = mamdani(implication, max, Defuzzifier::Centroid, Sampling::Exact);
            let system = tipper_with(output);
            points().iter().for_each(|x| check(&system, x, true));
            let fine = Sampling::Midpoints(20_000);
            let sampled = tipper_with(mamdani(implication, max, Defuzzifier::Centroid, fine));
            let shares = |system: &System| {
                system.explain(&[3.0, 2.0]).unwrap().outputs.remove(0).parts.shares
            };
            for (exact, sampled) in shares(&system).into_iter().zip(shares(&sampled)) {
                assert!((exact - sampled).abs() < 1e-6, "{exact} {sampled}");
            }
        }
    }

    #[test]
    fn the_corners_of_an_exact_set_enclose_its_area() {
        let terms: [(&str, Shape, &[f64]); 2] = [
            ("block", Shape::Rectangle, &[2.0, 3.0]),
            ("roof", Shape::Triangular, &[5.0, 6.0, 8.0]),
        ];
        let y = variable("y", (0.0, 10.0), &terms);
        let max = Aggregation::Norm(SNorm::Max);
        let (min, centroid) = (TNorm::Min, Defuzzifier::Centroid);
        let output = Output::mamdani_with(y, min, max, centroid, Sampling::Exact).unwrap();
        let x = variable("x", (0.0, 1.0), &[("any", Shape::Ramp, &[0.0, 1.0])]);
        let rules = "if x is any then y is block\nif x is any then y is roof";
        let system =
            System::from_text("s", vec![x], vec![output], rules, Logic::default()).unwrap();
        let parts = system.explain(&[0.5]).unwrap().outputs.remove(0).parts;
        let area = |ends: &[(f64, f64)]| 0.5 * (ends[0].1 + ends[1].1) * (ends[1].0 - ends[0].0);
        let areas: f64 = parts.set.windows(2).map(area).sum();
        // A block of 1 × ½, and the roof's lower half: ½·(3 + 1.5)/2.
        assert!(close(areas, 0.5 + 1.125), "{:?}", parts.set);
        assert!(close(parts.shares[0], 0.5 / 1.625));
        assert!(close(parts.contributions[0], 2.5 * 0.5 / 1.625));
        assert_eq!(parts.set.first(), Some(&(0.0, 0.0)));
        assert_eq!(parts.set.last(), Some(&(10.0, 0.0)));
        assert!(parts.set.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn what_rules_reach_together_is_shared_evenly() {
        let max = Aggregation::Norm(SNorm::Max);
        let text = "if x is any then tip is cheap\nif x is any then tip is cheap\n\
                    if x is any then tip is cheap with 0.5";
        let shares = |implication, aggregation, sampling| {
            let output = mamdani(implication, aggregation, Defuzzifier::Centroid, sampling);
            let x = variable("x", (0.0, 1.0), &[("any", Shape::Ramp, &[0.0, 1.0])]);
            let system =
                System::from_text("s", vec![x], vec![output], text, Logic::default()).unwrap();
            system.explain(&[1.0]).unwrap().outputs.remove(0).parts.shares
        };
        for sampling in [Sampling::Exact, Sampling::Endpoints(31)] {
            let product = shares(TNorm::Product, max, sampling);
            assert!(close(product[0], 0.5) && product[2] == 0.0, "{product:?}");
            let min = shares(TNorm::Min, max, sampling);
            // Up to ½ all three reach the triangle: a quarter of its area.
            assert!(min[0] == min[1] && (min[2] - 0.25 / 3.0).abs() < 0.005, "{min:?}");
        }
        let sum = shares(TNorm::Product, Aggregation::Sum, Sampling::Endpoints(31));
        assert!(close(sum[0], 0.4) && close(sum[2], 0.2), "{sum:?}");
    }

    #[test]
    fn a_defuzzifier_that_picks_a_point_has_shares_but_no_contributions() {
        for defuzzifier in [Defuzzifier::Bisector, Defuzzifier::MeanOfMaximum] {
            let (min, max) = (TNorm::Min, Aggregation::Norm(SNorm::Max));
            let output = mamdani(min, max, defuzzifier, Sampling::Endpoints(101));
            check(&tipper_with(output), &[3.0, 2.0], false);
        }
    }

    #[test]
    fn parts_of_weighted_outputs_add_up() {
        let names = ["cheap", "average", "generous"];
        let terms = || vec![Value::Constant(5.0), Value::Linear(vec![1.0, -0.5, 10.0])];
        let sugeno = |aggregation, weighting| {
            let formula = Value::parse("sqrt(service) + food^2", &["service", "food"]).unwrap();
            let values = terms().into_iter().chain([formula]);
            let terms = names.iter().map(|name| (*name).to_owned()).zip(values).collect();
            Output::sugeno_with("tip", terms, aggregation, weighting).unwrap()
        };
        let max = Aggregation::Norm(SNorm::Max);
        for aggregation in [Aggregation::Sum, max, Aggregation::Norm(SNorm::ProbabilisticSum)] {
            for weighting in [Weighting::Average, Weighting::Sum] {
                let system = tipper_with(sugeno(aggregation, weighting));
                points().iter().for_each(|x| check(&system, x, true));
            }
        }
        let height = mamdani(TNorm::Min, max, Defuzzifier::Height, Sampling::Endpoints(2));
        let system = tipper_with(height);
        points().iter().for_each(|x| check(&system, x, true));
        let parts = system.explain(&[3.0, 2.0]).unwrap().outputs.remove(0).parts;
        assert_eq!(parts.concluded, [5.0, 15.0, 25.0]);
        assert!(parts.set.is_empty());
        let ramps: [(&str, Shape, &[f64]); 3] = [
            (names[0], Shape::Ramp, &[10.0, 0.0]),
            (names[1], Shape::Sigmoid, &[15.0, 1.0]),
            (names[2], Shape::Ramp, &[20.0, 30.0]),
        ];
        for weighting in [Weighting::Average, Weighting::Sum] {
            let variable = variable("tip", (0.0, 30.0), &ramps);
            let system = tipper_with(Output::tsukamoto(variable, weighting).unwrap());
            points().iter().for_each(|x| check(&system, x, true));
        }
    }

    #[test]
    fn parts_of_a_grid_add_up() {
        let terms = ["N", "Z", "P"];
        let inputs = ["a", "b"]
            .map(|name| Variable::evenly(name, (0.0, 10.0), Shape::Bell, &terms).unwrap());
        let mut rng = Rng::new(1, 0);
        let planes = (0..27).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        let system = Tsk::new("grid", inputs.into(), crate::Order::One, planes).unwrap();
        for x in points() {
            check(&system, &x, true);
        }
        let explanation = system.explain(&[1.0, 9.0]).unwrap();
        let degrees = |input: usize, term: usize| explanation.inputs[input].degrees[term].1;
        assert_eq!(explanation.rules[5].strength, degrees(0, 1) * degrees(1, 2));
    }

    #[test]
    fn one_point_and_many_have_the_same_firing_strengths() {
        let system = tipper();
        let points = points().concat();
        let mut strengths = vec![0.0; points.len() / 2 * 3];
        system.firing_strengths_batch(&points, &mut strengths, 2).unwrap();
        for (x, row) in points.chunks(2).zip(strengths.chunks(3)) {
            assert_eq!(system.firing_strengths(x).unwrap(), row);
        }
        assert!(system.firing_strengths(&[1.0]).is_err());
        assert!(system.firing_strengths_batch(&points, &mut strengths[1..], 1).is_err());
    }

    #[test]
    fn where_no_rule_fires_it_says_so() {
        let x = variable("x", (0.0, 9.0), &[("low", Shape::Triangular, &[0.0, 1.0, 2.0])]);
        let system = |answer| {
            let output = Output::mamdani(tip()).unwrap().when_no_rule_fires(answer).unwrap();
            let rules = "if x is low then tip is cheap";
            System::from_text("s", vec![x.clone()], vec![output], rules, Logic::default()).unwrap()
        };
        for (answer, value, remark) in [
            (NoRuleFires::Error, f64::NAN, "an error"),
            (NoRuleFires::Value(4.0), 4.0, "for this case"),
            (NoRuleFires::Nan, f64::NAN, "no rule fires; the value is NaN"),
            (NoRuleFires::Previous, f64::NAN, "before stays"),
        ] {
            let explanation = system(answer).explain(&[5.0]).unwrap();
            let output = &explanation.outputs[0];
            assert_eq!(output.value.to_bits(), value.to_bits());
            assert!(!output.fires);
            assert!(output.remark().unwrap().contains(remark), "{answer:?}");
            assert!(explanation.to_string().contains(remark));
            assert_eq!((output.parts.shares[0], output.parts.contributions[0]), (0.0, 0.0));
        }
        assert!(system(NoRuleFires::Nan).explain(&[f64::NAN]).is_err());
    }

    #[test]
    fn where_sets_are_empty_it_says_so() {
        // None of the samples is at a peak, and below 1 the drastic product is 0.
        let (drastic, max) = (TNorm::Drastic, Aggregation::Norm(SNorm::Max));
        let samples = Sampling::Endpoints(100);
        let system = tipper_with(mamdani(drastic, max, Defuzzifier::Centroid, samples));
        let output = system.explain(&[3.0, 2.0]).unwrap().outputs.remove(0);
        assert!(output.fires && output.empty && output.value.is_nan());
        assert_eq!(output.parts.shares, [0.0; 3]);
        let remark = "rules fire, but their sets are empty; evaluation raises an error";
        assert_eq!(output.remark().unwrap(), remark);
    }

    #[test]
    fn inputs_are_shown_as_they_came_and_as_they_are_taken() {
        let system = tipper().with_outside(Outside::Clamp);
        let explanation = system.explain(&[12.0, 3.0]).unwrap();
        let service = &explanation.inputs[0];
        assert_eq!((service.given, service.value), (12.0, 10.0));
        assert_eq!(service.degrees[2], ("excellent".to_owned(), 1.0));
        assert_eq!(explanation.rules[2].strength, 1.0);
        assert!(tipper().with_outside(Outside::Error).explain(&[12.0, 3.0]).is_err());
    }
}
