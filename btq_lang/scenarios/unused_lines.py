"""Lines of a scenario that had no effect on its run, such as misspelt entries: no errors, but worth naming."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import Final

from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.plan import Plan, PlannedChange, WatchedEvent
from btq_lang.simulator.blackboard import Board
from btq_lang.simulator.nodes import Machine, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.skills import GivenSkill
from btq_lang.syntax.script.tree import variables
from btq_lang.util.spelling import did_you_mean, near


def unused_lines(
    mission: ScenarioMission,
    plan: Plan,
    machine: Machine,
    started: Collection[int],
    applied: Collection[int],
    waiting: Iterable[PlannedChange],
) -> tuple[str, ...]:
    """What had no effect, in words, by the lines.

    Args:
        started: the nodes that have run.
        applied: the identities of the givens that were about some activation.
        waiting: the changes that have not happened.
    """
    entries = _Entries(mission, plan, machine)
    unused = [
        *_givens(plan, started, applied),
        *((change.line, _not_yet(change)) for change in waiting),
        *((value.line, entries.unread(value.key)) for value in plan.entries if value.line),
        *entries.written_for_nobody(plan),
    ]
    return tuple(dict.fromkeys(f"line {line} has no effect: {why}" for line, why in sorted(unused) if why))


def _givens(plan: Plan, started: Collection[int], applied: Collection[int]) -> Iterator[tuple[int, str]]:
    """Those in the scenario itself; those of the file are for others, too."""
    for given in plan.givens:
        if given.rank < 0:
            continue
        if given.uids.isdisjoint(started):
            yield given.line, "none of its nodes runs"
        elif given.values and id(given) not in applied:
            yield given.line, "none of its nodes begins with such a value"


def _not_yet(change: PlannedChange) -> str:
    if isinstance(change.trigger, int):
        return "the run ends before"
    return "this does not happen" if isinstance(change.trigger, WatchedEvent) else "the condition is never true"


class _Entries:
    """Which entries nodes, signals and the scenario read, or may read."""

    def __init__(self, mission: ScenarioMission, plan: Plan, machine: Machine) -> None:
        self._machine: Final = machine
        self._nodes: Final = {node.uid: node for node in machine.nodes}
        self._root: Final = machine.nodes[0].board.root
        signals = (*mission.requirements.signals.values(), *plan.read)
        self._readers: Final = {
            *((_home(self._root, signal.entry), 0, "") for signal in signals if signal.entry),
            *((_home(node.board, key), node.uid, port) for node in machine.nodes for port, key in _keys(node)),
        }

    def unread(self, key: str) -> str:
        """That nothing reads an entry of the root blackboard; empty if something does."""
        names = {name for (board, name), *_ in self._readers if board == id(self._root)}
        return "" if key in names else f"nothing reads {{{key}}}{did_you_mean(near(key, names, limit=1))}"

    def written_for_nobody(self, plan: Plan) -> Iterator[tuple[int, str]]:
        """The entries that nodes write and nothing else reads."""
        effects = (change.effect for change in plan.changes)
        for given in (*plan.givens, *(effect for effect in effects if isinstance(effect, GivenSkill))):
            for port in {write.key for activation in given.activations for write in activation.writes or ()}:
                nodes = [self._nodes[uid] for uid in given.uids if uid in self._nodes]
                if nodes and not any(self._is_read(node, port) for node in nodes):
                    yield given.line, f"nothing reads `{port}` that it writes"

    def _is_read(self, writer: SimulatedNode, port: str) -> bool:
        home = _home(writer.board, key_of(writer.ports.get(port, ""), port) or port)
        return any(read == home and (uid, name) != (writer.uid, port) for read, uid, name in self._readers)


def _keys(node: SimulatedNode) -> Iterator[tuple[str, str]]:
    """The entries at the ports of a node and in its scripts, each with its port."""
    for port, written in node.ports.items():
        key = key_of(written, port)
        if key is not None:
            yield port, key
    for script in (*(script for _, script in node.conditions), *node.scripts.values()):
        yield from (("", variable.name) for variable in variables(script))


def _home(board: Board, key: str) -> tuple[int, str]:
    home, name = board.home(key)
    return id(home), name
