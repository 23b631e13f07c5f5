"""When nodes began: rows made by hand, and those of engines, which say in which tick each was written."""

from __future__ import annotations

import gzip
import json
from collections import Counter
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from evidence_logs import rows

from btq_lang.evidence.model import Activation, LoggedTree, LogSession
from btq_lang.evidence.readers.btlog import read
from btq_lang.evidence.runs import activations


def tree_of(text: str, delay: int | None = None) -> LoggedTree:
    """The tree of kinds, indented, with uids in their order; `delay`: of the Delays in it, in ms."""
    nodes: list[tuple[int, str, str, int]] = []
    above: list[int] = []
    for uid, line in enumerate(text.split("\n"), 1):
        kind = line.strip()
        del above[(len(line) - len(kind)) // 2 :]
        nodes.append((uid, kind, f"{kind}::{uid}", above[-1] if above else 0))
        above.append(uid)
    delays = {uid: delay * 1000 for uid, kind, *_ in nodes if kind == "Delay" and delay is not None}
    return LoggedTree(nodes, delays=delays)


def begins(tree: LoggedTree, log: str, uid: int) -> list[str]:
    """When the activations of a node began, in ms: `100`, or `100..200`; 0: the log does not say since when."""
    found = [each for each in activations(LogSession(tree, iter(rows(log)))) if each.uid == uid]
    return [
        f"{each.begin / 1000:g}" if each.is_begin_known else f"{each.earliest / 1000:g}..{each.begin / 1000:g}"
        for each in found
    ]


TWO = "Sequence\n  Move\n  Pick"
BESIDE = "Parallel\n  Move\n  Pick"
AROUND = "Sequence\n  Move\n  Inverter\n    Timeout\n      Pick"
INSIDE = "Parallel\n  Move\n  Sequence\n    Look\n    Pick"
SWITCH = "Sequence\n  Move\n  Switch2\n    Pick\n    Pick\n    Pick"
OWN = "Sequence\n  Move\n  Mine\n    Pick\n    Pick"


@pytest.mark.parametrize(
    ("tree", "log", "uid", "expected"),
    [
        # RUNNING of the parent, and the result of an elder sibling.
        (TWO, "1000 1R 1400 2S 1500 3S 1S", 2, ["1000"]),
        (TWO, "1000 1R 1400 2S 1500 3S 1S", 3, ["1400"]),
        (TWO, "1000 1R 1200 2R 1400 2S 1500 3S 1S", 2, ["1000"]),
        # Through nodes between that have written nothing.
        (AROUND, "1000 1R 2S 1100 5S 4S 3F 1F", 5, ["1000"]),
        (AROUND, "1000 1R 2S 1100 5S 4S 3F 1F", 3, ["1000"]),
        (AROUND, "1000 1R 2S 1100 3R 1300 5S 4S 3F 1F", 5, ["1100"]),
        # A child of Parallel may have been skipped, and begin later: once a younger one has a row, it was.
        (INSIDE, "1000 1R 2S 1100 4S 3R 1200 5S 3S 1S", 4, ["1000"]),
        (INSIDE, "1000 1R 2S 1100 4S 3R 1200 5S 3S 1S", 3, ["1000"]),
        (INSIDE, "1000 1R 2R 4R 3R 1100 4S 1200 5S 3S 1S", 5, ["1100..1200"]),
        (BESIDE, "1000 1R 3R 1500 2S 3S 1S", 2, ["1000..1500"]),
        # A node that pauses between children; its first one it ticks at once.
        ("AsyncSequence\n  Move\n  Pick", "1000 1R 1050 2S 1100 3S 1S", 2, ["1000"]),
        ("AsyncSequence\n  Move\n  Pick", "1000 1R 1050 2S 1100 3S 1S", 3, ["1050..1100"]),
        # It began after its own last row, whoever wrote that.
        ("Repeat\n  Move", "1000 1R 1020 2S 2I 1100 2S 1S", 2, ["1000", "1020..1100"]),
        ("Repeat\n  Move", "1000 1R 2R 1020 2S 1050 2I 1100 2R 1200 2S 1S", 2, ["1000", "1050..1100"]),
        # Switch goes on at once, but its RUNNING is written after its child's.
        (SWITCH, "1000 1R 2S 1100 4R 3R 1200 4S 3S 1S", 4, ["1000"]),
        (SWITCH, "1000 1R 2S 1100 4R 3R 1200 4S 3S 1S", 3, ["1000"]),
        (SWITCH, "1000 1R 2S 4R 3R 1050 4I 1150 5S 3S 1S", 5, ["1000..1150"]),
        # What another thread may have written shows no tick.
        (BESIDE, "1000 1R 2R 1100 2S 1300 3S 1S", 3, ["1000..1300"]),
        (BESIDE, "1000 1R 2R 1100 2I 1300 3S 1S", 3, ["1000..1300"]),
        # Yet a node begins after an elder sibling that it waits for.
        (TWO, "1000 1R 2R 1100 2S 1300 3S 1S", 3, ["1100..1300"]),
        ("SequenceWithMemory\n  Move\n  Pick", "1000 1R 2R 1100 2S 1300 3S 1S", 3, ["1100..1300"]),
        # Nothing is known before the first row, or across a clock that was set back.
        (TWO, "1400 2S 1500 3S 1S", 2, ["0..1400"]),
        (TWO, "1400 2S 1500 3S 1S", 3, ["1400"]),
        (TWO, "1500 1R 1200 2S 1300 3S 1S", 2, ["0..1200"]),
        (TWO, "1500 1R 1200 2S 1300 3S 1S", 3, ["1200"]),
        # A control node writes RUNNING, then it ticks its children.
        ("Sequence\n  Move\n  Fallback\n    Pick", "1000 1R 2S 1200 3R 1300 4S 3S 1S", 3, ["1200"]),
        # What somebody else's control node does in a tick is unknown; the engine writes its RUNNING after its tick.
        (OWN, "1000 1R 2S 1200 3R 1300 4S 1400 5S 3S 1S", 3, ["1000"]),
        (OWN, "1000 1R 2S 1200 3R 1300 4S 1400 5S 3S 1S", 4, ["1200..1300"]),
        (OWN, "1000 1R 2S 1200 3R 1300 4S 1400 5S 3S 1S", 5, ["1300..1400"]),
        # A node that begins in the microsecond of the row before began then.
        (BESIDE, "1000 1R 3R 2S 3S 1S", 2, ["1000"]),
    ],
)
def test_begins(tree: str, log: str, uid: int, expected: list[str]) -> None:
    assert begins(tree_of(tree), log, uid) == expected


@pytest.mark.parametrize(
    ("log", "delay", "expected"),
    [
        ("1000 1R 1350 2S 1S", 300, ["1300..1350"]),
        ("1000 1R 1299.5 2S 1S", 300, ["1299.5"]),  # clocks differ
        ("1000 1R 1350 2S 1S", None, ["1000..1350"]),  # the delay is an entry of the blackboard
        ("1000 1R 1100 2S 1S", 300, ["1000..1100"]),  # it did not wait: 4.8.3 and 4.8.4 do not
    ],
)
def test_a_delay_waits_before_its_child_begins(log: str, delay: int | None, expected: list[str]) -> None:
    assert begins(tree_of("Delay\n  Move", delay), log, 2) == expected


def test_what_follows_below_a_delay_did_not_wait_again() -> None:
    tree = tree_of("Delay\n  Parallel\n    Move\n    Pick", 300)
    assert begins(tree, "1000 1R 1100 2R 4R 1350 3S 1400 4S 2S 1S", 3) == ["1100..1350"]


ENGINES = ("random-4.6", "random-4.10", "nav2-humble", "nav2-jazzy", "nav2-kilted", "nav2-lyrical")


@pytest.mark.parametrize("engine", ENGINES)
def test_a_begin_that_is_known_lies_in_the_tick_of_its_row(engine: str, shared: Path) -> None:
    known: Counter[str] = Counter()
    wrong: list[tuple[int, int, int, int]] = []
    with gzip.open(shared / "engine" / f"{engine}.jsonl.gz", "rt", encoding="utf-8") as file:
        for line in file:
            case = json.loads(line)
            for each in of_case(case) if case["changes"] else ():  # else it was not loaded
                known["known" if each.is_begin_known else "unknown"] += 1
                if each.is_begin_known and each.begin != each.shown[0]:
                    wrong.append((case["seed"], each.uid, each.begin // SECOND, each.shown[0] // SECOND))
    assert wrong == []
    assert known["known"] > 4 * known["unknown"] > 0


def of_case(case: dict[str, Any]) -> list[Activation]:
    """What nodes did while the engine ticked them, one tick a second."""
    root = ElementTree.fromstring(case["xml"])
    trees = {each.get("ID"): each for each in root.iter("BehaviorTree")}
    names = iter(case["nodes"])
    nodes: list[tuple[int, str, str, int]] = []

    def add(element: ElementTree.Element, parent: int) -> None:
        uid, kind, name = next(names)
        nodes.append((uid, kind, f"{name}::{uid}", parent))
        for child in trees[element.get("ID")] if element.tag in ("SubTree", "SubTreePlus") else element:
            add(child, uid)

    add(trees["Main"][0], 0)
    ticked = [(tick * SECOND, uid, after) for tick, uid, _, after in case["changes"] if tick < case["ticks"]]
    return [*activations(LogSession(LoggedTree(nodes), iter(ticked)))]


SECOND = 1_000_000


@pytest.mark.parametrize(("name", "known", "of", "most"), [("lab", 780, 780, 0), ("nav", 790, 821, 5206)])
def test_nearly_all_begins_of_nodes_with_one_row_are_known(
    name: str, known: int, of: int, most: int, shared: Path
) -> None:
    found: list[Activation] = []
    for session in read(str(shared / "logs" / f"{name}.btlog")):
        leaves = session.tree.leaves
        found += [each for each in activations(session) if each.uid in leaves and each.shown == each.ended]
    assert (sum(each.is_begin_known for each in found), len(found)) == (known, of)
    assert max(each.begin - each.earliest for each in found) <= most
