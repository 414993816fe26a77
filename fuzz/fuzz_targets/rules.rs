//! Any text is rules or an error; a rule means the same when it is written and read again.

#![no_main]

use std::sync::LazyLock;

use fuzzy_core::{Rule, Vocabulary, parse_rules};
use libfuzzer_sys::fuzz_target;

static VOCABULARY: LazyLock<Vocabulary> = LazyLock::new(|| {
    let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let variable = |name: &str| (name.to_owned(), owned(&["low", "high", "very", "is", "a b"]));
    let inputs = ["x", "if", "room temperature"].map(variable).to_vec();
    let outputs = ["y", "a\"b"].map(variable).to_vec();
    Vocabulary::new(inputs, outputs, owned(&["very", "a bit"])).expect("the names differ")
});

fuzz_target!(|text: &str| {
    let Ok(rules) = parse_rules(text, &VOCABULARY) else { return };
    for rule in rules {
        VOCABULARY.check(&rule, 1).expect("a parsed rule fits its vocabulary");
        let again = Rule::parse(&rule.to_string(), &VOCABULARY, 1).expect("a rule's text is one");
        assert_eq!(again, rule);
    }
});
