"""Progress of experiments and of the whole: bars, lines, or JSON for machines."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Sequence
from typing import Any, Protocol, TextIO

from tqdm import tqdm

from fuzzyrs.experiments.experiment import Experiment

#: Where nobody redraws a bar, a line comes this often at most [s].
BETWEEN_LINES = 5.0

Plan = Sequence[tuple[Experiment, int]]


class Clock:
    """How long the work takes, and how long it will still take.

    What is left is estimated from the costs of experiments and from how long the finished ones
    took; so it is right for this machine once something was finished.

    Parameters
    ----------
    plan : sequence of (Experiment, int)
        The experiments and how many seeds each.
    cores : int
        How many seeds run at a time.
    """

    def __init__(self, plan: Plan, cores: int) -> None:
        self._began = time.monotonic()
        self._left = sum(experiment.cost * seeds for experiment, seeds in plan)
        self._done = 0.0
        self._cores = cores

    def pass_over(self, cost: float) -> None:
        """Take away work that was done before."""
        self._left -= cost

    def finish(self, cost: float) -> None:
        """Move work from what is left to what is done."""
        self._left -= cost
        self._done += cost

    @property
    def elapsed(self) -> float:
        """Since the beginning [s]."""
        return time.monotonic() - self._began

    @property
    def remaining(self) -> float:
        """Estimated time until the end [s]."""
        # A little of the estimate is mixed in, so that the first seeds don't overthrow it.
        trust = 1.0
        pace = (self.elapsed + trust / self._cores) / (self._done + trust)
        return max(self._left, 0.0) * pace


def duration(seconds: float) -> str:
    """Return a time as people say it.

    >>> duration(0.32), duration(75), duration(4000)
    ('0.3 s', '1 min 15 s', '1 h 6 min')
    """
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes >= 60:
        return f"{minutes // 60} h {minutes % 60} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


class Watch(Protocol):
    """Who is told how far the whole is. `experiments.reproduce` tells it of seeds."""

    def begin(self, experiment: Experiment) -> None:
        """The next experiment begins."""

    def started(self, total: int, done: int) -> None:
        """It has so many seeds, of which some were done before."""

    def finished(self, seeds: Sequence[int], done: int, total: int) -> None:
        """Some more of its seeds are done."""

    def say(self, text: str) -> None:
        """Print something for people that isn't progress."""

    def note(self, text: str) -> None:
        """Print a remark on the work, which is no result."""

    def tell(self, event: str, **values: Any) -> None:
        """Print something for machines."""

    def close(self) -> None:
        """The work has ended, or was stopped."""


class _Following:
    """What all watches know: the clock, and which experiment it is."""

    def __init__(self, plan: Plan, cores: int) -> None:
        self.clock = Clock(plan, cores)
        self._count = len(plan)
        self._place = 0
        self._cost = 0.0
        self._seen = 0
        self.name = ""

    def begin(self, experiment: Experiment) -> None:
        self._place += 1
        self._cost = experiment.cost
        place = f"[{self._place}/{self._count}] " if self._count > 1 else ""
        self.name = place + experiment.id
        self.id = experiment.id

    def started(self, total: int, done: int) -> None:
        del total
        self._seen = done
        self.clock.pass_over(done * self._cost)

    def finished(self, seeds: Sequence[int], done: int, total: int) -> None:
        del seeds, total
        self.clock.finish((done - self._seen) * self._cost)
        self._seen = done

    def tell(self, event: str, **values: Any) -> None:
        del event, values

    def close(self) -> None:
        pass


class Lines(_Following):
    """Lines on a stream that isn't a terminal: one every few seconds, and one at each end."""

    def __init__(self, plan: Plan, cores: int, stream: TextIO) -> None:
        super().__init__(plan, cores)
        self._stream = stream
        self._last = -BETWEEN_LINES

    def started(self, total: int, done: int) -> None:
        """Say what was done before, if anything."""
        super().started(total, done)
        self._began = time.monotonic()
        if done:
            self._line(f"going on with {done} of {total} seeds that are done already")

    def finished(self, seeds: Sequence[int], done: int, total: int) -> None:
        """Say how far the experiment is, and when the whole will be done."""
        super().finished(seeds, done, total)
        now = time.monotonic()
        if done == total or now - self._last >= BETWEEN_LINES:
            self._last = now
            self._line(
                f"{done} of {total} seeds in {duration(now - self._began)}; all in all "
                f"{duration(self.clock.elapsed)}, about {duration(self.clock.remaining)} left"
            )

    def say(self, text: str) -> None:
        """Print to standard output."""
        print(text)

    def note(self, text: str) -> None:
        """Print to standard error."""
        print(text, file=self._stream, flush=True)

    def _line(self, text: str) -> None:
        print(f"{self.name}: {text}", file=self._stream, flush=True)


class Bars(_Following):
    """Bars on a terminal: the experiment's seeds, and the whole."""

    def __init__(self, plan: Plan, cores: int, stream: TextIO) -> None:
        super().__init__(plan, cores)
        self._stream = stream
        self._bar: tqdm[Any] | None = None
        self._whole = tqdm(
            total=len(plan),
            file=stream,
            position=1,
            leave=False,
            disable=len(plan) == 1,
            bar_format="all  {percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt}{postfix}",
        )

    def started(self, total: int, done: int) -> None:
        """Begin the experiment's bar."""
        super().started(total, done)
        self._end()
        self._bar = tqdm(
            total=total,
            initial=done,
            desc=self.name,
            unit="seed",
            file=self._stream,
            position=0,
            leave=self._whole.disable,
        )

    def finished(self, seeds: Sequence[int], done: int, total: int) -> None:
        """Move both bars."""
        super().finished(seeds, done, total)
        if self._bar is not None:
            self._bar.update(len(seeds))
        times = f"{duration(self.clock.elapsed)}, about {duration(self.clock.remaining)} left"
        self._whole.set_postfix_str(times)

    def say(self, text: str) -> None:
        """Print above the bars."""
        tqdm.write(text, file=sys.stdout)

    def note(self, text: str) -> None:
        """Print above the bars."""
        tqdm.write(text, file=self._stream)

    def close(self) -> None:
        """Remove the bars."""
        self._end()
        self._whole.close()

    def _end(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None
            self._whole.update()


class Machine(_Following):
    """A JSON object on each line of standard output, and nothing for people."""

    def started(self, total: int, done: int) -> None:
        """Tell what was done before."""
        super().started(total, done)
        self.tell("started", id=self.id, total=total, done=done)

    def finished(self, seeds: Sequence[int], done: int, total: int) -> None:
        """Tell which seeds are done, and when the whole will be."""
        super().finished(seeds, done, total)
        self.tell(
            "seeds",
            id=self.id,
            seeds=list(seeds),
            done=done,
            total=total,
            elapsed=round(self.clock.elapsed, 3),
            remaining=round(self.clock.remaining, 3),
        )

    def say(self, text: str) -> None:
        """Say nothing."""

    def note(self, text: str) -> None:
        """Say nothing; events have the same."""

    def tell(self, event: str, **values: Any) -> None:
        """Print an event."""
        line = json.dumps({"event": event, **values}, ensure_ascii=False, allow_nan=False)
        print(line, flush=True)


def watch(plan: Plan, cores: int, *, machine: bool) -> Watch:
    """Return who suits standard error, or machines."""
    if machine:
        return Machine(plan, cores)
    kind = Bars if sys.stderr.isatty() else Lines
    return kind(plan, cores, sys.stderr)
