"""Rules as text and as objects: they mean the same, and what is wrong with them is said where."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fuzzyrs as fz
import rule_models as models
from fuzzyrs import errors

SERVICE = fz.Variable.evenly("service", (0, 10), ["poor", "good"])
FOOD = fz.Variable.evenly("food", (0, 10), ["rancid", "delicious"])
TIP = fz.Variable.evenly("tip", (0, 30), ["cheap", "generous"])
POWER = fz.Output.sugeno("power", {"none": 0, "full": 9})
GOOD = "if service is good then tip is generous and power is full"


def system(*rules, **options):
    return fz.System([SERVICE, FOOD], [TIP, POWER], [GOOD, *rules], **options)


def only(text, **options):
    """Give the rule that a text means."""
    return system(text, **options).rules[1]


# Text


@settings(max_examples=60)
@given(models.systems(), st.randoms(use_true_random=False))
def test_parentheses_that_are_not_needed_mean_nothing(model, random):
    def wrap(part):
        return f"({part})" if random.random() < 0.3 else part

    wrapped = [models.rule_text(rule, wrap) for rule in model.rules]
    assert models.build(model, wrapped) == models.build(model)


@settings(max_examples=60)
@given(models.systems(), st.data())
def test_rules_as_objects_mean_the_same(model, data):
    for rule in model.rules:  # an object has no way to conclude a formula
        for conclusion in rule.then:
            if not isinstance(conclusion.term, str):
                conclusion.term = "low"
    inputs = {one.name: models.variable(one) for one in model.inputs}
    outputs = {one.name: models.output(one) for one in model.outputs}
    rules = [models.rule_object(rule, inputs, outputs) for rule in model.rules]
    from_text, from_objects = models.build(model), models.build(model, rules)
    points = data.draw(models.points(model))
    before = [0.5] * len(model.outputs)
    try:
        right = from_text(points, previous=before)
    except fz.FuzzyrsError as error:
        with pytest.raises(type(error), match=re.escape(str(error))):
            from_objects(points, previous=before)
    else:
        assert from_objects(points, previous=before).tobytes() == right.tobytes()


@settings(max_examples=60)
@given(models.systems())
def test_what_rules_print_is_read_as_the_same_rules(model):
    built = models.build(model)
    printed = [str(rule) for rule in built.rules]
    again = fz.System(
        built.inputs,
        built.outputs,
        printed,
        conjunction=model.conjunction,
        disjunction=model.disjunction,
        hedges=built.hedges,
        outside=model.outside,
    )
    assert again == built


@pytest.mark.parametrize(
    "text",
    [
        "if service is poor then tip is cheap",
        "IF service IS poor THEN tip IS cheap",
        "if (service is poor) then tip is cheap;",
        "  if\tservice   is poor then tip is cheap  # and so on",
        "if service is 'poor' then \"tip\" is cheap",
        "if service is poor then tip is cheap with 1.0",
    ],
)
def test_one_rule_is_written_in_many_ways(text):
    assert only(text) == only("if service is poor then tip is cheap")


def test_a_text_has_a_rule_on_each_line():
    text = """
    # A comment, a blank line, a rule, and one that goes on.

    if service is poor then tip is cheap, power is none  # what follows is left out
    if service is good
        and (food is delicious or
    food is rancid)
      then tip is generous and power is full with .25
    """
    assert fz.System([SERVICE, FOOD], [TIP, POWER], text).rules == [
        only("if service is poor then tip is cheap and power is none"),
        only(
            "if service is good and (food is delicious or food is rancid) "
            "then tip is generous and power is full with 0.25"
        ),
    ]
    windows = text.replace("\n", "\r\n")
    assert fz.System([SERVICE, FOOD], [TIP, POWER], windows).rules[1].weight == 0.25


# What is wrong stands behind the @, and so the column is known.
WRONG = [
    ("if @servic is poor then tip is cheap", 'unknown input "servic"; did you mean "service"?'),
    ("if @tip is cheap then tip is cheap", '"tip" is an output; an antecedent needs an input'),
    ("if service is @por then tip is cheap", 'unknown term "por" of "service"; did you mean "poo'),
    ("if service is @cheap then tip is cheap", "unknown term"),
    ("if service is poor then @tipp is cheap", 'unknown output "tipp"; did you mean "tip"?'),
    ("if service is poor then @food is rancid", '"food" is an input; a conclusion needs an outp'),
    ("if service is poor then tip is @chaep", 'unknown term "chaep" of "tip"; did you mean "che'),
    ("if service is @vry poor then tip is cheap", 'unknown hedge "vry"; did you mean "very"?'),
    ("if food is rancid and not service is not @Poor then tip is cheap", 'did you mean "poor"?'),
    ("if food is rancid and @then tip is cheap", 'expected an input, "not", a hedge or "("'),
    ("if service is poor @than tip is cheap", 'found "than"; did you mean "then"?'),
    ("@service is poor then tip is cheap", 'expected "if", found "service"'),
    ("if (service is poor @then tip is cheap", 'expected "and", "or" or ")", found "then"'),
    ("if service is poor@) then tip is cheap", 'expected "and", "or" or "then", found ")"'),
    ("if service @= poor then tip is cheap", 'expected "is", found "="'),
    ("if service is poor then tip @cheap", 'expected "is" or "="'),
    ("if service is poor@", 'expected "and", "or" or "then", found the end'),
    ("if service is poor then tip is cheap with @1.5", "the weight must be between 0 and 1"),
    ("if service is poor then tip is cheap with @-0.5", "expected a weight between 0 and 1, foun"),
    ("if service is poor then tip is cheap with@", "expected a weight between 0 and 1, found th"),
    ("if service is poor then tip is cheap @if service is good", "or the end of the rule, found"),
    ("if service is poor then tip is cheap @§", "unexpected character '§'"),
    ("if service is @'poor then tip is cheap", "the quoted name does not end"),
    ("if service is poor then power = 2*@servis", 'unknown name "servis"; did you mean "servic'),
    ("if service is poor then power = 2*@", 'expected a number, a name or "(", found the end'),
    ("if service is poor then power = @sin(1, 2)", '"sin" takes 1 number, got 2'),
]


@pytest.mark.parametrize(("marked", "words"), WRONG, ids=[text for text, _ in WRONG])
def test_what_is_wrong_is_said_where(marked, words):
    column = marked.index("@") + 1
    text = marked.replace("@", "")
    with pytest.raises(errors.RuleError) as caught:
        system("if food is rancid then tip is cheap", text)
    assert str(caught.value).startswith(f"rule 3, column {column}: ")
    assert words in str(caught.value)
    assert caught.value.kind == "rule"
    lines = f"# Rules\n{GOOD}\n{text}\n{GOOD}"
    with pytest.raises(errors.RuleError) as caught:
        fz.System([SERVICE, FOOD], [TIP, POWER], lines)
    assert str(caught.value).startswith(f"rule 2, line 3, column {column}: ")
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("if x is a then y is low\nif x is c then y is low", "rule 2, line 2, column 9: "),
        ("if x is a then y is low\n\nif x is b then yy is low", "rule 2, line 3, column 16: "),
        ("if é is a then y is low", "rule 1, column 4: "),
        ("if 'ééé' is a\n  or x is c then y is low", "rule 1, line 2, column 11: "),
        ("if x is a then y is low with 2", "rule 1, column 30: "),
    ],
)
def test_columns_that_were_counted_by_hand(text, place):
    inputs = [fz.Variable.evenly(name, (0, 1), "ab") for name in ("x", "ééé")]
    output = fz.Variable.evenly("y", (0, 1), ["low", "high"])
    with pytest.raises(errors.RuleError, match="^" + re.escape(place)):
        fz.System(inputs, output, text)


def test_formulas_of_terms_are_read_when_the_inputs_are_known():
    output = fz.Output.sugeno("u", {"f": "2*servic + 1"})
    match = 'formula, column 3: unknown name "servic"; did you mean "service"?'
    with pytest.raises(errors.RuleError, match=re.escape(match)):
        fz.System([SERVICE], output, "if service is good then u is f")
    free = fz.Output.sugeno("u", {"f": "2*food + 1"})
    for inputs in ([SERVICE, FOOD], [FOOD, SERVICE]):
        built = fz.System(inputs, free, "if service is good then u is f")
        assert built(service=1, food=3) == 7


# Names

NAMES = [
    *["is", "IF", "With", "then", "not", "and"],  # words of the language
    *["very", "any", "sin", "pi", "e", "min", "if"],  # hedges, functions, constants
    *["room temperature", " padded ", "1st", "a-b", "a;b", "a,b", "(a)", "#5", "=", "a\tb"],
    *['say "hi"', "it's", "\"'", "back\\slash", "\\", 'end\\"'],
    *["température", "温度", "e\u0301", "🌡", "a\u2028b", "\u200b", "n" * 2000],
]


@pytest.mark.parametrize("name", NAMES, ids=lambda name: ascii(name)[:20])
def test_any_name_will_do_between_quotes(name):
    x = fz.Variable(name, (0, 1), {name: fz.MembershipFunction("ramp", [0, 1])})
    v = fz.Variable(name + "_", (0, 1), {name: fz.triangular(0, 0.5, 1)})
    u = fz.Output.sugeno("u", {name: 3})
    quoted = '"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"'
    doubled = "'" + name.replace("\\", "\\\\").replace("'", "''") + "'"
    built = fz.System(
        [x],
        [v, u],
        [
            f'if {quoted} is not {quoted} then "{quoted[1:-1]}_" is {quoted} and u is {quoted}',
            f"if {doubled} is {doubled} then u = 2*{doubled}",
        ],
    )
    assert built(0.5).tolist() == pytest.approx([0.5, (0.5 * 3 + 0.5 * 1) / 1])
    assert built(**{name: 0.5}).tolist() == built(0.5).tolist()
    assert fz.System([x], built.outputs, [str(rule) for rule in built.rules]) == built
    assert fz.System.from_json(built.to_json()) == built
    assert f"{name}.{name}.start" in built.parameter_names


@pytest.mark.parametrize("name", ["", " ", "a.b", "a\nb", "."])
def test_names_that_cannot_stand_in_a_path(name):
    ramp = fz.MembershipFunction("ramp", [0, 1])
    for make in [
        lambda: fz.Variable(name, (0, 1), {}),
        lambda: fz.Variable("x", (0, 1), {name: ramp}),
        lambda: fz.Output.sugeno(name),
        lambda: fz.Output.sugeno("u", {name: 1}),
        lambda: system(hedges={name: "x"}),
        lambda: system(name=name),
    ]:
        with pytest.raises(errors.InvalidValueError, match="is not usable"):
            make()


def test_names_must_differ():
    for inputs, outputs in [
        ([SERVICE, SERVICE], TIP),
        ([SERVICE], [TIP, TIP]),
        ([SERVICE], [TIP, fz.Output.sugeno("service", {"a": 1})]),
        ([SERVICE], [TIP, fz.Output.sugeno("tip", {"a": 1})]),
    ]:
        with pytest.raises(errors.InvalidValueError, match="appears twice in the inputs and out"):
            fz.System(inputs, outputs, "if service is poor then tip is cheap")


# Objects


def test_operators_make_the_rules_that_they_look_like():
    poor, rancid = SERVICE["poor"], FOOD["rancid"]
    cheap, full = TIP["cheap"], fz.Variable.evenly("power", (0, 1), ["none", "full"])["full"]
    for made, text in [
        (poor >> cheap, "if service is poor then tip is cheap"),
        ((poor & rancid) >> cheap, "if service is poor and food is rancid then tip is cheap"),
        ((poor | rancid) >> cheap, "if service is poor or food is rancid then tip is cheap"),
        (~poor >> cheap, "if not (service is poor) then tip is cheap"),
        (
            (poor & (rancid | ~poor)).hedge("very") >> cheap,
            "if very (service is poor and (food is rancid or not service is poor)) "
            "then tip is cheap",
        ),
        # Python's | and & bind as "or" and "and" do.
        (
            (poor | rancid & ~poor) >> cheap,
            "if service is poor or food is rancid and not service is poor then tip is cheap",
        ),
        (
            (poor & rancid | poor.hedge("very")) >> cheap,
            "if service is poor and food is rancid or very service is poor then tip is cheap",
        ),
        (poor >> [cheap, full], "if service is poor then tip is cheap, power is full"),
        ((poor >> cheap).weighted(0.25), "if service is poor then tip is cheap with 0.25"),
        (
            poor >> cheap.hedge("very").hedge("not"),
            "if service is poor then tip is not very cheap",
        ),
        ((~~poor) >> cheap, "if not not service is poor then tip is cheap"),
    ]:
        assert only(text) == made, text
        assert only(made) == made
        assert only(str(made)) == made
    assert str(poor & rancid) == "service is poor and food is rancid"
    assert repr(~(poor | rancid)) == 'Proposition("not (service is poor or food is rancid)")'
    assert repr(poor >> cheap) == 'Rule("if service is poor then tip is cheap")'
    weighted = (poor >> cheap).weighted(0.5)
    assert (weighted.weight, weighted.weighted(1).weight) == (0.5, 1.0)
    assert weighted.antecedent == poor != rancid
    assert weighted != poor >> cheap != rancid >> cheap


def test_chains_of_operators_are_flat():
    poor, rancid = SERVICE["poor"], FOOD["rancid"]
    chain = poor
    for _ in range(500):
        chain = chain & rancid
    assert str(chain) == " and ".join(["service is poor", *["food is rancid"] * 500])
    assert str((poor & rancid) & (rancid & poor)).count("(") == 0
    assert only(chain >> TIP["cheap"]).antecedent == chain


def test_rules_as_objects_are_checked_too():
    poor, cheap = SERVICE["poor"], TIP["cheap"]
    other = fz.Variable.evenly("servicee", (0, 1), ["poor", "bad"])
    for rule, words in [
        (other["poor"] >> cheap, 'rule 2: unknown input "servicee"; did you mean "service"?'),
        (poor >> other["bad"], 'rule 2: unknown output "servicee"'),
        (poor >> FOOD["rancid"], 'rule 2: "food" is an input; a conclusion needs an output'),
        (cheap >> cheap, 'rule 2: "tip" is an output; an antecedent needs an input'),
        (poor.hedge("vry") >> cheap, 'rule 2: unknown hedge "vry"; did you mean "very"?'),
        (poor >> cheap.hedge("vry"), 'rule 2: unknown hedge "vry"'),
        (poor >> [], "rule 2: a rule needs at least one conclusion"),
    ]:
        with pytest.raises(errors.RuleError, match=re.escape(words)):
            system(rule)


# Limits


def test_nesting_has_a_limit_in_text_and_in_objects():
    deep = "if {}service is poor{} then tip is cheap"
    assert only(deep.format("(" * 64, ")" * 64)) == only(deep.format("", ""))
    for opening, closing in [("(", ")"), ("not ", ""), ("very ", ""), ("not (", ")")]:
        text = deep.format(opening * 65, closing * 65)
        with pytest.raises(errors.RuleError, match="nested more than 64 levels deep"):
            only(text)
        huge = deep.format(opening * 100_000, closing * 100_000)
        with pytest.raises(errors.RuleError, match="nested more than 64 levels deep"):
            only(huge)
    for nest in [fz.Proposition.__invert__, lambda p: p.hedge("very"), lambda p: ~(p & p)]:
        proposition = SERVICE["poor"]
        for level in range(64):
            proposition = nest(proposition) if level < 12 else ~proposition
        rule = proposition >> TIP["cheap"]
        assert only(str(rule)) == rule
        with pytest.raises(errors.ShapeError, match="levels of an antecedent: expected at most 64"):
            nest(proposition)


def test_long_texts_are_refused():
    with pytest.raises(errors.ShapeError, match="at most 1000000, got"):
        fz.System([SERVICE], TIP, "if service is poor then tip is cheap\n" * 30_000)
    with pytest.raises(errors.RuleError, match="at most 10000 characters"):
        system(hedges={"long": "x" + " + 0" * 5000})


def test_ten_thousand_rules():
    texts = [
        f"if service is {('poor', 'good')[i % 2]} then power is {('none', 'full')[i % 2]}"
        for i in range(10_000)
    ]
    for rules in (texts, "\n".join(texts)):
        built = fz.System([SERVICE], POWER, rules)
        assert len(built.rules) == 10_000
        assert built(5) == pytest.approx(4.5)
    formulas = [f"if service is poor then power = {i} + service" for i in range(10_000)]
    built = fz.System([SERVICE], POWER, formulas)
    assert built(1) == pytest.approx(4999.5 + 1)
    assert len(built.parameters) == 4 + 2 + (2 + 1) * 10_000


def test_hedges_of_ones_own_must_stay_degrees():
    for formula, words in [
        ("2*x", "must be between 0 and 1, got 1.00"),
        ("x - 0.5", 'the hedge "own" at the degree 0 must be between 0 and 1, got -0.5'),
        ("ln(x)", "must be finite, got -inf"),
        ("1/(x - 1)", "must be between 0 and 1"),
        ("sqrt(x - 0.5)", "must be finite, got NaN"),
        ("y", 'unknown name "y"'),
        ("x^", "formula, column 3: expected a number"),
        ("", "formula, column 1: expected"),
    ]:
        with pytest.raises(fz.FuzzyrsError, match=re.escape(words)):
            system(hedges={"own": formula})
    assert system(hedges={"own": "sqrt(x)"}).hedges == {"own": "sqrt(x)"}


def test_hedges_of_conclusions_need_samples():
    rule = "if service is poor then {} is very {}"
    assert only(rule.format("tip", "cheap"))
    match = 'rule 2\'s conclusion about "power" does not fit: hedges in a conclusion need'
    with pytest.raises(errors.InvalidValueError, match=re.escape(match)):
        system(rule.format("power", "full"))
    sharp = fz.Variable.evenly("tip", (0, 30), ["cheap", "generous"], shape="triangular")
    for output in [
        fz.Output.mamdani(sharp, sampling="exact"),
        fz.Output.mamdani(sharp, defuzzifier="height"),
        fz.Output.sugeno("tip", {"cheap": 1}),
    ]:
        with pytest.raises(errors.InvalidValueError, match="does not fit: hedges in a conclusion"):
            fz.System([SERVICE], output, rule.format("tip", "cheap"))
