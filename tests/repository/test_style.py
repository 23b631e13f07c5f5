"""Types and style are tests like any other."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# CI never comes back to a cache that it has written, which takes a tenth of the time.
MYPY = ("mypy", "--cache-dir", os.devnull) if "BTQ_CI" in os.environ else ("mypy",)


@pytest.mark.parametrize("command", [MYPY, ("ruff", "check", "."), ("ruff", "format", "--check", ".")], ids=" ".join)
def test_nothing_to_complain_of(command: tuple[str, ...]) -> None:
    run = subprocess.run([sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
