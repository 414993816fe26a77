//! What every membership function is: a number from 0 to 1, and convex as a fuzzy set.

#![allow(clippy::unwrap_used)]

use fuzzy_core::membership::ParameterKind;
use fuzzy_core::{MembershipFunction, Shape};
use proptest::num::f64::{INFINITE, NEGATIVE, NORMAL, POSITIVE, ZERO};
use proptest::prelude::*;

/// Any valid function, of any size, with vertices that may coincide.
fn function() -> impl Strategy<Value = MembershipFunction> {
    let number = prop_oneof![-3.0..3.0, POSITIVE | NEGATIVE | NORMAL];
    let numbers = prop::collection::vec(number, 8);
    let shapes = prop::sample::select(Shape::ALL.to_vec());
    (shapes, numbers, any::<bool>()).prop_filter_map("invalid", |(shape, mut numbers, repeat)| {
        numbers.truncate(shape.parameter_count().unwrap_or(8));
        let kinds: Vec<_> = (0..numbers.len()).map(|index| shape.parameter_kind(index)).collect();
        let places = kinds.iter().filter(|kind| **kind == ParameterKind::Vertex).count();
        let mut vertices: Vec<f64> = numbers[..places].to_vec();
        if repeat && places > 2 && shape != Shape::Points {
            vertices[1] = vertices[0];
        }
        if !shape.is_monotone() {
            vertices.sort_by(f64::total_cmp);
        }
        let mut vertices = vertices.into_iter();
        for (number, kind) in numbers.iter_mut().zip(kinds) {
            *number = match kind {
                ParameterKind::Vertex => vertices.next().unwrap(),
                ParameterKind::Width | ParameterKind::Power => number.abs(),
                ParameterKind::Degree => number.abs() % 1.0,
                _ => *number,
            };
        }
        MembershipFunction::new(shape, &numbers).ok()
    })
}

/// Any number, often one near the parameters.
fn place() -> impl Strategy<Value = f64> {
    prop_oneof![-4.0..4.0, POSITIVE | NEGATIVE | NORMAL | ZERO | INFINITE]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn degrees_lie_between_0_and_1(function in function(), x in place()) {
        let degree = function.degree(x);
        prop_assert!((0.0..=1.0).contains(&degree), "{degree}");
    }

    #[test]
    fn degrees_at_the_parameters_too(function in function()) {
        for &x in function.parameters() {
            let degree = function.degree(x);
            prop_assert!((0.0..=1.0).contains(&degree), "{x}: {degree}");
        }
    }

    #[test]
    fn between_two_places_the_degree_is_no_smaller_than_at_both(
        function in function(),
        mut places in prop::array::uniform3(place()),
    ) {
        // Points may form a valley, and so may a difference.
        prop_assume!(!matches!(function.shape(), Shape::Points | Shape::SigmoidDifference));
        places.sort_by(f64::total_cmp);
        let [low, middle, high] = places.map(|x| function.degree(x));
        // The rounding of a degree; that of a power is larger.
        prop_assert!(middle >= low.min(high) * (1.0 - 1e-12), "{low} {middle} {high}");
    }

    #[test]
    fn outside_its_vertices_a_function_is_0(function in function(), x in place()) {
        let vertices = function.parameters();
        if matches!(function.shape(), Shape::Triangular | Shape::Trapezoidal)
            && (x < vertices[0] || x > vertices[vertices.len() - 1])
        {
            prop_assert_eq!(function.degree(x), 0.0);
        }
    }
}
