//! The analytic gradient of a system against central differences of its output.

use crate::common;
use crate::common::kinks;
use fuzzy_core::{Inference, Tsk};
use proptest::prelude::*;

/// The step of the differences: large against rounding, small against curvature.
const STEP: f64 = 1e-5;
/// How far from a kink a point has to be: beside the end of an ellipse curvature is large.
const CLEAR: f64 = 0.02;

/// Whether the degrees of all terms have a derivative near their input: no kink or jump, which
/// lie at parameters that are places, or in the middle of them.
fn away_from_kinks(system: &Tsk, x: &[f64]) -> bool {
    let mut terms =
        system.inputs().iter().zip(x).flat_map(|(input, &value)| {
            input.terms().iter().map(move |term| (&term.function, value))
        });
    terms.all(|(function, value)| kinks::distance_to_kinks(function, value) > CLEAR)
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
