//! Following a wall: a step of the simulation under the PD controller and under the thesis's
//! Mamdani controller (25 rules, two inputs of five trapezoids, 61 samples), and the controller
//! alone, beside a loop over all rules and samples as one writes it by hand.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::{Inference, Rng};
use pursuit_sim::strategy::FuzzySystem;
use pursuit_sim::{FuzzyRegulator, Pd, Pose, Regulator, Wall, WallFollowing};
use std::hint::black_box;

const STEPS: u32 = 6000;

/// The yardstick: the same controller without anything prepared but the terms at the samples.
struct ByHand {
    gains: [f64; 3],
    inputs: [[[f64; 4]; 5]; 2],
    samples: Vec<(f64, [f64; 5])>,
}

impl ByHand {
    fn of(regulator: &FuzzyRegulator) -> Self {
        let FuzzySystem::Rules(system) = regulator.system() else { unreachable!("25 rules") };
        let terms = |first: usize| -> [[f64; 4]; 5] {
            std::array::from_fn(|term| {
                std::array::from_fn(|k| system.parameters()[first + 4 * term + k])
            })
        };
        let gains = regulator.gains();
        let samples = (0..61)
            .map(|k| -1.2 + 2.4 * f64::from(k) / 60.0)
            .map(|y| (y, terms(40).map(|vertices| Self::degree(vertices, y))))
            .collect();
        let inputs = [terms(0), terms(20)];
        Self { gains: [gains.error, gains.rate, gains.output], inputs, samples }
    }

    fn degree([a, b, c, d]: [f64; 4], x: f64) -> f64 {
        ((x - a) / (b - a)).min((d - x) / (d - c)).clamp(0.0, 1.0)
    }

    fn output(&self, error: f64, rate: f64) -> f64 {
        let scaled = [self.gains[0] * error, self.gains[1] * rate].map(|x| x.clamp(-1.0, 1.0));
        let [first, second] = [0, 1]
            .map(|input| self.inputs[input].map(|vertices| Self::degree(vertices, scaled[input])));
        let mut strengths = [0.0_f64; 5];
        for rule in 0..25_usize {
            let concluded = (rule / 5 + rule % 5).saturating_sub(2).min(4);
            strengths[concluded] = strengths[concluded].max(first[rule / 5] * second[rule % 5]);
        }
        let (mut moment, mut area) = (0.0, 0.0);
        for (y, degrees) in &self.samples {
            let scaled = degrees.iter().zip(strengths).map(|(degree, w)| degree * w);
            let degree = scaled.fold(0.0, f64::max);
            moment += y * degree;
            area += degree;
        }
        if area > 0.0 { self.gains[2] * moment / area } else { 0.0 }
    }
}

fn thesis() -> FuzzyRegulator {
    FuzzyRegulator::thesis().expect("valid")
}

fn simulation(criterion: &mut Criterion) {
    let plant = WallFollowing::thesis(Wall::sine().expect("valid")).expect("valid");
    let start = Pose { x: 0.0, y: 1.45, heading: 0.0 };
    let expert = Regulator::Pd(Pd::new(1.2, 1.5).expect("valid"));
    let fuzzy = Regulator::Fuzzy(Box::new(thesis()));
    let mut group = criterion.benchmark_group("wall following, 6000 steps along a sine");
    group.throughput(Throughput::Elements(u64::from(STEPS)));
    for (name, regulator) in [("PD", &expert), ("Mamdani, 25 rules", &fuzzy)] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| plant.follow(black_box(regulator), start, STEPS))
        });
    }
    group.finish();
}

fn controller(criterion: &mut Criterion) {
    let mut rng = Rng::new(0, 0);
    let seen: Vec<(f64, f64)> =
        (0..STEPS).map(|_| (rng.uniform_in(-0.3, 0.3), rng.uniform_in(-0.3, 0.3))).collect();
    let fuzzy = thesis();
    let by_hand = ByHand::of(&fuzzy);
    let mut scratch = vec![0.0; fuzzy.scratch_count()];
    let difference = |&(e, rate): &(f64, f64), scratch: &mut [f64]| {
        (fuzzy.output(e, rate, scratch) - by_hand.output(e, rate)).abs()
    };
    assert!(seen.iter().all(|seen| difference(seen, &mut scratch) < 1e-12));
    let mut group = criterion.benchmark_group("Mamdani controller, 6000 outputs one by one");
    group.throughput(Throughput::Elements(u64::from(STEPS)));
    group.bench_function("fuzzyrs", |bencher| {
        bencher.iter(|| {
            let outputs = seen.iter().map(|&(e, rate)| fuzzy.output(e, rate, &mut scratch));
            outputs.sum::<f64>()
        })
    });
    group.bench_function("yardstick by hand", |bencher| {
        bencher.iter(|| {
            let seen = black_box(&seen).iter();
            seen.map(|&(e, rate)| by_hand.output(e, rate)).sum::<f64>()
        })
    });
    group.finish();
}

criterion_group! { name = benches; config = fuzzyrs_benches::criterion(); targets = simulation, controller }
criterion_main!(benches);
