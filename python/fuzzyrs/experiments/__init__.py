"""The thesis's tables and figures as experiments: one module per chapter, one id each.

Data flow: a frozen config goes through `run_seed` for each seed, the outcomes become rows beside
the published numbers, and every row gets its verdict.
"""

from __future__ import annotations

from fuzzyrs.experiments.registry import find, ids, select
from fuzzyrs.experiments.result import Result, Row
from fuzzyrs.experiments.runner import Interrupted, reproduce
from fuzzyrs.experiments.statistics import Paired

__all__ = ["Interrupted", "Paired", "Result", "Row", "find", "ids", "reproduce", "select"]
