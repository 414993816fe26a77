//! Where no term has a degree above 0, and where no rule fires.

use std::collections::HashMap;

use super::findings::{Finding, Kind};
use super::table::short;
use crate::inference::{Inference, Interface, NoRuleFires, Rules, System, Tsk};
use crate::rule::Name;
use crate::variable::Variable;

/// How many rules may be fired to look at all points together, at points and in gaps each.
const BUDGET: usize = 1 << 26;
/// The fewest and the most points that are looked at.
const POINTS: (usize, usize) = (256, 4096);
/// The fewest and the most points in one gap of an input.
const POINTS_IN_GAP: (usize, usize) = (16, 256);
/// Points whose firing strengths are held at a time.
const ROWS: usize = 64;

type Interval = (f64, f64);

/// The intervals and single points of a universe where every term has the degree 0, from the
/// terms' supports.
pub fn gaps(variable: &Variable) -> Vec<Interval> {
    let (terms, universe) = (variable.terms(), variable.universe());
    let silent = |x: f64| terms.iter().all(|term| term.function.degree(x) == 0.0);
    let mut supports: Vec<Interval> =
        terms.iter().filter_map(|term| term.function.support(universe)).collect();
    supports.sort_by(|a, b| a.0.total_cmp(&b.0));
    // What touches the upper end of the universe is looked at like what touches a neighbour.
    supports.push((universe.high(), universe.high()));
    let (mut gaps, mut reached): (Vec<Interval>, f64) = (Vec::new(), universe.low());
    for (low, high) in supports {
        let known = gaps.last().is_some_and(|gap| gap.1 == reached);
        if low > reached {
            gaps.push((reached, low));
        } else if low == reached && !known && silent(reached) {
            gaps.push((reached, reached));
        }
        reached = reached.max(high);
    }
    gaps
}

/// `from 3 to 7`, or `at 3`.
pub fn place((low, high): Interval) -> String {
    if low == high {
        return format!("at {}", short(low));
    }
    format!("from {} to {}", short(low), short(high))
}

/// Points spread evenly over the universes, row by row: multiples of the square roots of the
/// primes, without their whole parts (Richtmyer's sequence).
struct Spread<'a> {
    inputs: &'a [Variable],
    roots: Vec<f64>,
}

impl<'a> Spread<'a> {
    fn new(inputs: &'a [Variable]) -> Self {
        let is_prime = |n: &u32| (2..).take_while(|d| d * d <= *n).all(|d| !n.is_multiple_of(d));
        let primes = (2..).filter(is_prime).take(inputs.len());
        Self { inputs, roots: primes.map(|prime| f64::from(prime).sqrt()).collect() }
    }

    /// The point with this number.
    fn point(&self, number: usize) -> impl Iterator<Item = f64> {
        self.inputs.iter().zip(&self.roots).map(move |(input, root)| {
            let (low, high) = (input.universe().low(), input.universe().high());
            let share = ((number + 1) as f64 * root).fract();
            share.mul_add(high - low, low).clamp(low, high)
        })
    }

    fn points(&self, count: usize) -> Vec<f64> {
        (0..count).flat_map(|number| self.point(number)).collect()
    }
}

/// Points where no rule about an output fires: how many, and the first.
#[derive(Debug, Default)]
struct Silence {
    count: usize,
    example: Option<Vec<f64>>,
}

/// The rules about each output.
struct Coverage<'a> {
    system: &'a System,
    about: Vec<Vec<usize>>,
}

impl<'a> Coverage<'a> {
    fn new(system: &'a System) -> Self {
        let outputs = system.outputs().iter().enumerate();
        let numbers: HashMap<&str, usize> = outputs.map(|(k, o)| (o.name(), k)).collect();
        let mut about = vec![Vec::new(); numbers.len()];
        for (index, rule) in system.rules().iter().enumerate() {
            for conclusion in &rule.conclusions {
                if let Some(&output) = numbers.get(&*conclusion.output) {
                    about[output].push(index);
                }
            }
        }
        Self { system, about }
    }

    /// For each output where no rule about it fires, of these points.
    fn silences(&self, points: &[f64]) -> Vec<Silence> {
        let (inputs, rules) = (self.system.interface().inputs().len(), self.system.rule_count());
        let mut silences: Vec<Silence> = self.about.iter().map(|_| Silence::default()).collect();
        let mut strengths = vec![0.0; ROWS * rules];
        for points in points.chunks(ROWS * inputs) {
            let strengths = &mut strengths[..points.len() / inputs * rules];
            // Points within the universes are never refused.
            if self.system.firing_strengths_batch(points, strengths, 1).is_err() {
                continue;
            }
            for (point, strengths) in points.chunks(inputs).zip(strengths.chunks(rules)) {
                for (silence, about) in silences.iter_mut().zip(&self.about) {
                    if about.iter().all(|&rule| strengths[rule] == 0.0) {
                        silence.count += 1;
                        silence.example.get_or_insert_with(|| point.to_vec());
                    }
                }
            }
        }
        silences
    }
}

/// Gaps of the inputs of a system that matter, and points where no rule fires.
pub fn of_system(system: &System, is_used: impl Fn(usize) -> bool) -> Vec<Finding> {
    let (interface, coverage) = (system.interface(), Coverage::new(system));
    let (inputs, rules) = (interface.inputs(), system.rule_count());
    let spread = Spread::new(inputs);
    let found: Vec<(usize, Interval)> = inputs
        .iter()
        .enumerate()
        .filter(|&(index, _)| is_used(index))
        .flat_map(|(index, input)| gaps(input).into_iter().map(move |gap| (index, gap)))
        .collect();
    let in_gap = BUDGET / rules / found.len().max(1);
    let in_gap = in_gap.clamp(POINTS_IN_GAP.0, POINTS_IN_GAP.1);
    let mut findings = Vec::new();
    for (input, gap) in found {
        let mut points = spread.points(in_gap);
        points.iter_mut().skip(input).step_by(inputs.len()).for_each(|x| *x = middle(gap));
        let silences = coverage.silences(&points);
        let mut outputs = interface.outputs().iter().zip(silences);
        if let Some(((output, _), _)) = outputs.find(|(_, silence)| silence.count > 0) {
            findings.push(gap_of_input(inputs[input].name(), gap, output));
        }
    }
    let count = (BUDGET / rules).clamp(POINTS.0, POINTS.1);
    let silences = coverage.silences(&spread.points(count));
    findings.extend(silences.iter().enumerate().filter_map(|(output, silence)| {
        let example = silence.example.as_deref()?;
        Some(no_rule_fires(interface, output, example, (silence.count, count)))
    }));
    findings
}

/// Gaps of the inputs of a grid, and points where no rule fires.
pub fn of_tsk(system: &Tsk) -> Vec<Finding> {
    let (inputs, spread) = (system.inputs(), Spread::new(system.inputs()));
    let mut findings: Vec<Finding> = inputs
        .iter()
        .flat_map(|input| gaps(input).into_iter().map(|gap| (input.name(), gap)))
        .map(|(input, gap)| gap_of_input(input, gap, system.output()))
        .collect();
    // A grid's rules fire together as strongly as the product of the inputs' sums of degrees.
    let sum = |input: &Variable, x: f64| {
        input.terms().iter().map(|term| term.function.degree(x)).sum::<f64>()
    };
    let silent = |point: &Vec<f64>| {
        inputs.iter().zip(point).map(|(input, &x)| sum(input, x)).product::<f64>() == 0.0
    };
    let points = (0..POINTS.1).map(|number| spread.point(number).collect::<Vec<f64>>());
    let silences: Vec<Vec<f64>> = points.filter(silent).collect();
    if let Some(example) = silences.first() {
        let share = (silences.len(), POINTS.1);
        findings.push(no_rule_fires(system.interface(), 0, example, share));
    }
    findings
}

fn middle((low, high): Interval) -> f64 {
    0.5 * low + 0.5 * high
}

fn gap_of_input(input: &str, gap: Interval, output: &str) -> Finding {
    let message = format!(
        "no term of the input \"{input}\" has a degree above 0 {}, where there may be no rule \
         about \"{output}\" that fires; widen its terms or add one",
        place(gap)
    );
    Finding::new(Kind::Gap, message)
}

fn no_rule_fires(
    interface: &Interface,
    output: usize,
    example: &[f64],
    (silent, all): (usize, usize),
) -> Finding {
    let (output, choice) = &interface.outputs()[output];
    let inputs = interface.inputs().iter().zip(example);
    let example: Vec<String> =
        inputs.map(|(input, &x)| format!("{} = {}", Name(input.name()), short(x))).collect();
    let then = match choice {
        NoRuleFires::Error => "evaluation raises an error".to_owned(),
        NoRuleFires::Value(value) => format!("it is {}", short(*value)),
        NoRuleFires::Nan => "it is NaN".to_owned(),
        NoRuleFires::Previous => "it stays as it was before".to_owned(),
    };
    let message = format!(
        "no rule about \"{output}\" fires at {} % of {all} points spread over the universes, such \
         as {}: there {then}; widen terms, add rules, or choose what it is then",
        short((100.0 * silent as f64 / all as f64 * 10.0).round() / 10.0),
        example.join(", ")
    );
    Finding::new(Kind::NoRuleFires, message)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MembershipFunction, Shape};

    fn variable(terms: &[[f64; 3]]) -> Variable {
        let empty = Variable::new("x", 0.0, 10.0).unwrap();
        terms.iter().enumerate().fold(empty, |variable, (index, [a, b, c])| {
            let function = MembershipFunction::triangular(*a, *b, *c).unwrap();
            variable.with_term(&index.to_string(), function).unwrap()
        })
    }

    #[test]
    fn gaps_lie_between_supports_and_where_they_only_touch() {
        let of = |terms: &[[f64; 3]]| gaps(&variable(terms));
        assert_eq!(of(&[]), [(0.0, 10.0)]);
        assert_eq!(of(&[[0.0, 0.0, 6.0], [5.0, 10.0, 10.0]]), []);
        assert_eq!(of(&[[7.0, 10.0, 10.0], [0.0, 0.0, 3.0]]), [(3.0, 7.0)]);
        assert_eq!(of(&[[1.0, 2.0, 3.0]]), [(0.0, 1.0), (3.0, 10.0)]);
        let touching = of(&[[0.0, 2.0, 4.0], [4.0, 6.0, 10.0], [0.0, 1.0, 4.0]]);
        assert_eq!(touching, [(0.0, 0.0), (4.0, 4.0), (10.0, 10.0)]);
        assert_eq!(of(&[[-5.0, -2.0, -1.0], [0.0, 0.0, 10.0]]), [(10.0, 10.0)]);
        for shape in [Shape::Triangular, Shape::Trapezoidal, Shape::Gaussian, Shape::Cosine] {
            let even = Variable::evenly("x", (-0.1, 0.7), shape, &["a", "b", "c", "d"]).unwrap();
            assert_eq!(gaps(&even), [], "{shape:?}");
        }
    }

    #[test]
    fn points_are_spread_evenly() {
        let inputs: Vec<Variable> =
            (0..5).map(|k| Variable::new(&k.to_string(), -1.0, 3.0).unwrap()).collect();
        let points = Spread::new(&inputs).points(1000);
        assert!(points.iter().all(|x| (-1.0..=3.0).contains(x)));
        for input in 0..5 {
            for quarter in 0..4 {
                let low = f64::from(quarter) - 1.0;
                let inside = |x: &&f64| (low..low + 1.0).contains(*x);
                let count = points.iter().skip(input).step_by(5).filter(inside).count();
                assert!((245..=255).contains(&count), "{input} {quarter} {count}");
            }
        }
    }
}
