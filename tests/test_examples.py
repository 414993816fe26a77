"""Every script in examples/ runs, in a folder of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def test_every_example_runs(tmp_path):
    scripts = sorted((Path(__file__).parents[1] / "examples").glob("*.py"))
    for script in scripts:
        folder = tmp_path / script.stem
        folder.mkdir()
        done = subprocess.run(
            [sys.executable, "-W", "error", str(script)],
            cwd=folder,
            env={**os.environ, "MPLBACKEND": "Agg"},
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, f"{script.name}\n{done.stdout}{done.stderr}"
