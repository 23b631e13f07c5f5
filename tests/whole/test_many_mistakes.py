"""Thousands of mistakes in one file take as much longer as they are more: what is counted is calls, never time."""

from __future__ import annotations

import cProfile
from collections.abc import Callable, Iterable
from typing import TypeVar

import pytest
from kept_checks import Kept

from btq_lang.checks import check
from btq_lang.render import Finding, Report, render
from btq_lang.workspace.workspace import Workspace

T = TypeVar("T")
MAIN = "main.btq"
FEW, MANY = 100, 200
# Up to some hundreds of unknown names what is near to each is looked for among all: so many for it to show.
MORE = {"unknown in contexts": 600, "paths to nothing": 400}


def tree(lines: Iterable[str]) -> str:
    return "BehaviorTree Main\n    ->\n" + "".join(f"        {line}\n" for line in lines)


def in_tree(line: str, head: str = "") -> Callable[[int], str]:
    """A node for each mistake, `{i}` the number of it."""
    return lambda count: head + tree(line.replace("{i}", str(number)) for number in range(count))


def items(item: str, tail: str = "BehaviorTree Main\n    Action Go\n", head: str = "") -> Callable[[int], str]:
    """An item, or a line of one, for each."""
    return lambda count: head + "".join(item.replace("{i}", str(number)) for number in range(count)) + tail


def demands(clauses: str) -> Callable[[int], str]:
    return items(f"QualityReq r{{i}} : safety\n    {clauses}\n", head="signal s : m from {s}\n")


GO = "Action Go\n    input a : int\n"
TIMES = "QualityReq r(a : s) : safety\n    takes at most a\n"
MISTAKES: dict[str, Callable[[int], str]] = {
    "syntax": in_tree("Go ) x{i}"),
    "an attribute on a line of its own": items(
        "        Go\n            value = {x{i}}\n", "", "BehaviorTree M\n    ->\n"
    ),
    "characters": in_tree("Go° ; {i}"),
    "unclosed strings": in_tree('Go (a = "x{i})'),
    "unclosed brackets": in_tree("Go (a = x{i}"),
    "unclosed comments": in_tree("Go /* a{i}"),
    "indentation": items("        Go\n      Go\n", "", "BehaviorTree M\n    ->\n"),
    "items": items("Behaviour T{i}\n"),
    "clauses": items("    tkes at most {i} s\n", head="QualityReq r\n"),
    "unclosed titles": items("QualityReq r{i} (\n"),
    "unknown units": in_tree("Timeout (msec = {i} sek)"),
    "units that are glued": in_tree("Timeout (msec = {i}sek)"),
    "units in one requirement": items("    keeps s > {i} sek\n", head="signal s : m from {s}\nQualityReq r : safety\n"),
    "unknown nodes": in_tree("Knwn", "Action Known\n"),
    "unknown trees": in_tree("SubTree Nowhere{i}"),
    "unknown requirements": in_tree("Go satisfies rq{i}"),
    "unknown qualities": in_tree("Go satisfices qual{i}"),
    "unknown ports": in_tree("Go (b{i} = 1)", GO),
    "missing ports": in_tree("Go", GO),
    "wrong values": in_tree("Go (a = x{i})", GO),
    "an attribute again": lambda count: GO + tree([f"Go ({' '.join(f'a = {number}' for number in range(count))})"]),
    "children": in_tree("Inverter"),
    "scripts": in_tree('Script (code = "a := {i} +")'),
    "names of nodes": in_tree("Go same", "Action Go\n"),
    "names of trees": items("BehaviorTree Same\n    Go\n", ""),
    "names of signals": items("signal same : m from {a{i}}\n"),
    "names of requirements": items('QualityReq same "a{i}"\n'),
    "requirements that differ": in_tree(
        'Go (satisfices Quality = safety (QualityReq ID = "same" description = "a{i}"))'
    ),
    "circles": items("BehaviorTree T{i}\n    SubTree T{i}\n", ""),
    "circles that run another one": lambda count: "".join(
        f"BehaviorTree T{i}\n    ->\n        SubTree T{i}\n        SubTree T{max(i - 1, 0)}\n" for i in range(count)
    ),
    "contexts of themselves": items("context c{i} : c{i}\n"),
    "circles of contexts": lambda count: "".join(f"context c{i} : c{(i + 1) % count}\n" for i in range(count)),
    "unused": items("signal s{i} : m from {s{i}}\ncontext c{i} : s{i} > 3 m\n"),
    "unknown in contexts": items("context c{i} : nothing{i}\n"),
    "unknown in requirements": demands("Go keeps sig{i} > 3 m"),
    "units of requirements": demands("Go keeps s > 3 kg"),
    "paths to nothing": lambda count: demands("Gone{i} takes at most 1 s")(count).replace(
        "BehaviorTree Main\n    Action Go\n", tree(f"Action Go{number} label{number}" for number in range(count))
    ),
    "paths to several": lambda count: demands("Go takes at most 1 s")(count).replace(
        "    Action Go\n", "    ->\n" + "        Action Go\n" * count
    ),
    "kinds of nothing": demands("every Gone{i} takes at most 1 s"),
    "tags of nothing": lambda count: (
        "QualityReq r : safety\n    takes at most 1 s\n"
        + "".join(f"apply r to every node tagged gone{number}\n" for number in range(count))
        + tree(f"Action Go{number} tags t{number}" for number in range(count))
    ),
    "bounds": items("    Go takes at most {i} s\n", head="QualityReq r : safety\n"),
    "limits": items("QualityReq r{i} : safety\n    takes at most 0.1 ms\n    on violation fail\napply r{i} to Go\n"),
    "parameters": in_tree("Go satisfies r(b{i} = 3 s)", TIMES),
    "two values": items("apply r(a = {i} s) to Go\n", head=TIMES),
    "includes": items('include "x{i}.btq"\n'),
    "silenced": in_tree("Go # btq: ignore[nonsense{i}]"),
    "placeholders": in_tree('ScriptAction (name = "A b{i}")'),
    "entries of two types": in_tree(
        "A (x = {e{i}})\n        B (x = {e{i}})", "Action A\n    input x : int\nAction B\n    input x : double\n"
    ),
    "subtrees": in_tree("SubTree S (a = x{i} b = {c})", "BehaviorTree S\n    input a : int\n    Go (x = {a})\n"),
}


class Calls:
    """How many functions are called for each thing done, Python's own ones too."""

    def __init__(self) -> None:
        self.counts: list[int] = []

    def __call__(self, work: Callable[[], T]) -> T:
        profile = cProfile.Profile()
        done = profile.runcall(work)
        self.counts.append(sum(entry.callcount for entry in profile.getstats()))
        return done


def calls(text: str) -> list[int]:
    """What it costs to check a text, to check it again after an edit as an editor does, and to print what is found."""
    counted, answers = Calls(), Kept()
    workspace = Workspace.of({MAIN: text})
    found = counted(lambda: answers.check(workspace, MAIN)).diagnostics
    counted(lambda: answers.check(workspace.with_file(MAIN, f"{text}# a comment\n"), MAIN))
    report = Report(tuple(Finding(MAIN, text, each) for each in found), {MAIN: text}, (MAIN,))
    counted(lambda: "".join(render("full", report, colour=False, width=100)))
    return counted.counts


@pytest.mark.parametrize("mistake", MISTAKES)
def test_more_mistakes_take_as_much_longer(mistake: str) -> None:
    calls(MISTAKES[mistake](3))  # what is made once for all
    most = MORE.get(mistake, MANY)
    few, many = (calls(MISTAKES[mistake](count)) for count in (FEW, most))
    assert all(more < fewer * most / FEW * 1.1 for fewer, more in zip(few, many, strict=True)), (few, many)


def test_there_are_as_many_as_are_asked_for() -> None:
    told = {name: len(check(Workspace.of({MAIN: text(20)}), MAIN)) for name, text in MISTAKES.items()}
    assert [name for name, number in told.items() if not number] == []
    assert sum(number >= 19 for number in told.values()) > 30
