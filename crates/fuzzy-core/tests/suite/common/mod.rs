//! Random systems for the property tests.

pub mod kinks;
pub mod random_rules;

use fuzzy_core::membership::ParameterKind;
use fuzzy_core::{MembershipFunction, Order, Shape, Tsk, Variable};
use proptest::prelude::*;

/// Any shape, its sides or width 0.2 at least.
pub fn function() -> impl Strategy<Value = MembershipFunction> {
    let shapes = prop::sample::select(Shape::ALL.to_vec());
    let numbers = (-1.5..1.5, prop::array::uniform4(0.2..1.5), 2..=5_usize, any::<bool>());
    (shapes, numbers).prop_map(|(shape, (first, gaps, points, falls))| {
        let count = shape.parameter_count().unwrap_or(2 * points);
        let mut parameters = parameters(shape, count, first, gaps);
        if falls && matches!(shape, Shape::Ramp | Shape::Concave | Shape::Arc) {
            parameters.reverse();
        }
        MembershipFunction::new(shape, &parameters).unwrap()
    })
}

/// Parameters of each one's kind; places rise from `first`, two of them never less than 0.2 apart.
fn parameters(shape: Shape, count: usize, first: f64, gaps: [f64; 4]) -> Vec<f64> {
    let mut place = first;
    let parameter = |index: usize| {
        let gap = gaps[index % 4];
        match shape.parameter_kind(index) {
            ParameterKind::Centre | ParameterKind::Vertex => {
                place += if index == 0 { 0.0 } else { gap };
                place
            }
            ParameterKind::Width | ParameterKind::Power => gap,
            ParameterKind::Slope | ParameterKind::Direction if index == 3 => -4.0 * gap,
            ParameterKind::Slope | ParameterKind::Direction => 4.0 * gap,
            ParameterKind::Degree => gap / 1.5,
            kind => unreachable!("say above what a {kind:?} may be"),
        }
    };
    (0..count).map(parameter).collect()
}

/// Systems of one to three inputs with one to three terms of any shapes, of order 0 and 1.
pub fn system() -> impl Strategy<Value = Tsk> {
    let terms = prop::collection::vec(function(), 1..=3);
    let inputs = prop::collection::vec(terms, 1..=3);
    (inputs, prop::sample::select(vec![Order::Zero, Order::One])).prop_flat_map(
        |(inputs, order)| {
            let rules: usize = inputs.iter().map(Vec::len).product();
            let size = if order == Order::Zero { 1 } else { inputs.len() + 1 };
            prop::collection::vec(-2.0..2.0, rules * size).prop_map(move |consequents| {
                let variables = inputs.iter().enumerate().map(|(i, terms)| variable(i, terms));
                Tsk::new("random", variables.collect(), order, consequents).unwrap()
            })
        },
    )
}

fn variable(index: usize, terms: &[MembershipFunction]) -> Variable {
    let empty = Variable::new(&format!("input {index}"), -2.0, 2.0).unwrap();
    terms.iter().enumerate().fold(empty, |variable, (number, function)| {
        variable.with_term(&format!("term {number}"), function.clone()).unwrap()
    })
}
