"""What the command line tells of long work."""

from __future__ import annotations

import io
import re
import sys

import pytest

from fuzzyrs import experiments
from fuzzyrs.cli import progress
from fuzzyrs.cli.progress import Bars, Clock, Lines, duration


class Cheap(experiments.find("table-6-3")):
    id = "cheap"
    cost = 1.0


class Dear(Cheap):
    id = "dear"
    cost = 9.0


PLAN = [(Cheap(), 10), (Dear(), 10)]


@pytest.fixture
def now(monkeypatch):
    """A clock that stands still until it is moved."""
    time = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: time[0])
    return time


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0, "0.0 s"), (9.94, "9.9 s"), (9.96, "10 s"), (59.6, "1 min 0 s"), (3605, "1 h 0 min")],
)
def test_times_are_told_as_people_do(seconds, text):
    assert duration(seconds) == text


def test_what_is_left_follows_the_pace_so_far(now):
    clock = Clock(PLAN, cores=2)
    assert clock.remaining == pytest.approx(50)
    now[0] += 50
    clock.finish(10.0)
    # Five times as slow as estimated.
    assert clock.remaining == pytest.approx(90 * 50.5 / 11)
    clock.pass_over(80.0)
    assert clock.remaining == pytest.approx(10 * 50.5 / 11)
    clock.finish(10.0)
    assert clock.remaining == 0.0


def test_lines_come_at_ends_and_every_few_seconds(now):
    stream = io.StringIO()
    lines = Lines(PLAN, 2, stream)
    for experiment, total in PLAN:
        lines.begin(experiment)
        lines.started(total, 0)
        for done in range(1, total + 1):
            now[0] += 1.0
            lines.finished([done], done, total)
    lines.close()
    said = stream.getvalue().splitlines()
    assert [line.split(" seeds")[0] for line in said] == [
        "[1/2] cheap: 1 of 10",
        "[1/2] cheap: 6 of 10",
        "[1/2] cheap: 10 of 10",
        "[2/2] dear: 5 of 10",
        "[2/2] dear: 10 of 10",
    ]
    assert said[-1].endswith("10 of 10 seeds in 10 s; all in all 20 s, about 0.0 s left")


def test_one_experiment_leaves_its_bar():
    stream = io.StringIO()
    bars = Bars(PLAN[:1], 2, stream)
    bars.begin(PLAN[0][0])
    bars.started(10, 4)
    bars.finished([4, 5], 6, 10)
    bars.finished([6, 7, 8, 9], 10, 10)
    bars.close()
    assert "all" not in stream.getvalue()
    assert stream.getvalue().split("\r")[-1].startswith("cheap: 100%")
    assert "10/10" in stream.getvalue()


def test_several_experiments_have_a_bar_for_the_whole(now):
    stream = io.StringIO()
    bars = Bars(PLAN, 2, stream)
    for experiment, total in PLAN:
        bars.begin(experiment)
        bars.started(total, 0)
        now[0] += 5.0
        bars.finished(list(range(total)), total, total)
    bars.close()
    said = stream.getvalue()
    assert "[2/2] dear" in said
    assert re.search("all +0%", said)
    assert "0/2, 5.0 s, about" in said


def test_standard_output_stays_free_of_bars(capsys):
    bars = Bars(PLAN[:1], 2, sys.stderr)
    bars.begin(PLAN[0][0])
    bars.started(1, 0)
    bars.say("a table")
    bars.close()
    assert capsys.readouterr().out == "a table\n"
