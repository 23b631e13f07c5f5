"""Random runs: trees of nodes of the engine, with leaves that do something at random, while the world changes.

`python tests/engine/drawn_runs.py PREFIX SEED NUMBER` runs so many in the model and in an engine, and prints those that
differ, as small as they can be made.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from xml.etree import ElementTree

from drawn_trees import CONTROLS, DECORATORS, LEAVES, drawn

from btq_lang.catalog.nodes import BUILTINS, available
from btq_lang.projects.building import for_target
from btq_lang.projects.opening import open_workspace
from btq_lang.scenarios.installed_engine import InstalledEngine, installed_engine
from btq_lang.scenarios.mission import ScenarioMission, as_program
from btq_lang.scenarios.plan import Halt, Plan, PlannedChange, Set, WatchedEvent
from btq_lang.scenarios.replay import difference
from btq_lang.scenarios.running import run
from btq_lang.scenarios.tape import Tape
from btq_lang.simulator.nodes import FAILURE, RUNNING, SKIPPED, SUCCESS
from btq_lang.simulator.skills import GivenActivation, GivenSkill, Write

MORE_CONTROLS = (
    *CONTROLS,
    *("AsyncFallback", 'Parallel success_count="1" failure_count="2"', 'ParallelAll max_failures="2"'),
    *("ReactiveSequence", "ReactiveFallback", "Sequence", "Fallback"),
)
MORE_DECORATORS = (
    *DECORATORS,
    *(
        'Timeout msec="35"',
        'Delay delay_msec="25"',
        'Timeout msec="{x}"',
        'RunOnce then_skip="false"',
        "Timeout msec='0'",
    ),
    *('RetryUntilSuccessful num_attempts="-1"', 'Repeat num_cycles="3"', 'SkipUnlessUpdated entry="{x}"'),
    *('WaitValueUpdate entry="{y}"', 'Precondition if="x == 1" else="RUNNING"', 'LoopDouble queue="1;2;3" value="{x}"'),
    *('Sequence _while="x &lt; 3"', 'Fallback _skipIf="y == 3"', 'ForceSuccess _onHalted="z := 5"'),
    *('SubTree_ ID="Sub" k="{x}"', 'SubTree_ ID="Sub" k="{y}" _autoremap="true"', 'SubTree_ ID="Sub" k="3"'),
)
MORE_LEAVES = (
    *LEAVES,
    *('WasEntryUpdated entry="{x}"', 'UnsetBlackboard key="y"', 'Sleep msec="30"', 'Sleep msec="45"', 'Sleep msec="0"'),
    *('Script code="x += 1"', 'Script code="z = x"', 'Script code="@g := 2"', 'ScriptCondition code="@g == 2"'),
    *('Act _successIf="x == 2"', 'Act _failureIf="y &gt; 2"', 'Act _onSuccess="x = 2"', 'Cond _onFailure="y = 4"'),
    *('Act _onHalted="x = 5"', 'Do _post="z = 7"', 'Sleep msec="20" _onHalted="y = 1"', 'Act _while="x &lt; 3"'),
    *("Act", "Act", "Act", "Cond", "Do"),
)
SUBTREE = '<BehaviorTree ID="Sub"><Sequence>{}<ScriptCondition code="k &lt; 4"/></Sequence></BehaviorTree>'
CUSTOM = ("Act", "Cond", "Do")
TIMES = (0, 0, 5, 10, 10, 15, 20, 30, 30, 45, 100)
CHANGES = ("starts", "succeeds", "fails", "finishes", "halts")


@dataclass(frozen=True)
class DrawnRun:
    """A tree, its leaves by their names, and what changes."""

    xml: str
    skills: tuple[tuple[str, GivenSkill], ...]
    changes: tuple[PlannedChange, ...]

    def plan(self, mission: ScenarioMission) -> Plan:
        uids = {node.name: set[int]() for node in mission.tree.nodes.values()}
        for node in mission.tree.nodes.values():
            uids[node.name].add(node.uid)
        givens = (_with_uids(given, uids.get(name, set())) for name, given in self.skills)
        entries = (Set("", key, value) for key, value in (("x", 1.0), ("y", 2.0), ("z", 0.0)))
        return Plan(tuple(givens), tuple(entries), self.changes, (), ())


def _with_uids(given: GivenSkill, uids: Iterable[int]) -> GivenSkill:
    return GivenSkill(frozenset(uids), 0, given.activations, given.answers)


def drawn_run(random: Random, version: str) -> DrawnRun:
    """A run for a version of the engine."""
    kinds = [
        [each for each in kind if (node := BUILTINS.get(each.split()[0])) is None or available(node, version)]
        for kind in (MORE_CONTROLS, MORE_DECORATORS, MORE_LEAVES)
    ]
    tree = drawn(random, *kinds)
    while "<SubTree_" in tree:  # in place of a node with a child
        tree = re.sub(r"<SubTree_( [^>]*)>((?:(?!<SubTree_).)*?)</SubTree_>", r"<SubTree\1/>", tree)
    numbers = iter(range(1000))
    subtree = SUBTREE.format("<Act/><Cond/>" if random.random() < 0.5 else '<Act out="{k}"/><Sleep msec="15"/>')
    text = tree.replace("</root>", f"{subtree}</root>")
    text = re.sub(r"<(Act|Cond|Do)\b", lambda match: f'{match[0]} name="n{next(numbers)}"', text)
    names = re.findall(r'<(Act|Cond|Do) name="(\w+)"', text)
    skills = tuple((name, _skill(random, kind)) for kind, name in names)
    return DrawnRun(text, skills, tuple(_change(random) for _ in range(random.choice((0, 0, 1, 2)))))


def _skill(random: Random, kind: str) -> GivenSkill:
    if kind == "Cond":
        answers = tuple(random.random() < 0.6 for _ in range(random.randint(1, 4)))
        return GivenSkill(frozenset(), 0, (), answers)
    return GivenSkill(frozenset(), 0, tuple(_activation(random) for _ in range(random.randint(1, 3))))


def _activation(random: Random) -> GivenActivation:
    result = random.choice((SUCCESS,) * 6 + (FAILURE,) * 5 + (SKIPPED, RUNNING))
    value = float(random.randint(0, 4))
    writes = (Write(random.choice(("x", "y", "z", "out")), value, "double"),) if random.random() < 0.3 else ()
    return GivenActivation(result, random.choice(TIMES), writes, random.choice((0, 0, 1, 2)))


def _change(random: Random) -> PlannedChange:
    event = WatchedEvent(random.choice(CHANGES), frozenset(range(1, 8)), (), random.randint(1, 3))
    trigger = random.choice((10, 25, 40, 200, event))
    effect = Halt() if random.random() < 0.2 else Set("", random.choice("xyz"), float(random.randint(0, 4)))
    return PlannedChange(trigger, effect)


def compared(drawn: DrawnRun, engine: InstalledEngine, folder: Path) -> str | None:
    """How the engine differs from the model; empty: not at all; None: it cannot be told."""
    path = folder / "tree.xml"
    path.write_text(drawn.xml, encoding="utf-8")
    workspace = for_target(open_workspace(str(path)), engine.line)
    name = next(each for each in workspace.files if each.endswith("tree.xml"))
    mission = ScenarioMission(as_program(workspace, name, "Main"), name, "Main")
    plan, tape = drawn.plan(mission), Tape()
    ran = run(mission, plan, tape=tape)
    return None if ran.end in ("unknown", "unanswered") else difference(engine, mission, plan, tape, ran)


def shrunk(drawn: DrawnRun, engine: InstalledEngine, folder: Path) -> DrawnRun:
    """A run that differs, too, and none of the smaller ones does."""
    while True:
        for smaller in _smaller(drawn):
            try:
                differs = compared(smaller, engine, folder)
            except Exception:  # whatever a tree raises from which too much was taken: it is not a smaller run
                continue
            if differs and "Error at line" not in differs:
                drawn = smaller
                break
        else:
            return drawn


def _smaller(drawn: DrawnRun) -> Iterator[DrawnRun]:
    for index in range(len(drawn.changes)):
        yield replace(drawn, changes=drawn.changes[:index] + drawn.changes[index + 1 :])
    size = len([*ElementTree.fromstring(drawn.xml).iter()])
    for index in range(size):
        for way in ("child", "remove", "attribute"):
            root = ElementTree.fromstring(drawn.xml)
            parents = {child: parent for parent in root.iter() for child in parent}
            node = [*root.iter()][index]
            if node.tag in ("root", "BehaviorTree"):
                continue
            parent = parents[node]
            if way == "attribute":
                extra = [key for key in node.attrib if key.startswith("_")]
                if not extra:
                    continue
                del node.attrib[extra[0]]
            else:
                place = [*parent].index(node)
                parent.remove(node)
                if way == "child":
                    if not len(node):
                        continue
                    parent.insert(place, node[0])
            yield replace(drawn, xml=ElementTree.tostring(root, encoding="unicode"))
    for index, (name, skill) in enumerate(drawn.skills):
        if f'"{name}"' not in drawn.xml:
            yield replace(drawn, skills=drawn.skills[:index] + drawn.skills[index + 1 :])
        elif len(skill.activations) > 1:
            less = GivenSkill(skill.uids, 0, skill.activations[:-1], skill.answers)
            yield replace(drawn, skills=(*drawn.skills[:index], (name, less), *drawn.skills[index + 1 :]))


def told(seed: int, drawn: DrawnRun, engine: InstalledEngine, folder: Path) -> str:
    """A run that differs, as small as it can be made."""
    small = shrunk(drawn, engine, folder)
    skills = "\n".join(f"  {name}: {skill.activations or skill.answers}" for name, skill in small.skills)
    return f"seed {seed}: {compared(small, engine, folder)}\n{small.xml}\n{skills}\n  {small.changes}"


def main(prefix: str, first: int, number: int) -> None:
    engine = installed_engine(prefix)
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, first + number):
            drawn = drawn_run(Random(seed), engine.line)
            differs = compared(drawn, engine, Path(folder))
            count += differs is not None
            if differs:
                print(told(seed, drawn, engine, Path(folder)), flush=True)
    print(f"{number} drawn, {count} compared")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
