//! Any text is a formula or an error; a formula means the same when it is written and read again,
//! and has the same bits alone and in lanes.

#![no_main]

use fuzzy_core::Expression;
use fuzzy_core::math::{LANES, Lanes};
use libfuzzer_sys::fuzz_target;

const NAMES: [&str; 2] = ["x", "room temperature"];
const POINTS: [[f64; 2]; LANES] = [
    [0.5, -1.5],
    [0.0, 1.0],
    [-0.0, 2.0],
    [1e300, -3.0],
    [1e-310, 0.0],
    [f64::INFINITY, 7.0],
    [f64::NAN, f64::NAN],
    [1e10, 0.1],
];

fuzz_target!(|text: &str| {
    let Ok(formula) = Expression::parse(text, &NAMES) else { return };
    let again = Expression::parse(formula.source(), &NAMES).expect("a formula's source is one");
    assert_eq!(again, formula);

    let lanes = [0, 1].map(|i| Lanes::new(POINTS.map(|point| point[i])));
    let lanes = formula.evaluate(&lanes).to_array();
    for (point, lane) in POINTS.iter().zip(lanes) {
        assert_eq!(formula.evaluate(point).to_bits(), lane.to_bits());
    }
    if let Some(form) = formula.affine() {
        assert!(form.len() == NAMES.len() + 1 && form.iter().all(|value| value.is_finite()));
    }
});
