//! Minimax-Q(λ): one step on the thesis's table of joint actions beside the sweep over the whole
//! table that the equations print, a step of two independent learners, matrix games, and whole
//! trainings in time per step of the game.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::learn::rl::{
    Cut, MatrixGame, MinimaxQ, MinimaxQSettings, Play, QLambda, QLambdaSettings, Ties, Trace,
};
use fuzzy_core::{Control, Rng};
use pursuit_sim::training::{MinimaxQTraining, QLambdaTraining, Technique};
use pursuit_sim::{OneOnOne, Vehicle};
use std::hint::black_box;

const POINTS: usize = 11;
const STATES: usize = POINTS * POINTS;
const ACTIONS: usize = 11;
const OPPONENT: usize = 21;
const JOINT: usize = ACTIONS * OPPONENT;
const DISCOUNT: f64 = 0.5;
const TRACE_DECAY: f64 = 0.3;
const EXPLORATION: f64 = 0.1;
const LEARNING_RATE: f64 = 0.1;
const STEPS: usize = 1024;

/// States next to each other on the grid, with the reward of each step, as a game gives them.
fn walk() -> Vec<(usize, f64)> {
    let mut rng = Rng::new(5, 0);
    let (mut own, mut other) = (POINTS / 2, POINTS / 2);
    let move_one =
        |place: usize, rng: &mut Rng| (place + rng.below(3)).saturating_sub(1).min(POINTS - 1);
    (0..=STEPS)
        .map(|_| {
            (own, other) = (move_one(own, &mut rng), move_one(other, &mut rng));
            (own * POINTS + other, rng.uniform_in(-1.0, 1.0))
        })
        .collect()
}

/// The yardstick: (8.1) with the traces of 2.47 and 2.48 as they are printed.
struct FullSweep {
    values: Vec<f64>,
    traces: Vec<f64>,
}

impl FullSweep {
    fn payoffs(&self, state: usize) -> &[f64] {
        &self.values[state * JOINT..][..JOINT]
    }

    /// The action of the largest minimum, the answer to it, and that minimum.
    fn greedy(&self, state: usize) -> (usize, usize, f64) {
        let mut found = (0, 0, f64::NEG_INFINITY);
        for action in 0..ACTIONS {
            let row = &self.payoffs(state)[action * OPPONENT..][..OPPONENT];
            let mut answer = 0;
            for other in 1..OPPONENT {
                if row[other] < row[answer] {
                    answer = other;
                }
            }
            if row[answer] > found.2 {
                found = (action, answer, row[answer]);
            }
        }
        found
    }

    fn choose(&self, state: usize, rng: &mut Rng) -> (usize, usize) {
        let (action, answer, _) = self.greedy(state);
        let explore = |action, count, rng: &mut Rng| {
            if rng.uniform() < EXPLORATION { rng.below(count) } else { action }
        };
        let action = explore(action, ACTIONS, rng);
        (action, explore(answer, OPPONENT, rng))
    }

    fn learn(&mut self, state: usize, (action, other): (usize, usize), reward: f64, next: usize) {
        let joint = action * OPPONENT + other;
        let ahead = self.greedy(next).2;
        let error = reward + DISCOUNT * ahead - self.payoffs(state)[joint];
        self.traces.iter_mut().for_each(|trace| *trace *= DISCOUNT * TRACE_DECAY);
        let visited = &mut self.traces[state * JOINT..][..JOINT];
        visited.fill(0.0);
        visited[joint] = 1.0;
        for (value, trace) in self.values.iter_mut().zip(&self.traces) {
            *value += LEARNING_RATE * error * trace;
        }
    }
}

fn learner(play: Play) -> MinimaxQ {
    MinimaxQ::new(MinimaxQSettings {
        states: STATES,
        actions: ACTIONS,
        opponent_actions: OPPONENT,
        discount: DISCOUNT,
        trace_decay: TRACE_DECAY,
        trace: Trace::ReplacingState,
        play,
        ties: Ties::Random,
    })
    .expect("valid")
}

fn update(criterion: &mut Criterion) {
    let walk = walk();
    let mut group = criterion.benchmark_group("minimax-Q(lambda) step, 121 x 231 values");
    group.throughput(Throughput::Elements(STEPS as u64));
    for play in [Play::Answer, Play::Security, Play::Mixed] {
        let mut learner = learner(play);
        group.bench_function(format!("fuzzyrs, {}", play.name()), |bencher| {
            let mut rng = Rng::new(0, 0);
            bencher.iter(|| {
                for pair in black_box(&walk).windows(2) {
                    let ((state, reward), (next, _)) = (pair[0], pair[1]);
                    let chosen = learner.choose(state, EXPLORATION, &mut rng).expect("solvable");
                    learner
                        .learn(state, chosen, reward, Some(next), LEARNING_RATE)
                        .expect("finite rewards");
                }
            })
        });
    }
    let pairs = STATES * JOINT;
    let mut sweep = FullSweep { values: vec![0.0; pairs], traces: vec![0.0; pairs] };
    group.bench_function("yardstick, full sweep, answer", |bencher| {
        let mut rng = Rng::new(0, 0);
        bencher.iter(|| {
            for pair in black_box(&walk).windows(2) {
                let ((state, reward), (next, _)) = (pair[0], pair[1]);
                let chosen = sweep.choose(state, &mut rng);
                sweep.learn(state, chosen, reward, next);
            }
        })
    });
    let mut independent = [ACTIONS, OPPONENT].map(|actions| {
        QLambda::new(QLambdaSettings {
            states: STATES,
            actions,
            discount: DISCOUNT,
            trace_decay: TRACE_DECAY,
            trace: Trace::ReplacingState,
            cut: Cut::Never,
        })
        .expect("valid")
    });
    group.bench_function("independent Q(lambda) of both", |bencher| {
        let mut rng = Rng::new(0, 0);
        bencher.iter(|| {
            for pair in black_box(&walk).windows(2) {
                let ((state, reward), (next, _)) = (pair[0], pair[1]);
                for (learner, reward) in independent.iter_mut().zip([reward, -reward]) {
                    let action = learner.choose(state, EXPLORATION, &mut rng);
                    learner
                        .learn(state, action, reward, Some(next), LEARNING_RATE)
                        .expect("finite rewards");
                }
            }
        })
    });
    group.finish();
}

fn matrix_games(criterion: &mut Criterion) {
    let mut rng = Rng::new(3, 0);
    let games: Vec<Vec<f64>> =
        (0..64).map(|_| (0..JOINT).map(|_| rng.uniform_in(-1.0, 1.0)).collect()).collect();
    let mut solver = MatrixGame::new(ACTIONS, OPPONENT).expect("valid");
    let mut group = criterion.benchmark_group("matrix games");
    group.throughput(Throughput::Elements(games.len() as u64));
    group.bench_function("11 x 21", |bencher| {
        bencher.iter(|| {
            black_box(&games).iter().map(|game| solver.solve(game).expect("valid")).sum::<f64>()
        })
    });
    group.finish();
}

fn in_the_game(criterion: &mut Criterion) {
    let robot = |speed, steering| Vehicle::new(speed, 0.3, steering).expect("valid");
    let game = OneOnOne::new(robot(1.0, 0.5), robot(0.5, 1.0), 0.1, 0.1).expect("valid");
    let independent =
        |actions| QLambdaTraining { episodes: 200, actions, ..QLambdaTraining::default() };
    let pair = (independent(11), independent(21));
    let joint = MinimaxQTraining::default();
    let minimax = || joint.train_both(&joint, &game, 0, &Control::new()).expect("valid settings");
    let iql = || pair.0.train_both(&pair.1, &game, 0, &Control::new()).expect("valid settings");

    let mut group = criterion.benchmark_group("both robots learn, per step of the game");
    let steps = |time: f64| Throughput::Elements((time / game.time_step()).round() as u64);
    group.throughput(steps(minimax().learning_time));
    group.bench_function("minimax-Q(lambda)", |bencher| bencher.iter(minimax));
    group.throughput(steps(iql().learning_time));
    group.bench_function("independent Q(lambda)", |bencher| bencher.iter(iql));
    group.finish();
}

criterion_group! {
    name = benches;
    config = fuzzyrs_benches::criterion();
    targets = update, matrix_games, in_the_game
}
criterion_main!(benches);
