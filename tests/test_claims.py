"""The thesis's claims in words, and what becomes of them."""

from __future__ import annotations

import json

import pytest

from fuzzyrs import experiments
from fuzzyrs.experiments.claims import Claim, all_claims, judge, judge_all
from fuzzyrs.experiments.result import Result, Row


def result(identifier, **verdicts):
    rows = [Row(name, ["a"], [None], [[1.0]], verdict, "so") for name, verdict in verdicts.items()]
    return Result(identifier, [0], {}, rows, {})


def test_there_are_26_in_the_order_of_the_chapters():
    claims = all_claims()
    assert [claim.number for claim in claims] == list(range(1, 27))
    sections = [claim.source.removeprefix("section ").split(".") for claim in claims]
    assert sections == sorted(sections)
    assert {section[0] for section in sections} == set("345678")
    assert len({claim.text for claim in claims}) == 26


@pytest.mark.parametrize("claim", all_claims(), ids=lambda claim: str(claim.number))
def test_every_claim_rests_on_experiments_of_its_chapter(claim):
    assert claim.rests_on
    for identifier, _ in (*claim.rests_on, *claim.beside):
        chapter = experiments.find(identifier).chapter()
        assert claim.source.startswith(f"section {chapter}.")


@pytest.mark.parametrize(
    ("verdicts", "together"),
    [
        (["reproduced", "reproduced"], "reproduced"),
        (["reproduced", "close"], "close"),
        (["reproduced", "can't be checked"], "can't be checked"),
        (["close", "can't be checked"], "can't be checked"),
        (["differs", "reproduced"], "differs"),
        (["can't be checked", "differs"], "differs"),
        (["so-so", "reproduced"], "can't be checked"),
    ],
)
def test_a_claim_needs_all_that_it_rests_on(verdicts, together):
    claim = Claim(1, "It works.", "section 3.1", (("x", "one"), ("x", "two")), (("x", "three"),))
    one, two = verdicts
    judged = judge(claim, {"x": result("x", one=one, two=two, three="differs")})
    assert judged.verdict == together
    assert [finding.decides for finding in judged.findings] == [True, True, False]
    assert judged.findings[2].reason == "so"


def test_a_claim_without_its_experiments_cannot_be_checked():
    claim = Claim(1, "It works.", "section 3.1", (("x", "one"), ("y", "one")), (("z", "one"),))
    judged = judge(claim, {"x": result("x", one="reproduced")})
    assert judged.verdict == "can't be checked"
    assert [finding.verdict for finding in judged.findings] == ["reproduced", *["not run"] * 2]
    assert judged.findings[1].reason == "fuzzyrs reproduce y"
    differs = judge(claim, {"x": result("x", one="differs")})
    assert differs.verdict == "differs"


def test_only_claims_that_results_speak_of_are_judged():
    assert judge_all([result("table-6-1", **{"stage 1": "reproduced"})]) == []
    tables = {"sum of the times": "reproduced", "reward_ga": "close", "qlbgflc": "close"}
    tables |= {"longest learning time": "reproduced", "learning_time": "differs"}
    judged = judge_all([result("table-6-3", **tables)])
    assert [(each.claim.number, each.verdict) for each in judged] == [
        (10, "reproduced"),
        (11, "close"),
        (12, "differs"),
    ]
    assert json.loads(json.dumps(judged[0].to_dict()))["findings"][0]["row"] == "sum of the times"
