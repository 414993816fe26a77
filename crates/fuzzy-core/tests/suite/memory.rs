//! Where memory is allocated, and where none may be.

use allocation_counter::measure;
use fuzzy_core::learn::rl::{Cut, QLambda, QLambdaSettings, Trace};
use fuzzy_core::{Inference, Order, Rng, Shape, Tsk, Variable};

fn system() -> Tsk {
    let inputs = ["x", "y"].map(|name| {
        Variable::evenly(name, (-1.0, 1.0), Shape::Gaussian, &["N", "Z", "P"]).unwrap()
    });
    Tsk::new("system", inputs.to_vec(), Order::One, vec![0.5; 27]).unwrap()
}

#[test]
fn a_batch_on_one_thread_needs_the_same_for_any_number_of_rows() {
    let system = system();
    let width = system.parameters().len();
    let bytes = [100, 100_000].map(|rows| {
        let (points, mut outputs) = (vec![0.25; 2 * rows], vec![0.0; rows]);
        let evaluation = measure(|| system.evaluate_batch(&points, &mut outputs, 1).unwrap());
        let mut derivatives = vec![0.0; rows * width];
        let gradient = measure(|| system.gradient_batch(&points, &mut derivatives, 1).unwrap());
        [evaluation.bytes_total, gradient.bytes_total]
    });
    assert_eq!(bytes[0], bytes[1]);
    assert!(bytes[0][0] > 0, "nothing was measured");
}

#[test]
fn one_point_needs_nothing() {
    let system = system();
    let mut derivatives = vec![0.0; system.parameters().len()];
    let used = measure(|| {
        system.evaluate(&[0.3, -0.4]).unwrap();
        system.gradient(&[0.3, -0.4], &mut derivatives).unwrap();
    });
    assert_eq!(used.count_total, 0);
}

#[test]
fn a_learning_step_needs_nothing_once_the_traces_are_warm() {
    const STATES: usize = 121;
    for trace in [Trace::Replacing, Trace::ReplacingState, Trace::Accumulating] {
        let mut learner = QLambda::new(QLambdaSettings {
            states: STATES,
            actions: 11,
            discount: 0.5,
            trace_decay: 0.3,
            trace,
            cut: Cut::Watkins,
        })
        .unwrap();
        let mut rng = Rng::new(0, 0);
        let mut steps = |count: usize| {
            for _ in 0..count {
                let (state, next) = (rng.below(STATES), rng.below(STATES));
                let action = learner.choose(state, 0.5, &mut rng);
                learner.learn(state, action, rng.uniform(), Some(next), 0.1).unwrap();
            }
        };
        steps(1000);
        assert_eq!(measure(|| steps(10_000)).count_total, 0, "{trace:?}");
    }
}
