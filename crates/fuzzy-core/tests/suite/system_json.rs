//! Documents of rule systems: nothing that is read does harm.

use crate::common::random_rules as rules;
use allocation_counter::measure;
use fuzzy_core::{Result, System};
use proptest::prelude::*;
use proptest::sample::Index;

/// The most memory that a document may ask for, however small it is: a table of two million
/// degrees, twice while it is made, and its text.
const MOST: u64 = 100_000_000;

fn read(text: &str) -> Result<System> {
    let mut result = None;
    let used = measure(|| result = Some(System::from_json(text)));
    assert!(used.bytes_max <= MOST, "{} bytes for {} of text", used.bytes_max, text.len());
    result.unwrap()
}

/// What is put in place of a stretch of the text, besides single characters.
const PIECES: [&str; 16] = [
    "",
    "{",
    "]",
    ",",
    ":",
    "\"",
    "null",
    "-1",
    "1e400",
    "18446744073709551616",
    "99999",
    "[[]]",
    " and ",
    " is ",
    "(((",
    "if(",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn damaged_documents_do_no_harm(
        seed in 0..20_u64,
        damage in prop::collection::vec((any::<Index>(), any::<Index>(), any::<char>()), 1..4),
    ) {
        let mut text: Vec<char> = rules::system(seed).to_json().unwrap().chars().collect();
        for (start, length, character) in damage {
            let start = start.index(text.len() + 1);
            let end = (start + length.index(6)).min(text.len());
            match PIECES.get(length.index(PIECES.len() + 4)) {
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
}

#[test]
fn every_truncation_is_an_error() {
    let text = rules::system(3).to_json().unwrap();
    let text = text.trim_end();
    for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)) {
        assert!(read(&text[..end]).is_err(), "{}", &text[..end]);
    }
}

#[test]
fn tables_that_no_memory_holds_are_refused() {
    let text = rules::system(3).to_json().unwrap();
    for samples in ["1", "0", "100002", "18446744073709551615", "-1", "1.5"] {
        for (key, old) in [("samples", "41"), ("samples", "40")] {
            let (from, to) = (format!("\"{key}\": {old}"), format!("\"{key}\": {samples}"));
            if text.contains(&from) {
                assert!(read(&text.replace(&from, &to)).is_err(), "{samples}");
            }
        }
    }
    let rule =
        text.lines().find(|line| line.contains("\"if ")).unwrap().trim().trim_end_matches(',');
    let many = format!("{rule},\n").repeat(100_000);
    let text = text.replacen(rule, &format!("{many}{rule}"), 1);
    let wide = text.replace("\"samples\": 41", "\"samples\": 100000");
    let _ = read(&wide.replace("\"samples\": 40", "\"samples\": 100000"));
}
