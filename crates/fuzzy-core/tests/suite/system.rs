//! Rule systems: the same numbers in every way of evaluation, and numbers that are known.

use crate::common::random_rules as rules;
use fuzzy_core::inference::Wrt;
use fuzzy_core::norm::{Aggregation, SNorm, TNorm};
use fuzzy_core::output::{Defuzzifier, Sampling, Value, Weighting};
use fuzzy_core::{
    Inference, Logic, MembershipFunction, NoRuleFires, Output, Outside, Rng, Shape, System,
    Variable,
};

const SEEDS: std::ops::Range<u64> = 0..60;

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Points in and around the universe.
fn points(count: usize) -> Vec<f64> {
    let mut rng = Rng::new(1, 1);
    (0..2 * count).map(|_| rng.uniform_in(-1.2, 1.2)).collect()
}

fn row_by_row(system: &System, points: &[f64]) -> Vec<f64> {
    let evaluate = |x: &[f64]| {
        let mut outputs = [f64::NAN; 3];
        system.evaluate_into(x, &mut outputs).unwrap();
        outputs
    };
    points.chunks(2).flat_map(evaluate).collect()
}

#[test]
fn batches_on_any_number_of_threads_agree_with_single_points_to_the_bit() {
    for seed in SEEDS {
        let system = rules::system(seed);
        // Some seeds fill more than two blocks, so that threads matter.
        let points = points(if seed < 2 { 9001 } else { 21 });
        let expected = bits(&row_by_row(&system, &points));
        for threads in [1, 2, 7] {
            let mut outputs = vec![0.0; points.len() / 2 * 3];
            system.evaluate_batch(&points, &mut outputs, threads).unwrap();
            assert_eq!(bits(&outputs), expected, "seed {seed}, {threads} threads");
        }
    }
}

/// The centroid of one point is summed in lanes, that of many sample by sample.
#[test]
fn the_centroid_is_the_same_to_the_bit_for_any_number_of_samples_and_terms() {
    const NAMES: [&str; 9] = ["a", "b", "c", "d", "e", "f", "g", "h", "i"];
    let points = points(16);
    for terms in [1, 2, 5, 8, 9] {
        let mut u = Variable::new("u", -1.0, 1.0).unwrap();
        for (index, name) in NAMES[..terms].iter().enumerate() {
            let left = -1.1 + 0.2 * index as f64;
            let wide = MembershipFunction::trapezoidal(left, left + 0.2, left + 0.5, left + 0.9);
            u = u.with_term(name, wide.unwrap()).unwrap();
        }
        for samples in [2, 7, 8, 9, 16, 17, 61, 101] {
            for implication in [TNorm::Min, TNorm::Product, TNorm::Lukasiewicz] {
                let inputs = ["x", "y"].map(|name| {
                    Variable::evenly(name, (-1.0, 1.0), Shape::Gaussian, &["N", "Z", "P"]).unwrap()
                });
                let rules: Vec<String> = (0..9)
                    .map(|rule| {
                        let term = |k: usize| ["N", "Z", "P"][k % 3];
                        let (x, y, u) = (term(rule / 3), term(rule), NAMES[rule % terms]);
                        format!("if x is {x} and y is {y} then u is {u}")
                    })
                    .collect();
                let output = Output::mamdani_with(
                    u.clone(),
                    implication,
                    Aggregation::Norm(SNorm::Max),
                    Defuzzifier::Centroid,
                    Sampling::Endpoints(samples),
                );
                let output = output.unwrap().when_no_rule_fires(NoRuleFires::Value(7.0)).unwrap();
                let text = rules.join("\n");
                let logic = Logic::default();
                let system =
                    System::from_text("s", inputs.to_vec(), vec![output], &text, logic).unwrap();
                let each: Vec<f64> =
                    points.chunks(2).map(|x| system.evaluate(x).unwrap()).collect();
                let mut all = vec![0.0; each.len()];
                system.evaluate_batch(&points, &mut all, 1).unwrap();
                assert_eq!(bits(&all), bits(&each), "{terms} terms, {samples} samples");
            }
        }
    }
}

#[test]
fn a_population_agrees_with_its_systems_to_the_bit() {
    for seed in SEEDS {
        let system = rules::system(seed);
        let points = points(13);
        let own = system.parameters();
        let moved: Vec<f64> = own.iter().map(|value| value * 0.96875).collect();
        let vectors = [own, moved.as_slice()];
        let mut expected = Vec::new();
        for vector in vectors {
            expected.extend(row_by_row(&system.with_parameters(vector).unwrap(), &points));
        }
        for threads in [1, 2] {
            let mut outputs = vec![f64::NAN; 2 * 13 * 3];
            let vectors = vectors.concat();
            system.evaluate_population(&vectors, &points, &mut outputs, threads).unwrap();
            assert_eq!(bits(&outputs), bits(&expected), "seed {seed}");
        }
    }
}

#[test]
fn documents_keep_every_bit() {
    for seed in SEEDS {
        let system = rules::system(seed).with_outside(Outside::Clamp);
        let text = system.to_json().unwrap();
        let back = System::from_json(&text).unwrap();
        assert_eq!(back, system);
        assert_eq!(bits(back.parameters()), bits(system.parameters()));
        assert_eq!(back.to_json().unwrap(), text);
        let points = points(9);
        assert_eq!(bits(&row_by_row(&back, &points)), bits(&row_by_row(&system, &points)));
    }
}

/// x is "a" to the degree x and "b" to the degree 1 − x, for x from 0 to 1; so is y.
fn unit(name: &str) -> Variable {
    let ramp = |start, end| MembershipFunction::new(Shape::Ramp, &[start, end]).unwrap();
    let variable = Variable::new(name, 0.0, 1.0).unwrap();
    variable.with_term("a", ramp(0.0, 1.0)).unwrap().with_term("b", ramp(1.0, 0.0)).unwrap()
}

fn single(rules: &str, logic: Logic) -> System {
    let terms = [("one", 1.0), ("ten", 10.0)];
    let terms = terms.map(|(name, value)| (name.to_owned(), Value::Constant(value))).to_vec();
    let output = Output::sugeno_with("u", terms, Aggregation::Sum, Weighting::Sum).unwrap();
    let inputs = ["x", "y", "z"].map(unit).to_vec();
    System::from_text("single", inputs, vec![output], rules, logic).unwrap()
}

#[test]
fn parentheses_expanded_to_a_normal_form_gave_0_4375() {
    let logic = Logic {
        conjunction: TNorm::Product,
        disjunction: SNorm::ProbabilisticSum,
        ..Logic::default()
    };
    let system = single("if (x is a or y is a) and z is a then u is one", logic);
    assert_eq!(system.evaluate(&[0.5, 0.5, 0.5]).unwrap(), 0.375);
}

#[test]
fn weights_count_in_the_denominator_of_an_average_too() {
    let terms = vec![("ten".to_owned(), Value::Constant(10.0))];
    let output = Output::sugeno("u", terms).unwrap();
    let rules = "if x is a then u is ten with 0.5";
    let system =
        System::from_text("s", vec![unit("x")], vec![output], rules, Logic::default()).unwrap();
    assert_eq!(system.evaluate(&[0.5]).unwrap(), 10.0);
    let sum = single("if x is a then u is ten with 0.5", Logic::default());
    assert_eq!(sum.evaluate(&[0.5, 0.0, 0.0]).unwrap(), 2.5);
}

#[test]
fn a_formula_of_a_rule_is_a_term_with_parameters() {
    let system = single("if x is a then u = 2*y + 0.5\nif x is b then u = y^2", Logic::default());
    let names: Vec<String> = system.parameter_info().into_iter().map(|info| info.name).collect();
    let expected = ["u.one.constant", "u.ten.constant", "u.rule1.x", "u.rule1.y", "u.rule1.z"];
    assert_eq!(names[12..17], expected);
    assert_eq!(names[17..], ["u.rule1.constant", "rule.1.weight", "rule.2.weight"]);
    let expected = 0.25 * (2.0 * 3.0 + 0.5) + 0.75 * 9.0;
    assert_eq!(system.evaluate(&[0.25, 3.0, 0.0]).unwrap(), expected);
}

/// One fuzzy input and output on [0, 1], with these choices.
fn fuzzy(defuzzifier: Defuzzifier, sampling: Sampling, rules: &str) -> System {
    let triangle = |a, b, c| MembershipFunction::triangular(a, b, c).unwrap();
    let u = Variable::new("u", 0.0, 4.0)
        .and_then(|u| u.with_term("low", triangle(0.0, 1.0, 2.0)))
        .and_then(|u| u.with_term("high", triangle(2.0, 3.0, 4.0)))
        .unwrap();
    let max = Aggregation::Norm(SNorm::Max);
    let output = Output::mamdani_with(u, TNorm::Min, max, defuzzifier, sampling).unwrap();
    System::from_text("fuzzy", vec![unit("x")], vec![output], rules, Logic::default()).unwrap()
}

const BOTH: &str = "if x is a then u is low\nif x is b then u is high";

#[test]
fn an_exact_centroid_is_the_geometric_one() {
    let system = fuzzy(Defuzzifier::Centroid, Sampling::Exact, BOTH);
    // Triangles of base 2 and height 1, clipped at h: area 2h − h².
    let area = |h: f64| 2.0 * h - h * h;
    for x in [0.0, 0.125, 0.3, 0.5, 0.9, 1.0] {
        let (low, high) = (area(x), area(1.0 - x));
        let expected = (low + 3.0 * high) / (low + high);
        assert!((system.evaluate(&[x]).unwrap() - expected).abs() < 1e-14, "{x}");
    }
}

#[test]
fn the_exact_centroid_of_a_tiny_universe_was_zero() {
    for size in [1e-300, 1.0, 1e160] {
        let triangle = MembershipFunction::triangular(0.0, 0.5 * size, size).unwrap();
        let u = Variable::new("u", 0.0, size).unwrap().with_term("t", triangle).unwrap();
        let max = Aggregation::Norm(SNorm::Max);
        let centroid = Defuzzifier::Centroid;
        let output = Output::mamdani_with(u, TNorm::Min, max, centroid, Sampling::Exact).unwrap();
        let (inputs, rules) = (vec![unit("x")], "if x is a then u is t");
        let system = System::from_text("s", inputs, vec![output], rules, Logic::default()).unwrap();
        let share = system.evaluate(&[0.25]).unwrap() / size;
        assert!((share - 0.5).abs() < 1e-14, "{size}: {share}");
    }
}

#[test]
fn samples_approach_the_exact_centroid() {
    for seed in 0..20 {
        let output = |sampling| {
            let terms = ["A", "B", "C", "D"];
            let u = Variable::evenly("u", (-1.0, 1.0), Shape::Trapezoidal, &terms).unwrap();
            let max = Aggregation::Norm(SNorm::Max);
            let norm = [TNorm::Min, TNorm::Product][seed % 2];
            Output::mamdani_with(u, norm, max, Defuzzifier::Centroid, sampling).unwrap()
        };
        let rules = "if x is a then u is A\nif y is a then u is B\nif x is b then u is C\n\
                     if y is b and x is a then u is D with 0.7";
        let inputs = vec![unit("x"), unit("y")];
        let [exact, sampled] = [Sampling::Exact, Sampling::Midpoints(20_000)].map(|sampling| {
            let (inputs, outputs) = (inputs.clone(), vec![output(sampling)]);
            System::from_text("s", inputs, outputs, rules, Logic::default()).unwrap()
        });
        let x = [0.05 * seed as f64, (0.37 * seed as f64).fract()];
        let difference = exact.evaluate(&x).unwrap() - sampled.evaluate(&x).unwrap();
        assert!(difference.abs() < 1e-7, "{x:?}: {difference}");
    }
}

#[test]
fn defuzzifiers_pick_what_they_are_named_after() {
    let at = |defuzzifier, x: f64| {
        fuzzy(defuzzifier, Sampling::Endpoints(41), BOTH).evaluate(&[x]).unwrap()
    };
    // High is clipped at 0.75, from 2.75 to 3.25.
    assert!((at(Defuzzifier::SmallestOfMaximum, 0.25) - 2.8).abs() < 1e-12);
    assert!((at(Defuzzifier::MeanOfMaximum, 0.25) - 3.0).abs() < 1e-12);
    assert!((at(Defuzzifier::LargestOfMaximum, 0.25) - 3.2).abs() < 1e-12);
    assert!((at(Defuzzifier::Bisector, 0.5) - 2.0).abs() < 0.11);
    assert!((at(Defuzzifier::Height, 0.2) - (0.2 + 3.0 * 0.8)).abs() < 1e-12);
    assert!((at(Defuzzifier::Centroid, 0.5) - 2.0).abs() < 1e-12);
}

#[test]
fn an_output_may_stay_as_it_was() {
    let gap = MembershipFunction::triangular(0.0, 1.0, 2.0).unwrap();
    let x = Variable::new("x", 0.0, 10.0).unwrap().with_term("low", gap).unwrap();
    let output = Output::sugeno("u", vec![]).unwrap();
    let output = output.when_no_rule_fires(NoRuleFires::Previous).unwrap();
    let rules = "if x is low then u = x";
    let system = System::from_text("s", vec![x], vec![output], rules, Logic::default()).unwrap();
    let mut outputs = [7.0, 0.0, 0.0, 0.0];
    system.evaluate_batch(&[5.0, 1.5, 6.0, 0.5], &mut outputs, 2).unwrap();
    assert_eq!(outputs, [7.0, 1.5, 1.5, 0.5]);
    let message = system.evaluate(&[5.0]).unwrap_err().to_string();
    assert!(message.starts_with("no rule of \"s\" fires at [5.0]"), "{message}");
    let mut outputs = [f64::NAN; 2];
    let message = system.evaluate_batch(&[5.0, 1.0], &mut outputs, 1).unwrap_err().to_string();
    assert!(message.contains("fires at point 0 [5.0]"), "{message}");
}

#[test]
fn a_set_that_no_sample_sees_was_nan_whatever_the_choice() {
    let narrow = MembershipFunction::triangular(0.501, 0.502, 0.503).unwrap();
    let u = Variable::new("u", 0.0, 1.0).unwrap().with_term("spike", narrow).unwrap();
    for defuzzifier in Defuzzifier::ALL {
        let max = Aggregation::Norm(SNorm::Max);
        let sampling = Sampling::Endpoints(101);
        let output = Output::mamdani_with(u.clone(), TNorm::Min, max, defuzzifier, sampling)
            .and_then(|output| output.when_no_rule_fires(NoRuleFires::Value(0.25)));
        let (inputs, rules) = (vec![unit("x")], "if x is a then u is spike");
        let system =
            System::from_text("s", inputs, vec![output.unwrap()], rules, Logic::default()).unwrap();
        let expected = if defuzzifier == Defuzzifier::Height { 0.502 } else { 0.25 };
        assert_eq!(system.evaluate(&[0.5]).unwrap(), expected);
    }
}

#[test]
fn the_slope_of_a_root_at_zero_made_every_derivative_nan() {
    let system =
        single("if x is somewhat a then u is one\nif x is b then u is ten", Logic::default());
    let mut slopes = vec![f64::NAN; system.parameters().len()];
    system.jacobian(Wrt::Parameters, &[-1.0, 0.0, 0.0], &mut slopes).unwrap();
    assert!(slopes.iter().all(|slope| slope.is_finite()), "{slopes:?}");
}

#[test]
fn the_invalid_vector_of_a_population_was_not_named() {
    let system = single("if x is a then u is one", Logic::default());
    let mut vectors = system.parameters().repeat(3);
    let last = vectors.len() - 1;
    vectors[last] = 2.0;
    let mut outputs = [0.0; 3];
    let error = system.evaluate_population(&vectors, &[0.5; 3], &mut outputs, 1).unwrap_err();
    assert!(error.to_string().starts_with("parameter vector 2: the weight"), "{error}");
}

#[test]
fn inputs_outside_are_kept_clamped_or_refused() {
    let system = single("if x is a then u = x", Logic::default());
    let at = |outside, x| system.clone().with_outside(outside).evaluate(&[x, 0.0, 0.0]);
    assert_eq!(at(Outside::Keep, 2.0).unwrap(), 2.0);
    assert_eq!(at(Outside::Clamp, 2.0).unwrap(), 1.0);
    let message = at(Outside::Error, 2.0).unwrap_err().to_string();
    assert_eq!(message, "input \"x\" must be from 0 to 1, got 2");
    let clamped = system.clone().with_outside(Outside::Clamp);
    let mut slope = [f64::NAN; 3];
    clamped.jacobian(Wrt::Inputs, &[2.0, 0.0, 0.0], &mut slope).unwrap();
    assert_eq!(slope, [0.0; 3]);
}

#[test]
fn derivatives_agree_with_differences_of_smooth_systems() {
    let shape = Shape::Gaussian;
    let inputs = ["x", "y"].map(|name| Variable::evenly(name, (-1.0, 1.0), shape, &rules::TERMS));
    let inputs = inputs.into_iter().collect::<fuzzy_core::Result<Vec<_>>>().unwrap();
    let u = Variable::evenly("u", (-1.0, 1.0), shape, &rules::TERMS).unwrap();
    let sum = Aggregation::Sum;
    let sampling = Sampling::Midpoints(50);
    let norm = TNorm::Product;
    let outputs = vec![
        Output::mamdani_with(u, norm, sum, Defuzzifier::Centroid, sampling).unwrap(),
        Output::sugeno("v", vec![]).unwrap(),
    ];
    let logic =
        Logic { conjunction: norm, disjunction: SNorm::ProbabilisticSum, ..Logic::default() };
    let text = "if x is N and y is very Z then u is P and v = 2*x - y with 0.5\n\
                if not (x is P or y is N) then u is Z and v = sin(x*y) with 0.75\n\
                if x is Z then u is N and v = 3 with 0.25";
    let system = System::from_text("smooth", inputs, outputs, text, logic).unwrap();
    let (x, step) = ([0.3, -0.2], 1e-6);
    let outputs = |system: &System, x: &[f64]| {
        let mut outputs = [0.0; 2];
        system.evaluate_into(x, &mut outputs).unwrap();
        outputs
    };
    for wrt in [Wrt::Inputs, Wrt::Parameters] {
        let count = wrt.count(&system);
        let mut derivatives = vec![f64::NAN; 2 * count];
        system.jacobian(wrt, &x, &mut derivatives).unwrap();
        for k in 0..count {
            let moved = |step: f64| {
                let (mut x, mut parameters) = (x, system.parameters().to_vec());
                match wrt {
                    Wrt::Inputs => x[k] += step,
                    Wrt::Parameters => parameters[k] += step,
                }
                outputs(&system.with_parameters(&parameters).unwrap(), &x)
            };
            let (before, after) = (moved(-step), moved(step));
            for output in 0..2 {
                let difference = (after[output] - before[output]) / (2.0 * step);
                let ours = derivatives[output * count + k];
                assert!((ours - difference).abs() < 1e-7, "{wrt:?} {k}: {ours} {difference}");
            }
        }
    }
}

#[test]
fn what_does_not_fit_is_refused_in_words() {
    let message = |result: fuzzy_core::Result<Output>| result.unwrap_err().to_string();
    let gaussian = Variable::evenly("u", (0.0, 1.0), Shape::Gaussian, &["a", "b"]).unwrap();
    let max = Aggregation::Norm(SNorm::Max);
    let centroid = Defuzzifier::Centroid;
    let mamdani =
        |sampling| Output::mamdani_with(gaussian.clone(), TNorm::Min, max, centroid, sampling);
    let exact = message(mamdani(Sampling::Exact));
    assert!(exact.contains("\"a\" of \"u\"") && exact.contains("piecewise-linear"), "{exact}");
    assert!(message(mamdani(Sampling::Midpoints(1))).contains("at least 2, got 1"));
    assert!(message(mamdani(Sampling::Midpoints(1 << 40))).contains("at most 100001"));
    let tsukamoto = message(Output::tsukamoto(gaussian.clone(), Weighting::Average));
    assert!(tsukamoto.contains("monotone"), "{tsukamoto}");

    let build = |outputs: Vec<Output>, rules: &str| {
        let inputs = vec![unit("x")];
        System::from_text("s", inputs, outputs, rules, Logic::default()).unwrap_err().to_string()
    };
    let mamdani = mamdani(Sampling::Midpoints(50)).unwrap();
    assert!(build(vec![mamdani.clone()], "").contains("rules"));
    let formula = build(vec![mamdani.clone()], "if x is a then u = x");
    assert!(formula.contains("only a Sugeno output takes a formula"), "{formula}");
    let twice = build(vec![mamdani.clone(), mamdani.clone()], "if x is a then u is a");
    assert!(twice.contains("appears twice"), "{twice}");
    let linear = Output::sugeno("v", vec![("l".to_owned(), Value::Linear(vec![1.0]))]).unwrap();
    let short = build(vec![linear], "if x is a then v is l");
    assert_eq!(short, "coefficients of \"l\" of \"v\": expected 2, got 1");
    let silent =
        build(vec![mamdani, Output::sugeno("v", vec![]).unwrap()], "if x is a then u is a");
    assert!(silent.contains("rules about \"v\""), "{silent}");
}
