"""The checks on damaged files: cut, torn and stirred.  None raises, every place is in its file, a safe fix removes its
diagnostic, and a workspace reached by edits gives the same as a new one."""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from check_asserts import assert_sound
from damage import case, damaged
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import share_of

from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.lexer import tokens
from btq_lang.util.record import replace
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SUFFIXES = (".btq", ".qualitybtcpp")
PROJECT = Project(include_paths=("shared",))  # as the hospital's
TORN = 20  # deletions of a line, and of a token, in each file; whole/test_damage.py makes thousands


def folders() -> list[dict[str, str]]:
    """The examples, each with the files that belong to it."""
    found = []
    for folder in sorted(path for path in EXAMPLES.iterdir() if path.is_dir()):
        paths = sorted(path for path in folder.rglob("*") if path.suffix in SUFFIXES)
        found.append({str(path.relative_to(folder)): path.read_text("utf-8") for path in paths})
    return found


# Many mistakes at once: mutations of it reach what no example does.
CROOKED = {
    "main.btq": """\
include "parts.btq"
include "main.btq"
include "nowhere.btq"
qualities iso25010-2011
quality hygiene : safety
signal battery : %
signal battery : V
Action MoveBase
    input place : int = x
    input speed : double
SubTree Sub
    input 1st : string
TreeNodesModel
    Condition Ready
    Condition Ready
        input level
QualityReq rq1 : performance "fast"
    takes at most 30 s
QualityReq rq1 : speed
QualityReq rq2
apply rq3, rq1 to every MoveBase
BehaviorTree
    Sequence
BehaviorTree "a b"
    -> (ID = x) satisfices usability, performance <time-behavior>, robustnes
        MoveBase One (place = 3 m plce = 1 plce = 2)
        MoveBase One
        SubTree Loop
        SubTree
        SubTreePlus (ID = Loop)
        Retry (num_attempts = "3 times")
        Timeout (msec = 1e999 s)
            Switch (case_1 = a case_3 = b)
                Action
                keeps
        || (success_count = 7)
            SequenceStar
            Rety
            BatteryLow?
        "my node" (_skipif = true)
BehaviorTree Loop
    SubTree Loop satisfies rq9, QualityReq rq2, QualityReq rq5 "x"
    TryCatch
BehaviorTree Loop
BehaviorTree Retry
    Inverter
signal speed : m/s from {speed} counter fresh within 3 initially 5 %
signal heat : degC initially -1e999 degC
context hot : heat > 3 and near
context near : hot or "MoveBase"
QualityReq slow(limit : m/s, top : % = 3 m) : safety
    keeps speed + 3 <= limit * heat
    MoveBase takes at most 1e999 s if hot, 0 s if near else limit
    in at least 1e999 % of runs
    confidence 100 %
    over last 1e999 activations
    every Retry tries at most 1e999 per Loop
    from mission starts to Loop fails takes between 5 s and -3 s
    sum of One, MoveBase/MoveBase uses at most 3 degC of heat
    goal 3
apply slow(limit = 3, limit = 5 m/s, x = 2) to every MoveBase under Loop, every node tagged x except Nowhere
QualityReq late
    every Timeout takes at most 1 ms
    every MoveBase takes at least 5 s
    every Loop succeeds
    mission needs -speed > max(heat)
    on violation fail
""",
    "parts.btq": 'include "main.btq"\nsignal battery : K\nBehaviorTree Loop\n    X\nQualityReq rq1 "slow"\n',
}

ALL = [*folders(), CROOKED]
NUMBERS = range(len(ALL))


@pytest.mark.parametrize("number", NUMBERS)
def test_every_prefix(number: int) -> None:
    for path, text in ALL[number].items():
        lines = text.splitlines(keepends=True)
        for count in share_of(range(len(lines)), 8):
            examine_torn(number, path, "".join(lines[:count]))


@pytest.mark.parametrize("number", NUMBERS)
def test_a_line_missing(number: int) -> None:
    chance = random.Random(number)
    for path, text in ALL[number].items():
        lines = text.splitlines(keepends=True)
        for index in share_of(chance.sample(range(len(lines)), min(TORN, len(lines))), 8):
            examine_torn(number, path, "".join(lines[:index] + lines[index + 1 :]))


@pytest.mark.parametrize("number", NUMBERS)
def test_a_token_missing(number: int) -> None:
    chance = random.Random(number)
    for path, text in ALL[number].items():
        words = [token for token in tokens(text) if token.text.strip()]
        for token in share_of(chance.sample(words, min(TORN, len(words))), 8):
            examine_torn(number, path, text[: token.start] + text[token.end :])


@pytest.fixture(scope="module", autouse=True)
def missions_are_made() -> None:
    """Hypothesis makes some of the missions whose pieces are put in, which it must not do within a test of its own."""
    case(0, 0)


@st.composite
def mutated(draw: st.DrawFn) -> tuple[dict[str, str], str]:
    """The files of an example, one of them damaged, and which."""
    files = dict(draw(st.sampled_from(ALL)))
    path = draw(st.sampled_from(sorted(files)))
    files[path] = mutation(draw, files[path])
    return files, path


def mutation(draw: Callable[[st.SearchStrategy[Any]], Any], text: str) -> str:
    chance = draw(st.randoms(use_true_random=False))
    for _ in range(draw(st.integers(1, 4))):
        text = damaged(chance, text)
    return text


@given(mutated())
def test_mutated_files(mutated: tuple[dict[str, str], str]) -> None:
    files, path = mutated
    examine(Workspace.of(files, PROJECT), path, are_fewer=False)


@given(st.data())
@settings(max_examples=40)
def test_a_workspace_reached_by_edits_says_the_same_as_a_fresh_one(data: st.DataObject) -> None:
    files = dict(data.draw(st.sampled_from(ALL)))
    workspace = Workspace.of(files, PROJECT)
    for _ in range(data.draw(st.integers(1, 4))):
        path = data.draw(st.sampled_from(sorted(files)))
        if data.draw(st.booleans()) and len(files) > 1:
            del files[path]
            workspace = Workspace({name: workspace.files[name] for name in files}, PROJECT)
        else:
            files[path] = mutation(data.draw, files[path])
            workspace = workspace.with_file(path, files[path])
        said(workspace)  # so that whatever is kept for later is there when the next edit comes
    assert said(workspace) == said(Workspace.of(files, PROJECT))


def test_the_order_of_the_files_is_nothing() -> None:
    for files in ALL:
        assert said(Workspace.of(files, PROJECT)) == said(Workspace.of(dict(reversed(files.items())), PROJECT))


@pytest.mark.parametrize("version", ["4.6", "4.8", "4.10"])
def test_every_version_of_the_engine(version: str) -> None:
    for files in ALL:
        for path in files:
            examine(Workspace.of(files, replace(PROJECT, engines=(version,))), path)


def said(workspace: Workspace) -> dict[str, tuple[Diagnostic, ...]]:
    return {path: check(workspace, path) for path in sorted(workspace.files)}


def examine_torn(number: int, path: str, text: str) -> None:
    """Examine an example with another text in one of its files; what is known of the others is known for all texts."""
    examine(whole(number).with_file(path, text), path)


@cache
def whole(number: int) -> Workspace:
    return Workspace.of(ALL[number], PROJECT)


def examine(workspace: Workspace, path: str, *, are_fewer: bool = True) -> None:
    assert_sound(workspace, path, check(workspace, path), are_fewer=are_fewer)
