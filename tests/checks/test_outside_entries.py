"""The entries that bt_navigator sets before a tree runs: known to checks where the nodes of Nav2 are."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from btq_lang.catalog.nav2 import DISTRIBUTIONS, FILES
from btq_lang.catalog.nav2.navigator import outside_entries
from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace

MISSION = """\
BehaviorTree Main
    ->
        ComputePathToPose (goal = {gaol} path = {path})
        FollowPath (path = {path} error_code_id = {folow_path_error_code})
        Own (a = {wait_for_service_timeout} b = {server_timeuot})
        SubTree Below

BehaviorTree Below
    Own (a = {odom_smother})

Action Own
    input a
    input b = ""
"""


def found(distribution: str | None, text: str = MISSION) -> Iterator[tuple[int, str]]:
    nodes = (FILES[distribution],) if distribution is not None else ()
    files = {path: File(path, Path(path).read_text(encoding="utf-8")) for path in nodes}
    workspace = Workspace({**files, "m.btq": File("m.btq", text)}, Project(node_files=nodes))
    lines = workspace.files["m.btq"].lines
    for each in check(workspace, "m.btq"):
        if each.rule in ("misspelt-entry", "signal-never-written"):
            yield lines.position(each.span.start).line + 1, each.message


def test_a_misspelt_one_is_found_though_no_node_writes_the_right_one() -> None:
    assert [*found("lyrical")] == [
        (3, "nothing writes `gaol`, which is read here; did you mean `goal`?"),
        (4, "nothing reads `folow_path_error_code`, which is written here; did you mean `follow_path_error_code`?"),
        (5, "nothing writes `server_timeuot`, which is read here; did you mean `server_timeout`?"),
    ]


def test_humble_collects_no_error_codes() -> None:
    assert [line for line, _ in found("iron")] == [3, 4, 5]
    assert [line for line, _ in found("humble")] == [3, 5]
    assert [line for line, _ in found(None)] == []


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_none_is_called_unset(distribution: str) -> None:
    names = [name for name, direction in outside_entries(distribution) if direction != "input"]
    ports = "\n".join(f"    input p{at}" for at in range(2 * len(names)))
    given = " ".join(f"p{at} = {{{name}}} p{at + len(names)} = {{{name}_}}" for at, name in enumerate(names))
    text = f"BehaviorTree Main\n    Own ({given})\n\nAction Own\n{ports}\n"
    assert [*found(distribution, text)] == []


@pytest.mark.parametrize(("distribution", "lines"), [("lyrical", [1, 2]), ("kilted", [2])])
def test_a_signal_of_one_is_written(distribution: str, lines: list[int]) -> None:
    """`pathh` is likely to be a misspelt `path` only where that is set."""
    text = (
        "signal way : 1 from {pathh}\nsignal loops : 1 from {bt_lop_duration}\nBehaviorTree Main\n    AlwaysSuccess\n"
    )
    assert [line for line, _ in found(distribution, text)] == lines
