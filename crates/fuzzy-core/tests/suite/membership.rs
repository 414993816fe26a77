//! What every membership function is: a number from 0 to 1, with derivatives that differences
//! confirm, and with a support, a core and an inverse that samples confirm.

use crate::common;
#[allow(dead_code)]
use crate::common::kinks;
use fuzzy_core::membership::ParameterKind;
use fuzzy_core::{MembershipFunction, Shape, Universe};
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

/// The step of differences: large against rounding, small against curvature.
const STEP: f64 = 1e-5;
/// How far from a kink a place has to be: beside the end of an ellipse curvature is large.
const CLEAR: f64 = 0.02;

fn universe() -> impl Strategy<Value = Universe> {
    (-3.0..3.0, 0.1..5.0).prop_map(|(low, size)| Universe::new(low, low + size).unwrap())
}

fn is_pair(shape: Shape) -> bool {
    matches!(shape, Shape::SigmoidDifference | Shape::SigmoidProduct)
}

/// Whether a degree of 1 is only that of rounding.
fn is_pair_or_sigmoid(shape: Shape) -> bool {
    is_pair(shape) || shape == Shape::Sigmoid
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
        if matches!(function.shape(), Shape::Points | Shape::SigmoidDifference) {
            return Ok(());
        }
        places.sort_by(f64::total_cmp);
        let [low, middle, high] = places.map(|x| function.degree(x));
        // The rounding of a degree; that of a power is larger.
        prop_assert!(middle >= low.min(high) * (1.0 - 1e-12), "{low} {middle} {high}");
    }

    #[test]
    fn derivatives_are_finite_everywhere(function in function(), x in place()) {
        let gradient = function.gradient(x);
        prop_assert!(gradient.iter().all(|slope| slope.is_finite()), "{gradient:?}");
        prop_assert!(function.slope(x).is_finite());
    }

    #[test]
    fn what_is_no_number_has_no_degree(function in function()) {
        prop_assert!(function.degree(f64::NAN).is_nan());
        prop_assert!(function.slope(f64::NAN).is_nan());
        prop_assert!(function.gradient(f64::NAN).iter().all(|slope| slope.is_nan()));
    }

    #[test]
    fn derivatives_agree_with_central_differences(
        function in common::function(),
        x in -3.0..5.0,
    ) {
        prop_assume!(kinks::distance_to_kinks(&function, x) > CLEAR);
        let agrees = |ours: f64, theirs: f64| (ours - theirs).abs() <= 1e-5 * (1.0 + ours.abs());
        let slope = (function.degree(x + STEP) - function.degree(x - STEP)) / (2.0 * STEP);
        prop_assert!(agrees(function.slope(x), slope), "{} {slope}", function.slope(x));
        for (index, ours) in function.gradient(x).into_iter().enumerate() {
            let moved = |step: f64| {
                let mut parameters = function.parameters().to_vec();
                parameters[index] += step;
                MembershipFunction::new(function.shape(), &parameters).unwrap().degree(x)
            };
            let theirs = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
            prop_assert!(agrees(ours, theirs), "{index}: {ours} {theirs}");
        }
    }

    #[test]
    fn the_inverse_leads_back(function in common::function(), x in -3.0..5.0) {
        let degree = function.degree(x);
        let Some(back) = function.inverse(degree) else {
            prop_assert!(!function.shape().is_monotone());
            return Ok(());
        };
        prop_assert!((function.degree(back) - degree).abs() <= 1e-14);
        if degree > 0.001 && degree < 0.999 {
            prop_assert!((back - x).abs() <= 1e-12, "{back} {x}");
        }
    }

    #[test]
    fn only_the_support_has_degrees_above_0(
        function in common::function(),
        universe in universe(),
        shares in prop::array::uniform32(0.0..=1.0),
    ) {
        let support = function.support(universe);
        let (low, high) = support.unwrap_or((f64::NAN, f64::NAN));
        let size = universe.high() - universe.low();
        for x in shares.map(|share| universe.low() + share * size) {
            prop_assert!(function.degree(x) == 0.0 || (low <= x && x <= high), "{x} {support:?}");
        }
        if support.is_some() {
            prop_assert!(universe.low() <= low && low <= high && high <= universe.high());
        }
        if low > universe.low() || high < universe.high() {
            // Else a tail may be 0 by rounding.
            let near = 1e-6 * (high - low);
            prop_assert!(function.degree(low + near) > 0.0 && function.degree(high - near) > 0.0);
        }
    }

    #[test]
    fn the_core_has_degree_1_and_the_centre_the_greatest(
        function in common::function(),
        universe in universe(),
        shares in prop::array::uniform32(0.0..=1.0),
    ) {
        let centre = function.centre(universe);
        prop_assert!(universe.low() <= centre && centre <= universe.high());
        let core = function.core(universe);
        if let Some((low, high)) = core {
            prop_assert!(universe.low() <= low && low <= high && high <= universe.high());
            for x in [low, high] {
                prop_assert!(function.degree(x) >= 1.0 - 2.0 * f64::EPSILON, "{core:?}");
            }
            prop_assert_eq!(centre, 0.5 * low + 0.5 * high);
        }
        let size = universe.high() - universe.low();
        let (low, high) = core.unwrap_or((f64::NAN, f64::NAN));
        for x in shares.map(|share| universe.low() + share * size) {
            let outside = !(low - CLEAR < x && x < high + CLEAR);
            let reaches = function.degree(x) == 1.0 && !is_pair_or_sigmoid(function.shape());
            prop_assert!(!(outside && reaches), "{x} {core:?}");
            // Points may have two tops, and sigmoids of unlike steepness are no peak.
            if !matches!(function.shape(), Shape::Points) && !is_pair(function.shape()) {
                prop_assert!(function.degree(x) <= function.degree(centre) + 1e-15, "{x} {centre}");
            }
        }
    }

    #[test]
    fn the_corners_are_the_function(function in common::function(), x in -3.0..5.0) {
        let Some(corners) = function.vertices() else {
            prop_assert!(!function.shape().is_piecewise_linear());
            return Ok(());
        };
        prop_assert!(corners.is_sorted_by(|first, second| first.0 <= second.0));
        for &(x, degree) in &corners {
            prop_assert!(function.degree(x) >= degree);
        }
        let next = corners.iter().position(|corner| corner.0 > x);
        let expected = match next {
            Some(0) => corners[0].1,
            None => corners[corners.len() - 1].1,
            Some(next) => {
                let (x0, y0) = corners[next - 1];
                let (x1, y1) = corners[next];
                y0 + (y1 - y0) * (x - x0) / (x1 - x0)
            }
        };
        prop_assert!((function.degree(x) - expected).abs() <= 1e-13);
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
