"""Runs that `btq explore` finds happen in the engine, too, when its leaves do what they did there."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from random import Random
from typing import Any

from drawn_trees import drawn
from engine_loader import Answer, Engine, job
from seeds import seeds

from btq_lang.btcpp.reader import read
from btq_lang.exploration.answers import full_runs
from btq_lang.exploration.leaves import LeafKind
from btq_lang.exploration.opened import Opened
from btq_lang.exploration.search import Search, SearchBudget
from btq_lang.exploration.witness import Tick, replay
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.programs import KnownProgram
from btq_lang.simulator.versions import Dialect

KINDS = {
    "Act": LeafKind(is_action=True, is_declared=True, reads=("in",), writes=(("out", "int"),)),
    "Cond": LeafKind(is_condition=True, is_declared=True, writes=(("out", "double"),)),
    "Do": LeafKind(is_action=True, is_declared=True),
}
OUT = {"name": "out", "direction": "output"}
STUBS = [
    {"ID": "Act", "category": "Action", "ports": [{"name": "in", "direction": "input"}, {**OUT, "type": "int"}]},
    {"ID": "Cond", "category": "Condition", "ports": [{**OUT, "type": "double"}]},
    {"ID": "Do", "category": "Action", "ports": [{"name": "a", "direction": "input"}]},
]
TIMED = re.compile(r"<(?:Sleep|Timeout|Delay)\b")
STATUSES = ("IDLE", "RUNNING", "SUCCESS", "FAILURE")
ENDS = {"succeeds": "SUCCESS", "fails": "FAILURE", "is skipped": "SKIPPED"}


def parts(ticks: Sequence[Tick], conditions: set[int]) -> dict[str, list[Any]]:
    """What the leaves do, activation by activation, by path."""
    activations: dict[str, list[list[Any]]] = defaultdict(list)
    running: set[int] = set()
    for tick in ticks:
        for deed in tick.deeds:
            if deed.what == "is halted":
                running.discard(deed.uid)
                continue
            if deed.uid not in running:
                activations[deed.path].append([])
            status = {"runs": "RUNNING", "succeeds": "SUCCESS", "fails": "FAILURE"}[deed.what]
            output = {each.name: each.value for each in deed.writes}
            if deed.uid in conditions:  # their port is a double
                output = {name: float(value) for name, value in output.items()}
            activations[deed.path][-1].append({"status": status, "output": output})
            (running.add if deed.what == "runs" else running.discard)(deed.uid)
    return dict(activations)


def statuses(answer: Answer, leaves: set[int]) -> list[tuple[int, str]]:
    """The changes of leaves, without those that are reset."""
    return [
        (uid, after)
        for _, uid, before, after in answer.transitions
        if uid in leaves and (after != "IDLE" or before == "RUNNING")
    ]


def test_runs_of_drawn_trees_happen_in_the_engine(engine: Engine) -> None:
    jobs: list[Mapping[str, object]] = []
    runs: list[tuple[str, tuple[Tick, ...], set[int]]] = []
    for seed in seeds(400):
        xml = drawn(Random(seed))
        document = read(xml).document
        assert document is not None
        try:
            opened = Opened([document], "Main", KnownProgram(Dialect(engine.version)), KINDS)
        except (EngineError, NotModelled):
            continue
        if TIMED.search(xml):
            continue  # a run has no times
        leaves = {node.uid for node in opened.custom}
        conditions = {node.uid for node in opened.custom if node.id == "Cond"}
        for may_run in (frozenset[int](), full_runs(opened)):
            opened.begin(None, may_run)
            for ways in Search(opened.snapshots, SearchBudget(200)).run().ends.values():
                ticks = replay(opened, None, may_run, ways)
                if ticks[-1].result == "is not known":
                    continue
                given = {each.name: each.value for each in ticks[0].given}
                what = parts(ticks, conditions)
                jobs.append(job(xml, stubs=STUBS, parts=what, blackboard=given, ticks=len(ticks)))
                runs.append((xml, ticks, leaves))
    compared = 0
    for (xml, ticks, leaves), answer in zip(runs, engine.run(jobs), strict=True):
        if answer.stage in ("load", "create"):
            continue  # a node that came later, or an entry of another type than that of the value
        compared += 1
        changes = [(uid, STATUSES[status]) for tick in ticks for uid, status in tick.changes]
        assert statuses(answer, leaves)[: len(changes)] == changes, xml
        if ticks[-1].result == "throws":
            assert answer.stage == "tick", xml
        else:
            assert answer.status == ENDS[ticks[-1].result], xml
    assert compared > len(runs) * 3 / 4 > 0
