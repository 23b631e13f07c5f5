"""What parsers are measured on: the synthetic mission, imported public files, and drawn missions."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import drawn_missions
import missions
from turns import ROOT

NODES = 10_000


@dataclass(frozen=True)
class Input:
    """A file or a folder of files, with so many nodes together."""

    name: str
    path: Path
    nodes: int


def three(folder: Path, seed: int) -> Iterator[Input]:
    """The three inputs, written into a folder: the same synthetic mission each time, in both spellings, the imported
    files if they are there, and the drawn missions of a seed.
    """
    plan = missions.plan(NODES)
    for spelling in ("classic", "short"):
        path = folder / f"synthetic.{spelling}.btq"
        path.write_text(missions.write(plan, spelling), encoding="utf-8")
        yield Input(f"synthetic mission, {spelling}", path, NODES)
    if found := imported(folder / "imported"):
        yield found
    drawn = folder / "drawn"
    drawn.mkdir()
    for number, text in enumerate(drawn_missions.missions(NODES, seed)):
        (drawn / f"{number:04}.btq").write_text(text, encoding="utf-8", newline="")
    yield Input(f"drawn missions, seed {seed}", drawn, NODES)


def imported(folder: Path) -> Input | None:
    """The public files that `btq import` takes, as it writes them; nothing, and a note, where they are not there."""
    shared = Path(os.environ.get("BTQ_SHARED") or ROOT.parent / "shared")
    files = [str(path) for part in ("corpus", "original") for path in (shared / part).rglob("*.xml")]
    if not files:
        print(
            f"The public files are left out: there are none in {shared};"
            " set BTQ_SHARED to the folder that holds corpus/ and original/",
            file=sys.stderr,
        )
        return None
    folder.mkdir()
    command = (sys.executable, "-m", "btq_lang", "import", "-o", str(folder), *sorted(files))
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, env=os.environ | {"PYTHONPATH": str(ROOT)}
    )
    if done.returncode not in (0, 1):  # 1: some are refused, being no XML or of another kind
        raise SystemExit(f"`btq import` failed:\n{done.stdout}{done.stderr}")
    written = list(folder.iterdir())
    return Input(f"{len(written)} imported public files", folder, sum(map(_nodes, written)))


def _nodes(path: Path) -> int:
    import btq_lang

    parsed = btq_lang.parse(path.read_text(encoding="utf-8"))
    return sum(1 for tree in parsed.trees for _ in tree.walk())
