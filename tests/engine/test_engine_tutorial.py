"""The program of docs/tutorial.md, compiled and run as the page says, and the verdicts on its log."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
from pathlib import Path

from engine_loader import Engine
from in_process import run_btq

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_the_tutorial_comes_to_its_verdicts(engine: Engine, tmp_path: Path) -> None:
    (program,) = blocks("tutorial.md", "cpp")
    (commands,) = blocks("tutorial.md", "console")
    (tmp_path / "guide.btq").write_text(blocks("tutorial.md", "btq")[-1], encoding="utf-8")
    assert run_btq("build", "guide.btq", cwd=tmp_path)[0] == 0
    too_fast = program.replace("0.5", "1.0")
    assert too_fast != program
    assert verdicts(program, commands, engine, tmp_path) == (0, {"on_time": "satisfied", "gentle": "satisfied"})
    assert verdicts(too_fast, commands, engine, tmp_path)[1]["gentle"] == "violated"


def test_the_lines_about_evidence_are_of_that_program() -> None:
    (program,) = blocks("tutorial.md", "cpp")
    (lines,) = blocks("evidence.md", "cpp")
    assert lines in program


def verdicts(program: str, commands: str, engine: Engine, folder: Path) -> tuple[int, dict[str, str]]:
    """What the commands of the page come to: the exit code of the last one, and the verdict of each requirement."""
    (folder / "guide.cpp").write_text(program, encoding="utf-8")
    *before, judges = re.findall(r"^\$ (.*)$", commands, re.MULTILINE)
    for command in before:
        environment = {**os.environ, "PREFIX": str(prefix_of(engine))}
        subprocess.run(["bash", "-c", command], cwd=folder, env=environment, check=True)
    code, printed, _ = run_btq(*shlex.split(judges)[1:], "--format", "json", cwd=folder)
    return code, {each["id"]: each["verdict"] for each in json.loads(printed)["requirements"]}


def prefix_of(engine: Engine) -> Path:
    """Where the engine is installed: its package is in lib/cmake/NAME there, as ROS ships it in share/NAME/cmake."""
    cache = (engine.program.parent / "CMakeCache.txt").read_text(encoding="utf-8")
    (package,) = re.findall(r"^behaviortree_cpp_DIR:PATH=(.*)$", cache, re.MULTILINE)
    return Path(package).parents[2]


def blocks(page: str, language: str) -> list[str]:
    text = (DOCS / page).read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
