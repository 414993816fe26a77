"""``python -m fuzzyrs``: the command line."""

from __future__ import annotations

import sys

from fuzzyrs.cli import main

sys.exit(main())
