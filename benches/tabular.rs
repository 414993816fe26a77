//! Tabular learners: a choice by softmax beside the printed formula, and a step of model-building
//! Q-learning beside the sweep over whole tables that steps 4 to 9 of chapter 5 print. A step of
//! Q(λ) is in `q_lambda`.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::Rng;
use fuzzy_core::learn::rl::{Counts, Mdp, ModelBuilding, ModelBuildingSettings, softmax};
use std::hint::black_box;

const ACTIONS: usize = 11;
const CHOICES: usize = 1024;
const TEMPERATURE: f64 = 0.5;

fn choice(criterion: &mut Criterion) {
    let mut rng = Rng::new(5, 0);
    let values: Vec<f64> = (0..CHOICES * ACTIONS).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
    let mut group = criterion.benchmark_group("softmax, 11 actions");
    group.throughput(Throughput::Elements(CHOICES as u64));
    group.bench_function("fuzzyrs", |bencher| {
        let mut rng = Rng::new(0, 0);
        bencher.iter(|| -> usize {
            let rows = black_box(&values).chunks_exact(ACTIONS);
            rows.map(|row| softmax(row, TEMPERATURE, &mut rng)).sum()
        })
    });
    group.bench_function("yardstick, as printed", |bencher| {
        let mut rng = Rng::new(0, 0);
        bencher.iter(|| -> usize {
            let rows = black_box(&values).chunks_exact(ACTIONS);
            rows.map(|row| by_hand(row, rng.uniform())).sum()
        })
    });
    group.finish();
}

/// (2.56) with the standard library's exponential, which overflows for large values.
fn by_hand(values: &[f64], drawn: f64) -> usize {
    let mut weights = [0.0; ACTIONS];
    for (weight, value) in weights.iter_mut().zip(values) {
        *weight = (value / TEMPERATURE).exp();
    }
    let mut rest = drawn * weights.iter().sum::<f64>();
    for (action, weight) in weights.iter().enumerate() {
        rest -= weight;
        if rest < 0.0 {
            return action;
        }
    }
    ACTIONS - 1
}

const STEPS: usize = 2048;
const DISCOUNT: f64 = 0.9;
const RATE: f64 = 0.1;

/// The yardstick: steps 4 to 9 over whole tables.
struct FullSweep {
    states: usize,
    actions: usize,
    decay: f64,
    values: Vec<f64>,
    traces: Vec<f64>,
    means: Vec<f64>,
    visits: Vec<f64>,
    reached: Vec<f64>,
}

impl FullSweep {
    fn new(states: usize, actions: usize, decay: f64) -> Self {
        let pairs = states * actions;
        Self {
            states,
            actions,
            decay,
            values: vec![0.0; pairs],
            traces: vec![1.0; pairs],
            means: vec![0.0; pairs],
            visits: vec![1.0; pairs],
            reached: vec![0.0; pairs * states],
        }
    }

    fn learn(&mut self, state: usize, action: usize, reward: f64, next: usize) {
        let current = state * self.actions + action;
        self.means[current] += (reward - self.means[current]) / self.visits[current];
        self.reached[current * self.states + next] += 1.0;
        let rows = self.values.chunks_exact(self.actions);
        let best: Vec<f64> =
            rows.map(|row| row.iter().copied().fold(f64::NEG_INFINITY, f64::max)).collect();
        for pair in 0..self.values.len() {
            self.traces[pair] = if pair == current { 1.0 } else { self.decay * self.traces[pair] };
            let row = self.reached[pair * self.states..][..self.states].iter();
            let ahead: f64 = row.zip(&best).map(|(count, best)| count * best).sum();
            let target = self.means[pair] + DISCOUNT * ahead / self.visits[pair];
            self.values[pair] += RATE * self.traces[pair] * (target - self.values[pair]);
        }
        self.visits[current] += 1.0;
    }
}

/// One process with traces that fade slowly, so that all pairs are live, and one like the tables
/// of the other chapters.
fn model_building(criterion: &mut Criterion) {
    for (states, actions, trace_decay) in [(20, 3, 0.9), (121, 11, 0.3)] {
        let mdp = Mdp::garnet(states, actions, 5, 1).expect("valid");
        let mut rng = Rng::new(5, 0);
        let mut state = 0;
        let walk: Vec<(usize, usize, f64, usize)> = (0..STEPS)
            .map(|_| {
                let action = rng.below(actions);
                let (reward, next) = mdp.step(state, action, &mut rng);
                let step = (state, action, reward, next);
                state = next;
                step
            })
            .collect();
        let settings = ModelBuildingSettings {
            states,
            actions,
            discount: DISCOUNT,
            trace_decay,
            counts: Counts::Thesis,
        };
        let mut learner = ModelBuilding::new(settings).expect("valid");
        let mut sweep = FullSweep::new(states, actions, DISCOUNT * trace_decay);

        let name = format!("model-building step, {states} states, {actions} actions");
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(STEPS as u64));
        group.bench_function("fuzzyrs", |bencher| {
            bencher.iter(|| {
                for &(state, action, reward, next) in black_box(&walk) {
                    learner.learn(state, action, reward, Some(next), RATE).expect("finite rewards");
                }
            })
        });
        group.sample_size(10);
        group.bench_function("yardstick, full sweep", |bencher| {
            bencher.iter(|| {
                for &(state, action, reward, next) in black_box(&walk) {
                    sweep.learn(state, action, reward, next);
                }
            })
        });
        group.finish();
    }
}

criterion_group! {
    name = benches;
    config = fuzzyrs_benches::criterion();
    targets = choice, model_building
}
criterion_main!(benches);
