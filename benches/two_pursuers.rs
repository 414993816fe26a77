//! Games of two pursuers, in lock-step and one by one, beside the same games by hand, in time per
//! step of one robot; and whole trainings of the three robots.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::Control;
use fuzzyrs_benches::{by_hand, positions};
use pursuit_sim::rollout::two_pursuers::{play, play_many};
use pursuit_sim::training::{TwoPursuersQLambdaTraining, TwoPursuersQlbgflcTraining};
use pursuit_sim::{Aim, Controller, TwoPursuers, TwoPursuersStart};
use std::hint::black_box;

const GAMES: usize = 1024;
const MAX_STEPS: u32 = 600;
// Trainings differ from seed to seed; a fixed one keeps the runs comparable.
const SEED: u64 = 0;

fn classical(criterion: &mut Criterion) {
    let positions = positions(2 * GAMES);
    let pairs: Vec<[(f64, f64); 2]> =
        positions.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let starts: Vec<TwoPursuersStart> =
        pairs.iter().map(|&pair| TwoPursuersStart::pursuers_at(pair)).collect();
    let robots = [&Controller::Classical; 3];
    for aim in [Aim::LineOfSight, Aim::Intercept] {
        let game = TwoPursuers::thesis().expect("valid").with_aim(aim);
        let lock_step = || {
            let outcomes =
                play_many(&game, robots, black_box(&starts), MAX_STEPS, 1, &Control::new());
            outcomes.expect("valid").iter().map(|outcome| outcome.steps).collect::<Vec<u32>>()
        };
        let one_by_one = || -> u32 {
            let paths =
                black_box(&starts).iter().map(|&start| play(&game, robots, start, MAX_STEPS));
            paths.map(|path| path.expect("valid").outcome.steps).sum()
        };
        let yardstick = || -> Vec<u32> {
            let predict = aim == Aim::Intercept;
            let pairs = black_box(&pairs).iter();
            pairs.map(|&pair| by_hand::play_two(pair, MAX_STEPS, predict)).collect()
        };
        let steps = lock_step();
        let alike = steps.iter().zip(yardstick()).filter(|&(&ours, theirs)| ours == theirs).count();
        // Where pursuers balance each other, the last digit decides whither the evader flees.
        assert!(alike > GAMES * 99 / 100, "both play the same games: {alike}");

        let name = format!("two classical pursuers, {}", aim.name());
        let mut group = criterion.benchmark_group(name);
        let steps: u64 = steps.into_iter().map(u64::from).sum();
        group.throughput(Throughput::Elements(3 * steps));
        group.bench_function(BenchmarkId::new("fuzzyrs", "1 thread"), |b| b.iter(lock_step));
        group.bench_function(BenchmarkId::new("fuzzyrs", "one by one"), |b| b.iter(one_by_one));
        group.bench_function(BenchmarkId::new("yardstick", "one by one"), |b| b.iter(yardstick));
        group.finish();
    }
}

fn trainings(criterion: &mut Criterion) {
    let game = TwoPursuers::thesis().expect("valid");
    let tables = TwoPursuersQLambdaTraining::default();
    let several = TwoPursuersQlbgflcTraining::default();
    let one = TwoPursuersQlbgflcTraining { starts_per_generation: 1, ..several.clone() };
    let mut group = criterion.benchmark_group("whole trainings of three robots");
    group.sample_size(10);
    group.bench_function("Q(lambda), 2000 episodes", |bencher| {
        bencher.iter(|| tables.train(&game, black_box(SEED), &Control::new()))
    });
    group.bench_function("QLBGFLC, one start a generation", |bencher| {
        bencher.iter(|| one.train(&game, black_box(SEED), &Control::new()))
    });
    group.bench_function("QLBGFLC, four starts a generation", |bencher| {
        bencher.iter(|| several.train(&game, black_box(SEED), &Control::new()))
    });
    group.finish();
}

criterion_group! { name = benches; config = fuzzyrs_benches::criterion(); targets = classical, trainings }
criterion_main!(benches);
