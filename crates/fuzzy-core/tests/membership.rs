//! What every membership function is: a number from 0 to 1, and convex as a fuzzy set.

#![allow(clippy::unwrap_used)]

use fuzzy_core::{MembershipFunction, Shape};
use proptest::num::f64::{INFINITE, NEGATIVE, NORMAL, POSITIVE, ZERO};
use proptest::prelude::*;

/// Any valid function, of any size, with vertices that may coincide.
fn function() -> impl Strategy<Value = MembershipFunction> {
    let numbers = prop::array::uniform4(prop_oneof![-3.0..3.0, POSITIVE | NEGATIVE | NORMAL]);
    let shapes = prop::sample::select(Shape::ALL.to_vec());
    (shapes, numbers, any::<bool>()).prop_filter_map(
        "invalid",
        |(shape, mut numbers, repeat): (Shape, [f64; 4], bool)| {
            match shape {
                Shape::Gaussian | Shape::GaussianWidth => numbers[1] = numbers[1].abs(),
                _ => {
                    if repeat {
                        numbers[1] = numbers[0];
                    }
                    numbers[..shape.parameter_count()].sort_by(f64::total_cmp);
                }
            }
            MembershipFunction::new(shape, &numbers[..shape.parameter_count()]).ok()
        },
    )
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
        places.sort_by(f64::total_cmp);
        let [low, middle, high] = places.map(|x| function.degree(x));
        // The rounding of a degree.
        prop_assert!(middle >= low.min(high) * (1.0 - 4.0 * f64::EPSILON), "{low} {middle} {high}");
    }

    #[test]
    fn the_core_has_degree_1(function in function()) {
        let parameters = function.parameters();
        let core = match function.shape() {
            Shape::Gaussian | Shape::GaussianWidth => parameters[0],
            _ => parameters[1],
        };
        prop_assert!((function.degree(core) - 1.0).abs() <= 4.0 * f64::EPSILON);
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
