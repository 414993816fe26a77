//! Q(λ)-learning: one step on the thesis's table beside the sweep over the whole table that the
//! equations print, and whole trainings in time per step of the game.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::learn::rl::{Cut, QLambda, QLambdaSettings, Trace, epsilon_greedy, greedy};
use fuzzy_core::{Control, Rng};
use fuzzyrs_benches::{by_hand, positions};
use pursuit_sim::training::{QLambdaTraining, Technique};
use pursuit_sim::{Controller, OneOnOne};
use std::hint::black_box;

const POINTS: usize = 11;
const STATES: usize = POINTS * POINTS;
const ACTIONS: usize = 11;
const DISCOUNT: f64 = 0.5;
const TRACE_DECAY: f64 = 0.3;
const EXPLORATION: f64 = 0.1;
const LEARNING_RATE: f64 = 0.1;
const STEPS: usize = 4096;

/// States next to each other on the grid, with the reward of each step, as a game gives them.
fn walk() -> Vec<(usize, f64)> {
    let mut rng = Rng::new(5, 0);
    let (mut angle, mut rate) = (POINTS / 2, POINTS / 2);
    let move_one =
        |place: usize, rng: &mut Rng| (place + rng.below(3)).saturating_sub(1).min(POINTS - 1);
    (0..=STEPS)
        .map(|_| {
            (angle, rate) = (move_one(angle, &mut rng), move_one(rate, &mut rng));
            (angle * POINTS + rate, rng.uniform_in(-1.0, 1.0))
        })
        .collect()
}

/// The yardstick: equations 2.43–2.48 as they are printed.
struct FullSweep {
    values: Vec<f64>,
    traces: Vec<f64>,
}

impl FullSweep {
    fn row(&self, state: usize) -> &[f64] {
        &self.values[state * ACTIONS..][..ACTIONS]
    }

    fn learn(&mut self, state: usize, action: usize, reward: f64, next: usize) {
        let next = self.row(next);
        let error = reward + DISCOUNT * next[greedy(next)] - self.row(state)[action];
        self.traces.iter_mut().for_each(|trace| *trace *= DISCOUNT * TRACE_DECAY);
        let visited = &mut self.traces[state * ACTIONS..][..ACTIONS];
        visited.fill(0.0);
        visited[action] = 1.0;
        for (value, trace) in self.values.iter_mut().zip(&self.traces) {
            *value += LEARNING_RATE * error * trace;
        }
    }
}

fn update(criterion: &mut Criterion) {
    let walk = walk();
    let mut learner = QLambda::new(QLambdaSettings {
        states: STATES,
        actions: ACTIONS,
        discount: DISCOUNT,
        trace_decay: TRACE_DECAY,
        trace: Trace::ReplacingState,
        cut: Cut::Never,
    })
    .expect("valid");
    let pairs = STATES * ACTIONS;
    let mut sweep = FullSweep { values: vec![0.0; pairs], traces: vec![0.0; pairs] };

    let mut group = criterion.benchmark_group("Q(lambda) step, 121 states, 11 actions");
    group.throughput(Throughput::Elements(STEPS as u64));
    group.bench_function("fuzzyrs", |bencher| {
        let mut rng = Rng::new(0, 0);
        bencher.iter(|| {
            for pair in black_box(&walk).windows(2) {
                let ((state, reward), (next, _)) = (pair[0], pair[1]);
                let action = learner.choose(state, EXPLORATION, &mut rng);
                learner
                    .learn(state, action, reward, Some(next), LEARNING_RATE)
                    .expect("finite rewards");
            }
        })
    });
    group.bench_function("yardstick, full sweep", |bencher| {
        let mut rng = Rng::new(0, 0);
        bencher.iter(|| {
            for pair in black_box(&walk).windows(2) {
                let ((state, reward), (next, _)) = (pair[0], pair[1]);
                let action = epsilon_greedy(sweep.row(state), EXPLORATION, &mut rng);
                sweep.learn(state, action, reward, next);
            }
        })
    });
    group.finish();
}

fn in_the_game(criterion: &mut Criterion) {
    let game = OneOnOne::thesis().expect("valid");
    let training = QLambdaTraining::default();
    let train = || {
        training.train(&game, &Controller::Classical, 0, &Control::new()).expect("valid settings")
    };
    let steps = (train().learning_time / game.time_step()).round() as u64;

    let mut group = criterion.benchmark_group("Q(lambda) in the game, per step");
    group.throughput(Throughput::Elements(steps));
    group.bench_function("fuzzyrs", |bencher| bencher.iter(train));

    let positions = positions(1000);
    let play = || -> u64 {
        let classical = |angle, _| angle;
        let games = black_box(&positions).iter();
        games.map(|&position| u64::from(by_hand::play(position, 300, classical))).sum()
    };
    group.throughput(Throughput::Elements(play()));
    group.bench_function("yardstick, the game by hand without learning", |bencher| {
        bencher.iter(play)
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = fuzzyrs_benches::criterion();
    targets = update, in_the_game
}
criterion_main!(benches);
