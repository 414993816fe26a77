//! Formulas: any text ends in a formula or an error, and any formula is worth what it says.

use std::cell::Cell;

use fuzzy_core::Expression;
use fuzzy_core::math::{LANES, Lanes};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use proptest::test_runner::TestRunner;

const NAMES: [&str; 3] = ["x", "y", "room temperature"];

/// A formula as a tree, apart from the library.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Variable(usize),
    Minus(Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
    Call(&'static str, Vec<Tree>),
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (0..4_i32).prop_map(|value| Tree::Number(f64::from(value))),
        (0.0..5.0).prop_map(Tree::Number),
        (0..NAMES.len()).prop_map(Tree::Variable),
        (0..NAMES.len()).prop_map(Tree::Variable),
    ];
    leaf.prop_recursive(5, 24, 3, |inner| {
        let operators = vec!["+", "-", "*", "/", "^", "<", "<=", ">", ">="];
        let functions = vec!["abs", "sqrt", "exp", "ln", "sin", "cos", "tan", "sign"];
        let pair = (inner.clone(), inner.clone());
        let arguments = prop::collection::vec(inner.clone(), 2..4);
        prop_oneof![
            2 => inner.clone().prop_map(|of| Tree::Minus(Box::new(of))),
            9 => (select(operators), pair.clone())
                .prop_map(|(sign, (a, b))| Tree::Binary(sign, Box::new(a), Box::new(b))),
            4 => (select(functions), inner.clone())
                .prop_map(|(name, of)| Tree::Call(name, vec![of])),
            1 => pair.prop_map(|(a, b)| Tree::Call("atan2", vec![a, b])),
            2 => (select(vec!["min", "max"]), arguments)
                .prop_map(|(name, arguments)| Tree::Call(name, arguments)),
            1 => prop::array::uniform3(inner).prop_map(|all| Tree::Call("if", all.to_vec())),
        ]
    })
}

impl Tree {
    /// How strongly the tree's own operator binds.
    fn strength(&self) -> u8 {
        match self {
            Self::Binary("<" | "<=" | ">" | ">=", ..) => 0,
            Self::Binary("+" | "-", ..) => 1,
            Self::Binary("*" | "/", ..) => 2,
            Self::Minus(_) => 3,
            Self::Binary(..) => 4,
            Self::Number(_) | Self::Variable(_) | Self::Call(..) => 5,
        }
    }

    /// The text with as few parentheses as possible, in a place that wants such a strength.
    fn text(&self, least: u8) -> String {
        let text = match self {
            Self::Number(value) => format!("{value:?}"),
            Self::Variable(2) => format!("'{}'", NAMES[2]),
            Self::Variable(index) => NAMES[*index].to_owned(),
            Self::Minus(of) => format!("-{}", of.text(3)),
            Self::Binary(sign, a, b) => {
                let (left, right) = match self.strength() {
                    0 => (1, 1),
                    4 => (5, 3),
                    strength => (strength, strength + 1),
                };
                format!("{} {sign} {}", a.text(left), b.text(right))
            }
            Self::Call(name, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|a| a.text(0)).collect();
                format!("{name}({})", arguments.join(", "))
            }
        };
        if self.strength() < least { format!("({text})") } else { text }
    }

    /// The value with the standard library's functions, each result of which is off by a share of
    /// `error` upwards or downwards.
    fn value(&self, point: &[f64], error: f64, count: &mut u64) -> f64 {
        *count += 1;
        let up = (count.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 63) as f64;
        let inexact = |value: f64| value * (1.0 + error * (2.0 * up - 1.0));
        match self {
            Self::Number(value) => *value,
            Self::Variable(index) => point[*index],
            Self::Minus(of) => -of.value(point, error, count),
            Self::Binary(sign, a, b) => {
                let (a, b) = (a.value(point, error, count), b.value(point, error, count));
                match *sign {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    "^" => inexact(a.powf(b)),
                    "<" => f64::from(a < b),
                    "<=" => f64::from(a <= b),
                    ">" => f64::from(a > b),
                    _ => f64::from(a >= b),
                }
            }
            Self::Call(name, arguments) => {
                let values: Vec<f64> =
                    arguments.iter().map(|of| of.value(point, error, count)).collect();
                let x = values[0];
                let nan = values.iter().any(|value| value.is_nan());
                match *name {
                    "abs" => x.abs(),
                    "sqrt" => x.sqrt(),
                    "exp" => inexact(x.exp()),
                    "ln" => inexact(x.ln()),
                    "sin" => inexact(x.sin()),
                    "cos" => inexact(x.cos()),
                    "tan" => inexact(x.tan()),
                    "sign" if x == 0.0 || x.is_nan() => x,
                    "sign" => x.signum(),
                    "atan2" => inexact(x.atan2(values[1])),
                    "min" | "max" if nan => f64::NAN,
                    "min" => values.into_iter().fold(f64::INFINITY, f64::min),
                    "max" => values.into_iter().fold(f64::NEG_INFINITY, f64::max),
                    _ if x.is_nan() => x,
                    _ => values[if x == 0.0 { 2 } else { 1 }],
                }
            }
        }
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    let special = vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, 1e-310, -1e300];
    prop_oneof![
        8 => -5.0..5.0,
        4 => (-3..4_i32).prop_map(f64::from),
        1 => select(special),
    ]
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= tolerance * b.abs()
}

#[test]
fn formulas_are_worth_what_a_walk_along_the_tree_gives() {
    let points = prop::array::uniform8(prop::array::uniform3(coordinate()));
    let (kept, all) = (Cell::new(0), Cell::new(0));
    let test = |(tree, points): (Tree, [[f64; 3]; LANES])| {
        let formula = Expression::parse(&tree.text(0), &NAMES).unwrap();
        let lanes: [Lanes; 3] =
            std::array::from_fn(|i| Lanes::new(std::array::from_fn(|lane| points[lane][i])));
        let lanes = formula.evaluate(&lanes).to_array();
        for (point, lane) in points.iter().zip(lanes) {
            let value = formula.evaluate(point);
            prop_assert_eq!(value.to_bits(), lane.to_bits(), "{} {}", value, lane);

            let [expected, above, below] =
                [0.0, 1e-13, -1e-13].map(|error| tree.value(point, error, &mut 0));
            all.set(all.get() + 1);
            // Where the last digits of an intermediate result decide, nothing can be compared.
            if near(above, expected, 1e-10) && near(below, expected, 1e-10) {
                kept.set(kept.get() + 1);
                prop_assert!(near(value, expected, 1e-9), "{:?}: {} {}", point, value, expected);
            }
        }
        Ok(())
    };
    let mut runner = TestRunner::new(ProptestConfig::with_cases(10_000));
    runner.run(&(tree(), points), test).unwrap();
    assert!(kept.get() > all.get() * 9 / 10, "{} of {}", kept.get(), all.get());
}

/// Pieces that formulas are made of, and some that they are not.
const PIECES: [&str; 44] = [
    "x",
    "y",
    "'room temperature'",
    "\"",
    "'",
    "1",
    ".5",
    "1e-3",
    "1e999",
    "0",
    "+",
    "-",
    "*",
    "/",
    "^",
    "(",
    ")",
    ",",
    "<",
    "<=",
    ">",
    ">=",
    "=",
    "abs",
    "sqrt(",
    "exp(",
    "ln(",
    "sin(",
    "cos(",
    "tan(",
    "atan2(",
    "min(",
    "max(",
    "sign(",
    "if(",
    "pi",
    "e",
    " ",
    "\n",
    "#",
    ";",
    "ä",
    "\\",
    "and",
];

/// What a text means, checked for what every formula is: its source means the same, and its value
/// needs no more room than promised.
fn read(text: &str) -> bool {
    let Ok(formula) = Expression::parse(text, &NAMES) else { return false };
    formula.evaluate(&[1.5, -0.5, 3.0]);
    assert_eq!(Expression::parse(formula.source(), &NAMES).unwrap(), formula);
    if let Some(form) = formula.affine() {
        let expected = form[0] * 1.5 - form[1] * 0.5 + form[2] * 3.0 + form[3];
        let value = formula.evaluate(&[1.5, -0.5, 3.0]);
        // Variables that cancel out leave their rounding errors.
        let size: f64 = 3.0 + form.iter().map(|value| 3.0 * value.abs()).sum::<f64>();
        assert!((value - expected).abs() <= 1e-9 * size, "{text}: {value} {expected}");
    }
    true
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(15_000))]

    #[test]
    fn any_text_ends_in_a_formula_or_an_error(text in any::<String>()) {
        read(&text);
    }

    #[test]
    fn any_pieces_end_in_a_formula_or_an_error(
        pieces in prop::collection::vec(select(&PIECES[..]), 0..12),
    ) {
        read(&pieces.concat());
    }

    #[test]
    fn damaged_formulas_end_in_a_formula_or_an_error(
        tree in tree(),
        damage in prop::collection::vec((any::<Index>(), any::<Index>(), select(&PIECES[..])), 1..3),
    ) {
        let mut text: Vec<char> = tree.text(0).chars().collect();
        for (start, length, piece) in damage {
            let start = start.index(text.len() + 1);
            let end = (start + length.index(4)).min(text.len());
            text.splice(start..end, piece.chars());
        }
        read(&text.into_iter().collect::<String>());
    }
}

#[test]
fn pieces_often_make_a_formula() {
    let made = Cell::new(0);
    let mut runner = TestRunner::new(ProptestConfig::with_cases(2000));
    let pieces = prop::collection::vec(select(&PIECES[..]), 1..6);
    let count = |pieces: Vec<&str>| {
        made.set(made.get() + u32::from(read(&pieces.concat())));
        Ok(())
    };
    runner.run(&pieces, count).unwrap();
    assert!(made.get() > 40, "{}", made.get());
}
