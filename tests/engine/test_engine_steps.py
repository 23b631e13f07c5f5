"""What `btq check --target` says of the engine's own versions is what each of them does, from 3.8.5 on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import NamedTuple

import pytest
from engine_loader import Answer, Engine

from btq_lang.catalog.engine_changes import ENGINE_CHANGES
from btq_lang.catalog.versions import BehaviorChange, at_least

ROOT = '<root BTCPP_format="4" main_tree_to_execute="Main"><BehaviorTree ID="Main">{}</BehaviorTree></root>'
ONE, OTHER = "<AlwaysSuccess/>", "<AlwaysFailure/>"
TWO, LONG = '<Two name="two"/>', '<Long name="long"/>'
WHILE = '<Long name="long" _while="go"/>'
# `go` is true until the second tick.
BESIDE = (
    '<Sequence><Script code="go := true"/><Parallel success_count="2" failure_count="1">{}'
    f'<Sequence>{TWO}<Script code="go := false"/></Sequence></Parallel></Sequence>'
)
STUBS = [{"ID": "Two", "category": "Action"}, {"ID": "Long", "category": "Action"}]
ITEMS = {"LoopInt": "1;2", "LoopBool": "true;false", "LoopDouble": "1.5;2", "LoopString": "a;b"}


THROWS = "throws"


class Seen(NamedTuple):
    """What a tree does in each version.

    Attributes:
        by_version: what is seen, by the first version that does it; no version before the first loads the tree.
        two: what the action of that name returns, tick by tick.
        ends_go: whether the action `long` ends `go`.
    """

    tree: str
    look: Callable[[Answer], object]
    by_version: Mapping[str, object]
    two: tuple[str, ...] = ("RUNNING", "SUCCESS")
    ends_go: bool = False
    tick_ms: int = 0


def ended(answer: Answer) -> object:
    return answer.status


def ticked(answer: Answer) -> object:
    return answer.ticks


def halted(answer: Answer) -> object:
    return "IDLE" in answer.statuses("long")


def begun_again_and_halted(answer: Answer) -> object:
    return answer.statuses("two").count("RUNNING") > 1, answer.statuses("long").count("RUNNING") > 1


def reactive(node: str) -> Seen:
    changes: dict[str, object] = {"3.8": (False, False), "3.8.6": (True, False), "3.8.7": (True, True)}
    changes |= {"4.0": (False, False), "4.2": THROWS, "4.6": (True, True)}
    two = ("RUNNING", "SUCCESS" if node == "ReactiveSequence" else "FAILURE")
    return Seen(f"<{node}>{TWO}{LONG}</{node}>", begun_again_and_halted, changes, two)


def again(node: str, port: str) -> Seen:
    is_repeat = node == "Repeat"
    child, result = (ONE, "SUCCESS") if is_repeat else (OTHER, "FAILURE")
    if port:
        return Seen(f'<{node} {port}="0">{child}</{node}>', ended, {"3.8": result, "4.1": "SKIPPED", "4.7": result})
    count = "num_cycles" if is_repeat else "num_attempts"
    return Seen(f'<{node} {count}="3">{child}</{node}>', ticked, {"3.8": 1, "4.0": 3})


def switch(node: str, port: str, value: str) -> Seen:
    cases = [f"case_{each}" for each in range(1, int(node[-1]) + 1)]
    ports = " ".join(f'{each}="{value if each == port else "x"}"' for each in cases)
    children = "".join(ONE if each == port else OTHER for each in [*cases, "else"])
    changes = {"4.0": "FAILURE", "4.5.1": "SUCCESS"} | ({"4.10": "FAILURE"} if value == "5abc" else {})
    return Seen(f'<{node} variable="5" {ports}>{children}</{node}>', ended, changes)


def loop(node: str, is_entry: bool) -> Seen:
    queue = "{q}" if is_entry else ITEMS[node]
    tree = f'<Repeat num_cycles="2"><{node} queue="{queue}" value="{{v}}">{ONE}</{node}></Repeat>'
    if is_entry:
        tree = f"<Sequence><Script code=\"q := '{ITEMS[node]}'\"/>{tree}</Sequence>"
    return Seen(tree, ticked, {"4.6": 3, "4.9.1" if is_entry else "4.7": 5})


def in_turn(node: str) -> Seen:
    """Its child is skipped after it has run."""
    result = "FAILURE" if "Fallback" in node else "SUCCESS"
    return Seen(f"<{node}>{WHILE}</{node}>", ended, {"4.6": result, "4.7": "SKIPPED"}, ends_go=True)


def seen(row: BehaviorChange, node: str) -> Seen:
    """What shows a row."""
    if "Reactive" in node:
        return reactive(node)
    if node in ("Repeat", "RetryUntilSuccessful"):
        return again(node, row.port)
    if node.startswith("Switch"):
        return switch(node, row.port, "5.0" if row.matches("5.0") else "5abc")
    if node in ITEMS:
        return loop(node, row.matches("{q}"))
    if node == "Precondition":
        tree = BESIDE.format(f'<Precondition if="go">{LONG}</Precondition>')
        return Seen(tree, ended, {"4.6": "FAILURE", "4.7": "SUCCESS"})
    if node == "Delay":
        changes = {"3.8": "RUNNING", "4.8.3": "SUCCESS", "4.9": "RUNNING"}
        return Seen(f'<Delay delay_msec="60000">{ONE}</Delay>', ended, changes, tick_ms=50)
    if node in ("SkipUnlessUpdated", "WaitValueUpdate"):
        start = '<Script code="e := 1"/>' if node == "SkipUnlessUpdated" else ""
        write = '<Script code="e := 1"/>' if node == "WaitValueUpdate" else ""
        beside = BESIDE.format(f'<{node} entry="e" _while="go">{LONG}</{node}>')
        tree = f"<Sequence>{start}{beside.replace('<Two', f'{write}<Two')}</Sequence>"
        return Seen(tree, halted, {"4.6": False, "4.9": True})
    if node == "SetBlackboard":
        asked = '<Sequence><WasEntryUpdated entry="e"/><SetBlackboard value="{a}" output_key="e"/></Sequence>'
        tree = f'<Sequence><Script code="a := 1; e := 2"/><Repeat num_cycles="2">{asked}</Repeat></Sequence>'
        return Seen(tree, ended, {"4.6": "FAILURE", "4.7": "SUCCESS"})
    return in_turn(node)


SHOWN = [
    (row, node)
    for row in ENGINE_CHANGES
    for node in row.nodes
    if not (node[:-1] == "Switch" and row.port[5:] > node[-1])
]


@pytest.mark.parametrize(("row", "node"), SHOWN, ids=lambda each: getattr(each, "since", each))
def test_each_row_is_what_the_engine_does(any_engine: Engine, row: BehaviorChange, node: str) -> None:
    shown = seen(row, node)
    known = [what for since, what in shown.by_version.items() if at_least(any_engine.version, since)]
    if known:
        first = {"status": "RUNNING", "write": {"go": False}} if shown.ends_go else "RUNNING"
        answer = any_engine.run_one(
            ROOT.format(shown.tree),
            stubs=STUBS,
            parts={"two": shown.two, "long": [first, "RUNNING", "RUNNING", "RUNNING", "SUCCESS"]},
            blackboard={"go": True} if shown.ends_go else {},
            ticks=12,
            tick_ms=shown.tick_ms,
        )
        assert answer.stage == ("tick" if known[-1] == THROWS else "done"), answer.error
        assert known[-1] in (THROWS, shown.look(answer))


@pytest.mark.parametrize(("row", "node"), SHOWN, ids=lambda each: getattr(each, "since", each))
def test_each_row_names_the_version_in_which_something_is_seen(row: BehaviorChange, node: str) -> None:
    changes = seen(row, node).by_version
    changed = [now for (_, before), (now, after) in pairwise(changes.items()) if before != after]
    assert {row.since, row.until, row.after} - {""} <= {*changed}
