"""What the thesis claims in words, and what becomes of it in saved results.

A claim rests on rows of experiments, and its verdict follows from theirs. Rows beside them, and a
sentence, say what one should know before believing or dismissing it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from importlib import resources
from typing import Any

from fuzzyrs.experiments.result import Result
from fuzzyrs.experiments.verdict import CLOSE, DIFFERS, REPRODUCED, UNCHECKED

NOT_RUN = "not run"

#: An experiment's id and the name of one of its rows.
Evidence = tuple[str, str]


@dataclass(frozen=True)
class Claim:
    """A statement of the thesis.

    Attributes
    ----------
    number : int
        In the order of the chapters.
    text, source : str
        What is claimed, and in which section.
    rests_on : tuple of (str, str)
        The rows that decide, as (experiment, row).
    beside : tuple of (str, str)
        Rows that tell more and don't decide.
    remark : str
        What was found besides, with 100 seeds, if anything.
    """

    number: int
    text: str
    source: str
    rests_on: tuple[Evidence, ...]
    beside: tuple[Evidence, ...] = ()
    remark: str = ""

    @property
    def experiments(self) -> list[str]:
        """The experiments that decide, each once."""
        return list(dict.fromkeys(identifier for identifier, _ in self.rests_on))


@dataclass(frozen=True)
class Finding:
    """A row that says something about a claim.

    Attributes
    ----------
    experiment, row : str
        Which row.
    verdict, reason : str
        Its verdict; "not run" if there is no result of the experiment.
    decides : bool
        Whether the claim rests on it.
    """

    experiment: str
    row: str
    verdict: str
    reason: str
    decides: bool

    def __str__(self) -> str:
        return f"{self.experiment}, {self.row}: {self.verdict}"


@dataclass(frozen=True)
class Judged:
    """What became of a claim.

    Attributes
    ----------
    claim : Claim
        Which one.
    verdict : str
        "reproduced" or "close" if all rows that it rests on are at least that; "differs" if one
        differs; else "can't be checked".
    findings : tuple of Finding
        The rows.
    """

    claim: Claim
    verdict: str
    findings: tuple[Finding, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the same as plain values."""
        claim = self.claim
        return {
            "number": claim.number,
            "claim": claim.text,
            "source": claim.source,
            "verdict": self.verdict,
            "remark": claim.remark,
            "findings": [asdict(finding) for finding in self.findings],
        }


@cache
def all_claims() -> tuple[Claim, ...]:
    """Return all claims in the order of the chapters."""
    source = resources.files("fuzzyrs.experiments.reference").joinpath("claims.json")
    documents = json.loads(source.read_text(encoding="utf-8"))
    return tuple(_claim(number, values) for number, values in enumerate(documents, start=1))


def _claim(number: int, values: Mapping[str, Any]) -> Claim:
    rows = {key: tuple(map(tuple, values.get(key, []))) for key in ("rests_on", "beside")}
    return Claim(number, values["text"], values["source"], remark=values.get("remark", ""), **rows)


def judge(claim: Claim, results: Mapping[str, Result]) -> Judged:
    """Return what becomes of a claim in some results, by their ids."""
    findings = tuple(
        _finding(evidence, results, decides=evidence in claim.rests_on)
        for evidence in (*claim.rests_on, *claim.beside)
    )
    return Judged(claim, _together([each.verdict for each in findings if each.decides]), findings)


def judge_all(results: Sequence[Result]) -> list[Judged]:
    """Return what becomes of all claims that some results say something about."""
    by_id = {result.id: result for result in results}
    return [
        judge(claim, by_id)
        for claim in all_claims()
        if any(identifier in by_id for identifier in claim.experiments)
    ]


def _finding(evidence: Evidence, results: Mapping[str, Result], *, decides: bool) -> Finding:
    identifier, name = evidence
    if identifier not in results:
        return Finding(identifier, name, NOT_RUN, f"fuzzyrs reproduce {identifier}", decides)
    row = next((row for row in results[identifier].rows if row.name == name), None)
    if row is None:  # the result is older than the row
        return Finding(identifier, name, NOT_RUN, f"reproduce {identifier} again", decides)
    return Finding(identifier, name, row.verdict, row.reason, decides)


def _together(verdicts: Sequence[str]) -> str:
    """Return the verdict on something that needs all of some others."""
    order = (DIFFERS, NOT_RUN, UNCHECKED, CLOSE, REPRODUCED)
    worst = min(verdicts, key=order.index)
    return UNCHECKED if worst == NOT_RUN else worst
