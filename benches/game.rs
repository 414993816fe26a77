//! Games in lock-step beside the same games by hand, in time per step of one robot.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fuzzy_core::{Control, Inference, MembershipFunction, Rng, Tsk, Variable};
use fuzzyrs_benches::{by_hand, positions};
use pursuit_sim::{
    Controller, Entrant, FuzzyController, OneOnOne, Outcome, Start, play_many, play_population,
};
use std::hint::black_box;

const GAMES: usize = 4096;
const POPULATION: usize = 40;
const MAX_STEPS: u32 = 300;

fn robot_steps(steps: impl Iterator<Item = u32>) -> u64 {
    2 * steps.map(u64::from).sum::<u64>()
}

fn steps(outcomes: &[Outcome]) -> Vec<u32> {
    outcomes.iter().map(|outcome| outcome.steps).collect()
}

fn classical(criterion: &mut Criterion) {
    let game = OneOnOne::thesis().expect("valid");
    let positions = positions(GAMES);
    let starts: Vec<Start> = positions.iter().map(|&(x, y)| Start::evader_at(x, y)).collect();
    let lock_step = || {
        let (classical, control) = (&Controller::Classical, Control::new());
        play_many(&game, classical, classical, black_box(&starts), MAX_STEPS, 1, &control)
            .expect("valid")
    };
    let yardstick = || -> Vec<u32> {
        let positions = black_box(&positions).iter();
        positions.map(|&position| by_hand::play(position, MAX_STEPS, |angle, _| angle)).collect()
    };
    let played = steps(&lock_step());
    assert_eq!(played, yardstick(), "both play the same games");

    let mut group = criterion.benchmark_group("classical against classical");
    group.throughput(Throughput::Elements(robot_steps(played.into_iter())));
    group.bench_function(BenchmarkId::new("fuzzyrs", "1 thread"), |b| b.iter(lock_step));
    group.bench_function(BenchmarkId::new("yardstick", "one by one"), |b| b.iter(yardstick));
    group.finish();
}

/// A pursuer with three Gaussians for each input, as the trainings tune it.
fn fuzzy() -> FuzzyController {
    let variable = |name| {
        let means = [("N", -1.0), ("Z", 0.0), ("P", 1.0)];
        means.into_iter().fold(Variable::new(name, -1.0, 1.0).expect("valid"), |v, (term, mean)| {
            let function = MembershipFunction::gaussian_width(mean, 0.6).expect("valid");
            v.with_term(term, function).expect("valid")
        })
    };
    let inputs = vec![variable("angle"), variable("rate")];
    let consequents = vec![-0.9, -0.4, -0.4, -0.4, 0.0, 0.4, 0.4, 0.4, 0.9];
    let system = Tsk::zero_order("pursuer", inputs, consequents).expect("valid");
    FuzzyController::new(system, 1.0, 1.0).expect("valid")
}

fn rule_by_rule(parameters: &[f64], angle: f64, rate: f64) -> f64 {
    let degree = |term: usize, value: f64| {
        let z = (value.clamp(-1.0, 1.0) - parameters[2 * term]) / parameters[2 * term + 1];
        (-z * z).exp()
    };
    let (mut weighted, mut strength) = (0.0, 0.0);
    for rule in 0..9 {
        let weight = degree(rule / 3, angle) * degree(3 + rule % 3, rate);
        weighted += weight * parameters[12 + rule];
        strength += weight;
    }
    weighted / strength
}

fn population(criterion: &mut Criterion) {
    let game = OneOnOne::thesis().expect("valid");
    let controller = fuzzy();
    let position = (-6.0, 7.0);
    let mut rng = Rng::new(1, 0);
    let mut population = controller.system().parameters().repeat(POPULATION);
    population.iter_mut().for_each(|parameter| *parameter += rng.uniform_in(-0.1, 0.1));
    let lock_step = || {
        let evader = Entrant::Same(&Controller::Classical);
        let pursuers = Entrant::Population(&controller, black_box(&population));
        let (start, control) = (Start::evader_at(position.0, position.1), Control::new());
        play_population(&game, pursuers, evader, &[start], MAX_STEPS, &control)
            .expect("within the plane")
    };
    let yardstick = || -> Vec<u32> {
        let individuals = black_box(&population).chunks_exact(population.len() / POPULATION);
        individuals
            .map(|parameters| {
                by_hand::play(position, MAX_STEPS, |angle, rate| {
                    rule_by_rule(parameters, angle, rate)
                })
            })
            .collect()
    };
    let played = steps(&lock_step());
    assert_eq!(played, yardstick(), "both play the same games");

    let mut group = criterion.benchmark_group("population of 40 fuzzy pursuers");
    group.throughput(Throughput::Elements(robot_steps(played.into_iter())));
    group.bench_function(BenchmarkId::new("fuzzyrs", "lock-step"), |b| b.iter(lock_step));
    group.bench_function(BenchmarkId::new("yardstick", "rule by rule"), |b| b.iter(yardstick));
    group.finish();
}

criterion_group! {
    name = benches;
    config = fuzzyrs_benches::criterion();
    targets = classical, population
}
criterion_main!(benches);
