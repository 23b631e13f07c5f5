"""Guards that nobody breaks change nothing: random trees, with and without what requirements add, do the same.

What each node of the mission goes through is compared tick by tick: when it begins, how it ends, when it is halted.
That a node is idle again after its end is not: who resets it when is the business of the node above.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

import pytest
from engine_loader import Answer, Engine, job
from seeds import seeds

from btq_lang.btcpp.document import Document, write
from btq_lang.btcpp.enforcement import enforced
from btq_lang.btcpp.export import export
from btq_lang.btcpp.instances import instances
from btq_lang.btcpp.marks import MARK
from btq_lang.workspace.workspace import Workspace

HEAD = """\
signal good : bool from {good} initially true
signal spent : Wh from {spent} counter initially 0 Wh
context often : good
QualityReq q_fail
    takes at most 1 h if good else 2 h
    needs good
    keeps good
    leaves good
    uses at most 1 Wh of spent
    tries at most 1000
    on violation fail
QualityReq q_halt
    takes at most 1 h
    keeps good
    leaves good
    on violation halt
QualityReq q_late
    takes at most 1 h
    never not good
    when often
    on violation halt
QualityReq q_first
    needs good
    tries at most 1000 per Top
    on violation halt
Root Main
"""
NAMES = ("q_fail", "q_halt", "q_late", "q_first")
CONTROLS = ("->", "?", "R->", "R?", "M->", "||", "IfThenElse", "WhileDoElse")
DECORATORS = ("Inverter", "ForceSuccess", "ForceFailure", "Retry (num_attempts = 2)", "Repeat (num_cycles = 2)")
LEAVES = 12


def mission(chance: random.Random) -> str:
    """A tree and one that it runs, some of their nodes with requirements."""
    part = "BehaviorTree Part\n" + "".join(lines(chance, 1, 2, False))
    return f"{HEAD}BehaviorTree Main\n    -> Top\n{''.join(lines(chance, 2, 3, True))}        Leaf0\n{part}"


def lines(chance: random.Random, level: int, depth: int, sub: bool) -> Iterator[str]:
    blanks = "    " * level
    pairs = [f'{name} = "b{chance.randrange(3)} == 1"' for name in chance.choice(CONDITIONS) if chance.random() < 0.15]
    demanded = [name for name in NAMES if chance.random() < 0.3]
    kind = chance.random()
    if depth == 0 or kind < 0.2:
        head, children = f"Leaf{chance.randrange(LEAVES)}", 0
    elif kind < 0.3 and sub:
        head, children = "SubTree Part", 0
        pairs.append("_autoremap = true")
    elif kind < 0.5:
        head, children = chance.choice(DECORATORS), 1
    else:
        head = chance.choice(CONTROLS)
        children = chance.randrange(2, 4)
    if "(" in head:
        head, _, own = head.partition(" (")
        pairs.append(own.rstrip(")"))
    brackets = f" ({' '.join(pairs)})" if pairs else ""
    satisfies = f" satisfies {', '.join(demanded)}" if demanded else ""
    yield f"{blanks}{head}{brackets}{satisfies}\n"
    for _ in range(children):
        yield from lines(chance, level + 1, depth - 1, sub)


# Not all four: beside `_skipIf`, `_successIf` moves too, and what it decides is no longer seen at the node itself.
CONDITIONS = (("_skipIf", "_while"), ("_failureIf", "_successIf"))


def parts(chance: random.Random) -> dict[str, list[object]]:
    """What the leaves do: activations of some ticks each, in which now and then an entry changes."""
    found: dict[str, list[object]] = {}
    for leaf in range(LEAVES):
        activations: list[object] = []
        for _ in range(3):
            steps: list[dict[str, object]] = [{"status": "RUNNING"} for _ in range(chance.randrange(3))]
            steps.append({"status": chance.choice(["SUCCESS", "SUCCESS", "FAILURE"])})
            if chance.random() < 0.3:
                chance.choice(steps)["write"] = {f"b{chance.randrange(3)}": chance.randrange(2)}
            activations.append(steps)
        found[f"Leaf{leaf}"] = activations
    return found


@pytest.mark.parametrize("seed", seeds(4))
def test_random_trees_do_the_same(engine: Engine, seed: int) -> None:
    chance = random.Random(seed)
    cases: list[tuple[str, Document, Document, dict[str, Any]]] = []
    clauses = 0
    while len(cases) < 60:
        text = mission(chance)
        workspace = Workspace.of({"main.btq": text})
        plain = export(workspace, "main.btq").document
        done = enforced(workspace, "main.btq", export(workspace, "main.btq"))
        clauses += sum(held.way == "enforced" for applied in done.clauses for held in applied)
        what = {"parts": parts(chance), "ticks": 40, "blackboard": {f"b{n}": chance.randrange(2) for n in range(3)}}
        cases.append((text, plain, done.export.document, what))
    answers = engine.run(job(write(document), **what) for _, *both, what in cases for document in both)
    assert clauses > 500
    ended = []
    for (text, plain, guarded, _), before, after in zip(cases, answers[::2], answers[1::2], strict=True):
        assert (after.stage, after.status, after.ticks) == (before.stage, before.status, before.ticks), text
        assert list(lives(after, guarded)) == list(lives(before, plain)), text
        ended.append(before.status)
    assert {"SUCCESS", "FAILURE"} <= set(ended)


def lives(answer: Answer, document: Document) -> Iterator[list[tuple[int, str]]]:
    """What each node of the mission goes through: the ticks, and what it is from then on."""
    for instance in instances([document], "Main"):
        if instance.element.get(MARK) is None:
            yield [
                (tick, now)
                for tick, uid, before, now in answer.transitions
                if uid == instance.uid and (now != "IDLE" or before == "RUNNING")
            ]
