"""After an edit, the checks report what they would report for a new workspace."""

from __future__ import annotations

import gc
import random
from collections import Counter
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import missions
import pytest
from kept_checks import Kept
from seeds import seeds, share_of

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import CHECKS, Check, check
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.tree import Tree
from btq_lang.workspace.config import Project
from btq_lang.workspace.factories import Factory
from btq_lang.workspace.resolved import ResolvedTree
from btq_lang.workspace.workspace import Workspace

EVERY_FORM = (Path(__file__).parents[1] / "every_form.btq").read_text(encoding="utf-8")
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
BOARDS = """include "skills.btq"
Action Take
    input what : string
    output taken : int
Action Look
    output seen : string
BehaviorTree Main
    ->
        Take (what = {goal} taken = {count})
        SubTree Carry (to = {goal} speed = {count})
        SubTree Bring (_autoremap = true)
        Script (code = "goal_x := 1; done := True")
        Look (seen = text)
BehaviorTree Bring
    R?
        Take (what = {gaol} taken = {@count})
        SubTree Round (a = {count})
        SubTree "" (_skipIf = "done")
BehaviorTree Round
    ->
        AlwaysFailure
        SubTree Bring (_while = "goal == 1")
        ScriptCondition (name = "Near?")
        Look (seen = {a})
BehaviorTree Alone
    Fallback
        ScriptAction (name = "Near!")
        SubTree Round
        Look (seen = 3)
        Look (seen = 4)
        Look (seen = 5)
"""
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
        "{goal}",
        "@",
        " (_autoremap = true)",
        " (a = {b})",
        'Script (code = "goal := 1")',
        "AlwaysSuccess",
        "\nSubTree Round\n",
        "\n        SubTree Alone (to = {goal})\n",
        "BehaviorTree Bring\n    AlwaysFailure\n",
    ),
)


EDITED = {
    "includes": FILES,
    "every form": {"/p/main.btq": EVERY_FORM},
    "entries": {"/p/main.btq": BOARDS, "/p/skills.btq": SKILLS},
    "classic": {"/p/main.btq": missions.mission(60, 2, "classic")},
    "short": {"/p/main.btq": missions.mission(60, 2, "short")},
}


@pytest.mark.parametrize(("seed", "name"), list(product(share_of(seeds(4), 4), EDITED)))
def test_what_is_kept_is_what_would_be_found(seed: int, name: str) -> None:
    files = EDITED[name]
    chance = random.Random(seed)
    workspace = Workspace.of(files)
    kept = {path: Kept() for path in files}
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
            assert kept[each].check(workspace, each).diagnostics == check(fresh, each), (step, each, texts)


TOP = """<root BTCPP_format="4">
<BehaviorTree ID="Top"><Sequence><SubTree ID="Carry" ot="x"/><Take what="{gaol}"/><SubTree ID="Alone"/></Sequence>
</BehaviorTree></root>
"""


PROJECTS = {
    "factory": (Project(), Factory("f", main=("Main", "Top"), files=("/p/main.btq", "/p/top.xml", "/p/skills.btq"))),
    "files of nodes": (
        Project(),
        Factory("f", main=("Gone",), files=("/p/main.btq", "/p/top.xml"), node_files=("/p/skills.btq",)),
    ),
    "pool": (Project(pools=("/p",)), None),
}


@pytest.mark.parametrize(("seed", "name"), list(product(share_of(seeds(4), 4), PROJECTS)))
def test_what_is_kept_is_found_beyond_includes(seed: int, name: str) -> None:
    project, factory = PROJECTS[name]
    chance = random.Random(seed)
    texts = {"/p/main.btq": BOARDS.replace('include "skills.btq"', ""), "/p/skills.btq": SKILLS, "/p/top.xml": TOP}
    workspace = Workspace({path: file_of(path, text) for path, text in texts.items()}, project, factory)
    kept = {path: Kept() for path in texts}
    for step in range(60):
        path = chance.choice(("/p/main.btq", "/p/skills.btq"))
        text = workspace.files[path].text
        at = chance.randrange(len(text) + 1)
        text = text[:at] + chance.choice((*PIECES, "", "")) + text[at + chance.choice((0, 0, 1, 5)) :]
        text = texts[path] if chance.random() < 0.15 else text
        workspace = workspace.with_file(path, text)
        now = {each: file_of(each, file.source) for each, file in workspace.files.items()}
        fresh = Workspace(now, project, factory)
        assert workspace == fresh
        for each in texts:
            assert kept[each].check(workspace, each).diagnostics == check(fresh, each), (step, each, text)


def test_what_no_quote_closes_is_not_empty() -> None:
    workspace = Workspace.of(
        {"/p/main.btq": 'QualityReq "Slowly\nQualityReq rq1 : safety "Calm"\n    takes at most 3 s\n'}
    )
    anew, kept = check(workspace, "/p/main.btq"), Kept().check(workspace, "/p/main.btq").diagnostics
    assert [each.rule for each in anew] == [each.rule for each in kept] == ["unclosed-string"]


@pytest.mark.parametrize("spelling", ["classic", "short"])
def test_trees_and_requirements_change_names_and_places(spelling: missions.Spelling) -> None:
    """In a file of so many trees that cached results about all of them are updated instead of recomputed."""
    chance = random.Random(1)
    lines = missions.mission(300, 3, spelling).split("\n")
    kept = Kept()
    workspace = Workspace.of({"/p/main.btq": "\n".join(lines)})
    for step in range(20):
        named = [at for at, line in enumerate(lines) if line.lstrip().startswith(("BehaviorTree", "QualityReq"))]
        one, other = chance.choice(named), chance.choice(named)
        change = chance.randrange(3)
        if change == 0:
            lines[one], lines[other] = lines[other], lines[one]
        else:
            lines[one] = lines[one][:-1] if change == 1 else f"{lines[one]}a"
        text = "\n".join(lines)
        workspace = workspace.with_file("/p/main.btq", text)
        fresh = Workspace.of({"/p/main.btq": text})
        assert kept.check(workspace, "/p/main.btq").diagnostics == check(fresh, "/p/main.btq"), (step, text)


def asked_after(monkeypatch: pytest.MonkeyPatch, before: dict[str, str], after: dict[str, str], path: str) -> list[str]:
    """The trees of a file that the checks read when some files change."""
    asked: list[str] = []

    def noting(view: View) -> Iterator[Diagnostic]:
        asked.append(view.tree_name.text if view.tree_name is not None else "")
        yield from ()

    monkeypatch.setitem(CHECKS, Tree, (*CHECKS[Tree], noting))
    workspace = Workspace.of(before)
    answers = Kept()
    answers.check(workspace, path)
    asked.clear()
    for other, text in after.items():
        workspace = workspace.with_file(other, text)
    assert answers.check(workspace, path).diagnostics == check(Workspace.of({**before, **after}), path)
    return asked[: len(asked) - len(workspace.files[path].parsed.trees)]  # without those of the fresh workspace


def test_an_edit_in_one_tree_asks_for_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    edited = {"/p/main.btq": MAIN.replace("Sleep", "Sleeep")}
    assert asked_after(monkeypatch, FILES, edited, "/p/main.btq") == ["Help"]


def test_a_model_that_changes_is_asked_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    edited = {"/p/skills.btq": SKILLS.replace("input speed", "input haste")}
    assert asked_after(monkeypatch, FILES, edited, "/p/main.btq") == ["Main", "Help"]


@pytest.mark.parametrize(
    "text", [EVERY_FORM, BOARDS, missions.mission(60, 2, "classic"), missions.mission(60, 2, "short")]
)
def test_every_check_says_what_it_asks_for(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    """Else it would run again for every item after every edit."""
    asked: list[tuple[str, type]] = []

    def watched(check: Check) -> Check:
        def noting(view: View) -> Iterator[Diagnostic]:
            asked.append((check.__name__, type(view.item)))
            yield from check(view)

        return noting

    for item, checks in CHECKS.items():
        monkeypatch.setitem(CHECKS, item, tuple(map(watched, checks)))
    answers = Kept()
    workspace = Workspace.of({"/p/main.btq": text})
    answers.check(workspace, "/p/main.btq")
    asked.clear()
    answers.check(workspace.with_file("/p/main.btq", f"{text}\n# the end\n"), "/p/main.btq")
    last = type(workspace.files["/p/main.btq"].parsed.entries[-1].item)
    assert {item for _, item in asked} <= {last}
    assert set(Counter(asked).values()) <= {1}


def test_what_an_edit_replaces_goes_when_it_is_swept() -> None:
    """What is computed from a workspace keeps the whole of it alive."""
    workspace, answers = Workspace.of(FILES), Kept()
    gc.collect()
    before = Counter(type(each) for each in gc.get_objects())
    for letter in "abc":
        workspace = workspace.with_file("/p/main.btq", MAIN.replace("Place it", f"Place {letter}"))
        answers.check(workspace, "/p/main.btq")
    assert answers.workspace is not None
    answers.workspace.store.sweep(always=True)
    gc.collect()  # nodes and their parents hold each other
    after = Counter(type(each) for each in gc.get_objects())
    trees = sum(len(file.of_type(Tree)) for file in workspace.files.values())
    assert after[ResolvedTree] - before[ResolvedTree] == trees
