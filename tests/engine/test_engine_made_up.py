"""Missions that hypothesis makes up, built by the command and run by the engine: what no check calls an error loads,
ticks, and is the tree that the side file says."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from engine_loader import Answer, Engine, job
from mission_strategies import START, made_up, missions, odd_missions

from btq_lang.btcpp.export import export
from btq_lang.checks import check
from btq_lang.cli import main
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

# What only the tick shows and the mission has brought about itself: a port reads an entry that nobody has written, the
# condition of a WhileDoElse or an IfThenElse is skipped.
PARDONED = re.compile(
    r"Missing parameter \[msec\]|\[WhileDoElse\]: you are not allowed|unexpected happened in IfThenElse"
)


def test_sound_missions_load_and_tick(engine: Engine, tmp_path: Path) -> None:
    # Collected first: an engine that starts for each would take minutes.
    answers = run(engine, made_up(missions(), 250), tmp_path)
    assert len(answers) > 150
    assert {text: answer.error for text, answer in answers.items() if is_refused(answer)} == {}


def test_missions_with_odd_names_load_and_tick(engine: Engine, tmp_path: Path) -> None:
    answers = run(engine, made_up(odd_missions(), 250), tmp_path)
    assert len(answers) > 40
    assert {text: answer.error for text, answer in answers.items() if is_refused(answer)} == {}


def run(engine: Engine, texts: Sequence[str], folder: Path) -> dict[str, Answer]:
    """What the engine makes of the missions without an error, built for its version."""
    version = ".".join(engine.version.split(".")[:2])
    project = Project(engines=(version,))
    sound = [text for text in texts if is_sound(text, project)]
    for number, text in enumerate(sound):
        (folder / f"mission{number:03}.btq").write_text(text, encoding="utf-8", newline="")
    assert main(["build", str(folder), "--target", version]) == 0
    files = sorted(folder.glob("*.xml"))
    answers = engine.run(_job(file) for file in files)
    for file, answer in zip(files, answers, strict=True):
        side = file.with_name(f"{file.stem}.qreq.json")
        said: dict[str, Any] = json.loads(side.read_text(encoding="utf-8")) if side.exists() else {"main_tree": None}
        if said["main_tree"] is not None and answer.stage == "done":
            made = [(node.uid, node.path) for node in answer.tree]
            assert made == [(each["uid"], each["path"]) for each in said["nodes"]], file.read_text(encoding="utf-8")
    return dict(zip(sound, answers, strict=True))


def _job(file: Path) -> dict[str, object]:
    if "main_tree_to_execute=" in file.read_text(encoding="utf-8"):
        return job(file, ticks=12, blackboard=START, halt=True)
    return job(file, every_tree=True)  # a file that only others use


def is_sound(text: str, project: Project) -> bool:
    """Whether a build would write the mission."""
    workspace = Workspace.of({"main.btq": text}, project)
    found = check(workspace, "main.btq")
    return (
        all(each.effective_severity is not Severity.ERROR for each in found)
        and not export(workspace, "main.btq").problems
    )


def is_refused(answer: Answer) -> bool:
    if answer.stage == "tick" and answer.crashed == 0:
        return PARDONED.search(answer.error) is None
    return answer.stage != "done" or answer.crashed != 0
