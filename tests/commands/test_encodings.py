"""The commands where standard output has an encoding that lacks characters, such as a pipe on Windows.

An encoding is set as a system does it, by `PYTHONIOENCODING`, in processes.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from btq_lang.render import FORMATS

MISSION = """\
BehaviorTree Größe
    ->
        Action Pick "→ “x” ≤ 3 …"
        Kühl
        Timeout (msec = -5)
            Dock
QualityReq Schnell
    "φ ✓"
    Pick takes at most 3 “m”
"""


def btq(folder: Path, encoding: str, *arguments: str) -> tuple[int, bytes, bytes]:
    """The exit code and the bytes that are written."""
    done = subprocess.run(
        [sys.executable, "-m", "btq_lang", *arguments],
        cwd=folder,
        capture_output=True,
        env={**os.environ, "PYTHONIOENCODING": encoding, "NO_COLOR": "1"},
        timeout=60,
    )
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "mission.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "old.btq").write_text(MISSION.replace("φ", "ψ"), encoding="utf-8")
    return tmp_path


COMMANDS = (
    *(f"check mission.btq --output-format {form}" for form in FORMATS),
    "check mission.btq --statistics",
    "check mission.btq --fix --diff",
    "explain",
    "explain takes",
    "trace mission.btq",
    "trace mission.btq --format markdown",
    "graph mission.btq",
    "diff old.btq mission.btq",
    "diff old.btq mission.btq --format markdown",
    "format --diff mission.btq",
    "build mission.btq --verbose",
    "verify --mission mission.btq no→log.btlog",
    "check --help",
    "--help",
)


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_writes_in_every_encoding(command: str, encoding: str, folder: Path) -> None:
    code, out, err = btq(folder, encoding, *command.split())
    expected = btq(folder, "utf-8", *command.split())
    assert (code, len(out.splitlines()), len(err.splitlines())) == (
        expected[0],
        len(expected[1].splitlines()),
        len(expected[2].splitlines()),
    )
    assert b"internal error" not in err


@pytest.mark.parametrize(
    ("encoding", "line"),
    [
        ("cp1252", '    Pick (a = "-> “é” <= 3 …"'),
        ("cp437", '    Pick (a = "-> "é" ≤ 3 ..."'),
        ("ascii", '    Pick (a = "-> "e" <= 3 ..."'),
    ],
)
def test_what_an_encoding_lacks_is_replaced_by_what_can_be_read(encoding: str, line: str, folder: Path) -> None:
    (folder / "main.btq").write_text('BehaviorTree Main\n    Pick (a = "→ “é” ≤ 3 …"\n', encoding="utf-8")
    _, out, _ = btq(folder, encoding, "check", "main.btq")
    assert out.decode(encoding).splitlines()[4] == f"2 | {line}"


def test_what_programs_read_and_files_are_utf_8(folder: Path) -> None:
    for arguments in (("check", "mission.btq", "--output-format", "junit"), ("graph", "mission.btq")):
        assert btq(folder, "cp1252", *arguments)[1] == btq(folder, "utf-8", *arguments)[1]
    btq(folder, "ascii", "check", "mission.btq", "-o", "report.txt")
    assert "“m”" in (folder / "report.txt").read_text(encoding="utf-8")
