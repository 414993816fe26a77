//! What is odd about a system: what can never matter, what contradicts itself, and where nothing
//! fires.

use std::collections::{HashMap, HashSet};

use super::conclusions::repeated;
use super::findings::{Finding, Kind};
use super::gaps::{self, gaps, place};
use super::words::is_own_formula;
use crate::hedge::Hedge;
use crate::inference::{Inference, System, Tsk, all_hedges};
use crate::output::{Defuzzifier, Method, Output, Sampling};
use crate::rule::{Antecedent, Consequent, Rule};
use crate::variable::{Term, Universe, Variable};

/// How many parts of a universe are tried for a degree above 0.
const TRIALS: u32 = 256;

/// What is odd about a system of rules.
pub fn system(system: &System) -> Vec<Finding> {
    let inputs = system.interface().inputs();
    let used = Used::by(system);
    let mut findings: Vec<Finding> =
        inputs.iter().flat_map(|input| outside("input", input)).collect();
    findings.extend(system.outputs().iter().flat_map(of_output));
    findings.extend(used.findings(system));
    findings.extend(repeated(system));
    findings.extend(silent_rules(system));
    findings.extend(gaps::of_system(system, |input| used.inputs.contains(inputs[input].name())));
    findings
}

/// What is odd about a grid.
pub fn tsk(system: &Tsk) -> Vec<Finding> {
    let mut findings: Vec<Finding> =
        system.inputs().iter().flat_map(|input| outside("input", input)).collect();
    findings.extend(gaps::of_tsk(system));
    findings
}

/// Whether a term has a degree above 0 somewhere in a universe.
fn is_within(term: &Term, universe: Universe) -> bool {
    let (low, size) = (universe.low(), universe.high() - universe.low());
    let tried = (0..=TRIALS).map(|k| (f64::from(k) / f64::from(TRIALS)).mul_add(size, low));
    let mut places = tried.chain([term.function.centre(universe)]);
    // The support is that of the equation: far tails are 0 all the same.
    term.function.support(universe).is_some() && places.any(|x| term.function.degree(x) > 0.0)
}

/// Terms that lie outside the universe of their variable.
fn outside(role: &str, variable: &Variable) -> Vec<Finding> {
    let universe = variable.universe();
    let terms = variable.terms().iter().filter(|term| !is_within(term, universe));
    let message = |term: &Term| {
        format!(
            "the term \"{}\" of the {role} \"{}\" has no degree above 0 {}, its universe; move or \
             delete it, or widen the universe",
            term.name,
            variable.name(),
            place((universe.low(), universe.high()))
        )
    };
    terms.map(|term| Finding::new(Kind::OutsideUniverse, message(term))).collect()
}

/// Terms of an output that cannot matter, and values that no term stands for.
fn of_output(output: &Output) -> Vec<Finding> {
    let Some(variable) = output.variable() else { return Vec::new() };
    let mut findings = outside("output", variable);
    let Method::Mamdani { defuzzifier, sampling, .. } = output.method() else { return findings };
    if *defuzzifier == Defuzzifier::Height {
        // It looks at the centres of the terms alone.
        return findings;
    }
    findings.extend(unseen(variable, *sampling));
    let intervals = gaps(variable).into_iter().filter(|gap| gap.0 < gap.1);
    findings.extend(intervals.map(|gap| {
        let message = format!(
            "no term of the output \"{}\" has a degree above 0 {}, so no rule can ask for values \
             there; widen its terms, add one, or narrow the universe",
            output.name(),
            place(gap)
        );
        Finding::new(Kind::Gap, message)
    }));
    findings
}

/// Terms within the universe of an output that none of its samples sees.
fn unseen(variable: &Variable, sampling: Sampling) -> Vec<Finding> {
    let (universe, samples) = (variable.universe(), sampling.points(variable));
    if samples.is_empty() {
        return Vec::new();
    }
    let sees = |term: &Term| samples.iter().any(|&y| term.function.degree(y) > 0.0);
    let terms = variable.terms().iter().filter(|term| is_within(term, universe) && !sees(term));
    let message = |term: &Term| {
        format!(
            "the term \"{}\" of the output \"{}\" has the degree 0 at all {} samples, so its rules \
             say nothing; widen it, take more samples, or the height as defuzzifier",
            term.name,
            variable.name(),
            samples.len()
        )
    };
    terms.map(|term| Finding::new(Kind::UnseenTerm, message(term))).collect()
}

/// What rules speak of.
struct Used<'a> {
    inputs: HashSet<&'a str>,
    terms: HashSet<(&'a str, &'a str)>,
}

impl<'a> Used<'a> {
    fn by(system: &'a System) -> Self {
        let mut used = Self { inputs: HashSet::new(), terms: HashSet::new() };
        for rule in system.rules() {
            used.ask(&rule.antecedent);
            for conclusion in &rule.conclusions {
                if let Consequent::Term { term, .. } = &conclusion.value {
                    used.terms.insert((&conclusion.output, term));
                }
            }
        }
        used
    }

    fn ask(&mut self, antecedent: &'a Antecedent) {
        match antecedent {
            Antecedent::Is { variable, term, .. } => {
                self.inputs.insert(variable);
                self.terms.insert((variable, term));
            }
            Antecedent::And(parts) | Antecedent::Or(parts) => {
                parts.iter().for_each(|part| self.ask(part));
            }
            Antecedent::Not(of) | Antecedent::Hedged { of, .. } => self.ask(of),
        }
    }

    fn findings(&self, system: &System) -> Vec<Finding> {
        let mut findings = Vec::new();
        for input in system.interface().inputs() {
            let name = input.name();
            if !self.inputs.contains(name) {
                let message =
                    format!("no rule asks for the input \"{name}\"; delete it, or use it");
                findings.push(Finding::new(Kind::UnusedInput, message));
                continue;
            }
            let terms = input.terms().iter().map(|term| &*term.name);
            findings.extend(self.unused_terms(name, terms, "asks whether the input"));
        }
        for output in system.outputs() {
            let terms = output.term_names().into_iter();
            findings.extend(self.unused_terms(output.name(), terms, "concludes that the output"));
        }
        findings
    }

    fn unused_terms<'b>(
        &self,
        variable: &str,
        terms: impl Iterator<Item = &'b str>,
        verb: &str,
    ) -> Vec<Finding> {
        let unused = terms.filter(|term| !self.terms.contains(&(variable, term)));
        let message = |term: &str| {
            format!("no rule {verb} \"{variable}\" is \"{term}\"; delete the term, or use it")
        };
        unused.map(|term| Finding::new(Kind::UnusedTerm, message(term))).collect()
    }
}

/// Rules that never fire, and terms of outputs that only they conclude.
fn silent_rules(system: &System) -> Vec<Finding> {
    let reach = Reach::of(system);
    let mut findings = Vec::new();
    let mut reached: HashSet<(&str, &str)> = HashSet::new();
    let mut missed: Vec<(&str, &str)> = Vec::new();
    for (index, rule) in system.rules().iter().enumerate() {
        let silence = reach.silence(rule, index + 1);
        for conclusion in &rule.conclusions {
            let Consequent::Term { term, .. } = &conclusion.value else { continue };
            let place = (&*conclusion.output, &**term);
            if silence.is_none() {
                reached.insert(place);
            } else if !is_own_formula(term, index) {
                missed.push(place);
            }
        }
        findings.extend(silence);
    }
    // Each only once.
    missed.retain(|&place| reached.insert(place));
    findings.extend(missed.into_iter().map(|(output, term)| {
        let message = format!(
            "only rules that never fire conclude \"{term}\" of the output \"{output}\"; mend them, \
             or delete the term"
        );
        Finding::new(Kind::UnreachableTerm, message)
    }));
    findings
}

/// The terms of the inputs that lie within their universes, and what hedges mean.
struct Reach<'a> {
    terms: HashMap<(&'a str, &'a str), (&'a Term, Universe)>,
    hedges: HashMap<String, Hedge>,
}

impl<'a> Reach<'a> {
    fn of(system: &'a System) -> Self {
        let inputs = system.interface().inputs().iter();
        let terms = inputs.flat_map(|input| {
            let within = input.terms().iter().filter(|term| is_within(term, input.universe()));
            within.map(|term| ((input.name(), &*term.name), (term, input.universe())))
        });
        let hedges = all_hedges(&system.logic().hedges).into_iter();
        Self {
            terms: terms.collect(),
            hedges: hedges.map(|hedge| (hedge.name().to_owned(), hedge)).collect(),
        }
    }

    /// Why a rule never fires; none if it may.
    fn silence(&self, rule: &Rule, number: usize) -> Option<Finding> {
        if rule.weight == 0.0 {
            let message = format!(
                "rule {number}, \"{rule}\", has the weight 0, so it never fires; delete it, or \
                 give it another weight"
            );
            return Some(Finding::new(Kind::ZeroWeight, message));
        }
        if self.may_fire(&rule.antecedent) {
            return None;
        }
        let message = format!(
            "rule {number}, \"{rule}\", never fires: within the universes its condition is 0 \
             everywhere; mend the condition or its terms, or delete it"
        );
        Some(Finding::new(Kind::NeverFires, message))
    }

    /// Whether an antecedent may be above 0 within the universes, as far as supports tell.
    fn may_fire(&self, antecedent: &Antecedent) -> bool {
        match antecedent {
            Antecedent::Is { variable, hedges, term } => {
                let known = self.terms.contains_key(&(&**variable, &**term));
                known || self.lifts_zero(hedges.iter().map(String::as_str))
            }
            Antecedent::And(parts) => {
                parts.iter().all(|part| self.may_fire(part)) && self.may_meet(parts)
            }
            Antecedent::Or(parts) => parts.iter().any(|part| self.may_fire(part)),
            Antecedent::Not(_) => true,
            Antecedent::Hedged { hedge, of } => self.may_fire(of) || self.lifts_zero([&**hedge]),
        }
    }

    /// Whether hedges, the last applied first, make more of the degree 0.
    fn lifts_zero<'b>(
        &self,
        hedges: impl IntoIterator<Item = &'b str, IntoIter: DoubleEndedIterator>,
    ) -> bool {
        let known = hedges.into_iter().rev().filter_map(|hedge| self.hedges.get(hedge));
        known.fold(0.0, |degree, hedge| hedge.apply(degree)) > 0.0
    }

    /// Whether the terms of one input that are joined by `and` have a number in common.
    fn may_meet(&self, parts: &[Antecedent]) -> bool {
        let mut joined: HashMap<&str, Vec<(&Term, Universe)>> = HashMap::new();
        for part in parts {
            let Antecedent::Is { variable, hedges, term } = part else { continue };
            let found = self.terms.get(&(&**variable, &**term));
            if let Some(found) = found.filter(|_| !self.lifts_zero(hedges.iter().map(|h| &**h))) {
                joined.entry(variable).or_default().push(*found);
            }
        }
        joined.values().all(|terms| have_common_number(terms))
    }
}

fn have_common_number(terms: &[(&Term, Universe)]) -> bool {
    let supports = terms.iter().filter_map(|(term, universe)| term.function.support(*universe));
    let common = supports.reduce(|a, b| (a.0.max(b.0), a.1.min(b.1)));
    common.is_none_or(|(low, high)| {
        low < high || low == high && terms.iter().all(|(term, _)| term.function.degree(low) > 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::super::Insight;
    use super::super::examples::{tip, tipper, variable};
    use super::*;
    use crate::{Logic, MembershipFunction, NoRuleFires, Shape};

    const TRIANGLE: Shape = Shape::Triangular;

    fn input(name: &str) -> Variable {
        let terms: [(&str, Shape, &[f64]); 3] = [
            ("low", TRIANGLE, &[0.0, 0.0, 4.0]),
            ("high", TRIANGLE, &[6.0, 10.0, 10.0]),
            ("huge", TRIANGLE, &[20.0, 30.0, 40.0]),
        ];
        variable(name, (0.0, 10.0), &terms)
    }

    fn kinds(findings: &[Finding]) -> Vec<Kind> {
        findings.iter().map(|found| found.kind).collect()
    }

    fn found(inputs: Vec<Variable>, output: Output, rules: &str) -> Vec<Finding> {
        let system = System::from_text("s", inputs, vec![output], rules, Logic::default());
        system.unwrap().validate()
    }

    fn messages(findings: &[Finding], kind: Kind) -> Vec<&str> {
        findings.iter().filter(|found| found.kind == kind).map(|found| &*found.message).collect()
    }

    #[test]
    fn there_is_nothing_odd_about_the_tipper_or_an_even_grid() {
        assert_eq!(tipper().validate(), []);
        let terms = ["N", "Z", "P"];
        for shape in [Shape::Gaussian, TRIANGLE, Shape::SemiEllipse, Shape::Cosine] {
            let inputs =
                ["a", "b"].map(|name| Variable::evenly(name, (-1.0, 1.0), shape, &terms).unwrap());
            let grid = Tsk::zero_order("grid", inputs.to_vec(), vec![0.0; 9]).unwrap();
            assert_eq!(grid.validate(), []);
            let output = Output::mamdani(Variable::evenly("y", (0.0, 5.0), shape, &terms).unwrap());
            let rules: Vec<String> = terms
                .iter()
                .flat_map(|a| terms.map(|b| format!("if a is {a} and b is {b} then y is {b}")))
                .collect();
            assert_eq!(found(inputs.to_vec(), output.unwrap(), &rules.join("\n")), []);
        }
    }

    #[test]
    fn gaps_are_told_where_nothing_fires_in_them() {
        let rules = "if x is low then tip is cheap\nif x is high then tip is average\n\
                     if x is huge then tip is generous";
        let findings = found(vec![input("x")], Output::mamdani(tip()).unwrap(), rules);
        assert_eq!(
            messages(&findings, Kind::Gap),
            ["no term of the input \"x\" has a degree above 0 from 4 to 6, where there may be no \
              rule about \"tip\" that fires; widen its terms or add one"]
        );
        let silent = messages(&findings, Kind::NoRuleFires);
        assert!(silent[0].starts_with("no rule about \"tip\" fires at 20"), "{silent:?}");
        assert!(silent[0].contains("such as x = "), "{silent:?}");
        assert!(silent[0].contains("there evaluation raises an error; widen"), "{silent:?}");
        let fires = "if x is not low then tip is cheap\nif x is low or x is high then tip is average\n\
                     if x is not huge then tip is generous";
        let findings = found(vec![input("x")], Output::mamdani(tip()).unwrap(), fires);
        assert_eq!(kinds(&findings), [Kind::OutsideUniverse]);
    }

    #[test]
    fn a_place_where_terms_only_touch_is_a_gap() {
        let terms: [(&str, Shape, &[f64]); 1] = [("all", TRIANGLE, &[0.0, 5.0, 10.0])];
        let one = crate::output::Value::Constant(1.0);
        let output = Output::sugeno("tip", vec![("cheap".to_owned(), one)]);
        let rules = "if x is all then tip is cheap";
        let findings = found(vec![variable("x", (0.0, 10.0), &terms)], output.unwrap(), rules);
        assert_eq!(kinds(&findings), [Kind::Gap, Kind::Gap]);
        assert!(findings[1].message.contains("above 0 at 10, where"), "{}", findings[1]);
    }

    #[test]
    fn what_rules_never_speak_of_is_told() {
        let inputs = vec![input("x"), input("y")];
        let rules = "if x is not low then tip is cheap\nif x is low then tip is average";
        let findings = found(inputs, Output::mamdani(tip()).unwrap(), rules);
        assert_eq!(
            messages(&findings, Kind::UnusedInput),
            ["no rule asks for the input \"y\"; delete it, or use it"]
        );
        assert_eq!(
            messages(&findings, Kind::UnusedTerm),
            [
                "no rule asks whether the input \"x\" is \"high\"; delete the term, or use it",
                "no rule asks whether the input \"x\" is \"huge\"; delete the term, or use it",
                "no rule concludes that the output \"tip\" is \"generous\"; delete the term, or \
                 use it",
            ]
        );
        assert_eq!(messages(&findings, Kind::OutsideUniverse).len(), 2);
        assert_eq!(messages(&findings, Kind::Gap), [""; 0]);
    }

    #[test]
    fn far_tails_are_outside_too() {
        let far = MembershipFunction::gaussian(100.0, 1.0).unwrap();
        let x = input("x").with_term("far", far).unwrap();
        let grid = Tsk::zero_order("grid", vec![x], vec![0.0; 4]).unwrap();
        let findings = grid.validate();
        let outside = messages(&findings, Kind::OutsideUniverse);
        assert_eq!(
            outside[1],
            "the term \"far\" of the input \"x\" has no degree above 0 from 0 to 10, its \
             universe; move or delete it, or widen the universe"
        );
        // The equation of a Gaussian leaves no gap, its degrees do.
        assert_eq!(messages(&findings, Kind::NoRuleFires).len(), 1);
    }

    #[test]
    fn a_grid_is_told_its_gaps() {
        let inputs = vec![input("x"), input("y")];
        let grid = Tsk::zero_order("grid", inputs, vec![0.0; 9]).unwrap();
        let grid = grid.when_no_rule_fires(NoRuleFires::Value(0.5)).unwrap();
        let findings = grid.validate();
        assert_eq!(messages(&findings, Kind::Gap).len(), 2);
        let silent = messages(&findings, Kind::NoRuleFires);
        // One gap of a fifth in each of two inputs: 1 − 0.8².
        assert!(silent[0].starts_with("no rule about \"output\" fires at 36"), "{silent:?}");
        assert!(silent[0].contains("there it is 0.5; widen"), "{silent:?}");
    }

    #[test]
    fn outputs_have_gaps_and_terms_between_samples() {
        let terms: [(&str, Shape, &[f64]); 3] = [
            ("left", TRIANGLE, &[0.0, 1.0, 2.0]),
            ("point", Shape::Singleton, &[5.03]),
            ("right", TRIANGLE, &[8.0, 9.0, 10.0]),
        ];
        let rules = "if x is not low then y is left\nif x is low then y is right\n\
                     if x is high then y is point";
        let y = variable("y", (0.0, 10.0), &terms);
        let findings = found(vec![input("x")], Output::mamdani(y).unwrap(), rules);
        let gaps = messages(&findings, Kind::Gap);
        assert!(gaps[0].contains("output \"y\" has a degree above 0 from 2 to 5.03"), "{gaps:?}");
        assert_eq!(
            messages(&findings, Kind::UnseenTerm),
            ["the term \"point\" of the output \"y\" has the degree 0 at all 101 samples, so its \
              rules say nothing; widen it, take more samples, or the height as defuzzifier"]
        );
    }

    #[test]
    fn rules_that_never_fire_are_told_and_what_only_they_conclude() {
        let inputs = || vec![input("x"), input("y")];
        let rules = |odd: &str| {
            format!(
                "if x is not low or y is not high then tip is cheap\n\
                 if x is low or y is high then tip is average\n{odd} then tip is generous"
            )
        };
        let of = |odd: &str| found(inputs(), Output::mamdani(tip()).unwrap(), &rules(odd));
        for odd in [
            "if x is very huge",
            "if x is low and y is huge",
            "if x is low and y is high and x is high",
            "if very (x is huge or y is huge)",
        ] {
            let findings = of(odd);
            let never = messages(&findings, Kind::NeverFires);
            let place = format!("rule 3, \"{odd} then tip is generous\", never fires");
            assert!(never[0].starts_with(&place), "{never:?}");
            assert_eq!(messages(&findings, Kind::UnreachableTerm).len(), 1);
        }
        for fine in ["if x is not huge", "if any x is huge", "if x is low and x is not low"] {
            assert_eq!(messages(&of(fine), Kind::NeverFires), [""; 0], "{fine}");
        }
        let findings = found(
            inputs(),
            Output::mamdani(tip()).unwrap(),
            &format!("{} with 0", rules("if x is high")),
        );
        assert_eq!(messages(&findings, Kind::ZeroWeight).len(), 1);
        assert_eq!(
            messages(&findings, Kind::UnreachableTerm),
            ["only rules that never fire conclude \"generous\" of the output \"tip\"; mend them, \
              or delete the term"]
        );
    }

    #[test]
    fn ten_thousand_rules_are_looked_at() {
        let names: Vec<String> = (0..100).map(|k| format!("t{k}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let inputs = ["x", "y"].map(|x| Variable::evenly(x, (0.0, 1.0), TRIANGLE, &names).unwrap());
        let rule = |k: usize| {
            let (x, y) = (names[k / 100], names[k % 100]);
            format!("if x is {x} and y is {y} then tip is cheap")
        };
        let rules: Vec<String> = (0..10_000).map(rule).collect();
        let output =
            Output::mamdani(variable("tip", (0.0, 1.0), &[("cheap", TRIANGLE, &[-1.0, 0.0, 2.0])]));
        let findings = found(inputs.to_vec(), output.unwrap(), &rules.join("\n"));
        assert_eq!(findings, []);
    }
}
