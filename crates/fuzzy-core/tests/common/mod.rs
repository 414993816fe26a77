//! Random systems for the property tests.

use fuzzy_core::{MembershipFunction, Order, Shape, Tsk, Variable};
use proptest::prelude::*;

/// Any shape, its sides or width 0.2 at least.
pub fn function() -> impl Strategy<Value = MembershipFunction> {
    let gaps = prop::array::uniform3(0.2..1.5);
    (prop::sample::select(Shape::ALL.to_vec()), -1.5..1.5, gaps).prop_map(|(shape, first, gaps)| {
        let parameters = match shape {
            Shape::Gaussian | Shape::GaussianWidth => vec![first, gaps[0]],
            _ => {
                let vertices = gaps.iter().scan(first, |vertex, gap| {
                    *vertex += gap;
                    Some(*vertex)
                });
                std::iter::once(first).chain(vertices).take(shape.parameter_count()).collect()
            }
        };
        MembershipFunction::new(shape, &parameters).unwrap()
    })
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
    terms.iter().enumerate().fold(empty, |variable, (number, &function)| {
        variable.with_term(&format!("term {number}"), function).unwrap()
    })
}
