"""What checks keep from one edit to the next is what they would find anew."""

from __future__ import annotations

import random
from pathlib import Path

import missions
import pytest

from btq_lang.checks import Kept, check
from btq_lang.workspace import Workspace

EVERY_FORM = (Path(__file__).parent / "every_form.btq").read_text(encoding="utf-8")
MAIN = """include "skills.btq"
include "requirements.btq"
Root Main
BehaviorTree Main
    ->
        Pick (from = {shelf} speed = 3) satisfies rq1
        SubTree Carry (to = "x")
        ScriptAction (name = "Place it")
        Timeout (msec = 30 s)
            Place satisfies rq2
BehaviorTree Help
    ? (name = "a")
        Inverter (name = "a")
            Pick satisfices performance, gentleness
        Sleep
        SubTree Carry
"""
SKILLS = """Action Pick
    input from : string
    input speed : double
quality gentleness : safety
BehaviorTree Carry
    input to : string
    Move (to = {to})
"""
REQUIREMENTS = """signal battery : %
QualityReq rq1 : safety "Slowly"
    takes at most 3 s
QualityReq rq2 "Then"
    keeps battery > 3 %
    on violation fail
"""
FILES = {"/p/main.btq": MAIN, "/p/skills.btq": SKILLS, "/p/requirements.btq": REQUIREMENTS}
PIECES = (
    *(
        "\n",
        "    ",
        "Pick",
        "Carry",
        "rq1",
        "rq2",
        "a",
        "1",
        '"',
        "(",
        ")",
        "{",
        "}",
        "# ",
        "-",
        " = ",
        ", ",
        "?",
        "->",
    ),
    *("\n    ->\n", "\nBehaviorTree B\n    Pick (from = 3)\n", "\nAction Move\n    input to : int\n", " satisfies rq1"),
    *(
        "\nsignal s : %\n",
        "\nquality q : safety\n",
        "qualities iso25010-2011\n",
        " (name = a)",
        " satisfices performance",
    ),
    *(
        "\nQualityReq rq3\n",
        "Root B\n",
        "TreeNodesModel\n",
        "SubTree ",
        "Timeout",
        "Inverter",
        "30 s",
        'include "main.btq"\n',
    ),
)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    "files",
    [
        FILES,
        {"/p/main.btq": EVERY_FORM},
        {"/p/main.btq": missions.mission(60, 2, "classic")},
        {"/p/main.btq": missions.mission(60, 2, "short")},
    ],
    ids=["includes", "every form", "classic", "short"],
)
def test_what_is_kept_is_what_would_be_found(files: dict[str, str], seed: int) -> None:
    chance = random.Random(seed)
    workspace = Workspace.of(files)
    kept: dict[str, dict[int, Kept]] = {path: {} for path in files}
    for step in range(60):
        path = chance.choice(sorted(files))
        text = workspace.files[path].text
        at = chance.randrange(len(text) + 1)
        gone = chance.choice((0, 0, 1, 1, 5))
        text = text[:at] + chance.choice((*PIECES, "", "")) + text[at + gone :]
        if chance.random() < 0.15:
            text = files[path]  # mend it all: after a mistake in syntax there is less to find
        workspace = workspace.with_file(path, text)
        texts = {each: file.text for each, file in workspace.files.items()}
        fresh = Workspace.of(texts)
        for each in files:
            assert check(workspace, each, kept[each]) == check(fresh, each), (step, each, texts)


def test_an_edit_in_one_tree_leaves_what_was_found_in_the_others() -> None:
    workspace = Workspace.of(FILES)
    kept: dict[int, Kept] = {}
    check(workspace, "/p/main.btq", kept)
    before = [one.found for one in kept.values()]
    check(workspace.with_file("/p/main.btq", MAIN.replace("Sleep", "Sleeep")), "/p/main.btq", kept)
    after = [one.found for one in kept.values()]
    assert [now is then for now, then in zip(after, before, strict=True)] == [True, True, False]


def test_a_model_that_changes_is_asked_for_again() -> None:
    workspace = Workspace.of(FILES)
    kept: dict[int, Kept] = {}
    assert "unknown-port" not in {one.rule for one in check(workspace, "/p/main.btq", kept)}
    changed = workspace.with_file("/p/skills.btq", SKILLS.replace("input speed", "input haste"))
    assert "unknown-port" in {one.rule for one in check(changed, "/p/main.btq", kept)}
