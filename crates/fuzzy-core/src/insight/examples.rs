//! Systems that several tests look into.

use crate::inference::{Logic, System};
use crate::membership::{MembershipFunction, Shape};
use crate::norm::{Aggregation, TNorm};
use crate::output::{Defuzzifier, Output, Sampling};
use crate::variable::Variable;

/// A variable with terms of any shapes.
pub fn variable(name: &str, universe: (f64, f64), terms: &[(&str, Shape, &[f64])]) -> Variable {
    let empty = Variable::new(name, universe.0, universe.1).unwrap();
    terms.iter().fold(empty, |variable, (term, shape, parameters)| {
        let function = MembershipFunction::new(*shape, parameters).unwrap();
        variable.with_term(term, function).unwrap()
    })
}

pub fn tip() -> Variable {
    let triangle = Shape::Triangular;
    let terms: [(&str, Shape, &[f64]); 3] = [
        ("cheap", triangle, &[0.0, 5.0, 10.0]),
        ("average", triangle, &[10.0, 15.0, 20.0]),
        ("generous", triangle, &[20.0, 25.0, 30.0]),
    ];
    variable("tip", (0.0, 30.0), &terms)
}

/// MATLAB's tipper, whose food may be neither rancid nor delicious.
pub fn tipper_with(output: Output) -> System {
    let gaussian = Shape::Gaussian;
    let service = variable(
        "service",
        (0.0, 10.0),
        &[
            ("poor", gaussian, &[0.0, 1.5]),
            ("good", gaussian, &[5.0, 1.5]),
            ("excellent", gaussian, &[10.0, 1.5]),
        ],
    );
    let food = variable(
        "food",
        (0.0, 10.0),
        &[
            ("rancid", Shape::Trapezoidal, &[0.0, 0.0, 1.0, 3.0]),
            ("delicious", Shape::Trapezoidal, &[7.0, 9.0, 10.0, 10.0]),
        ],
    );
    let rules = "if service is poor or food is rancid then tip is cheap\n\
                 if service is good then tip is average\n\
                 if service is excellent or food is delicious then tip is generous";
    System::from_text("tipper", vec![service, food], vec![output], rules, Logic::default()).unwrap()
}

pub fn tipper() -> System {
    tipper_with(Output::mamdani(tip()).unwrap())
}

/// A Mamdani output over [`tip`].
pub fn mamdani(
    implication: TNorm,
    aggregation: Aggregation,
    defuzzifier: Defuzzifier,
    sampling: Sampling,
) -> Output {
    Output::mamdani_with(tip(), implication, aggregation, defuzzifier, sampling).unwrap()
}
