//! Whole trainings with the thesis's settings on one core, beside a million steps of the game by
//! hand, which tell how fast the machine is at the moment.

use criterion::{Criterion, criterion_group, criterion_main};
use fuzzy_core::Control;
use fuzzyrs_benches::{by_hand, positions};
use pursuit_sim::training::{QLambdaTraining, QlbgflcTraining, RewardGaTraining};
use pursuit_sim::{Controller, OneOnOne};
use std::hint::black_box;

fn trainings(criterion: &mut Criterion) {
    let game = OneOnOne::thesis().expect("valid");
    let evader = Controller::Classical;
    let q_lambda = QLambdaTraining::default();
    let reward_ga = RewardGaTraining::default();
    let qlbgflc = QlbgflcTraining::default();
    // Trainings differ from seed to seed; a fixed one keeps the runs comparable.
    const SEED: u64 = 0;

    let mut group = criterion.benchmark_group("whole trainings");
    group.bench_function("QLBGFLC", |bencher| {
        bencher.iter(|| qlbgflc.train(&game, &evader, black_box(SEED), &Control::new()))
    });
    group.bench_function("Q(lambda), 1000 episodes", |bencher| {
        bencher.iter(|| q_lambda.train(&game, &evader, black_box(SEED), &Control::new()))
    });
    group.bench_function("reward GA", |bencher| {
        bencher.iter(|| reward_ga.train(&game, &evader, black_box(SEED), &Control::new()))
    });
    let positions = positions(256);
    group.bench_function("yardstick, a million steps by hand", |bencher| {
        bencher.iter(|| {
            let mut games = black_box(&positions).iter().cycle();
            let mut steps = 0;
            while steps < 1_000_000 {
                let Some(&position) = games.next() else { break };
                steps += by_hand::play(position, 300, |angle, _| angle);
            }
            steps
        })
    });
    group.finish();
}

criterion_group! { name = benches; config = fuzzyrs_benches::criterion(); targets = trainings }
criterion_main!(benches);
