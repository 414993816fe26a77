//! Whole trainings with the thesis's settings on one core, beside a million steps of the game by
//! hand, which tell how fast the machine is at the moment.

use criterion::{Criterion, criterion_group, criterion_main};
use fuzzy_core::Control;
use fuzzyrs_benches::{by_hand, positions};
use pursuit_sim::training::{
    DaiTraining, IanfisTraining, IgbflcTraining, QLambdaTraining, QlbgflcTraining, QlfisTraining,
    RewardGaTraining, Technique, WallIgbflcTraining,
};
use pursuit_sim::{
    Controller, EvasiveTurn, OneOnOne, Pd, Regulator, SpeedLaw, Vehicle, Wall, WallFollowing,
};
use std::f64::consts::PI;
use std::hint::black_box;

// Trainings differ from seed to seed; a fixed one keeps the runs comparable.
const SEED: u64 = 0;

fn trainings(criterion: &mut Criterion) {
    let game = OneOnOne::thesis().expect("valid");
    let evader = Controller::Classical;
    let q_lambda = QLambdaTraining::default();
    let reward_ga = RewardGaTraining::default();
    let qlbgflc = QlbgflcTraining::default();

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
    let (qlfis, dai) = (QlfisTraining::default(), DaiTraining::default());
    group.bench_function("QLFIS, 1000 episodes", |bencher| {
        bencher.iter(|| qlfis.train(&game, &evader, black_box(SEED), &Control::new()))
    });
    group.bench_function("Dai et al., 1000 episodes", |bencher| {
        bencher.iter(|| dai.train(&game, &evader, black_box(SEED), &Control::new()))
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

/// The same where both robots learn.
fn both_learn(criterion: &mut Criterion) {
    let game = OneOnOne::thesis().expect("valid");
    let exploring = |actions| QLambdaTraining { exploration: 1.0, actions, ..Default::default() };
    let tables = (exploring(11), exploring(21));
    let (qlfis, dai) = (QlfisTraining::default(), DaiTraining::default());
    let (qlbgflc, reward_ga) = (QlbgflcTraining::default(), RewardGaTraining::default());

    let mut group = criterion.benchmark_group("whole trainings of both robots");
    group.bench_function("QLBGFLC", |bencher| {
        bencher.iter(|| qlbgflc.train_both(&qlbgflc, &game, black_box(SEED), &Control::new()))
    });
    group.bench_function("Q(lambda), 1000 episodes", |bencher| {
        bencher.iter(|| tables.0.train_both(&tables.1, &game, black_box(SEED), &Control::new()))
    });
    group.bench_function("reward GA", |bencher| {
        bencher.iter(|| reward_ga.train_both(&reward_ga, &game, black_box(SEED), &Control::new()))
    });
    group.bench_function("QLFIS, 1000 episodes", |bencher| {
        bencher.iter(|| qlfis.train_both(&qlfis, &game, black_box(SEED), &Control::new()))
    });
    group.bench_function("Dai et al., 1000 episodes", |bencher| {
        bencher.iter(|| dai.train_both(&dai, &game, black_box(SEED), &Control::new()))
    });
    group.finish();
}

/// Those of chapters 3 and 4, which learn from a PD controller.
fn imitations(criterion: &mut Criterion) {
    let robot = |speed, limit| {
        Vehicle::new(speed, 1.0, limit).expect("valid").with_speed_law(SpeedLaw::Cosine)
    };
    let game = OneOnOne::new(robot(1.0, PI / 6.0), robot(0.5, PI / 3.0), 0.1, 0.1).expect("valid");
    let evader = Controller::EvasiveTurn(EvasiveTurn::new(1.6, false).expect("valid"));
    let (ianfis, igbflc) = (IanfisTraining::default(), IgbflcTraining::default());
    let wall = WallFollowing::thesis(Wall::sine().expect("valid")).expect("valid");
    let expert = Regulator::Pd(Pd::new(1.2, 1.5).expect("valid"));
    let along_walls = WallIgbflcTraining::default();

    let mut group = criterion.benchmark_group("learning from an expert");
    group.bench_function("IANFIS, pursuit", |bencher| {
        bencher.iter(|| ianfis.train(&game, &evader, black_box(SEED), &Control::new()))
    });
    group.bench_function("IGBFLC, pursuit", |bencher| {
        bencher.iter(|| igbflc.train(&game, &evader, black_box(SEED), &Control::new()))
    });
    group.bench_function("IGBFLC, wall, 600 s, three stages", |bencher| {
        bencher.iter(|| along_walls.train(&wall, &expert, black_box(SEED), &Control::new()))
    });
    group.finish();
}

criterion_group! { name = benches; config = fuzzyrs_benches::criterion(); targets = trainings, both_learn, imitations }
criterion_main!(benches);
