//! What formulas are worth, and what is said about texts that are none.

use super::*;
use crate::math::Lanes;

const NAMES: [&str; 3] = ["x", "y", "room temperature"];

fn value_at(text: &str, point: &[f64]) -> f64 {
    let formula = Expression::parse(text, &NAMES).unwrap();
    let value = formula.evaluate(point);
    let lanes: Vec<Lanes> = point.iter().map(|&x| Lanes::splat(x)).collect();
    let lane = formula.evaluate(&lanes).to_array()[3];
    assert_eq!(lane.to_bits(), value.to_bits(), "{text}: {lane} {value}");
    value
}

fn value(text: &str) -> f64 {
    value_at(text, &[2.0, 3.0, 5.0])
}

#[test]
fn operators_bind_as_in_mathematics() {
    let cases = [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("7 - 2 - 1", 4.0),
        ("12 / 3 / 2", 2.0),
        ("2 ^ 3 ^ 2", 512.0),
        ("-3 ^ 2", -9.0),
        ("(-3) ^ 2", 9.0),
        ("2 ^ -1", 0.5),
        ("2 ^ -1 ^ 2", 0.5),
        ("--3", 3.0),
        ("2 - -3", 5.0),
        ("2 * -3", -6.0),
        ("-2 * 3 + 1", -5.0),
        ("1 + 1 < 3", 1.0),
        ("3 <= 2 + 1", 1.0),
        ("(1 < 2) + (2 > 1) + (1 >= 2)", 2.0),
        ("x*y + 'room temperature'", 11.0),
        ("\"room temperature\"^2", 25.0),
    ];
    for (text, expected) in cases {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn functions_do_what_their_names_say() {
    let cases = [
        ("abs(-x)", 2.0),
        ("sqrt(16)", 4.0),
        ("exp(0)", 1.0),
        ("ln(e)", 1.0),
        ("sin(pi / 6)", 0.5),
        ("cos(pi / 3)", 0.5),
        ("tan(pi / 4)", 1.0),
        ("atan2(1, -1)", 0.75 * std::f64::consts::PI),
        ("min(3, 1)", 1.0),
        ("max(3, 1, x, 7, y)", 7.0),
        ("sign(-y) + 10*sign(x) + 100*sign(0)", 9.0),
        ("if(x > y, 1, 2)", 2.0),
        ("if(-0.5, 1, 2)", 1.0),
    ];
    for (text, expected) in cases {
        assert!((value(text) - expected).abs() < 1e-15, "{text}: {}", value(text));
    }
}

#[test]
fn nothing_hides_what_is_no_number() {
    let cases = [
        ("1/0", f64::INFINITY),
        ("-1/0", f64::NEG_INFINITY),
        ("ln(0)", f64::NEG_INFINITY),
        ("0^0", 1.0),
        ("0^-1", f64::INFINITY),
        ("exp(1000)", f64::INFINITY),
        ("exp(-1000)", 0.0),
        ("(-2)^3", -8.0),
        ("(-8)^(1/3)", f64::NAN),
        ("sqrt(-1)", f64::NAN),
        ("ln(-1)", f64::NAN),
        ("0/0", f64::NAN),
        ("sin(1/0)", f64::NAN),
        ("min(1, x)", f64::NAN),
        ("min(x, 1)", f64::NAN),
        ("max(1, x)", f64::NAN),
        ("max(x, 1)", f64::NAN),
        ("sign(x)", f64::NAN),
        ("abs(x)", f64::NAN),
        ("if(x, 1, 2)", f64::NAN),
        ("if(1, 2, x)", 2.0),
        ("if(0, x, 2)", 2.0),
        ("x < 1", 0.0),
        ("x >= 1", 0.0),
    ];
    for (text, expected) in cases {
        let value = value_at(text, &[f64::NAN, 1.0, 1.0]);
        assert!(value == expected || value.is_nan() && expected.is_nan(), "{text}: {value}");
    }
    assert!(value_at("x + 'room temperature'", &[1.0]).is_nan());
    for text in ["x", "-x", "abs(x) + x"] {
        let value = value_at(text, &[f64::from_bits(0xFFF8_0000_0000_1234)]);
        assert_eq!(value.to_bits(), f64::NAN.to_bits());
    }
}

#[test]
fn variables_hide_constants_but_not_functions() {
    let formula = Expression::parse("e + sin(sin) + if", &["e", "sin", "if"]).unwrap();
    assert_eq!(formula.evaluate(&[1.0, 0.0, 3.0]), 4.0);
    assert_eq!(formula.variable_count(), 3);
}

#[test]
fn the_source_is_the_text_on_one_line() {
    let formula = Expression::parse("  2*x\n  +\t'room temperature' # why\n", &NAMES).unwrap();
    assert_eq!(formula.source(), "2*x + 'room temperature'");
    assert_eq!(Expression::parse(formula.source(), &NAMES).unwrap(), formula);
}

#[test]
fn mistakes_are_placed_and_corrected() {
    let cases = [
        ("2*sine(x)", "column 3: unknown function \"sine\"; did you mean \"sin\"?"),
        (
            "äö + x",
            "column 1: unknown name \"äö\"; known: x, y, room temperature, pi, e, abs, sqrt, exp, ln, sin, cos, tan, atan2, min, max, sign, if",
        ),
        (
            "'größe'*x + 'room temprature'",
            "column 1: unknown variable \"größe\"; known: x, y, room temperature",
        ),
        (
            "x + 'room temprature'",
            "column 5: unknown variable \"room temprature\"; did you mean \"room temperature\"?",
        ),
        ("sqr + 1", "column 1: unknown name \"sqr\"; did you mean \"sqrt\"?"),
        ("sin x", "column 5: expected \"(\" after \"sin\", found \"x\""),
        ("x(1)", "column 2: expected an operator or the end, found \"(\""),
        ("2 x", "column 3: expected an operator or the end, found \"x\""),
        ("(1 + 2", "column 7: expected an operator or \")\", found the end"),
        ("1 + 2)", "column 6: expected an operator or the end, found \")\""),
        ("1 +", "column 4: expected a number, a name or \"(\", found the end"),
        ("* 2", "column 1: expected a number, a name or \"(\", found \"*\""),
        ("", "column 1: expected a number, a name or \"(\", found the end"),
        ("sin()", "column 5: expected a number, a name or \"(\", found \")\""),
        ("1 < x < 2", "column 7: comparisons cannot be chained; use parentheses"),
        ("1 + atan2(1)", "column 5: \"atan2\" takes 2 numbers, got 1"),
        ("sin(1, 2)", "column 1: \"sin\" takes 1 number, got 2"),
        ("if(1, 2, 3, 4)", "column 1: \"if\" takes 3 numbers, got 4"),
        ("min(1)", "column 1: \"min\" takes at least 2 numbers, got 1"),
        ("x @ 2", "column 3: unexpected character '@'"),
        ("x = 2", "column 3: expected an operator or the end, found \"=\""),
        ("1e400", "column 1: the number 1e400 is too large"),
        ("'x", "column 1: the quoted name does not end"),
    ];
    for (text, expected) in cases {
        let message = Expression::parse(text, &NAMES).unwrap_err().to_string();
        assert_eq!(message, format!("formula, {expected}"), "{text}");
    }
}

#[test]
fn nesting_is_bounded() {
    let nested = |open: &str, count: usize, close: &str| {
        format!("{}1{}", open.repeat(count), close.repeat(count))
    };
    for (open, close) in [("(", ")"), ("-", ""), ("x^", ""), ("sin(", ")"), ("2^-", "")] {
        let levels = open.matches(['(', '-', '^']).count();
        let fits = nested(open, MAX_NESTING / levels - 1, close);
        assert!(Expression::parse(&fits, &NAMES).is_ok(), "{fits}");
        let long = 9_999 / (open.len() + close.len());
        for count in [MAX_NESTING + 1, long] {
            let error = Expression::parse(&nested(open, count, close), &NAMES).unwrap_err();
            assert!(error.to_string().contains("nested more than 64 levels deep"), "{error}");
        }
    }
    // Each level keeps three results here.
    let keeps = |innermost: &str| nested("1 < 1 + 2*(", 21, ")").replacen("(1)", innermost, 1);
    assert!(Expression::parse(&keeps("1"), &NAMES).is_ok());
    assert!(Expression::parse(&keeps("(1 + 1)"), &NAMES).is_err());
    for levels in 0..MAX_NESTING {
        assert_eq!(value(&nested("1 + (", levels, ")")), levels as f64 + 1.0);
    }
}

#[test]
fn texts_are_bounded() {
    let text = "1+".repeat(MAX_CHARACTERS / 2);
    assert!(Expression::parse(&(text.clone() + "1"), &NAMES).is_err());
    assert!(Expression::parse(&text[2..], &NAMES).is_err());
    assert_eq!(value(&(text[2..].to_owned() + "1")), MAX_CHARACTERS as f64 / 2.0);
}

#[test]
fn weighted_sums_are_recognised() {
    let cases: [(&str, Option<[f64; 4]>); 20] = [
        ("3", Some([0.0, 0.0, 0.0, 3.0])),
        ("-x", Some([-1.0, 0.0, 0.0, 0.0])),
        ("2*(x - 3*y)/4 + 'room temperature' - (1 - 2^3)", Some([0.5, -1.5, 1.0, 7.0])),
        ("x*sin(0) + 1", Some([0.0, 0.0, 0.0, 1.0])),
        ("x - x", Some([0.0, 0.0, 0.0, 0.0])),
        ("(x - x)*y", Some([0.0, 0.0, 0.0, 0.0])),
        ("x^1 + y^0", Some([1.0, 0.0, 0.0, 1.0])),
        ("if(1 < 2, x, y*y)", Some([1.0, 0.0, 0.0, 0.0])),
        ("if(1 > 2, x*x, y)", Some([0.0, 1.0, 0.0, 0.0])),
        ("max(1, 2)*x", Some([2.0, 0.0, 0.0, 0.0])),
        ("1/(1/0)*x", Some([0.0, 0.0, 0.0, 0.0])),
        ("x*y", None),
        ("2/x", None),
        ("x^2", None),
        ("abs(x)", None),
        ("min(x, 1)", None),
        ("if(x, 1, 2)", None),
        ("x < 1", None),
        ("x/0", None),
        ("if(0/0, x, y)", None),
    ];
    for (text, expected) in cases {
        let form = Expression::parse(text, &NAMES).unwrap().affine();
        assert_eq!(form, expected.map(|form| form.to_vec()), "{text}");
    }
}
