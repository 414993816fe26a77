//! Who goes for whom: assignments of 1000 to 1000, and an episode of as many pairs.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::learn::assignment::{Objective, assign};
use fuzzy_core::{Control, Rng};
use pursuit_sim::{Controller, Crew, ManyOnMany, ManyStart, Pose, Vehicle, play_coupled};

const SIZE: usize = 1000;

fn assignments(criterion: &mut Criterion) {
    let mut rng = Rng::new(1, 0);
    let costs: Vec<f64> = (0..SIZE * SIZE).map(|_| rng.uniform_in(0.0, 60.0)).collect();
    let mut group = criterion.benchmark_group("assignment of 1000");
    group.sample_size(10);
    for objective in [Objective::Sum, Objective::Bottleneck] {
        group.bench_function(objective.name(), |b| {
            b.iter(|| assign(black_box(&costs), SIZE, objective).expect("valid"));
        });
    }
    group.finish();
}

fn episode(criterion: &mut Criterion) {
    let mut rng = Rng::new(2, 0);
    let mut robots = |low, high| -> Vec<Vehicle> {
        let mut robot = || Vehicle::new(rng.uniform_in(low, high), 0.3, 0.5).expect("valid");
        (0..SIZE).map(|_| robot()).collect()
    };
    let (pursuers, evaders) = (robots(1.5, 2.5), robots(0.5, 1.0));
    let game = ManyOnMany::new(pursuers, evaders, 0.1, 0.1).expect("valid");
    let mut poses = || -> Vec<Pose> {
        let mut place = || rng.uniform_in(-20.0, 20.0);
        (0..SIZE).map(|_| Pose { x: place(), y: place(), heading: 0.0 }).collect()
    };
    let start = ManyStart { pursuers: poses(), evaders: poses() };
    let coupling: Vec<usize> = (0..SIZE).collect();
    let crews = [Crew::Same(&Controller::Classical); 2];
    let control = Control::new();
    let play = || play_coupled(&game, &coupling, &start, crews, 600, 1, &control).expect("valid");
    let steps: u64 = play().pairs.iter().map(|pair| u64::from(pair.steps)).sum();
    let mut group = criterion.benchmark_group("an episode of 1000 pairs");
    group.throughput(Throughput::Elements(steps));
    group.sample_size(20);
    group.bench_function("steps of a pair", |b| b.iter(play));
    group.finish();
}

criterion_group!(benches, assignments, episode);
criterion_main!(benches);
