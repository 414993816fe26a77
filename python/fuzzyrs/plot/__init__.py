"""Plots of systems and games. They need matplotlib: ``pip install "fuzzyrs[plot]"``."""

from __future__ import annotations

from fuzzyrs.plot._axes import COLOURS, require_matplotlib
from fuzzyrs.plot._membership import membership
from fuzzyrs.plot._paths import paths
from fuzzyrs.plot._rules import rules
from fuzzyrs.plot._surface import surface

__all__ = ["COLOURS", "membership", "paths", "require_matplotlib", "rules", "surface"]
