"""`[[overrides]]` of the project file: other severities in some files, at the command line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from in_process import run_btq

Check = Callable[..., tuple[int, str, str]]

WRONG = "BehaviorTree Main\n    Sequnce\n        Dock (a = {=})\n"
PROJECT = """\
[[overrides]]
include = ["vendor/"]
ignore = ["unknown-node"]

[[overrides]]
include = ["vendor/**/*.new.btq", "vendor/a.xml"]

[overrides.rules]
unknown-node = "error"
"""


@pytest.fixture
def check(tmp_path: Path) -> Check:
    """`btq check` in a project with own and vendor's files."""
    (tmp_path / "btq.toml").write_text(PROJECT)
    for name in ("own.btq", "vendor/a.btq", "vendor/lib/a.btq", "vendor/lib/a.new.btq"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(WRONG)
    return lambda *arguments: run_btq("check", "--output-format", "concise", *arguments, cwd=tmp_path)


def places(printed: str) -> list[str]:
    return [line.split("]")[0] for line in printed.splitlines() if "[" in line]


def test_a_folder_has_its_own_severities(check: Check) -> None:
    code, printed, errors = check("--select", "unknown-node")
    assert (code, errors) == (1, "")
    assert places(printed) == ["own.btq:2:5: warning[unknown-node", "vendor/lib/a.new.btq:2:5: error[unknown-node"]
    assert check("--select", "unknown-node", "vendor/lib/a.btq")[0] == 0


def test_xml_has_them_too(check: Check, tmp_path: Path) -> None:
    xml = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequnce><A/></Sequnce></BehaviorTree></root>\n'
    for name in ("own.xml", "vendor/a.xml", "vendor/b.xml"):
        (tmp_path / name).write_text(xml)
    printed = check("--select", "unknown-node", "own.xml", "vendor/a.xml", "vendor/b.xml")[1]
    assert places(printed) == ["own.xml:1:49: warning[unknown-node", "vendor/a.xml:1:49: error[unknown-node"]


def test_the_command_line_comes_first(check: Check) -> None:
    assert places(check("--ignore", "unknown-node", "vendor/lib/a.new.btq")[1]) == []


def test_a_mistake_in_them_is_trouble(check: Check, tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text(PROJECT.replace('include = ["vendor/"]', 'includes = ["vendor/"]'))
    code, _, errors = check()
    assert code == 2
    assert errors.splitlines() == [
        "btq: btq.toml:1:3: `overrides.include` must have at least one pattern, none of them empty",
        "btq: btq.toml:2:1: unknown key `overrides.includes`; did you mean `include`?",
    ]
