"""What studies in other processes run: functions of a module that those can import."""

from __future__ import annotations

import os
import time
from typing import Any


def line(seed: int, slope: float, kind: str | None) -> dict[str, Any]:
    return {"value": slope * seed, "kind too": kind, "large": seed > 1}


def leave(seed: int) -> int:
    if seed == 5:
        os._exit(1)
    return seed


def worker(seed: int) -> int:
    """Take a while, and tell which process it is."""
    del seed
    time.sleep(0.05)
    return os.getpid()
