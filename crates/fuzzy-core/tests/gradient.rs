//! The analytic gradient of a system against central differences of its output.

#![allow(clippy::unwrap_used)]

mod common;

use fuzzy_core::{Shape, Tsk};
use proptest::prelude::*;

/// The step of the differences: large against rounding, small against curvature.
const STEP: f64 = 1e-5;

/// Whether no triangle or trapezoid has a vertex near its input: there it has no derivative.
fn away_from_kinks(system: &Tsk, x: &[f64]) -> bool {
    system.inputs().iter().zip(x).all(|(input, &value)| {
        input.terms().iter().map(|term| term.function).all(|function| {
            matches!(function.shape(), Shape::Gaussian | Shape::GaussianWidth)
                || function.parameters().iter().all(|vertex| (vertex - value).abs() > 2.0 * STEP)
        })
    })
}

/// The sum of all firing strengths.
fn strength(system: &Tsk, x: &[f64]) -> f64 {
    let inputs = system.inputs().iter().zip(x);
    inputs
        .map(|(input, &value)| {
            input.terms().iter().map(|term| term.function.degree(value)).sum::<f64>()
        })
        .product()
}

/// (f(φ + h) − f(φ − h))/2h for the parameter φ with this index.
fn central_difference(system: &Tsk, index: usize, x: &[f64]) -> f64 {
    let output = |step: f64| {
        let mut parameters = system.parameters().to_vec();
        parameters[index] += step;
        system.with_parameters(&parameters).unwrap().evaluate(x).unwrap()
    };
    (output(STEP) - output(-STEP)) / (2.0 * STEP)
}

proptest! {
    #[test]
    fn the_gradient_agrees_with_central_differences(
        system in common::system(),
        point in prop::array::uniform3(-2.0..2.0),
    ) {
        let x = &point[..system.inputs().len()];
        // A weak strength in the denominator magnifies the error of the differences.
        prop_assume!(away_from_kinks(&system, x) && strength(&system, x) > 0.05);
        let mut gradient = vec![f64::NAN; system.parameters().len()];
        let output = system.gradient(x, &mut gradient).unwrap();
        prop_assert_eq!(output.to_bits(), system.evaluate(x).unwrap().to_bits());
        for (index, (parameter, &ours)) in system.parameter_info().iter().zip(&gradient).enumerate() {
            let difference = central_difference(&system, index, x);
            prop_assert!(
                (ours - difference).abs() <= 1e-5 * (1.0 + ours.abs()),
                "{}: {} but {}", parameter.name, ours, difference
            );
        }
    }
}
