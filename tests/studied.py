"""What studies in other processes run: functions of a module that those can import."""

from __future__ import annotations

from typing import Any


def line(seed: int, slope: float, kind: str | None) -> dict[str, Any]:
    return {"value": slope * seed, "kind too": kind, "large": seed > 1}
