//! JSON documents: what is written is read to the bit, and nothing that is read does harm.

use crate::common;
use allocation_counter::measure;
use fuzzy_core::{Inference, NoRuleFires, Result, Tsk};
use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
use proptest::prelude::*;
use proptest::sample::Index;

/// Reads a document that may be anything, and checks that it took memory in proportion to it.
fn read(text: &str) -> Result<Tsk> {
    let mut result = None;
    let used = measure(|| result = Some(Tsk::from_json(text)));
    // Numbers of two characters become 8 bytes, in vectors that double; messages come on top.
    let most = 64 * text.len() as u64 + 10_000;
    assert!(used.bytes_max <= most, "{} bytes for {} of text", used.bytes_max, text.len());
    result.unwrap()
}

/// A valid document to damage.
fn document() -> String {
    use fuzzy_core::{MembershipFunction, Variable};
    let x = Variable::new("x", -1.0, 1.0)
        .unwrap()
        .with_term("low", MembershipFunction::triangular(-1.0, -1.0, 1.0).unwrap())
        .unwrap()
        .with_term("high", MembershipFunction::gaussian(1.0, 0.5).unwrap())
        .unwrap();
    Tsk::zero_order("s", vec![x], vec![0.25, -0.5]).unwrap().to_json().unwrap()
}

fn finite() -> impl Strategy<Value = f64> {
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

fn answer() -> impl Strategy<Value = NoRuleFires> {
    prop_oneof![
        Just(NoRuleFires::Error),
        Just(NoRuleFires::Nan),
        finite().prop_map(NoRuleFires::Value),
    ]
}

proptest! {
    #[test]
    fn every_system_survives_the_round_trip_to_the_bit(
        system in common::system(),
        answer in answer(),
        values in prop::collection::vec(finite(), 108),
        output in "[^.\n]{0,20}[a-z]",
    ) {
        // Consequents of any size: 3³ rules of order 1 have 108.
        let mut parameters = system.parameters().to_vec();
        let first = system.grid().first_consequent();
        parameters[first..].iter_mut().zip(values).for_each(|(p, value)| *p = value);
        let system = system
            .with_parameters(&parameters).unwrap()
            .with_output(&output).unwrap()
            .when_no_rule_fires(answer).unwrap();
        let back = read(&system.to_json().unwrap()).unwrap();
        let bits = |system: &Tsk| system.parameters().iter().map(|p| p.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&back), bits(&system));
        prop_assert_eq!(back, system);
    }

    #[test]
    fn garbage_is_an_error(text in any::<String>()) {
        prop_assert!(read(&text).is_err());
    }

    #[test]
    fn damaged_documents_do_no_harm(
        damage in prop::collection::vec((any::<Index>(), any::<Index>(), any::<char>()), 1..6),
    ) {
        // What is put in place of a stretch of the text: nothing, a piece of JSON, or a character.
        const PIECES: [&str; 12] =
            ["", "{", "[", "]", ",", ":", "\"", "null", "-1", "1e400", "18446744073709551616", "[[]]"];
        let mut text: Vec<char> = document().chars().collect();
        for (start, length, character) in damage {
            let start = start.index(text.len() + 1);
            let end = (start + length.index(12)).min(text.len());
            let piece = length.index(PIECES.len() + 1);
            match PIECES.get(piece) {
                Some(piece) => text.splice(start..end, piece.chars()).for_each(drop),
                None => text.splice(start..end, [character]).for_each(drop),
            }
        }
        let text: String = text.into_iter().collect();
        // A change may leave a valid document, which must then survive the round trip.
        if let Ok(system) = read(&text) {
            prop_assert_eq!(read(&system.to_json().unwrap()).unwrap(), system);
        }
    }

    #[test]
    fn truncated_documents_are_errors(system in common::system(), end in any::<Index>()) {
        let text = system.to_json().unwrap();
        let end = end.index(text.trim_end().len());
        prop_assert!(read(&text[..end]).is_err());
    }
}

/// The message for a document in which one piece is replaced; it must be there.
fn message(piece: &str, replacement: &str) -> String {
    let text = document();
    assert!(text.contains(piece), "{piece} is not in {text}");
    read(&text.replacen(piece, replacement, 1)).unwrap_err().to_string()
}

#[test]
fn numbers_out_of_range_are_refused() {
    for number in ["1e400", "-1e400", "NaN", "Infinity", "1e999999999999", "\"0.25\"", "null"] {
        let message = message("0.25", number);
        assert!(message.contains("not a valid fuzzyrs JSON document"), "{number}: {message}");
    }
    assert!(message("\"version\": 1", "\"version\": 18446744073709551616").contains("version"));
    assert!(message("\"version\": 1", "\"version\": 1.5").contains("version"));
    assert!(message("\"order\": 0", "\"order\": 256").contains("256"));
}

#[test]
fn deep_nesting_is_refused() {
    let deep = "[".repeat(1_000_000);
    for text in [deep.clone(), "{\"a\":".repeat(1_000_000), deep.clone() + &"]".repeat(1_000_000)] {
        assert!(read(&text).is_err());
    }
    for value in ["0.25", "1,", "\"low\"", "\"error\""] {
        message(value, &deep);
    }
    // The first look, at the header, skips what it doesn't know.
    message("\"name\"", &format!("\"extra\": {deep}, \"name\""));
    message("\"name\"", &format!("\"extra\": {deep}{}, \"name\"", "]".repeat(deep.len())));
}

#[test]
fn huge_counts_are_refused() {
    let terms: Vec<String> = (0..1000)
        .map(|i| format!(r#"{{"name": "t{i}", "shape": "gaussian", "parameters": [0, 1]}}"#))
        .collect();
    let document = |inputs: usize, terms: &[String]| {
        let terms = terms.join(",");
        let input = |i| format!(r#"{{"name": "x{i}", "universe": [0, 1], "terms": [{terms}]}}"#);
        let inputs: Vec<String> = (0..inputs).map(input).collect();
        format!(
            r#"{{"format": "fuzzyrs", "version": 1, "type": "tsk", "name": "s", "inputs": [{}],
                "output": "y", "order": 1, "no_rule_fires": "nan", "consequents": [1, 2]}}"#,
            inputs.join(",")
        )
    };
    // 10⁹ rules, 2⁹⁰ rules.
    let many = read(&document(3, &terms)).unwrap_err().to_string();
    assert!(many.contains("expected 4000000000, got 2"), "{many}");
    let uncountable = read(&document(90, &terms[..2])).unwrap_err().to_string();
    assert!(uncountable.contains("too many"), "{uncountable}");
    assert!(read(&document(1, &terms[..1])).is_ok());
}

#[test]
fn repeated_fields_and_wrong_types_are_refused() {
    assert!(message("\"name\"", "\"name\": \"t\", \"name\"").contains("duplicate field"));
    assert!(message("\"order\": 0", "\"order\": 0, \"order\": 1").contains("duplicate field"));
    for wrong in ["7", "[]", "{}", "null", "true"] {
        message("\"s\"", wrong);
        message("\"triangular\"", wrong);
        message("\"low\"", wrong);
    }
    for wrong in ["{}", "\"0\"", "-1", "0.5", "null"] {
        message("\"order\": 0", &format!("\"order\": {wrong}"));
    }
    for wrong in ["\"Error\"", "{\"value\": 1e400}", "{\"value\": 1, \"error\": null}", "{}"] {
        message("\"error\"", wrong);
    }
}
