//! A step of QLFIS (act, gradients, traces, both updates) and of the actor-critic with a network,
//! each beside the equations written down plainly.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::learn::rl::{Agent, NeuralActorCritic, Qlfis, TdSettings};
use fuzzy_core::{Rng, Shape, Tsk, Variable};
use std::hint::black_box;

const STEPS: usize = 4096;
const TABLE: [f64; 9] = [-0.5, -0.25, 0.0, -0.25, 0.0, 0.25, 0.0, 0.25, 0.5];

fn system(consequents: [f64; 9]) -> Tsk {
    let inputs = ["angle", "rate"].map(|name| {
        Variable::evenly(name, (-1.0, 1.0), Shape::GaussianWidth, &["N", "Z", "P"]).expect("valid")
    });
    Tsk::zero_order("system", inputs.to_vec(), consequents.to_vec()).expect("valid")
}

/// Observations next to each other with the reward of each step, as a game gives them.
fn walk() -> Vec<([f64; 2], f64)> {
    let mut rng = Rng::new(5, 0);
    let mut x = [0.0_f64; 2];
    (0..=STEPS)
        .map(|_| {
            x = x.map(|x| (x + rng.uniform_in(-0.2, 0.2)).clamp(-1.0, 1.0));
            (x, rng.uniform_in(-1.0, 1.0))
        })
        .collect()
}

/// The yardstick: equations 7.7, 7.10–7.15 rule by rule with the standard library's exponential.
struct Plain {
    parameters: Vec<f64>,
    traces: Vec<f64>,
}

impl Plain {
    fn new(system: &Tsk) -> Self {
        use fuzzy_core::Inference;
        Self { parameters: system.parameters().to_vec(), traces: vec![0.0; 21] }
    }

    /// The output; the rules' firing strengths, and their sum.
    fn fire(&self, x: [f64; 2]) -> (f64, [f64; 9], f64) {
        let p = &self.parameters;
        let degree = |term: usize, x: f64| (-((x - p[2 * term]) / p[2 * term + 1]).powi(2)).exp();
        let (mut strengths, mut weighted, mut total) = ([0.0; 9], 0.0, 0.0);
        for (rule, strength) in strengths.iter_mut().enumerate() {
            *strength = degree(rule / 3, x[0]) * degree(3 + rule % 3, x[1]);
            weighted += *strength * p[12 + rule];
            total += *strength;
        }
        (weighted / total, strengths, total)
    }

    fn gradient(&self, x: [f64; 2], (output, strengths, total): (f64, [f64; 9], f64)) -> [f64; 21] {
        let p = &self.parameters;
        let mut gradient = [0.0; 21];
        for (rule, strength) in strengths.iter().enumerate() {
            gradient[12 + rule] = strength / total;
            let pull = (p[12 + rule] - output) * strength / total;
            for (term, x) in [(rule / 3, x[0]), (3 + rule % 3, x[1])] {
                let (off, width) = (x - p[2 * term], p[2 * term + 1]);
                gradient[2 * term] += pull * 2.0 * off / width.powi(2);
                gradient[2 * term + 1] += pull * 2.0 * off.powi(2) / width.powi(3);
            }
        }
        gradient
    }

    fn step(&mut self, decay: f64, gain: f64, gradient: [f64; 21], step: f64) {
        let numbers = self.parameters.iter_mut().zip(&mut self.traces).zip(gradient);
        for ((parameter, trace), gradient) in numbers {
            *trace = decay * *trace + gain * gradient;
            *parameter += step * *trace;
        }
        for term in 0..6 {
            self.parameters[2 * term] = self.parameters[2 * term].clamp(-1.0, 1.0);
            self.parameters[2 * term + 1] = self.parameters[2 * term + 1].clamp(0.02, 2.0);
        }
    }
}

fn steps(agent: &mut impl Agent, walk: &[([f64; 2], f64)], rng: &mut Rng) {
    let mut action = [0.0];
    for pair in walk.windows(2) {
        let ((x, reward), (next, _)) = (pair[0], pair[1]);
        agent.act(&x, &mut action, rng);
        agent.learn(reward, &next, true, rng).expect("rewards are small");
    }
}

fn bench(criterion: &mut Criterion) {
    let walk = walk();
    let (actor, critic) = (system(TABLE), system([0.0; 9]));
    let mut group = criterion.benchmark_group("QLFIS step, 2 inputs, 9 rules");
    group.throughput(Throughput::Elements(STEPS as u64));
    group.bench_function("fuzzyrs", |bencher| {
        let mut rng = Rng::new(0, 0);
        let systems = std::slice::from_ref(&actor);
        let mut agent = Qlfis::fuzzy(systems, &critic, TdSettings::qlfis()).expect("valid");
        bencher.iter(|| steps(&mut agent, black_box(&walk), &mut rng))
    });
    group.bench_function("yardstick, rule by rule", |bencher| {
        let mut rng = Rng::new(0, 0);
        let (mut actor, mut critic) = (Plain::new(&actor), Plain::new(&critic));
        bencher.iter(|| {
            for pair in black_box(&walk).windows(2) {
                let ((x, reward), (next, _)) = (pair[0], pair[1]);
                let noise = rng.normal();
                let (u, value) = (actor.fire(x), critic.fire(x));
                black_box(u.0 + 0.08 * noise);
                let error = reward + 0.95 * critic.fire(next).0 - value.0;
                let gradient = critic.gradient(x, value);
                critic.step(0.95 * 0.9, 1.0, gradient, 0.1 * error);
                let gradient = actor.gradient(x, u);
                actor.step(0.0, noise, gradient, 0.01 * error);
            }
        })
    });
    group.finish();

    let mut group = criterion.benchmark_group("neural critic step, 7-21-1");
    group.throughput(Throughput::Elements(STEPS as u64));
    group.bench_function("fuzzyrs", |bencher| {
        let mut rng = Rng::new(0, 0);
        let systems = std::slice::from_ref(&actor);
        let settings = TdSettings::neural();
        let mut agent = NeuralActorCritic::neural(systems, 21, settings, &mut rng).expect("valid");
        bencher.iter(|| steps(&mut agent, black_box(&walk), &mut rng))
    });
    group.finish();
}

criterion_group! { name = benches; config = fuzzyrs_benches::criterion(); targets = bench }
criterion_main!(benches);
