use super::*;
use crate::inference::{Inference, NoRuleFires, Order, Outside};
use crate::learn::schedule::Schedule;
use crate::membership::Shape;
use crate::variable::Variable;

const TERMS: [&str; 3] = ["N", "Z", "P"];

fn variables(shape: Shape) -> Vec<Variable> {
    let evenly = |name| Variable::evenly(name, (-1.0, 1.0), shape, &TERMS).unwrap();
    vec![evenly("x"), evenly("y")]
}

fn system(shape: Shape, consequents: [f64; 9]) -> Tsk {
    Tsk::zero_order("s", variables(shape), consequents.to_vec()).unwrap()
}

const TABLE_7_1: [f64; 9] = [-0.5, -0.25, 0.0, -0.25, 0.0, 0.25, 0.0, 0.25, 0.5];

fn agent(settings: TdSettings) -> Qlfis {
    let actor = system(Shape::GaussianWidth, TABLE_7_1);
    let critic = system(Shape::GaussianWidth, [0.0; 9]);
    Qlfis::fuzzy(&[actor], &critic, settings).unwrap()
}

/// Points and rewards as an environment might give them.
fn experience(rng: &mut Rng) -> ([f64; 2], f64) {
    ([rng.uniform_in(-1.2, 1.2), rng.uniform_in(-1.2, 1.2)], rng.uniform_in(-1.0, 1.0))
}

/// Equations 7.7 and 7.10–7.15 as they are printed, for 2 inputs with 3 terms each: parameters
/// are (mean, width) of each term, then the consequents.
#[derive(Clone)]
struct Printed {
    parameters: Vec<f64>,
    traces: Vec<f64>,
}

impl Printed {
    fn strengths(&self, x: [f64; 2]) -> Vec<f64> {
        let degree = |term: usize, x: f64| {
            let z = (x - self.parameters[2 * term]) / self.parameters[2 * term + 1];
            (-z * z).exp()
        };
        (0..9).map(|rule| degree(rule / 3, x[0]) * degree(3 + rule % 3, x[1])).collect()
    }

    fn output(&self, x: [f64; 2]) -> f64 {
        let strengths = self.strengths(x);
        let weighted: f64 = strengths.iter().zip(&self.parameters[12..]).map(|(w, k)| w * k).sum();
        weighted / strengths.iter().sum::<f64>()
    }

    fn gradient(&self, x: [f64; 2]) -> Vec<f64> {
        let (strengths, output) = (self.strengths(x), self.output(x));
        let total: f64 = strengths.iter().sum();
        let mut gradient = vec![0.0; 21];
        for rule in 0..9 {
            gradient[12 + rule] = strengths[rule] / total;
            let pull = (self.parameters[12 + rule] - output) * strengths[rule] / total;
            for (term, x) in [(rule / 3, x[0]), (3 + rule % 3, x[1])] {
                let (mean, width) = (self.parameters[2 * term], self.parameters[2 * term + 1]);
                gradient[2 * term] += pull * 2.0 * (x - mean) / width.powi(2);
                gradient[2 * term + 1] += pull * 2.0 * (x - mean).powi(2) / width.powi(3);
            }
        }
        gradient
    }

    fn step(&mut self, decay: f64, gain: f64, gradient: &[f64], step: f64) {
        for (index, gradient) in gradient.iter().enumerate() {
            self.traces[index] = decay * self.traces[index] + gain * gradient;
            self.parameters[index] += step * self.traces[index];
        }
        for term in 0..6 {
            self.parameters[2 * term] = self.parameters[2 * term].clamp(-1.0, 1.0);
            self.parameters[2 * term + 1] = self.parameters[2 * term + 1].clamp(0.02, 2.0);
        }
    }
}

#[test]
fn a_thousand_steps_are_those_of_the_printed_equations() {
    let mut agent = agent(TdSettings::qlfis());
    let parameters = system(Shape::GaussianWidth, TABLE_7_1).parameters().to_vec();
    let mut actor = Printed { parameters, traces: vec![0.0; 21] };
    let mut critic = actor.clone();
    critic.parameters[12..].fill(0.0);
    let (mut rng, mut world, mut u_c) = (Rng::new(3, 0), Rng::new(4, 0), [0.0]);
    for episode in 1..=20 {
        agent.begin_episode(episode);
        let critic_rate = 0.1 - 0.09 * episode as f64 / 1000.0;
        let (mut x, _) = experience(&mut world);
        for _ in 0..50 {
            agent.act(&x, &mut u_c, &mut rng);
            let (next, reward) = experience(&mut world);
            let error = reward + 0.95 * critic.output(next) - critic.output(x);
            let actual = agent.learn(reward, &next, true, &mut rng).unwrap();
            assert!((actual - error).abs() < 1e-9);
            let tried = (u_c[0] - actor.output(x)) / 0.08;
            critic.step(0.95 * 0.9, 1.0, &critic.gradient(x), critic_rate * error);
            actor.step(0.0, tried, &actor.gradient(x), 0.1 * critic_rate * error);
            x = next;
        }
    }
    let near = |system: &Tsk, printed: &Printed| {
        for (a, b) in system.parameters().iter().zip(&printed.parameters) {
            assert!((a - b).abs() < 1e-8, "{a} {b}");
        }
    };
    near(&agent.actors().unwrap()[0], &actor);
    near(&agent.critic().system().unwrap(), &critic);
    assert!(
        agent.actors().unwrap()[0].parameters()
            != system(Shape::GaussianWidth, TABLE_7_1).parameters()
    );
}

/// The derivatives of a system's output to its parameters, by differences.
fn differences(system: &Tsk, x: &[f64]) -> Vec<f64> {
    let step = 1e-5;
    let moved = |k: usize, by: f64| {
        let mut parameters = system.parameters().to_vec();
        parameters[k] += by;
        system.with_parameters(&parameters).unwrap().evaluate(x).unwrap()
    };
    (0..system.parameters().len())
        .map(|k| (moved(k, step) - moved(k, -step)) / (2.0 * step))
        .collect()
}

/// The variable with the same terms, none at the edge of its universe.
fn with_room(variable: &Variable) -> Variable {
    let wider = Variable::new(variable.name(), -2.0, 2.0).unwrap();
    variable
        .terms()
        .iter()
        .fold(wider, |wider, term| wider.with_term(&term.name, term.function.clone()).unwrap())
}

#[test]
fn a_step_goes_along_derivatives_that_differences_confirm() {
    for (shape, order) in [
        (Shape::Gaussian, Order::Zero),
        (Shape::Gaussian, Order::One),
        (Shape::Bell, Order::Zero),
        (Shape::GaussianWidth, Order::One),
    ] {
        let size = if order == Order::One { 3 } else { 1 };
        let mut rng = Rng::new(8, 0);
        let consequents: Vec<f64> = (0..9 * size).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
        let inputs = variables(shape).iter().map(with_room).collect::<Vec<_>>();
        let new = |name| Tsk::new(name, inputs.clone(), order, consequents.clone()).unwrap();
        let (actors, critic) = ([new("a"), new("b")], new("c"));
        let settings = TdSettings { actor_trace_decay: 0.5, ..TdSettings::qlfis() };
        let mut agent = Qlfis::fuzzy(&actors, &critic, settings).unwrap();
        agent.begin_episode(500);
        let (x, next) = ([0.13, -0.57], [0.4, 0.2]);
        let mut action = [0.0; 2];
        agent.act(&x, &mut action, &mut rng);
        let error = agent.learn(0.3, &next, true, &mut rng).unwrap();
        let value = |x: &[f64]| critic.evaluate(x).unwrap();
        assert!((error - (0.3 + 0.95 * value(&next) - value(&x))).abs() < 1e-12);
        let moved = |after: &Tsk, before: &Tsk, factor: f64| {
            let each = after.parameters().iter().zip(before.parameters());
            for ((after, before), slope) in each.zip(differences(before, &x)) {
                let (moved, expected) = (after - before, factor * slope);
                assert!((moved - expected).abs() < 1e-9, "{shape:?} {moved} {expected}");
            }
        };
        moved(&agent.critic().system().unwrap(), &critic, 0.055 * error);
        for ((after, before), u_c) in agent.actors().unwrap().iter().zip(&actors).zip(action) {
            let tried = (u_c - before.evaluate(&x).unwrap()) / 0.08;
            moved(after, before, 0.0055 * error * tried);
        }
    }
}

/// The network's output as one writes it down.
fn network(weights: &[f64], x: &[f64], hidden: usize) -> f64 {
    let (inputs, mut output) = (x.len(), weights[weights.len() - 1]);
    for h in 0..hidden {
        let sum: f64 = (0..inputs).map(|i| weights[i * hidden + h] * x[i]).sum();
        let sum = sum + weights[inputs * hidden + h];
        output += weights[(inputs + 1) * hidden + h] * sum.tanh();
    }
    output
}

#[test]
fn the_network_learns_along_derivatives_that_differences_confirm() {
    let mut rng = Rng::new(2, 0);
    let actor = system(Shape::GaussianWidth, TABLE_7_1);
    let settings = TdSettings { tune: Tune::Consequents, ..TdSettings::neural() };
    let mut agent = NeuralActorCritic::neural(&[actor], 21, settings, &mut rng).unwrap();
    assert_eq!(agent.critic().weights().len(), 190);
    assert!(agent.critic().weights().iter().all(|w| w.abs() <= 0.1));
    let mut action = [0.0];
    let mut traces = vec![0.0; 190];
    let mut before: Option<[f64; 3]> = None;
    let points = [[0.1, -0.2], [0.5, 0.3], [-0.4, 0.9], [0.0, 0.1]];
    agent.begin_episode(1);
    for pair in points.windows(2) {
        let weights = agent.critic().weights().to_vec();
        agent.act(&pair[0], &mut action, &mut rng);
        let now = [pair[0][0], pair[0][1], action[0]];
        let x = [&now[..], &before.unwrap_or(now), &[1.0]].concat();
        let mut u = [0.0];
        agent.exploit(&pair[1], &mut u);
        let next = [&[pair[1][0], pair[1][1], u[0]], &now[..], &[1.0]].concat();
        let error = 0.7 + 0.95 * network(&weights, &next, 21) - network(&weights, &x, 21);
        let actual = agent.learn(0.7, &pair[1], true, &mut rng).unwrap();
        assert!((actual - error).abs() < 1e-14);
        for k in 0..190 {
            let moved = |by: f64| {
                let mut weights = weights.clone();
                weights[k] += by;
                network(&weights, &x, 21)
            };
            let slope = (moved(1e-4) - moved(-1e-4)) / 2e-4;
            traces[k] = 0.95 * 0.9 * traces[k] + slope;
            let expected = weights[k] + (0.01 - 0.009 / 1000.0) * error * traces[k];
            assert!((agent.critic().weights()[k] - expected).abs() < 1e-10);
        }
        before = Some(now);
    }
}

#[test]
fn only_what_shall_be_tuned_is_tuned() {
    let mut agent = agent(TdSettings::fuzzy_actor_critic());
    let (mut rng, mut action) = (Rng::new(1, 0), [0.0]);
    agent.begin_episode(1);
    let before = agent.actors().unwrap()[0].clone();
    for _ in 0..100 {
        let (x, reward) = experience(&mut rng);
        agent.act(&x, &mut action, &mut rng);
        agent.learn(reward, &x, true, &mut rng).unwrap();
    }
    let after = agent.actors().unwrap()[0].clone();
    assert_eq!(after.inputs(), before.inputs());
    assert!(after.consequents().iter().zip(before.consequents()).all(|(a, b)| a != b));
    assert_eq!(agent.held(), 0);
}

#[test]
fn an_end_is_worth_nothing_more() {
    let mut agent = agent(TdSettings::qlfis());
    let (mut rng, mut action, x) = (Rng::new(1, 0), [0.0], [0.3, 0.3]);
    agent.begin_episode(1);
    for _ in 0..50 {
        agent.act(&x, &mut action, &mut rng);
        agent.learn(1.0, &x, true, &mut rng).unwrap();
    }
    let value = agent.critic().system().unwrap().evaluate(&x).unwrap();
    assert!(value > 1.0);
    agent.act(&x, &mut action, &mut rng);
    let mut other = agent.clone();
    assert!((agent.learn(0.0, &x, false, &mut rng).unwrap() + value).abs() < 1e-12);
    assert!((other.learn(0.0, &x, true, &mut rng).unwrap() + 0.05 * value).abs() < 1e-12);
}

#[test]
fn traces_end_with_the_episode_where_that_is_wanted() {
    let run = |clear_traces| {
        let mut agent = agent(TdSettings { clear_traces, ..TdSettings::qlfis() });
        let (mut rng, mut action) = (Rng::new(1, 0), [0.0]);
        for (episode, x) in [(1, [0.9, 0.9]), (2, [-0.9, -0.9])] {
            agent.begin_episode(episode);
            agent.act(&x, &mut action, &mut rng);
            agent.learn(if episode == 1 { 0.0 } else { 1.0 }, &x, false, &mut rng).unwrap();
        }
        agent.critic().system().unwrap().evaluate(&[0.9, 0.9]).unwrap()
    };
    // In the second episode the first one's trace is rewarded too, or not.
    assert!(run(false) > 10.0 * run(true).abs(), "{} {}", run(false), run(true));
}

#[test]
fn a_step_that_cannot_be_leaves_everything_as_it_was() {
    let mut agent = agent(TdSettings::qlfis());
    let (mut rng, mut action, x) = (Rng::new(1, 0), [0.0], [0.3, 0.3]);
    agent.begin_episode(1);
    assert_eq!(agent.learn(0.0, &x, true, &mut rng).unwrap_err().kind(), "out_of_order");
    agent.act(&x, &mut action, &mut rng);
    agent.learn(1.0, &x, true, &mut rng).unwrap();
    agent.act(&x, &mut action, &mut rng);
    let mut calm = agent.clone();
    assert_eq!(agent.learn(f64::NAN, &x, true, &mut rng).unwrap_err().kind(), "not_finite");
    for reward in [1e13, -1e300] {
        let error = agent.learn(reward, &x, true, &mut rng).unwrap_err();
        assert_eq!(error.kind(), "learning_diverged", "{error}");
    }
    // A TD error and a critic's step that can be, but an actor's that cannot.
    let settings = TdSettings {
        actor_rate: Schedule::Power { scale: 1.0, power: 0.0 },
        critic_rate: Schedule::Power { scale: 1e-6, power: 0.0 },
        ..TdSettings::qlfis()
    };
    let mut eager = self::agent(settings);
    eager.begin_episode(1);
    let before = (eager.actors().unwrap(), eager.critic().system().unwrap());
    let failed = (0..1000).any(|_| {
        eager.act(&x, &mut action, &mut rng);
        let now = (eager.actors().unwrap(), eager.critic().system().unwrap());
        assert_eq!(now, before);
        let error = eager.learn(9.9e11, &x, false, &mut rng).map_err(|error| error.to_string());
        match error {
            Err(message) => {
                assert!(message.contains("a number of the actor"), "{message}");
                assert_eq!((eager.actors().unwrap(), eager.critic().system().unwrap()), before);
                true
            }
            Ok(_) => {
                eager = self::agent(settings);
                false
            }
        }
    });
    assert!(failed);
    for agent in [&mut agent, &mut calm] {
        agent.learn(0.5, &x, true, &mut rng).unwrap();
    }
    assert_eq!(agent.actors().unwrap(), calm.actors().unwrap());
    assert_eq!(agent.critic().system().unwrap(), calm.critic().system().unwrap());
}

#[test]
fn widths_and_means_are_held_within_bounds_and_that_is_counted() {
    let settings = TdSettings {
        critic_rate: Schedule::Power { scale: 1.0, power: 0.0 },
        narrowest: 0.2,
        ..TdSettings::qlfis()
    };
    let mut agent = agent(settings);
    let (mut rng, mut action) = (Rng::new(5, 0), [0.0]);
    agent.begin_episode(1);
    for _ in 0..300 {
        let (x, reward) = experience(&mut rng);
        agent.act(&x, &mut action, &mut rng);
        agent.learn(3.0 * reward, &x, true, &mut rng).unwrap();
    }
    assert!(agent.held() > 0);
    let critic = agent.critic().system().unwrap();
    let mut on_the_edge = 0;
    for function in critic.inputs().iter().flat_map(|v| v.terms()).map(|term| &term.function) {
        let [mean, width] = function.parameters() else { panic!() };
        assert!((-1.0..=1.0).contains(mean) && (0.4..=2.0).contains(width), "{mean} {width}");
        on_the_edge += usize::from(*width == 0.4 || *width == 2.0 || mean.abs() == 1.0);
    }
    assert!(on_the_edge > 0);
}

#[test]
fn where_no_rule_fires_nothing_is_said_and_nothing_learned() {
    let actor = system(Shape::GaussianWidth, TABLE_7_1);
    let far = [1e6, -1e6];
    let (mut rng, mut action) = (Rng::new(5, 0), [f64::NAN]);
    for (answer, expected) in [(NoRuleFires::Error, 0.0), (NoRuleFires::Value(0.25), 0.25)] {
        let actor = actor.clone().when_no_rule_fires(answer).unwrap();
        let mut agent =
            Qlfis::fuzzy(std::slice::from_ref(&actor), &actor, TdSettings::qlfis()).unwrap();
        agent.exploit(&far, &mut action);
        assert_eq!(action, [expected]);
        agent.act(&far, &mut action, &mut rng);
        assert!(agent.learn(1.0, &far, true, &mut rng).unwrap().is_finite());
        assert_eq!(agent.actors().unwrap()[0], actor);
        assert_eq!(agent.critic().system().unwrap(), actor);
    }
    let clamped = actor.clone().with_outside(Outside::Clamp);
    let mut agent =
        Qlfis::fuzzy(std::slice::from_ref(&clamped), &clamped, TdSettings::qlfis()).unwrap();
    agent.exploit(&far, &mut action);
    assert_eq!(action[0], actor.evaluate(&[1.0, -1.0]).unwrap());
}

#[test]
fn noise_may_fall_to_nothing() {
    let noise = Schedule::Power { scale: 0.1, power: 300.0 };
    let mut agent = agent(TdSettings { noise, ..TdSettings::qlfis() });
    let (mut rng, mut action, mut plain) = (Rng::new(5, 0), [0.0], [0.0]);
    agent.begin_episode(1_000_000);
    agent.exploit(&[0.1, 0.2], &mut plain);
    agent.act(&[0.1, 0.2], &mut action, &mut rng);
    assert_eq!(action, plain);
    agent.learn(1.0, &[0.1, 0.2], true, &mut rng).unwrap();
}

#[test]
fn impossible_settings_and_systems_are_refused() {
    let good = TdSettings::qlfis();
    let constant = |scale| Schedule::Power { scale, power: 0.0 };
    for (bad, word) in [
        (TdSettings { discount: 1.1, ..good }, "discount"),
        (TdSettings { critic_trace_decay: -0.1, ..good }, "trace decay of the critic"),
        (TdSettings { actor_trace_decay: f64::NAN, ..good }, "trace decay of the actor"),
        (TdSettings { critic_rate: constant(0.0), ..good }, "learning rate of the critic"),
        (TdSettings { actor_rate: constant(1.5), ..good }, "learning rate of the actor"),
        (TdSettings { noise: constant(0.0), ..good }, "noise"),
        (TdSettings { narrowest: 0.0, ..good }, "narrowest width"),
    ] {
        let s = system(Shape::Gaussian, TABLE_7_1);
        let message = Qlfis::fuzzy(std::slice::from_ref(&s), &s, bad).unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    }
    let s = system(Shape::Gaussian, TABLE_7_1);
    assert!(Qlfis::fuzzy(&[], &s, good).is_err());
    let x = Variable::evenly("x", (-1.0, 1.0), Shape::Gaussian, &TERMS).unwrap();
    let one = Tsk::zero_order("one", vec![x], vec![0.0; 3]).unwrap();
    assert!(Qlfis::fuzzy(&[one], &s, good).unwrap_err().to_string().contains("\"one\""));
    let strict = s.clone().with_outside(Outside::Error);
    assert!(Qlfis::fuzzy(&[strict], &s, good).unwrap_err().to_string().contains("clamp"));
    let mut rng = Rng::new(0, 0);
    assert!(NeuralActorCritic::neural(std::slice::from_ref(&s), 0, good, &mut rng).is_err());
    assert!(NeuralActorCritic::neural(&[s], usize::MAX / 4, good, &mut rng).is_err());
    assert!(NeuralActorCritic::neural(&[], 3, good, &mut rng).is_err());
}
