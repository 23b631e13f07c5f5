"""A run of a scenario in an installed engine: its leaves do what they did in the model, at the same times.

One invariant: what cannot be run there as it is here raises `NotRun` with the reason, and is never taken as equal.

A job, and its answer, are JSON; all times are in milliseconds since the start of the run, and numbers of nodes are the
engine's own.

    job     the texts of the tree and its name, the kinds of leaves, what is given, what leaves return and write, what
            else changes, when the program halts the tree, and which entries and ports are needed
    answer  how the run ended, its error, and what happened, as `tape.Moment` has it
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import zip_longest
from typing import Any, Final

from btq_lang.btcpp.document import Document, Element, write
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.evidence.wording import duration
from btq_lang.scenarios.installed_engine import EngineFailure, EngineTooSlow, InstalledEngine
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.plan import Plan, Set
from btq_lang.scenarios.running import ScenarioRun, watched
from btq_lang.scenarios.tape import Event, LeafTick, Moment, Tape
from btq_lang.simulator.blackboard import BOOL, Unknown, Unsaid
from btq_lang.simulator.leaves import tick_custom
from btq_lang.simulator.loading import CATEGORIES
from btq_lang.simulator.nodes import STATUS_NAMES
from btq_lang.simulator.skills import Write


class NotRun(Exception):
    """The engine cannot run the scenario as the model does; the message says why."""


def difference(engine: InstalledEngine, mission: ScenarioMission, plan: Plan, tape: Tape, run: ScenarioRun) -> str:
    """Run a scenario in an engine; the first difference to the run in the model, empty if there is none.

    Args:
        tape: of the run in the model.

    Raises:
        NotRun: the engine cannot run it as the model does.
    """
    if mission.dialect.version != engine.line:
        version = mission.dialect.version
        raise NotRun(f"it is {engine.version}, and the tree is built for {version}; use --target {engine.line}")
    job = Job(mission, plan, tape)
    try:
        answer = engine.run(job.data(run))
    except EngineFailure as failure:
        return f"{failure}"
    except EngineTooSlow as reason:
        raise NotRun(str(reason)) from None
    if answer["end"] == "no clock":
        raise NotRun("the tree has timers, and the time of this engine is not to be controlled")
    return _difference(mission, tape, run, answer, moments_of(answer["moments"], job.unsaid))


# ---- the job ----


class Job:
    """What the program in the engine is asked to do; `unsaid`: values that nothing determines, by their numbers."""

    def __init__(self, mission: ScenarioMission, plan: Plan, tape: Tape) -> None:
        self._mission: Final = mission
        self._plan: Final = plan
        self._tape: Final = tape
        self.unsaid: Final[list[Unsaid]] = []

    def data(self, run: ScenarioRun) -> dict[str, object]:
        """The job as plain data."""
        now, changes = self._tape.until or (run.now + _GRACE, 0)
        return {
            "tree": self._mission.name,
            "texts": [_without_includes(document) for document in self._mission.documents],
            "kinds": [*self._kinds()],
            "given": _sets(self._plan.entries),
            "leaves": {uid: [*map(self._tick, ticks)] for uid, ticks in self._tape.leaves.items()},
            "at_changes": [_changes(*each) for each in self._tape.at_changes],
            "between": [_changes(*each) for each in self._tape.between],
            "until": {"now": now, "changes": changes},
            "read": [*dict.fromkeys(signal.entry for signal in self._plan.read if signal.entry)],
            "watched": sorted(watched(self._plan)),
        }

    def _kinds(self) -> Iterator[dict[str, object]]:
        """The leaves that the program registers.

        Raises:
            NotRun: the tree has other nodes which the engine does not have.
        """
        for node in self._tape.machine.nodes if self._tape.machine is not None else ():
            if node.id not in BUILTINS and node.rules.flow is not tick_custom:
                raise NotRun(f"BehaviorTree.CPP does not have {node.id}")
        ports: dict[str, dict[str, None]] = {}
        for element in _nodes(self._mission.documents):
            id_ = element.tag if element.tag not in CATEGORIES else element.get("ID") or ""
            if id_ in BUILTINS:
                continue
            if any(element.elements):
                raise NotRun(f"BehaviorTree.CPP does not have {id_}")
            names = [attribute.name for attribute in element.attributes]
            ports.setdefault(id_, {}).update({name: None for name in names if name not in _NO_PORTS and name[0] != "_"})
        for id_, written in ports.items():
            every = dict.fromkeys((*written, *self._mission.outputs.get(id_, ())))
            yield {"id": id_, "is_condition": id_ in self._mission.conditions, "ports": [*every]}

    def _tick(self, tick: LeafTick) -> dict[str, object]:
        writes = [{"key": each.key, "value": self._written(each)} for each in tick.writes]
        return {"now": tick.now, "result": STATUS_NAMES[tick.result], "sets": _sets(tick.sets), "writes": writes}

    def _written(self, written: Write) -> object:
        value = written.value
        if isinstance(value, Unsaid):
            self.unsaid.append(value)
            return {"unsaid": len(self.unsaid) - 1}
        return bool(value) if written.type == BOOL else value


def _without_includes(document: Document) -> str:
    """The text of a file: what it includes is given to the engine, too."""
    root = document.root
    children = [child for child in root.children if not (isinstance(child, Element) and child.tag == "include")]
    return write(Document([Element(root.tag, root.attributes, children)]))


def _nodes(documents: Iterable[Document]) -> Iterator[Element]:
    for document in documents:
        for tree in document.root.elements:
            if tree.tag == "BehaviorTree":
                yield from (element for element in tree.walk() if element is not tree)


def _changes(now: int, changes: int, sets: Iterable[Set]) -> dict[str, object]:
    return {"now": now, "changes": changes, "sets": _sets(sets)}


def _sets(sets: Iterable[Set]) -> list[dict[str, object]]:
    return [{"key": each.key, "value": each.value} for each in sets if each.key]


# ---- the answer ----


def moments_of(answer: Any, unsaid: list[Unsaid]) -> Iterator[Moment]:
    """What happened in the engine; `unsaid`: as of the job."""

    def event(answered: list[Any]) -> Event:
        what, value = answered
        if isinstance(what, str):
            return what, None if isinstance(value, dict) else value
        return what, {port: _text(each, unsaid) for port, each in value.items()} if isinstance(value, dict) else value

    for first, last, is_tick, events in answer:
        yield Moment(first, last, is_tick, tuple(map(event, events)))


def _text(value: Any, unsaid: list[Unsaid]) -> str | Unknown | None:
    """A value at a port as scenarios compare it."""
    if isinstance(value, dict):
        return unsaid[value["unsaid"]]
    return value if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def _difference(
    mission: ScenarioMission, tape: Tape, run: ScenarioRun, answer: dict[str, Any], theirs: Iterable[Moment]
) -> str:
    """The first difference in words; empty if there is none."""
    error = f", and the engine throws an exception: {answer['error']}" if answer["error"] else ""
    for ours, other in zip_longest(_flat(tape.moments()), _flat(theirs)):
        if ours != other:
            words = [_words(mission, each) for each in (other, ours)]
            return f"{words[0]}{error}; in the model {words[1]}"
    ends = ("RUNNING",) if tape.until is not None else _ENDS.get(run.end, (run.end,))
    return "" if answer["end"] in ends else f"it ends with {answer['end']}{error}; in the model it {run.end}"


def _flat(moments: Iterable[Moment]) -> Iterator[tuple[int, int, Event]]:
    return ((moment.first, moment.last, event) for moment in moments for event in moment.events)


def _words(mission: ScenarioMission, happened: tuple[int, int, Event] | None) -> str:
    if happened is None:
        return "nothing more happens"
    first, last, (what, value) = happened
    time = f"after {duration(first / 1000)}" + (
        f", and in each tick until {duration(last / 1000)}," if last > first else ""
    )
    if isinstance(what, str):
        return f"{time} the entry `{what}` is {value!r}"
    path = mission.tree.nodes[what].path
    return f"{time} {path} {f'becomes {STATUS_NAMES[value]}' if isinstance(value, int) else f'begins with {value}'}"


_ENDS: Final[dict[str, tuple[str, ...]]] = {
    "succeeds": ("SUCCESS",),
    "fails": ("FAILURE",),
    "is skipped": ("SKIPPED",),
}
_NO_PORTS: Final = ("ID", "name")
_GRACE: Final = 20  # milliseconds for which a run that has ended in the model may go on
