//! Rules: any text ends in rules or an error, and what is written means what was written.

use std::sync::LazyLock;

use allocation_counter::measure;
use fuzzy_core::{
    Antecedent, Conclusion, Consequent, Expression, Result, Rule, Vocabulary, parse_rules,
};
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Names that need no quotes, and names that nobody should choose.
const INPUTS: [&str; 6] = ["food", "service", "room temperature", "if", "c'd", "größe"];
const OUTPUTS: [&str; 3] = ["tip", "With", "a\"b\\"];
const TERMS: [&str; 8] = ["low", "high", "very", "not", "IS", "1st", "a, b # c", "\\\"'"];
const HEDGES: [&str; 6] = ["very", "somewhat", "low", "a bit", "or", "\\"];
const FORMULAS: [&str; 8] = [
    "1",
    "-food ^ 2",
    "2*food + 'room temperature'",
    "if(if > 0, 1, \"c'd\")",
    "max(food, größe, 'c''d', 1e-3) < 0.5",
    "food # the best\n + service",
    "  sin ( pi )",
    "e",
];

static VOCABULARY: LazyLock<Vocabulary> = LazyLock::new(|| {
    let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let variables = |names: &[&str]| {
        names.iter().map(|&name| (name.to_owned(), owned(&TERMS))).collect::<Vec<_>>()
    };
    Vocabulary::new(variables(&INPUTS), variables(&OUTPUTS), owned(&HEDGES)).unwrap()
});

fn name(names: &'static [&'static str]) -> impl Strategy<Value = String> {
    select(names).prop_map(str::to_owned)
}

fn hedges() -> impl Strategy<Value = Vec<String>> {
    let hedge = prop_oneof![name(&HEDGES), Just("not".to_owned())];
    prop::collection::vec(hedge, 0..3)
}

fn antecedent() -> impl Strategy<Value = Antecedent> {
    let leaf = (name(&INPUTS), hedges(), name(&TERMS))
        .prop_map(|(variable, hedges, term)| Antecedent::Is { variable, hedges, term });
    leaf.prop_recursive(6, 20, 4, |inner| {
        let several = prop::collection::vec(inner.clone(), 2..5);
        let hedge = prop_oneof![name(&HEDGES), Just("not".to_owned())];
        prop_oneof![
            2 => several.clone().prop_map(Antecedent::And),
            2 => several.prop_map(Antecedent::Or),
            1 => inner.clone().prop_map(|of| Antecedent::Not(Box::new(of))),
            1 => (hedge, inner)
                .prop_map(|(hedge, of)| Antecedent::Hedged { hedge, of: Box::new(of) }),
        ]
    })
}

fn conclusion() -> impl Strategy<Value = Conclusion> {
    let term =
        (hedges(), name(&TERMS)).prop_map(|(hedges, term)| Consequent::Term { hedges, term });
    let formula = select(&FORMULAS[..])
        .prop_map(|text| Consequent::Formula(Expression::parse(text, &INPUTS).unwrap()));
    (name(&OUTPUTS), prop_oneof![term, formula])
        .prop_map(|(output, value)| Conclusion { output, value })
}

fn rule() -> impl Strategy<Value = Rule> {
    let weight = prop_oneof![Just(1.0), Just(0.0), Just(-0.0), Just(5e-324), 0.0..1.0];
    (antecedent(), prop::collection::vec(conclusion(), 1..4), weight)
        .prop_map(|(antecedent, conclusions, weight)| Rule { antecedent, conclusions, weight })
}

/// Reads rules that may be anything; those that are some must survive being written.
fn read(text: &str) -> Result<Vec<Rule>> {
    let rules = parse_rules(text, &VOCABULARY)?;
    for rule in &rules {
        assert_eq!(VOCABULARY.check(rule, 1), Ok(()));
        assert_eq!(&Rule::parse(&rule.to_string(), &VOCABULARY, 1).unwrap(), rule);
    }
    Ok(rules)
}

const PIECES: [&str; 40] = [
    "if",
    "then",
    "and",
    "or",
    "not",
    "is",
    "with",
    "very",
    "somewhat",
    "food",
    "service",
    "tip",
    "low",
    "high",
    "'room temperature'",
    "\"if\"",
    "(",
    ")",
    "=",
    ",",
    ";",
    "0.5",
    "2",
    "+",
    "-",
    "*",
    "^",
    "<",
    "#",
    "\n",
    "\n  ",
    "'",
    "\"",
    "\\",
    "sin(",
    "if(",
    "pi",
    "x",
    "ä",
    ".",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn any_text_ends_in_rules_or_an_error(text in any::<String>()) {
        let _ = read(&text);
    }

    #[test]
    fn any_words_end_in_rules_or_an_error(
        words in prop::collection::vec(select(&PIECES[..]), 0..24),
        gap in select(vec!["", " "]),
    ) {
        let _ = read(&words.join(gap));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6_000))]

    #[test]
    fn a_written_rule_is_read_as_it_was(rule in rule()) {
            prop_assert_eq!(VOCABULARY.check(&rule, 1), Ok(()));
        let text = rule.to_string();
        let parsed = Rule::parse(&text, &VOCABULARY, 1).unwrap();
        prop_assert_eq!(&parsed, &rule);
        prop_assert_eq!(parsed.to_string(), text);
    }

    #[test]
    fn damaged_rules_end_in_rules_or_an_error(
        rules in prop::collection::vec(rule(), 1..3),
        damage in prop::collection::vec((any::<Index>(), any::<Index>(), select(&PIECES[..])), 1..4),
    ) {
        let texts: Vec<String> = rules.iter().map(Rule::to_string).collect();
        let mut text: Vec<char> = texts.join("\n").chars().collect();
        for (start, length, piece) in damage {
            let start = start.index(text.len() + 1);
            let end = (start + length.index(6)).min(text.len());
            text.splice(start..end, piece.chars());
        }
        let _ = read(&text.into_iter().collect::<String>());
    }

    #[test]
    fn rules_on_several_lines_are_those_of_each_line(rules in prop::collection::vec(rule(), 0..4)) {
        let text: String = rules.iter().map(|rule| format!("{rule}  # why\n\n")).collect();
        prop_assert_eq!(read(&text).unwrap(), rules);
    }
}

#[test]
fn memory_grows_with_the_text_alone() {
    let begin = "if food is low then tip ";
    for text in [
        "(".repeat(1_000_000),
        "a".repeat(1_000_000),
        "if ".to_owned() + &"a".repeat(999_000),
        "'".repeat(1_000_000),
        "1e".repeat(500_000),
        "if ".repeat(300_000),
        "if\n".repeat(300_000),
        "if food is ".to_owned() + &"very ".repeat(199_000) + "low then tip is low",
        "if ".to_owned() + &"food is low or ".repeat(66_000) + "food is low then tip is low",
        format!("{begin}is low\n").repeat(30_000),
        format!("{begin}=1\n").repeat(35_000),
        begin.to_owned() + &"is low, tip ".repeat(80_000) + "is low",
        begin.to_owned() + "= " + &"(".repeat(900_000),
        begin.to_owned() + "= " + &"-".repeat(900_000),
        begin.to_owned() + "= " + &"1+".repeat(450_000),
    ] {
        let used = measure(|| drop(parse_rules(&text, &VOCABULARY)));
        let most = 100 * text.len() as u64;
        assert!(used.bytes_max <= most, "{} bytes for {}…", used.bytes_max, &text[..30]);
    }
}

#[test]
fn formulas_take_memory_for_their_text_alone() {
    for text in ["(".repeat(10_000), "1+".repeat(5_000), "-x".repeat(5_000), "x,".repeat(5_000)] {
        let used = measure(|| drop(Expression::parse(&text, &["x"])));
        assert!(used.bytes_max <= 150 * text.len() as u64, "{}", used.bytes_max);
    }
    let formula = Expression::parse("max(1, 2) + sin(x)^2 - if(x > 0, 1, 0)", &["x"]).unwrap();
    assert_eq!(measure(|| assert!(formula.evaluate(&[0.5]) > 1.0)).count_total, 0);
}
