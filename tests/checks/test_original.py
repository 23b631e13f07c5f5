"""The published language's own example, byte for byte: understood, without a wrong diagnostic."""

from __future__ import annotations

from pathlib import Path

import pytest

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import check
from btq_lang.util.text import LineIndex
from btq_lang.workspace.workspace import Workspace

PATH = "/original/paper_example.qualitybtcpp"


@pytest.fixture(scope="module")
def workspace(shared: Path) -> Workspace:
    text = (shared / "original" / "paper_example.qualitybtcpp").read_bytes().decode()
    return Workspace.of({PATH: text})


def test_its_trees_requirements_and_qualities_are_found(workspace: Workspace) -> None:
    assert workspace.files[PATH].parsed.diagnostics == ()
    scope = workspace.scope(PATH)
    assert scope.names(Kind.TREE) == ("mainTree", "PickPlace")
    assert scope.names(Kind.REQUIREMENT) == ("rq1", "rq2", "rq3")
    main = workspace.main_tree(PATH)
    assert main is not None
    assert main.symbol.name == "mainTree"
    uses = [(use.kind, use.name) for _, use in workspace.files[PATH].uses]
    assert (Kind.QUALITY, "performance") in uses
    assert uses.count((Kind.TREE, "PickPlace")) == 2


def test_what_is_said_of_it(workspace: Workspace) -> None:
    lines = LineIndex(workspace.files[PATH].text)
    found = [
        (lines.position(each.span.start).line + 1, each.effective_severity.value, each.rule)
        for each in check(workspace, PATH)
    ]
    placeholders = [(line, "hint", "classic-placeholder") for line in (5, 6, 13, 15, 24, 32, 33)]
    assert sorted(found) == sorted(
        [
            *placeholders,
            (3, "hint", "condition-without-recheck"),
            (8, "hint", "old-quality-name"),
            (10, "hint", "prose-constraint"),
        ]
    )
