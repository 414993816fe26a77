//! Rule systems, two inputs of five trapezoids, 25 rules: Mamdani with a sampled and with the
//! exact centroid, Takagi-Sugeno-Kang; one call, and a batch beside a loop over all samples with
//! every term as one writes it by hand.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::norm::{Aggregation, SNorm, TNorm};
use fuzzy_core::output::{Defuzzifier, Sampling, Value};
use fuzzy_core::{Inference, Logic, Output, Rng, Shape, System, Variable};
use std::hint::black_box;

const POINTS: usize = 100_000;
const TERMS: [&str; 5] = ["NB", "NS", "Z", "PS", "PB"];
const SAMPLES: usize = 101;

fn variable(name: &str) -> Variable {
    Variable::evenly(name, (-1.0, 1.0), Shape::Trapezoidal, &TERMS).expect("valid")
}

/// The usual table: the concluded term is the sum of the inputs' terms, held within the five.
fn concluded(rule: usize) -> usize {
    (rule / 5 + rule % 5).saturating_sub(2).min(4)
}

fn system(output: Output, conjunction: TNorm) -> System {
    let rules: Vec<String> = (0..25)
        .map(|rule| {
            let (x, y, u) = (TERMS[rule / 5], TERMS[rule % 5], TERMS[concluded(rule)]);
            format!("if x is {x} and y is {y} then u is {u}")
        })
        .collect();
    let logic = Logic { conjunction, ..Logic::default() };
    let inputs = vec![variable("x"), variable("y")];
    System::from_text("bench", inputs, vec![output], &rules.join("\n"), logic).expect("valid")
}

fn mamdani(sampling: Sampling) -> System {
    let output = Output::mamdani_with(
        variable("u"),
        TNorm::Min,
        Aggregation::Norm(SNorm::Max),
        Defuzzifier::Centroid,
        sampling,
    );
    system(output.expect("valid"), TNorm::Min)
}

fn sugeno() -> System {
    let terms = TERMS
        .iter()
        .zip(0..)
        .map(|(term, i)| ((*term).to_owned(), Value::Constant(f64::from(i) / 2.0 - 1.0)));
    system(Output::sugeno("u", terms.collect()).expect("valid"), TNorm::Product)
}

/// The yardstick for the sampled centroid.
struct ByHand {
    terms: [[f64; 4]; 5],
    samples: Vec<(f64, [f64; 5])>,
}

impl ByHand {
    fn new() -> Self {
        let variable = variable("u");
        let mut terms = [[0.0; 4]; 5];
        for (term, vertices) in variable.terms().iter().zip(&mut terms) {
            vertices.copy_from_slice(term.function.parameters());
        }
        let samples = (0..SAMPLES)
            .map(|k| -1.0 + 2.0 * k as f64 / (SAMPLES - 1) as f64)
            .map(|y| (y, terms.map(|vertices| Self::degree(vertices, y))))
            .collect();
        Self { terms, samples }
    }

    fn degree([a, b, c, d]: [f64; 4], x: f64) -> f64 {
        ((x - a) / (b - a)).min(1.0).min((d - x) / (d - c)).max(0.0)
    }

    fn evaluate(&self, x: f64, y: f64) -> f64 {
        let degrees = |x: f64| self.terms.map(|vertices| Self::degree(vertices, x));
        let (first, second) = (degrees(x), degrees(y));
        let mut strengths = [0.0_f64; 5];
        for rule in 0..25 {
            let strength = first[rule / 5].min(second[rule % 5]);
            strengths[concluded(rule)] = strengths[concluded(rule)].max(strength);
        }
        let (mut moment, mut area) = (0.0, 0.0);
        for (y, degrees) in &self.samples {
            let clipped = degrees.iter().zip(strengths).map(|(degree, w)| degree.min(w));
            let degree = clipped.fold(0.0, f64::max);
            moment += y * degree;
            area += degree;
        }
        moment / area
    }
}

fn systems() -> [(&'static str, System); 3] {
    [
        ("mamdani, 101 samples", mamdani(Sampling::Endpoints(SAMPLES))),
        ("mamdani, exact", mamdani(Sampling::Exact)),
        ("sugeno", sugeno()),
    ]
}

fn batch(criterion: &mut Criterion) {
    let mut rng = Rng::new(0, 0);
    let points: Vec<f64> = (0..2 * POINTS).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
    let mut outputs = vec![0.0; POINTS];
    let mut group = criterion.benchmark_group("rule system, batch of 1e5, 25 rules");
    group.throughput(Throughput::Elements(POINTS as u64));
    for (name, system) in systems() {
        group.bench_function(name, |bencher| {
            bencher.iter(|| system.evaluate_batch(black_box(&points), &mut outputs, 1))
        });
    }
    let by_hand = ByHand::new();
    let (ours, theirs) = (systems()[0].1.evaluate(&[0.3, -0.4]), by_hand.evaluate(0.3, -0.4));
    assert!(ours.is_ok_and(|ours| (ours - theirs).abs() < 1e-12));
    group.bench_function("yardstick, 101 samples by hand", |bencher| {
        bencher.iter(|| {
            for (output, point) in outputs.iter_mut().zip(points.chunks_exact(2)) {
                *output = by_hand.evaluate(point[0], point[1]);
            }
            black_box(&outputs);
        })
    });
    group.finish();
}

fn single(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("rule system, one point, 25 rules");
    for (name, system) in systems() {
        group.bench_function(name, |bencher| {
            bencher.iter(|| system.evaluate(black_box(&[0.3, -0.4])))
        });
    }
    let by_hand = ByHand::new();
    group.bench_function("yardstick, 101 samples by hand", |bencher| {
        bencher.iter(|| by_hand.evaluate(black_box(0.3), black_box(-0.4)))
    });
    group.finish();
}

criterion_group! { name = benches; config = fuzzyrs_benches::criterion(); targets = batch, single }
criterion_main!(benches);
