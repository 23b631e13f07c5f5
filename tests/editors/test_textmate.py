"""The TextMate grammar, run by the engine of VS Code: which scopes each word has, held against reviewed snapshots.

Where the grammar is meant to change: `pytest tests/editors/test_textmate.py --update`, and look at the difference.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from installed import ROOT, there

SNAPSHOTS = Path(__file__).parent / "snapshots"
EXTENSION = ROOT / "editors" / "vscode"


@pytest.mark.parametrize(
    "source", ["tests/every_form.btq", "examples/laboratory/mission.btq", "examples/classic/inspector.qualitybtcpp"]
)
def test_every_word_has_its_scopes(source: str, node: Path, update: bool, tmp_path: Path) -> None:
    program = there(
        EXTENSION / "node_modules/vscode-tmgrammar-test/dist/snapshot.js", "vscode-tmgrammar-test", "package"
    )
    name = source.replace("/", "-")
    shutil.copyfile(ROOT / source, tmp_path / name)
    run = subprocess.run(
        [str(node), str(program), "--updateSnapshot", str(tmp_path / name)],
        cwd=EXTENSION,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    made = (tmp_path / f"{name}.snap").read_text(encoding="utf-8")
    reviewed = SNAPSHOTS / f"{name}.snap"
    if update:
        reviewed.write_text(made, encoding="utf-8")
    assert made.splitlines() == reviewed.read_text(encoding="utf-8").splitlines()
