"""What conditions answer in a drawn run: by signals and entries as they are now, and by when they fail.

One invariant: numbers that belong to the run are only compared by questions (`LiveValue`), so what an answer depends on
is known.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from btq_lang.catalog.units import Unit, to_si
from btq_lang.prediction.declared import DeclaredCondition, Outages
from btq_lang.prediction.robot import Robot
from btq_lang.prediction.skill import Source
from btq_lang.prediction.streams import Stream
from btq_lang.prediction.world import WorldValue
from btq_lang.requirements.model import (
    All,
    Any,
    Arithmetic,
    Compare,
    Condition,
    Flag,
    InContext,
    Minus,
    Negation,
    Quantity,
    ResolvedSignal,
    Running,
    SignalRead,
    TextValue,
)
from btq_lang.simulator.blackboard import Unknown, Value
from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.nodes import RUNNING, SimulatedNode
from btq_lang.simulator.scripts import combined, compared
from btq_lang.simulator.timers import NEVER


class DeclaredAnswers:
    """What a condition answers of which btq.toml says something."""

    source: Source = "declared"

    def __init__(
        self,
        robot: Robot,
        declared: DeclaredCondition,
        courses: Mapping[str, WorldValue],
        uids: Mapping[int, frozenset[int]],
    ) -> None:
        """Answer nothing yet.

        Args:
            courses: the signals of the world that change, by name.
            uids: the numbers of the nodes that the condition names, by the identity of the target.
        """
        self._declared: Final = declared
        self._courses: Final = courses
        self._uids: Final = uids
        self._outages: Outages | None = None
        self._is_out = False  # until:
        self._until = 0
        self.ask_is_out: Final = self.is_out  # one object: questions are compared
        self._robot: Final = robot
        self.is_timely: Final = declared.fails > 0

    def begin(self, random: Stream) -> None:
        """Begin a run."""
        self._outages = self._declared.outages(random)
        self._until = 0

    def holds(self, node: SimulatedNode) -> bool:
        """What it answers now."""
        if self._outages is not None and self._robot.asker.ask(self.ask_is_out):
            return False
        condition = self._declared.condition
        return condition is None or _Moment(self._robot, node, self._courses, self._uids).holds(condition)

    def is_out(self) -> bool:
        """Whether it fails now, whatever else it would answer."""
        if self._robot.machine.now >= self._until:
            self._look(self._robot.machine.now)
        return self._is_out

    def next_change(self, now: int) -> int:
        """When it begins or ends to fail."""
        if self._outages is None:
            return NEVER
        if now >= self._until:
            self._look(now)
        return self._until

    def _look(self, now: int) -> None:
        """Note whether it fails, and until when that stays so."""
        assert self._outages is not None, "it may fail"
        self._is_out = self._outages.is_out(now)
        self._until = self._outages.next_change(now)


class _Moment:
    """The world and the tree at a moment, as a condition sees them; numbers are in SI.

    What is live in them is only compared, so that the state of the tree and the answers decide.
    """

    def __init__(
        self, robot: Robot, node: SimulatedNode, courses: Mapping[str, WorldValue], uids: Mapping[int, frozenset[int]]
    ) -> None:
        self._robot: Final = robot
        self._node: Final = node
        self._courses: Final = courses
        self._uids: Final = uids

    def holds(self, condition: Condition) -> bool:
        """Whether a condition holds.

        Raises:
            NotModelled: it needs something that is not known here.
        """
        if isinstance(condition, Compare):
            values = [self._number(operand) for operand in condition.operands]
            return all(
                compared(left, sign, right)
                for sign, left, right in zip(condition.operators, values, values[1:], strict=False)
            )
        if isinstance(condition, All):
            return all(map(self.holds, condition.conditions))
        if isinstance(condition, Any):
            return any(map(self.holds, condition.conditions))
        if isinstance(condition, Negation):
            return not self.holds(condition.condition)
        if isinstance(condition, InContext):
            return self.holds(condition.condition)
        if isinstance(condition, Flag):
            return condition.value
        if isinstance(condition, SignalRead):
            return bool(compared(self._number(condition), "!=", 0))
        if isinstance(condition, Running):
            nodes = self._robot.machine.nodes
            return any(nodes[uid - 1].status == RUNNING for uid in self._uids[id(condition.target)])
        raise NotModelled(f"what {self._node.path} answers depends on more than values and nodes of this moment")

    def _number(self, part: object) -> Value:
        if isinstance(part, SignalRead):
            return _in_si(self._value(part.signal), part.signal.unit)
        if isinstance(part, Quantity):
            return part.si
        if isinstance(part, Flag | TextValue):
            return int(part.value) if isinstance(part.value, bool) else part.value
        if isinstance(part, Minus):
            return combined("-", 0.0, self._number(part.operand))
        if isinstance(part, Arithmetic):
            return combined(part.operator, self._number(part.left), self._number(part.right))
        raise NotModelled(f"what {self._node.path} answers depends on more than the values of this moment")

    def _value(self, signal: ResolvedSignal) -> Value:
        if (live := self._courses.get(signal.name)) is not None:
            return live
        board = self._node.board
        entry = board.root.entries.get(signal.entry) or board.entry(signal.entry)
        if entry is None or entry.value is None:
            raise NotModelled(f"{self._node.path} is asked, and nothing gives `{signal.name}` a value")
        return entry.value


def _in_si(value: Value, unit: Unit | None) -> Value:
    if unit is None or isinstance(value, str):
        return value
    if not isinstance(value, Unknown):
        return to_si(float(value), unit)
    scaled = combined("*", value, unit.factor) if unit.factor != 1 else value
    return combined("+", scaled, unit.offset) if unit.offset else scaled
