//! TSK inference, two inputs of three Gaussians: one call, and a batch of a million points beside
//! the same formula written rule by rule with the standard library's exponential.

use criterion::{BatchSize, Criterion};
use criterion::{BenchmarkId, Throughput, criterion_group, criterion_main};
use fuzzy_core::{Inference, Rng, Shape, Tsk, Variable};
use std::hint::black_box;

const POINTS: usize = 1_000_000;

fn system() -> Tsk {
    let inputs = ["x", "y"].map(|name| {
        Variable::evenly(name, (-1.0, 1.0), Shape::Gaussian, &["N", "Z", "P"]).expect("valid")
    });
    let consequents = (0..9).map(|i| f64::from(i) / 4.0 - 1.0).collect();
    Tsk::zero_order("bench", inputs.to_vec(), consequents).expect("valid")
}

/// The yardstick: what one writes by hand, rule by rule.
fn rule_by_rule(parameters: &[f64], x: f64, y: f64) -> f64 {
    let degree = |index: usize, value: f64| {
        let z = (value - parameters[2 * index]) / parameters[2 * index + 1];
        (-0.5 * z * z).exp()
    };
    let (mut weighted, mut strength) = (0.0, 0.0);
    for rule in 0..9 {
        let weight = degree(rule / 3, x) * degree(3 + rule % 3, y);
        weighted += weight * parameters[12 + rule];
        strength += weight;
    }
    weighted / strength
}

fn batch(criterion: &mut Criterion) {
    let system = system();
    let mut rng = Rng::new(0, 0);
    let points: Vec<f64> = (0..2 * POINTS).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
    let mut outputs = vec![0.0; POINTS];
    let mut group = criterion.benchmark_group("tsk batch of 1e6, 9 rules");
    group.throughput(Throughput::Elements(POINTS as u64));
    group.bench_function(BenchmarkId::new("fuzzyrs", "1 thread"), |bencher| {
        bencher.iter(|| system.evaluate_batch(black_box(&points), &mut outputs, 1))
    });
    group.bench_function(BenchmarkId::new("yardstick", "rule by rule"), |bencher| {
        bencher.iter(|| {
            for (output, point) in outputs.iter_mut().zip(points.chunks_exact(2)) {
                *output = rule_by_rule(system.parameters(), point[0], point[1]);
            }
            black_box(&outputs);
        })
    });
    group.finish();
}

fn single(criterion: &mut Criterion) {
    let system = system();
    let mut group = criterion.benchmark_group("tsk one point, 9 rules");
    group.bench_function("fuzzyrs", |bencher| {
        bencher.iter(|| system.evaluate(black_box(&[0.3, -0.4])))
    });
    group.bench_function("yardstick, rule by rule", |bencher| {
        bencher
            .iter(|| rule_by_rule(black_box(system.parameters()), black_box(0.3), black_box(-0.4)))
    });
    group.bench_function("gradient", |bencher| {
        bencher.iter_batched_ref(
            || vec![0.0; system.parameters().len()],
            |derivatives| system.gradient(black_box(&[0.3, -0.4]), derivatives),
            BatchSize::SmallInput,
        )
    });
    group.finish();
}

criterion_group! { name = benches; config = fuzzyrs_benches::criterion(); targets = batch, single }
criterion_main!(benches);
