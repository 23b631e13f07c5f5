"""The settings for simulated runs in a mission: which nodes and signals they name, with their values in its units.

One invariant: what cannot be understood is left out, and is one problem at its key.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.units import Unit, a_dimension, convert, parse_unit, to_si
from btq_lang.grammar.conditions import parse_cond
from btq_lang.requirements import nodes
from btq_lang.requirements.entries import ScenarioReader, line_of_text
from btq_lang.requirements.model import NO_DIMENSION, Condition, NodeTarget, ResolvedSignal
from btq_lang.requirements.terms import ONE
from btq_lang.syntax.tokens import NEWLINE
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.project_simulation import SaidValue, SkillSetting, WorldSetting
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

Problem: TypeAlias = tuple[str, tuple[str, ...]]  # the message, and the keys below `simulate` to its place


class ResolvedSkill(Record):
    """A setting for some nodes.

    Attributes:
        targets: the skills that it names.
        condition: what they answer; None: nothing is said, or it could not be understood.
    """

    setting: SkillSetting
    targets: tuple[NodeTarget, ...]
    condition: Condition | None = None


class DeclaredSignal(Record):
    """How a signal changes; values are in its unit.

    Attributes:
        rate: by how much it changes in a second.
        rates: in place of that while one of some nodes runs; those of several that run add up.
        low, high: what it does not leave.
    """

    signal: ResolvedSignal
    start: float | bool | str
    rate: float = 0.0
    rates: tuple[tuple[tuple[NodeTarget, ...], float], ...] = ()
    low: float = float("-inf")
    high: float = float("inf")


class SettingsReader:
    """Reads settings for a mission.

    Attributes:
        problems: what is wrong, in order.
        unknown: the same of names that the mission lacks: another mission of the project may have them.
        known: the keys of the names that it has.
    """

    def __init__(self, store: Store[Workspace], viewpoint: str) -> None:
        self._store: Final = store
        self._viewpoint: Final = viewpoint
        self.problems: list[Problem] = []
        self.unknown: Final[list[Problem]] = []
        self.known: Final[set[tuple[str, ...]]] = set()

    def skill(self, setting: SkillSetting) -> ResolvedSkill | None:
        """A setting of a skill; None if the mission lacks its nodes."""
        keys = ("skills", setting.name)
        named = self._targets(setting.name, keys)
        targets = tuple(target for target in named if is_skill(target.node))
        if named and not targets:
            node = named[0].node
            kind = node.kind.tag if node.kind is not None else node.category
            message = f"`{setting.name}` is a {kind}, and no skill; name an action or a condition"
            self.problems.append((message, keys))
        is_of_condition = bool(setting.condition or setting.fails)
        for target in targets:
            if is_condition(target.node) != is_of_condition:
                what = (
                    "an action; say what it `takes` and how often it `succeeds`"
                    if is_of_condition
                    else "a condition; say what it `is`, or how often it `fails` and `for` how long"
                )
                self.problems.append((f"`{setting.name}` is {what}", keys))
                return None
        condition = self._condition(setting.condition, (*keys, "is")) if targets and setting.condition else None
        return ResolvedSkill(setting, targets, condition) if targets else None

    def signal(self, setting: WorldSetting) -> DeclaredSignal | None:
        """A setting of the world; None if it could not be understood."""
        keys = ("world", setting.signal)
        signal = self._signal(setting.signal)
        if signal is None:
            names = self._store.ask(inputs.names, self._viewpoint, Kind.SIGNAL)
            likely = did_you_mean(near(setting.signal, names, 1))
            self.unknown.append((f"unknown signal `{setting.signal}`{likely}", keys))
            return None
        self.known.add(keys)
        before = len(self.problems)
        start = self._value(setting.start, signal, (*keys, "start"))
        rate = self._rate(setting.rate, signal, (*keys, "rate")) if setting.rate is not None else 0.0
        rates = [
            (self._targets(name, (*keys, "while", name)), self._rate(text, signal, (*keys, "while", name)))
            for name, text in setting.rates
        ]
        low, high = [self._value(each, signal, (*keys, "between")) for each in setting.between] or [None, None]
        if len(self.problems) > before or start is None:
            return None
        declared = DeclaredSignal(signal, start, rate, tuple(rates))
        if not isinstance(low, float) or not isinstance(high, float) or not isinstance(start, float):
            return declared
        if not low <= start <= high or low == high:
            message = f"`{setting.signal}` must start between the two values, of which the lower one comes first"
            self.problems.append((message, (*keys, "between")))
            return None
        return DeclaredSignal(signal, start, rate, tuple(rates), low, high)

    # ---- parts ----

    def _condition(self, text: str, keys: tuple[str, ...]) -> Condition | None:
        """A condition over signals and entries; None: it could not be understood."""
        cursor = line_of_text(text)
        written = parse_cond(cursor)
        if cursor.kind != NEWLINE and not cursor.problems:
            cursor.expected("the end of the condition")
        mistakes = [*cursor.problems, *cursor.lexer.problems]
        reader = self._reader()
        if mistakes or reader is None:
            self.problems += [(mistakes[0].message, keys)] if mistakes else []
            return None
        reader.source = text, Span(0, 0)
        condition = reader.condition(written)
        if reader.problems:
            self.problems.append((reader.problems[0].diagnostic.message, keys))
            return None
        return condition

    def _targets(self, name: str, keys: tuple[str, ...]) -> tuple[NodeTarget, ...]:
        targets = self._store.ask(nodes.find, self._viewpoint, tuple(name.split("/")))
        if not targets:
            names = self._store.ask(nodes.node_names, self._viewpoint)
            likely = did_you_mean(near(name, names, 1)) if "/" not in name else ""
            what = "unknown node" if "/" not in name else "no node matches"
            self.unknown.append((f"{what} `{name}`{likely}", keys))
        else:
            self.known.add(keys)
        return targets

    def _reader(self) -> ScenarioReader | None:
        """A reader of texts that are not in the mission; None: the mission has no tree."""
        path, facts = next(iter(self._store.ask(inputs.trees, self._viewpoint)), ("", None))
        return ScenarioReader(self._store, self._viewpoint, path, facts) if facts is not None else None

    def _signal(self, name: str) -> ResolvedSignal | None:
        """A signal, or an entry in braces as one."""
        reader = self._reader()
        if reader is None:
            return None
        if not name.startswith("{"):
            return reader.signal(name)
        key = name.strip("{}").strip()
        return ResolvedSignal(name, "number", ONE, key, "gauge", None, None, reader.place(Span(0, 0)))

    def _value(self, said: SaidValue, signal: ResolvedSignal, keys: tuple[str, ...]) -> float | bool | str | None:
        """A value of a signal in its unit."""
        value = said.value
        is_entry = signal.name.startswith("{")
        sort = "bool" if isinstance(value, bool) else "text" if isinstance(value, str) else "number"
        if sort != signal.sort and not is_entry:
            expected = {"bool": "true or false", "text": "a text", "number": "a number"}[signal.sort]
            self.problems.append((f"expected {expected} for `{signal.name}`", keys))
            return None
        if isinstance(value, bool | str):
            return value
        return self._in_unit(value, said.unit, signal.unit, keys)

    def _rate(self, said: SaidValue, signal: ResolvedSignal, keys: tuple[str, ...]) -> float:
        """A rate in the unit of the signal and seconds."""
        if isinstance(said.value, bool | str) or signal.sort != "number":
            self.problems.append((f"`{signal.name}` cannot change with time, because it is not a number", keys))
            return 0.0
        own = signal.unit
        if own is None or said.unit is None:
            return self._in_unit(said.value, said.unit, own, keys) or 0.0
        symbol = "1" if own.dimension == NO_DIMENSION else own.symbol
        wanted = parse_unit("1/s" if symbol == "1" else "K/s" if own.offset else f"{symbol}/s")
        assert wanted is not None, "each unit has a rate"
        return self._in_unit(said.value, said.unit, wanted, keys) or 0.0

    def _in_unit(self, value: float, unit: Unit | None, wanted: Unit | None, keys: tuple[str, ...]) -> float | None:
        """A number in another unit."""
        if wanted is None:
            return to_si(value, unit) if unit is not None else value
        if unit is None and wanted.dimension == NO_DIMENSION:
            return value
        if unit is None:
            self.problems.append((f"missing unit after `{value:g}`; expected {_wanted_unit(wanted)}", keys))
            return None
        if unit.dimension != wanted.dimension:
            message = f"expected {_wanted_unit(wanted)}, found `{value:g} {unit.symbol}` ({a_dimension(unit)})"
            self.problems.append((message, keys))
            return None
        return convert(value, unit, wanted)


def _wanted_unit(unit: Unit) -> str:
    """What a value in a unit is, in words, or the unit itself where there are none."""
    name = a_dimension(unit)
    return name if name.startswith(("a ", "an ")) else f"a value in {unit.symbol}"


def is_skill(node: ResolvedNode) -> bool:
    """Whether a node is a leaf of the program, whose code is not known."""
    return node.kind is None and not node.children and not node.is_subtree


def is_condition(node: ResolvedNode) -> bool:
    """Whether a skill is a condition."""
    return node.category == "Condition"
