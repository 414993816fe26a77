//! What rules mean, and what is said about those that mean nothing.

use super::*;

fn vocabulary() -> Vocabulary {
    let variable = |name: &str, terms: &[&str]| {
        (name.to_owned(), terms.iter().map(|&term| term.to_owned()).collect())
    };
    Vocabulary::new(
        vec![
            variable("food", &["rancid", "delicious"]),
            variable("service", &["poor", "good", "very"]),
            variable("room temperature", &["low"]),
        ],
        vec![variable("tip", &["cheap", "generous"]), variable("mood", &[])],
        ["very", "somewhat", "a bit"].map(str::to_owned).to_vec(),
    )
    .unwrap()
}

fn antecedent(text: &str) -> Antecedent {
    let text = format!("if {text} then tip is cheap");
    Rule::parse(&text, &vocabulary(), 1).unwrap().antecedent
}

fn is(variable: &str, hedges: &[&str], term: &str) -> Antecedent {
    let hedges = hedges.iter().map(|&hedge| hedge.to_owned()).collect();
    Antecedent::Is { variable: variable.to_owned(), hedges, term: term.to_owned() }
}

#[test]
fn or_binds_weaker_than_and_weaker_than_not() {
    let [a, b, c] =
        [is("food", &[], "rancid"), is("service", &[], "poor"), is("room temperature", &[], "low")];
    let text = "food is rancid or service is poor and 'room temperature' is low";
    let expected = Antecedent::Or(vec![a.clone(), Antecedent::And(vec![b.clone(), c.clone()])]);
    assert_eq!(antecedent(text), expected);
    let text = "(food is rancid or service is poor) and not 'room temperature' is low";
    let not = Antecedent::Not(Box::new(c.clone()));
    let either = Antecedent::Or(vec![a.clone(), b.clone()]);
    assert_eq!(antecedent(text), Antecedent::And(vec![either, not]));
    let text = "not very (food is rancid and service is poor) or 'room temperature' is low";
    let both = Box::new(Antecedent::And(vec![a, b]));
    let very = Antecedent::Hedged { hedge: "very".to_owned(), of: both };
    assert_eq!(antecedent(text), Antecedent::Or(vec![Antecedent::Not(Box::new(very)), c]));
}

#[test]
fn parentheses_are_kept() {
    let [a, b, c] = ["rancid", "delicious", "rancid"].map(|term| is("food", &[], term));
    let text = "food is rancid and (food is delicious and food is rancid)";
    let inner = Antecedent::And(vec![b.clone(), c.clone()]);
    assert_eq!(antecedent(text), Antecedent::And(vec![a.clone(), inner]));
    let text = "(food is rancid and ((food is delicious))) and food is rancid";
    let inner = Antecedent::And(vec![a.clone(), b.clone()]);
    assert_eq!(antecedent(text), Antecedent::And(vec![inner, c.clone()]));
    let text = "food is rancid and food is delicious and food is rancid";
    assert_eq!(antecedent(text), Antecedent::And(vec![a, b, c]));
}

#[test]
fn the_last_name_is_the_term() {
    assert_eq!(antecedent("service is very"), is("service", &[], "very"));
    assert_eq!(antecedent("service is not very"), is("service", &["not"], "very"));
    assert_eq!(
        antecedent("service IS very NOT 'a bit' very very"),
        is("service", &["very", "not", "a bit", "very"], "very")
    );
}

#[test]
fn conclusions_have_terms_or_formulas() {
    let text = "if food is rancid then tip is not very cheap, mood = if(food > 1, 2*food, \
                'room temperature')\t and mood = -1 with .25 ; # why";
    let rule = Rule::parse(text, &vocabulary(), 1).unwrap();
    assert_eq!(rule.weight, 0.25);
    assert_eq!(
        rule.to_string(),
        "if food is rancid then tip is not very cheap \
         and mood = if(food > 1, 2*food, 'room temperature') and mood = -1 with 0.25"
    );
    let Consequent::Formula(formula) = &rule.conclusions[1].value else { panic!() };
    assert_eq!(formula.evaluate(&[0.5, 0.0, 7.0]), 7.0);
}

fn message(text: &str) -> String {
    Rule::parse(text, &vocabulary(), 1).unwrap_err().to_string()
}

#[test]
fn mistakes_are_placed_and_corrected() {
    let cases = [
        (
            "if food is rancd then tip is cheap",
            "column 12: unknown term \"rancd\" of \"food\"; did you mean \"rancid\"?",
        ),
        (
            "if food is rancid than tip is cheap",
            "column 19: expected \"then\", found \"than\"; did you mean \"then\"?",
        ),
        (
            "if food is rancid Adn food is rancid",
            "column 19: expected \"and\", found \"Adn\"; did you mean \"and\"?",
        ),
        (
            "if tip is cheap then tip is cheap",
            "column 4: \"tip\" is an output; an antecedent needs an input",
        ),
        (
            "if food is rancid then food is rancid",
            "column 24: \"food\" is an input; a conclusion needs an output",
        ),
        (
            "if fod is rancid then tip is cheap",
            "column 4: unknown input \"fod\"; did you mean \"food\"?",
        ),
        (
            "if food si rancid then tip is cheap",
            "column 9: expected \"is\", found \"si\"; did you mean \"is\"?",
        ),
        (
            "if food is vrey rancid then tip is cheap",
            "column 12: unknown hedge \"vrey\"; did you mean \"very\"?",
        ),
        (
            "if vrey (food is rancid) then tip is cheap",
            "column 4: unknown hedge \"vrey\"; did you mean \"very\"?",
        ),
        ("if food (is rancid) then tip is cheap", "column 9: expected \"is\", found \"(\""),
        (
            "if food is rancid service is poor then tip is cheap",
            "column 19: expected \"and\", \"or\" or \"then\", found \"service\"",
        ),
        (
            "if (food is rancid then tip is cheap",
            "column 20: expected \"and\", \"or\" or \")\", found \"then\"",
        ),
        (
            "if food is rancid) then tip is cheap",
            "column 18: expected \"and\", \"or\" or \"then\", found \")\"",
        ),
        ("if food is then tip is cheap", "column 12: expected a term of \"food\", found \"then\""),
        (
            "if food is rancid then tip is cheap wiht 0.5",
            "column 37: expected \"with\", found \"wiht\"; did you mean \"with\"?",
        ),
        (
            "if food is rancid then tip is cheap with 1.5",
            "column 42: the weight must be between 0 and 1, got 1.5",
        ),
        (
            "if food is rancid then tip is cheap with -1",
            "column 42: expected a weight between 0 and 1, found \"-\"",
        ),
        (
            "if food is rancid then tip = 2 * fod",
            "column 34: unknown name \"fod\"; did you mean \"food\"?",
        ),
        (
            "if food is rancid then tip = 2 food",
            "column 32: expected \"and\", \",\", \"with\" or the end of the rule, found \"food\"",
        ),
        (
            "if food is rancid then mood is low",
            "column 32: unknown term \"low\" of \"mood\"; none is defined",
        ),
        ("if food is rancid then", "column 23: expected an output, found the end"),
        ("if food is rancid then tip", "column 27: expected \"is\" or \"=\", found the end"),
        ("if 'größe is rancid", "column 4: the quoted name does not end"),
        ("if food & food is rancid", "column 9: unexpected character '&'"),
        ("fi food is rancid", "column 1: expected \"if\", found \"fi\"; did you mean \"if\"?"),
        ("", "column 1: expected \"if\", found the end"),
    ];
    for (text, expected) in cases {
        assert_eq!(message(text), format!("rule 1, {expected}"), "{text}");
    }
}

#[test]
fn columns_count_characters() {
    let message = message("if \"room temperature\" is low and größe is small then tip is cheap");
    assert!(message.starts_with("rule 1, column 34: unknown input \"größe\""), "{message}");
}

#[test]
fn rules_begin_with_if_or_without_indentation() {
    let text = "
        # A comment, a blank line, and two rules on five lines.

        if food is rancid
            and service is poor # worst
        then tip is cheap;
        If ('room temperature' is low or
    food is delicious
    ) then mood = (2 *
if(food > 1, 1, 2)) with 0.5
if food is rancid then tip is cheap";
    let rules = parse_rules(text, &vocabulary()).unwrap();
    let texts: Vec<String> = rules.iter().map(Rule::to_string).collect();
    assert_eq!(
        texts,
        [
            "if food is rancid and service is poor then tip is cheap",
            "if \"room temperature\" is low or food is delicious \
             then mood = (2 * if(food > 1, 1, 2)) with 0.5",
            "if food is rancid then tip is cheap",
        ]
    );
    assert_eq!(parse_rules(" \n # nothing\n", &vocabulary()).unwrap(), []);
}

#[test]
fn mistakes_in_a_text_have_a_line() {
    let text = "\nif food is rancid then tip is cheap\r\n\nfi food is rancid then tip is cheap";
    let message = parse_rules(text, &vocabulary()).unwrap_err().to_string();
    let expected = "rule 2, line 4, column 1: expected \"if\", found \"fi\"; did you mean \"if\"?";
    assert_eq!(message, expected);
    let text = "if food is rancid then tip is cheap\nif food is rancid\n  then tip is chaep";
    let message = parse_rules(text, &vocabulary()).unwrap_err().to_string();
    assert!(message.starts_with("rule 2, line 3, column 15: unknown term"), "{message}");
}

#[test]
fn nesting_is_bounded() {
    let nested = |count: usize| {
        let (open, close) = ("(".repeat(count), ")".repeat(count));
        format!("if {open}food is rancid{close} then tip is cheap")
    };
    assert!(Rule::parse(&nested(MAX_NESTING), &vocabulary(), 1).is_ok());
    // Parentheses behind a hedge are no level of their own.
    let (open, close) = ("not (".repeat(MAX_NESTING), ")".repeat(MAX_NESTING));
    let hedged = format!("if {open}food is rancid{close} then tip is cheap");
    assert!(Rule::parse(&hedged, &vocabulary(), 1).is_ok());
    for text in [
        nested(MAX_NESTING + 1),
        nested(400_000),
        format!("if {}food is rancid", "not ".repeat(200_000)),
        format!("if {}food is rancid", "not (".repeat(150_000)),
        format!("if {}food is rancid", "very (".repeat(150_000)),
    ] {
        let message = message(&text);
        assert!(message.contains("nested more than 64 levels deep"), "{message}");
    }
}

#[test]
fn texts_are_bounded() {
    let text = " ".repeat(MAX_CHARACTERS + 1);
    let message = parse_rules(&text, &vocabulary()).unwrap_err().to_string();
    assert!(message.contains("at most 1000000, got 1000001"), "{message}");
    let formula = format!("if food is rancid then mood = {}1", "1+".repeat(5_000));
    let message = Rule::parse(&formula, &vocabulary(), 1).unwrap_err().to_string();
    assert_eq!(message, "rule 1, column 31: a formula has at most 10000 characters");
}

#[test]
fn long_chains_are_flat() {
    let text = "food is rancid and ".repeat(50_000);
    let text = format!("if {text}food is rancid then tip is cheap");
    let rule = Rule::parse(&text, &vocabulary(), 1).unwrap();
    assert_eq!(rule.to_string(), text);
    let hedges = format!("if food is {}rancid then tip is cheap", "very ".repeat(100_000));
    assert_eq!(Rule::parse(&hedges, &vocabulary(), 1).unwrap().to_string(), hedges);
}

#[test]
fn rules_without_a_text_are_checked() {
    let cheap = |hedges: &[&str]| Conclusion {
        output: "tip".to_owned(),
        value: Consequent::Term {
            hedges: hedges.iter().map(|&hedge| hedge.to_owned()).collect(),
            term: "cheap".to_owned(),
        },
    };
    let rule = |antecedent: Antecedent| Rule::new(antecedent, vec![cheap(&[])]);
    let good = rule(is("food", &["very"], "rancid"));
    assert_eq!(vocabulary().check(&good, 1), Ok(()));

    let formula = |text: &str, inputs: &[&str]| Conclusion {
        output: "mood".to_owned(),
        value: Consequent::Formula(Expression::parse(text, inputs).unwrap()),
    };
    let inputs = ["food", "service", "room temperature"];
    let deep =
        (0..=MAX_NESTING).fold(is("food", &[], "rancid"), |of, _| Antecedent::Not(Box::new(of)));
    let food = || Antecedent::is("food", "rancid");
    let cases = [
        (
            rule(Antecedent::is("food", "rancd")),
            "unknown term \"rancd\" of \"food\"; did you mean \"rancid\"?",
        ),
        (rule(is("food", &["vrey"], "rancid")), "unknown hedge \"vrey\"; did you mean \"very\"?"),
        (
            rule(Antecedent::is("tip", "cheap")),
            "\"tip\" is an output; an antecedent needs an input",
        ),
        (
            rule(food().hedged("so").unwrap()),
            "unknown hedge \"so\"; known: very, somewhat, a bit, not",
        ),
        (rule(deep), "the antecedent is nested more than 64 levels deep"),
        (rule(Antecedent::And(vec![food()])), "\"and\" and \"or\" join two conditions or more"),
        (Rule::new(food(), vec![]), "a rule needs at least one conclusion"),
        (
            Rule::new(food(), vec![cheap(&["vrey"])]),
            "unknown hedge \"vrey\"; did you mean \"very\"?",
        ),
        (Rule { weight: -0.5, ..good.clone() }, "the weight must be between 0 and 1, got -0.5"),
        (Rule { weight: f64::NAN, ..good.clone() }, "the weight must be between 0 and 1, got NaN"),
        (
            Rule::new(food(), vec![formula("food", &["food"])]),
            "the formula of \"mood\" is over other inputs",
        ),
        (
            Rule::new(food(), vec![formula("1 + fod", &["fod"])]),
            "\"mood\": formula, column 5: unknown name \"fod\"; did you mean \"food\"?",
        ),
    ];
    for (rule, expected) in cases {
        let message = vocabulary().check(&rule, 3).unwrap_err().to_string();
        assert_eq!(message, format!("rule 3: {expected}"));
    }
    let formula = Rule::new(food(), vec![formula("food  *2", &inputs), cheap(&["not", "very"])]);
    assert_eq!(vocabulary().check(&formula, 1), Ok(()));
    assert!(good.clone().with_weight(1.5).is_err());
    assert_eq!(good.with_weight(0.5).unwrap().weight, 0.5);
}

#[test]
fn operators_continue_chains_and_refuse_deep_trees() {
    let [a, b, c] = ["a", "b", "c"].map(|term| Antecedent::is("x", term));
    let chain = Antecedent::And(vec![a.clone(), b.clone(), c.clone()]);
    assert_eq!(a.clone().and(b.clone()).unwrap().and(c.clone()).unwrap(), chain);
    assert_eq!(a.clone().and(b.clone().and(c.clone()).unwrap()).unwrap(), chain);
    let mixed = a.clone().or(b.clone()).unwrap().and(c.clone()).unwrap();
    assert_eq!(mixed.to_string(), "(x is a or x is b) and x is c");
    let mixed = a.clone().and(b.clone()).unwrap().or(c.clone().or(a.clone()).unwrap()).unwrap();
    assert_eq!(mixed.to_string(), "x is a and x is b or x is c or x is a");

    let mut deep = a.clone();
    for level in 0..MAX_NESTING {
        deep = if level % 2 == 0 { deep.not() } else { deep.hedged("very") }.unwrap();
    }
    let message = deep.clone().not().unwrap_err().to_string();
    assert_eq!(message, "levels of an antecedent: expected at most 64, got more");
    assert!(deep.clone().hedged("very").is_err());
}

#[test]
fn what_operators_accept_has_a_text() {
    let food = || Antecedent::is("food", "rancid");
    let mut deep = food();
    let error = loop {
        // Each turn puts the tree into parentheses once.
        match deep.clone().or(food()).and_then(|either| either.and(food())) {
            Ok(deeper) => deep = deeper,
            Err(error) => break error.to_string(),
        }
    };
    assert_eq!(error, "levels of an antecedent: expected at most 64, got more");
    assert_eq!(deep.to_string().matches('(').count(), MAX_NESTING);
    assert_eq!(antecedent(&deep.to_string()), deep);
}

#[test]
fn names_of_a_vocabulary_differ() {
    let variable = |name: &str, terms: &[&str]| {
        (name.to_owned(), terms.iter().map(|&term| term.to_owned()).collect())
    };
    let x = || variable("x", &["a"]);
    let message = |inputs, outputs, hedges: &[&str]| {
        let hedges = hedges.iter().map(|&hedge| hedge.to_owned()).collect();
        Vocabulary::new(inputs, outputs, hedges).unwrap_err().to_string()
    };
    assert!(message(vec![x()], vec![x()], &[]).contains("variable \"x\" appears twice"));
    let twice = variable("y", &["a", "b", "a"]);
    assert!(
        message(vec![x()], vec![twice], &[]).contains("term \"a\" appears twice in variable \"y\"")
    );
    assert!(message(vec![x()], vec![], &["very", "very"]).contains("hedge \"very\" appears twice"));
    assert!(message(vec![variable("x\ny", &[])], vec![], &[]).contains("not usable"));
}
