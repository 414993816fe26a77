use super::*;
use crate::learn::data::DataSet;
use crate::{
    Control, Inference, Logic, MembershipFunction, NoRuleFires, Order, Output, Outside, Rng, Shape,
    System, Tsk, Variable,
};

fn settings(epochs: u32, premise: PremiseStep) -> AnfisSettings {
    AnfisSettings { epochs, premise, ..AnfisSettings::default() }
}

fn fitted<S: crate::inference::Adaptive>(
    system: &S,
    data: &DataSet,
    settings: &AnfisSettings,
) -> Trained<S> {
    fit(system, data, None, settings, &Control::new()).unwrap()
}

/// The example of the documentation of MATLAB's `anfis`: y = sin(2x)/exp(x/5) at 0, 0.1, …, 10, and
/// five bells on a grid.
fn matlab() -> (Tsk, DataSet) {
    let points: Vec<f64> = (0..=100).map(|i| f64::from(i) / 10.0).collect();
    let targets: Vec<f64> = points.iter().map(|x| (2.0 * x).sin() / (x / 5.0).exp()).collect();
    let mut x = Variable::new("x", 0.0, 10.0).unwrap();
    for (name, centre) in ["a", "b", "c", "d", "e"].into_iter().zip([0.0, 2.5, 5.0, 7.5, 10.0]) {
        let bell = MembershipFunction::new(Shape::Bell, &[centre, 1.25, 2.0]).unwrap();
        x = x.with_term(name, bell).unwrap();
    }
    let system = Tsk::new("fis", vec![x], Order::One, vec![0.0; 10]).unwrap();
    (system, DataSet::new(1, &points, &targets).unwrap())
}

#[test]
fn the_errors_that_matlab_prints_come_out_digit_for_digit() {
    let (system, data) = matlab();
    for solver in [Solver::Cholesky, Solver::Orthogonal] {
        let consequents = Some(LeastSquares { ridge: 0.0, solver });
        let settings = AnfisSettings { consequents, ..settings(20, PremiseStep::default()) };
        let trained = fitted(&system, &data, &settings);
        let errors = &trained.history.training;
        assert_eq!(
            format!("{:.7} {:.7} {:.6}", errors[0], errors[1], errors[2]),
            "0.0694086 0.0680259 0.066663"
        );
        // The step grows after four falls.
        assert_eq!(trained.history.step[..5], [0.01; 5]);
        assert_eq!(trained.history.step[5], 0.01 * 1.1, "{:?}", trained.history);
        assert_eq!(trained.best_epoch, 19);
    }
}

fn thesis_grid(order: Order) -> Tsk {
    let terms = ["NB", "NS", "Z", "PS", "PB"];
    let inputs = ["x", "y"]
        .map(|name| Variable::evenly(name, (-1.0, 1.0), Shape::GaussianWidth, &terms).unwrap());
    let size = if order == Order::Zero { 1 } else { 3 };
    Tsk::new("grid", inputs.to_vec(), order, vec![0.0; 25 * size]).unwrap()
}

fn samples(count: usize) -> (Vec<f64>, Vec<f64>) {
    let mut rng = Rng::new(1, 0);
    let points: Vec<f64> = (0..2 * count).map(|_| rng.uniform_in(-1.0, 1.0)).collect();
    let targets = points.chunks(2).map(|p| (3.0 * p[0]).sin() * p[1] + p[0]).collect();
    (points, targets)
}

#[test]
fn a_sequential_step_is_the_thesiss() {
    let mut system = thesis_grid(Order::Zero);
    let mut rng = Rng::new(2, 0);
    let parameters: Vec<f64> = system
        .parameters()
        .iter()
        .enumerate()
        .map(|(k, &p)| if k < 20 { p } else { rng.uniform_in(-1.0, 1.0) })
        .collect();
    system = system.with_parameters(&parameters).unwrap();
    let (points, targets) = samples(3);
    let rate = 0.05;
    // (2.25)-(2.34), written out.
    let mut p = parameters.clone();
    for (x, wanted) in points.chunks(2).zip(&targets) {
        let degree = |i: usize, t: usize| {
            let (m, s) = (p[10 * i + 2 * t], p[10 * i + 2 * t + 1]);
            (-((x[i] - m) / s).powi(2)).exp()
        };
        let w: Vec<f64> = (0..25).map(|l| degree(0, l / 5) * degree(1, l % 5)).collect();
        let total: f64 = w.iter().sum();
        let f: f64 = (0..25).map(|l| w[l] * p[20 + l]).sum::<f64>() / total;
        let mut moved = p.clone();
        for l in 0..25 {
            for (i, t) in [(0, l / 5), (1, l % 5)] {
                let (m, s) = (p[10 * i + 2 * t], p[10 * i + 2 * t + 1]);
                let pull = rate * (wanted - f) * (p[20 + l] - f) / total * w[l];
                moved[10 * i + 2 * t] += pull * 2.0 * (x[i] - m) / s.powi(2);
                moved[10 * i + 2 * t + 1] += pull * 2.0 * (x[i] - m).powi(2) / s.powi(3);
            }
        }
        p = moved;
    }
    let data = DataSet::new(2, &points, &targets).unwrap();
    let premise = PremiseStep::Sequential { rate, order: SampleOrder::AsGiven };
    let mut fitted = train::Fitted::new(&system);
    let mut sweep = premise::Sweep::new(&system, &data, 0);
    sweep.run(&system, &mut fitted, rate, SampleOrder::AsGiven, &Control::new()).unwrap();
    assert!(premise.check().is_ok());
    for (ours, expected) in fitted.parameters.iter().zip(&p) {
        assert!((ours - expected).abs() < 1e-14, "{ours} {expected}");
    }
}

/// The grid as rules of a system.
fn as_rules(grid: &Tsk) -> System {
    let inputs = grid.inputs().to_vec();
    let size = grid.grid().consequent_size();
    let mut rules = String::new();
    let mut terms = Vec::new();
    for (rule, own) in grid.consequents().chunks(size).enumerate() {
        let names = grid.rule_terms(rule);
        rules += &format!("if x is {} and y is {} then z is c{rule}\n", names[0], names[1]);
        let value = match own {
            [constant] => crate::output::Value::Constant(*constant),
            coefficients => crate::output::Value::Linear(coefficients.to_vec()),
        };
        terms.push((format!("c{rule}"), value));
    }
    let output = Output::sugeno("z", terms).unwrap();
    let logic = Logic { conjunction: crate::norm::TNorm::Product, ..Logic::default() };
    System::from_text("rules", inputs, vec![output], &rules, logic).unwrap()
}

#[test]
fn rules_are_fitted_as_the_grid_that_they_make() {
    let (points, targets) = samples(83);
    let data = DataSet::new(2, &points, &targets).unwrap();
    for order in [Order::Zero, Order::One] {
        let grid = thesis_grid(order);
        let rules = as_rules(&grid);
        for premise in [
            PremiseStep::default(),
            PremiseStep::Batch { rate: 0.1 },
            PremiseStep::Sequential { rate: 0.01, order: SampleOrder::Shuffled },
        ] {
            let consequents = LeastSquares { ridge: 1e-3, ..LeastSquares::default() };
            let settings = AnfisSettings { consequents: Some(consequents), ..settings(4, premise) };
            let (ours, theirs) =
                (fitted(&grid, &data, &settings), fitted(&rules, &data, &settings));
            assert!(ours.history.training[3] < ours.history.training[0]);
            for (a, b) in ours.history.training.iter().zip(&theirs.history.training) {
                assert!((a - b).abs() < 1e-9, "{order:?} {premise:?} {a} {b}");
            }
            let a = ours.system.parameters();
            let b = &theirs.system.parameters()[..a.len()];
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-7), "{order:?} {premise:?}");
        }
    }
}

#[test]
fn solvers_agree_also_with_a_ridge() {
    let (points, targets) = samples(203);
    let data = DataSet::new(2, &points, &targets).unwrap();
    for order in [Order::Zero, Order::One] {
        for ridge in [0.0, 1e-3] {
            let solved = |solver| {
                let consequents = Some(LeastSquares { ridge, solver });
                let settings = AnfisSettings { consequents, ..settings(1, PremiseStep::Fixed) };
                fitted(&thesis_grid(order), &data, &settings).system.parameters().to_vec()
            };
            let (a, b) = (solved(Solver::Cholesky), solved(Solver::Orthogonal));
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-7), "{order:?} {ridge}");
        }
    }
}

#[test]
fn several_outputs_share_the_premises() {
    let inputs = ["x", "y"].map(|name| {
        Variable::evenly(name, (-1.0, 1.0), Shape::Gaussian, &["low", "high"]).unwrap()
    });
    let parse = |text: &str| crate::output::Value::parse(text, &["x", "y"]).unwrap();
    let first =
        Output::sugeno("u", vec![("a".to_owned(), parse("x + y")), ("b".to_owned(), parse("1"))]);
    let second =
        Output::sugeno("v", vec![("c".to_owned(), parse("x*y")), ("d".to_owned(), parse("2"))]);
    let rules = "if x is low then u is a and v is c\n\
                 if y is high then u is b and v is d\n\
                 if x is high or y is low then u is b";
    let system = System::from_text(
        "two",
        inputs.to_vec(),
        vec![first.unwrap(), second.unwrap()],
        rules,
        Logic::default(),
    )
    .unwrap();
    // Targets from other parameters, so that all errors can vanish.
    let mut wanted = system.parameters().to_vec();
    let first_consequent = 8;
    for (k, value) in wanted[first_consequent..first_consequent + 5].iter_mut().enumerate() {
        *value = k as f64 - 1.5;
    }
    let (points, _) = samples(50);
    let mut targets = vec![0.0; 100];
    let other = system.with_parameters(&wanted).unwrap();
    other.evaluate_batch(&points, &mut targets, 1).unwrap();
    let data = DataSet::with_outputs(2, 2, &points, &targets).unwrap();
    let trained = fitted(&system, &data, &settings(1, PremiseStep::Fixed));
    assert!(trained.history.training[0] < 1e-12);
    assert_eq!(trained.stopped, Stop::Fixed);
    for (ours, wanted) in trained.system.parameters().iter().zip(&wanted) {
        assert!((ours - wanted).abs() < 1e-9);
    }
    let mut moved = wanted.clone();
    moved[0] += 0.2;
    moved[3] -= 0.1;
    let start = system.with_parameters(&moved).unwrap();
    let trained = fitted(&start, &data, &settings(200, PremiseStep::default()));
    let errors = &trained.history.training;
    assert!(errors[trained.best_epoch] < 0.3 * errors[0], "{errors:?}");
    assert!(
        fit(
            &system,
            &DataSet::new(2, &points, &targets[..50]).unwrap(),
            None,
            &AnfisSettings::default(),
            &Control::new()
        )
        .is_err()
    );
}

#[test]
fn the_best_is_kept_whatever_ends_the_training() {
    let (points, targets) = samples(120);
    let data = DataSet::new(2, &points, &targets).unwrap();
    let grid = thesis_grid(Order::Zero);
    // Steps so large that the premises are thrown about.
    let wild = fitted(&grid, &data, &settings(40, PremiseStep::Batch { rate: 1e4 }));
    let errors = &wild.history.training;
    let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(errors[wild.best_epoch], least);
    let check = fitted(
        &wild.system,
        &data,
        &AnfisSettings { consequents: None, ..settings(1, PremiseStep::Fixed) },
    );
    assert_eq!(check.history.training[0], least);
    // So large that numbers overflow.
    let lost = fitted(
        &grid,
        &data,
        &settings(40, PremiseStep::Sequential { rate: 1e300, order: SampleOrder::AsGiven }),
    );
    assert!(matches!(lost.stopped, Stop::Diverged(_)), "{:?}", lost.stopped);
    assert_eq!(lost.best_epoch, 0);

    // The better the training samples are fitted, the worse these are.
    let (other_points, other_targets) =
        (&points[..60], targets[..30].iter().map(|y| -y).collect::<Vec<_>>());
    let validation = DataSet::new(2, other_points, &other_targets).unwrap();
    let patient =
        AnfisSettings { patience: Some(3), ..settings(500, PremiseStep::Batch { rate: 0.5 }) };
    let trained = fit(&grid, &data, Some(&validation), &patient, &Control::new()).unwrap();
    let errors = &trained.history.validation;
    assert_eq!(trained.stopped, Stop::Patience);
    assert_eq!(errors.len(), trained.best_epoch + 4);
    assert!(errors.iter().all(|&error| error >= errors[trained.best_epoch]));

    let control = Control::new();
    control.cancel();
    let settings = settings(5, PremiseStep::default());
    assert_eq!(fit(&grid, &data, None, &settings, &control).unwrap_err(), crate::Error::Cancelled);
}

#[test]
fn data_that_say_little_have_a_documented_outcome() {
    let grid = thesis_grid(Order::One);
    let first = grid.grid().first_consequent();
    let (points, targets) = samples(10);
    let few = DataSet::new(2, &points, &targets).unwrap();
    let exact = fitted(&grid, &few, &settings(1, PremiseStep::Fixed));
    assert!(exact.history.training[0] < 1e-9);
    let norm = |system: &Tsk| system.parameters()[first..].iter().map(|k| k * k).sum::<f64>();
    let ridge = LeastSquares { ridge: 1e-3, ..LeastSquares::default() };
    let damped = AnfisSettings { consequents: Some(ridge), ..settings(1, PremiseStep::Fixed) };
    assert!(norm(&fitted(&grid, &few, &damped).system) < norm(&exact.system));
    // A constant input column.
    let constant: Vec<f64> =
        points.iter().enumerate().map(|(k, &p)| if k % 2 == 0 { p } else { 0.25 }).collect();
    let data = DataSet::new(2, &constant, &targets).unwrap();
    assert!(
        fitted(&grid, &data, &settings(3, PremiseStep::default())).history.training[2].is_finite()
    );
}

#[test]
fn samples_that_a_system_cannot_answer_are_named() {
    let x = Variable::new("x", 0.0, 10.0).unwrap();
    let x = x.with_term("low", MembershipFunction::triangular(0.0, 1.0, 2.0).unwrap()).unwrap();
    let gap = Tsk::zero_order("gap", vec![x], vec![3.0]).unwrap();
    let data = DataSet::new(1, &[0.5, 1.0, 5.0], &[1.0, 1.0, 2.0]).unwrap();
    let run = |system: &Tsk| {
        fit(system, &data, None, &settings(2, PremiseStep::default()), &Control::new())
    };
    let message = run(&gap).unwrap_err().to_string();
    assert!(
        message.starts_with("no rule of \"gap\" about \"output\" fires at sample 2 [5.0]"),
        "{message}"
    );
    assert!(run(&gap.clone().when_no_rule_fires(NoRuleFires::Nan).unwrap()).is_err());
    let filled = run(&gap.clone().when_no_rule_fires(NoRuleFires::Value(2.0)).unwrap()).unwrap();
    assert!(filled.history.training[0] < 1e-12);
    assert!((filled.system.consequents()[0] - 1.0).abs() < 1e-12);
    let strict = gap.with_outside(Outside::Error);
    let outside = DataSet::new(1, &[0.5, 11.0], &[1.0, 1.0]).unwrap();
    let error =
        fit(&strict, &outside, None, &AnfisSettings::default(), &Control::new()).unwrap_err();
    assert_eq!(error.to_string(), "sample 1: input \"x\" must be from 0 to 10, got 11");
}
