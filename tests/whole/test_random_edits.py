"""A few hundred of the random edits that `random_edits.py` makes by the hundred thousand."""

from __future__ import annotations

from pathlib import Path

from random_edits import Drift
from seeds import SEED


def test_random_edits_keep_in_step(tmp_path: Path) -> None:
    drift = Drift(tmp_path, seed=7 + SEED)
    drift.edits(300)
    assert drift.editor.close() == ""
