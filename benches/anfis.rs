//! ANFIS: one hybrid epoch (least squares of 75 consequents and a gradient step of 20 premise
//! parameters) on 1000 samples, and the training that IANFIS repeats: 30 epochs of least squares
//! and a sequential sweep over 2000 samples.

use criterion::{Criterion, criterion_group, criterion_main};
use fuzzy_core::learn::anfis::{
    AnfisSettings, LeastSquares, PremiseStep, SampleOrder, Solver, fit,
};
use fuzzy_core::learn::data::DataSet;
use fuzzy_core::{Control, Order, Rng, Shape, Tsk, Variable};

fn grid(shape: Shape, order: Order) -> Tsk {
    let terms = ["NB", "NS", "Z", "PS", "PB"];
    let input = |name| Variable::evenly(name, (-1.0, 1.0), shape, &terms).expect("valid");
    let size = if order == Order::Zero { 1 } else { 3 };
    let consequents = vec![0.0; 25 * size];
    Tsk::new("bench", vec![input("x"), input("y")], order, consequents).expect("valid")
}

fn samples(count: usize) -> DataSet {
    let mut rng = Rng::new(0, 0);
    let points: Vec<f64> = (0..2 * count).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
    let targets: Vec<f64> =
        points.chunks(2).map(|p| (3.0 * p[0]).sin() * (2.0 * p[1]).cos()).collect();
    DataSet::new(2, &points, &targets).expect("valid")
}

fn settings(epochs: u32, ridge: f64, premise: PremiseStep) -> AnfisSettings {
    let consequents = Some(LeastSquares { ridge, solver: Solver::Cholesky });
    AnfisSettings { epochs, consequents, premise, ..AnfisSettings::default() }
}

fn epochs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("anfis");
    let (system, data) = (grid(Shape::Gaussian, Order::One), samples(1000));
    let hybrid = settings(10, 1e-6, PremiseStep::Batch { rate: 0.01 });
    group.bench_function("10 hybrid epochs, 25 rules of order 1, 1000 samples", |bencher| {
        bencher.iter(|| fit(&system, &data, None, &hybrid, &Control::new()))
    });
    let (system, data) = (grid(Shape::GaussianWidth, Order::Zero), samples(2000));
    let sweep = PremiseStep::Sequential { rate: 0.01, order: SampleOrder::Shuffled };
    let sequential = settings(30, 1e-3, sweep);
    group.bench_function("30 sequential epochs, 25 rules of order 0, 2000 samples", |bencher| {
        bencher.iter(|| fit(&system, &data, None, &sequential, &Control::new()))
    });
    group.finish();
}

criterion_group!(benches, epochs);
criterion_main!(benches);
