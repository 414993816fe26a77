"""A clear message instead of a crash on x86 processors that lack what the core is built for."""

from __future__ import annotations

import platform
import subprocess
import sys
from pathlib import Path

# Two of the features that tell x86-64-v3 (2013 and later) from older processors.
_NEEDED = frozenset({"avx2", "fma"})
_PF_AVX2_INSTRUCTIONS_AVAILABLE = 40


def _features() -> frozenset[str] | None:
    """Return the processor's features in lower case, or None where they cannot be known."""
    if sys.platform == "linux":
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("flags"):
                return frozenset(line.partition(":")[2].split())
    elif sys.platform == "darwin":
        names = ["machdep.cpu.features", "machdep.cpu.leaf7_features"]
        listed = subprocess.run(
            ["sysctl", "-n", *names], capture_output=True, text=True, check=True
        )
        return frozenset(listed.stdout.lower().split())
    elif sys.platform == "win32":
        import ctypes

        present = ctypes.windll.kernel32.IsProcessorFeaturePresent(_PF_AVX2_INSTRUCTIONS_AVAILABLE)
        return _NEEDED if present else frozenset()
    return None


def check() -> None:
    """Raise ImportError if this is an x86 processor without AVX2 and FMA."""
    if platform.machine().lower() not in {"x86_64", "amd64"}:
        return
    try:
        features = _features()
    except (OSError, subprocess.SubprocessError):
        return
    missing = sorted(_NEEDED - features) if features is not None else []
    if missing:
        raise ImportError(
            f"this processor lacks {' and '.join(missing)}, which fuzzyrs is built for "
            "(x86-64-v3: Intel Haswell, AMD Excavator or later)"
        )


check()
