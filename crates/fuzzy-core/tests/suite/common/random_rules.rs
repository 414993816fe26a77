//! Rule systems drawn at random: every norm, method and defuzzifier turns up.

use fuzzy_core::norm::{Aggregation, SNorm, TNorm};
use fuzzy_core::output::{Defuzzifier, Sampling, Value, Weighting};
use fuzzy_core::{
    Hedge, Logic, MembershipFunction, NoRuleFires, Output, Rng, Shape, System, Variable,
};

pub const TERMS: [&str; 3] = ["N", "Z", "P"];

fn pick<T: Copy>(rng: &mut Rng, choices: &[T]) -> T {
    choices[rng.below(choices.len())]
}

fn variable(rng: &mut Rng, name: &str, shapes: &[Shape]) -> Variable {
    Variable::evenly(name, (-1.0, 1.0), pick(rng, shapes), &TERMS).unwrap()
}

/// An antecedent with so many operators around its propositions.
fn antecedent(rng: &mut Rng, depth: usize) -> String {
    if depth == 0 {
        let hedge = pick(rng, &["", "", "not ", "very ", "somewhat ", "rather "]);
        let (input, term) = (pick(rng, &["x", "y"]), pick(rng, &TERMS));
        return format!("{input} is {hedge}{term}");
    }
    let (left, right) = (antecedent(rng, depth - 1), antecedent(rng, depth - 1));
    let (join, prefix) = (pick(rng, &["and", "or"]), pick(rng, &["", "not ", "very "]));
    format!("{prefix}(({left}) {join} ({right}))")
}

fn mamdani(rng: &mut Rng) -> Output {
    let sampling = pick(
        rng,
        &[Sampling::Endpoints(41), Sampling::Midpoints(40), Sampling::Exact, Sampling::Exact],
    );
    let exact = sampling == Sampling::Exact;
    let shapes: &[Shape] =
        if exact { &[Shape::Triangular] } else { &[Shape::Gaussian, Shape::Trapezoidal] };
    let aggregations: Vec<Aggregation> =
        SNorm::ALL.map(Aggregation::Norm).into_iter().chain([Aggregation::Sum]).collect();
    Output::mamdani_with(
        variable(rng, "u", shapes),
        if exact { pick(rng, &[TNorm::Min, TNorm::Product]) } else { pick(rng, &TNorm::ALL) },
        if exact { Aggregation::Norm(SNorm::Max) } else { pick(rng, &aggregations) },
        if exact { Defuzzifier::Centroid } else { pick(rng, &Defuzzifier::ALL) },
        sampling,
    )
    .unwrap()
}

fn sugeno(rng: &mut Rng) -> Output {
    let values = [
        Value::Constant(rng.uniform_in(-1.0, 1.0)),
        Value::Linear((0..3).map(|_| rng.uniform_in(-1.0, 1.0)).collect()),
        Value::parse("sin(x)*y + x^2", &["x", "y"]).unwrap(),
    ];
    let terms = TERMS.map(str::to_owned).into_iter().zip(values).collect();
    let aggregation = pick(rng, &[Aggregation::Sum, Aggregation::Norm(SNorm::Max)]);
    let weighting = pick(rng, &[Weighting::Average, Weighting::Sum]);
    Output::sugeno_with("v", terms, aggregation, weighting).unwrap()
}

fn tsukamoto() -> Output {
    let term = |shape, parameters: &[f64]| MembershipFunction::new(shape, parameters).unwrap();
    let variable = Variable::new("w", -1.0, 1.0)
        .and_then(|w| w.with_term("N", term(Shape::Ramp, &[0.0, -1.0])))
        .and_then(|w| w.with_term("Z", term(Shape::Sigmoid, &[0.0, 4.0])))
        .and_then(|w| w.with_term("P", term(Shape::SShape, &[0.0, 1.0])));
    Output::tsukamoto(variable.unwrap(), Weighting::Average).unwrap()
}

/// A system with an output of each method.
pub fn system(seed: u64) -> System {
    let rng = &mut Rng::new(seed, 0);
    let shapes = [Shape::Gaussian, Shape::Triangular, Shape::Bell];
    let inputs = vec![variable(rng, "x", &shapes), variable(rng, "y", &shapes)];
    let logic = Logic {
        conjunction: pick(rng, &TNorm::ALL),
        disjunction: pick(rng, &SNorm::ALL),
        hedges: vec![Hedge::custom("rather", "x^1.5").unwrap()],
    };
    let answer = |output: Output| output.when_no_rule_fires(NoRuleFires::Value(0.125)).unwrap();
    let outputs = [mamdani(rng), sugeno(rng), tsukamoto()].map(answer).to_vec();
    let mut rules = String::new();
    for rule in 0..6 {
        let depth = rule % 3;
        let antecedent = antecedent(rng, depth);
        let [u, v, w] = [(); 3].map(|()| pick(rng, &TERMS));
        let weight = rng.uniform_in(0.1, 1.0);
        rules += &format!("if {antecedent} then u is {u}, v is {v}, w is {w} with {weight}\n");
    }
    System::from_text("random", inputs, outputs, &rules, logic).unwrap()
}
