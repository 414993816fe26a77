//! One generation of 200 individuals of 35 genes: with the error of 25 TSK rules at 200 points as
//! fitness, beside the same formula written rule by rule; and the operators alone.

use criterion::{Criterion, criterion_group, criterion_main};
use fuzzy_core::learn::data::DataSet;
use fuzzy_core::learn::genetic::{
    Crossover, Elite, Genetic, GeneticSettings, Mutation, SquaredError, Stop,
};
use fuzzy_core::{Control, Error, Inference, Rng, Shape, Tsk, Variable};
use std::hint::black_box;

const MEANS: usize = 10;
const GENES: usize = MEANS + 25;

fn settings() -> GeneticSettings {
    GeneticSettings { population: 200, ..GeneticSettings::default() }
}

fn search(settings: GeneticSettings) -> Genetic {
    Genetic::new([(-1.0, 1.0); GENES], settings, 1).expect("valid")
}

/// The means of the terms and the constants; widths stay.
fn decode(genes: &[f64], parameters: &mut [f64]) -> bool {
    for (place, &mean) in parameters.iter_mut().step_by(2).zip(&genes[..MEANS]) {
        *place = mean;
    }
    parameters[2 * MEANS..].copy_from_slice(&genes[MEANS..]);
    true
}

/// The yardstick: what one writes by hand, rule by rule.
fn rule_by_rule(parameters: &[f64], points: &[f64], targets: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (point, target) in points.chunks_exact(2).zip(targets) {
        let degree = |index: usize, value: f64| {
            let z = (value - parameters[2 * index]) / parameters[2 * index + 1];
            (-0.5 * z * z).exp()
        };
        let (mut weighted, mut strength) = (0.0, 0.0);
        for rule in 0..25 {
            let weight = degree(rule / 5, point[0]) * degree(5 + rule % 5, point[1]);
            weighted += weight * parameters[2 * MEANS + rule];
            strength += weight;
        }
        sum += (weighted / strength - target).powi(2);
    }
    sum / targets.len() as f64
}

fn generations(criterion: &mut Criterion) {
    let terms = ["a", "b", "c", "d", "e"];
    let inputs = ["x", "y"]
        .map(|name| Variable::evenly(name, (-1.0, 1.0), Shape::Gaussian, &terms).expect("valid"));
    let system = Tsk::zero_order("bench", inputs.to_vec(), vec![0.0; 25]).expect("valid");
    let mut rng = Rng::new(0, 0);
    let points: Vec<f64> = (0..400).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
    let targets: Vec<f64> = points.chunks(2).map(|x| x[0] * x[1]).collect();
    let data = DataSet::new(2, &points, &targets).expect("valid");
    let error = SquaredError::new(&system, &data, decode).expect("valid");
    let control = Control::new();

    let mut group = criterion.benchmark_group("genetic, a generation of 200 x 35");
    let mut own = search(settings());
    group.bench_function("TSK of 25 rules, 200 points", |bencher| {
        bencher.iter(|| {
            own.run(Stop::after(1), Elite::Remembered, &control, |population, fitness| {
                error.evaluate(population, fitness)
            })
        })
    });
    let mut by_hand = search(settings());
    group.bench_function("yardstick, rule by rule", |bencher| {
        bencher.iter(|| {
            by_hand.run(Stop::after(1), Elite::Remembered, &control, |population, fitness| {
                let mut parameters = system.parameters().to_vec();
                for (genes, fitness) in population.chunks_exact(GENES).zip(fitness) {
                    decode(genes, &mut parameters);
                    *fitness = rule_by_rule(&parameters, &points, &targets);
                }
                Ok::<(), Error>(())
            })
        })
    });
    let binary = Crossover::SimulatedBinary { eta: 15.0 };
    let polynomial = Mutation::Polynomial { rate: 0.1, eta: 20.0 };
    for (name, settings) in [
        ("operators alone, BLX and Gaussian", settings()),
        (
            "operators alone, SBX and polynomial",
            GeneticSettings { crossover: binary, mutation: polynomial, ..settings() },
        ),
        (
            "operators alone, averages",
            GeneticSettings {
                population: 200,
                elite: 100,
                immigrants: 20,
                ..GeneticSettings::averaging()
            },
        ),
    ] {
        let mut search = search(settings);
        let mut fitness = vec![0.0; 200];
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                for (fitness, x) in fitness.iter_mut().zip(search.ask()) {
                    *fitness = x.iter().map(|v| v * v).sum();
                }
                search.tell(black_box(&fitness))
            })
        });
    }
    group.finish();
}

criterion_group! { name = benches; config = fuzzyrs_benches::criterion(); targets = generations }
criterion_main!(benches);
