"""From the words of a scenario to its plan.

One invariant: a scenario with a mistake has no plan; each mistake is reported once, at its line.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from btq_lang.catalog.units import from_si
from btq_lang.evidence.model import ROOT
from btq_lang.requirements import nodes
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.attach import by_subject
from btq_lang.requirements.clauses import claim_of
from btq_lang.requirements.entries import ScenarioReader, key_of
from btq_lang.requirements.model import (
    Condition,
    Flag,
    MissionRun,
    NodeTarget,
    Quantity,
    ResolvedParameter,
    ResolvedRequirement,
    ResolvedSignal,
    TextValue,
    signals_in,
)
from btq_lang.requirements.terms import DURATION
from btq_lang.scenarios import plan
from btq_lang.scenarios.mission import ScenarioMission, line_of
from btq_lang.simulator.blackboard import BOOL, type_of
from btq_lang.simulator.nodes import FAILURE, RUNNING, SKIPPED, SUCCESS
from btq_lang.simulator.skills import GivenActivation, GivenSkill, Write
from btq_lang.syntax import scenarios as written
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import BRACED, NUMBER, QUANTITY
from btq_lang.syntax.tree import Amount, Claim, Event, Given, Pair, Scenario, Word
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Span


class ScenarioMistake(Record):
    """Something wrong with a scenario."""

    line: int
    message: str


class ScenarioMistakes(Exception):
    """A scenario cannot be run."""

    def __init__(self, mistakes: Sequence[ScenarioMistake]) -> None:
        super().__init__("; ".join(mistake.message for mistake in mistakes))
        self.mistakes: Final = mistakes


def plan_of(mission: ScenarioMission, scenario: Scenario, common: Sequence[Given]) -> plan.Plan:
    """What a scenario says.

    Args:
        common: what is given for all scenarios of the file.

    Raises:
        ScenarioMistakes: it has some.
    """
    readers = [_ItemReader(mission, given, _OF_FILE) for given in common]
    for reader, given in zip(readers, common, strict=True):
        reader.give(given)
    own = _ItemReader(mission, scenario, 0)
    for step in scenario.steps:
        if isinstance(step, written.Given):
            own.give(step)
        elif isinstance(step, written.When):
            own.change(step)
        else:
            own.expect(step)
    mistakes = [mistake for reader in (*readers, own) for mistake in reader.mistakes()]
    if not (mistakes or own.expectations):
        mistakes.append(ScenarioMistake(own.line(scenario.start), "it expects nothing"))
    if mistakes:
        raise ScenarioMistakes(mistakes)
    names = {each.expected.name for each in own.expectations if isinstance(each.expected, plan.WantedVerdict)}
    judged = [applied for applied in mission.requirements.applied if applied.requirement.name in names]
    return plan.Plan(
        tuple(given for reader in (*readers, own) for given in reader.givens),
        tuple(value for reader in (*readers, own) for value in reader.values),
        tuple(own.changes),
        tuple(own.expectations),
        tuple(dict.fromkeys(signals_in((*_conditions(own), *_of_applied(judged))))),
    )


def _conditions(reader: _ItemReader) -> Iterator[object]:
    """What triggers and expectations have of requirements, in which signals are named."""
    for change in reader.changes:
        if not isinstance(change.trigger, int | plan.WatchedEvent):
            yield change.trigger
    for expected in [each.expected for each in reader.expectations]:
        if isinstance(expected, plan.ExpectedEnd):
            yield expected.condition
        elif isinstance(expected, plan.ExpectedClaims):
            yield from _of_applied(expected.applied)


def _of_applied(applied: Iterable[Applied]) -> Iterator[object]:
    for each in applied:
        yield from (each.requirement, each.subject)


class _ItemReader:
    """Reads the lines of an item.

    Attributes:
        givens, values, changes, expectations: what they say.
    """

    def __init__(self, mission: ScenarioMission, item: Given | Scenario, rank: int) -> None:
        """rank: is added to how specific each given is."""
        self._mission: Final = mission
        self._item: Final = item
        self._rank: Final = rank
        facts = mission.workspace.files[mission.path].facts[id(item)]
        self._reader: Final = ScenarioReader(mission.workspace.store, mission.path, mission.path, facts)
        self._own_mistakes: Final[list[ScenarioMistake]] = []
        self.givens: Final[list[GivenSkill]] = []
        self.values: Final[list[plan.Set]] = []
        self.changes: Final[list[plan.PlannedChange]] = []
        self.expectations: Final[list[plan.Expectation]] = []

    def line(self, offset: int) -> int:
        """The line of an offset in the item."""
        return line_of(self._mission.workspace, self._mission.path, self._item, offset)[1]

    def mistakes(self) -> list[ScenarioMistake]:
        """What is wrong with the lines."""
        problems = [
            ScenarioMistake(self.line(problem.diagnostic.span.start), problem.diagnostic.message)
            for problem in self._reader.problems
        ]
        return [*dict.fromkeys((*problems, *self._own_mistakes))]

    def _complain(self, offset: int, message: str) -> None:
        self._own_mistakes.append(ScenarioMistake(self.line(offset), message))

    # ---- given ----

    def give(self, given: written.Given) -> None:
        """Read what is given."""
        if isinstance(given.fact, written.Assignment):
            value = self._set(given.fact)
            self.values.extend([value] if value is not None else [])
        elif given.fact is not None:
            skill = self._skill(given.fact, self._rank)
            if skill is not None:
                self.givens.append(skill)

    def _skill(self, fact: written.NodesDo, rank: int) -> GivenSkill | None:
        uids, values = self._nodes(fact.nodes)
        if not uids:
            return None
        rank += (_PATH if fact.nodes.path is not None else 0) + (_VALUES if values else 0)
        answers: list[bool] = []
        activations: list[GivenActivation] = []
        writes = any(behavior.writes for behavior in fact.behaviors)
        for behavior in fact.behaviors:
            times = self._times(behavior.times)
            words = [word.raw for aspect in behavior.aspects for word in aspect.answers]
            answers += [word == "true" for word in words] * (times or 1)
            activation = self._activation(behavior, uids)
            if words:
                times = len(words) * (times or 1) if behavior is not fact.behaviors[-1] else 0
            if activation != GivenActivation() or (words and writes):
                activations.append(replace(activation, times=times))
        if activations and activations[-1].times:
            activations.append(GivenActivation())
        return GivenSkill(uids, rank, tuple(activations), tuple(answers), values, self.line(fact.start))

    def _activation(self, behavior: written.Behavior, uids: frozenset[int]) -> GivenActivation:
        result: int | None = None
        takes: int | None = None
        for aspect in behavior.aspects:
            result = _RESULTS.get(aspect.word.raw, result)
            if aspect.duration is not None:
                duration = self._reader.quantity(aspect.duration, DURATION)
                takes = round(duration.si * 1000) if duration is not None else 0
        pairs = [(pair.key, pair.value) for pair in behavior.writes if pair.value is not None]
        writes = [write for key, word in pairs if (write := self._write(key, word, uids)) is not None]
        return GivenActivation(result, takes, tuple(writes) or None)

    def _write(self, key: Word, word: Word, uids: frozenset[int]) -> Write | None:
        """What nodes write through a port, into the entry that a signal reads, or into another entry."""
        name = key_of(key)
        value: float | int | str | bool | None = _literal(word)
        signal = None if any(self._mission.has_port(uid, name) for uid in uids) else self._reader.signal(name)
        if signal is not None and not signal.key:
            message = (
                f"`{name}` is a signal without an entry; no node writes it, so change it with `when …: {name} = …`"
            )
            self._complain(key.start, message)
            return None
        if signal is not None:
            name, value = f"@{signal.entry}", self._value(signal, word)
        if value is None:
            return None
        is_bool = isinstance(value, bool)
        return Write(name, int(value) if isinstance(value, bool) else value, BOOL if is_bool else type_of(value))

    def _times(self, word: Word | None) -> int:
        if word is None:
            return 0
        return _TIMES.get(word.raw) or int(float(word.raw))

    def _nodes(self, pattern: written.NodePattern) -> tuple[frozenset[int], tuple[tuple[str, str], ...]]:
        """The nodes of a pattern, and the values of their ports."""
        reader = self._reader
        if pattern.every is not None:
            name = pattern.every.text
            targets = [NodeTarget(node) for node in reader.store.ask(nodes.every, reader.viewpoint, name)]
            if not targets:
                reader.report_unknown_kind(pattern.every)
        elif pattern.path is not None:
            names = tuple(word.text for word in pattern.path.names)
            targets = [*reader.find(names)]
            if not targets:
                reader.target(pattern.path)
        else:
            targets = []
        return self._uids(targets, pattern.start), _values(pattern.pairs)

    def _uids(self, targets: Sequence[NodeTarget], offset: int) -> frozenset[int]:
        uids = frozenset(uid for target in targets for uid in self._mission.uids(target))
        if targets and not uids:
            self._complain(offset, f"the node is not in the tree `{self._mission.name}`")
        return uids

    def _set(self, assignment: written.Assignment) -> plan.Set | None:
        target, word = assignment.target, assignment.value
        if word is None:
            return None
        if target.kind == BRACED:
            return plan.Set("", key_of(target), _literal(word), self.line(assignment.start))
        signal = self._reader.signal(target.text)
        if signal is None:
            self._reader.unknown(target, ("signals",))
            return None
        value = self._value(signal, word)
        return plan.Set("" if signal.key else signal.name, signal.entry, value) if value is not None else None

    def _value(self, signal: ResolvedSignal, word: Word) -> float | str | bool | None:
        """The value of a signal, numbers in its unit."""
        value = self._reader.argument(ResolvedParameter(signal.name, signal.sort, signal.unit, None), Amount(word))
        if isinstance(value, Quantity):
            return from_si(value.si, signal.unit) if signal.unit is not None else value.si
        return value.value if isinstance(value, Flag | TextValue) else None

    # ---- when ----

    def change(self, when: written.When) -> None:
        """Read what changes during the run."""
        trigger = self._trigger(when.trigger)
        effect: plan.Set | GivenSkill | plan.Halt | None
        if isinstance(when.effect, written.Assignment):
            effect = self._set(when.effect)
        elif isinstance(when.effect, written.NodesDo):
            effect = self._skill(when.effect, _LATER)
        else:
            effect = plan.Halt() if when.effect is not None else None
        if trigger is not None and effect is not None:
            self.changes.append(plan.PlannedChange(trigger, effect, self.line(when.start)))

    def _trigger(self, trigger: object) -> int | plan.WatchedEvent | Condition | None:
        if isinstance(trigger, written.Elapsed):
            duration = self._reader.quantity(trigger.duration, DURATION)
            return round(duration.si * 1000) if duration is not None else None
        if isinstance(trigger, written.EventTrigger):
            uids = self._event_nodes(trigger.event)
            return (
                plan.WatchedEvent(trigger.event.happening, uids, _values(trigger.pairs), trigger.nth) if uids else None
            )
        return self._reader.condition(trigger)  # type: ignore[arg-type]  # the last kind of trigger

    def _event_nodes(self, event: Event) -> frozenset[int]:
        if event.path is None:
            return frozenset((ROOT,))
        targets = self._reader.find(tuple(word.text for word in event.path.names))
        if not targets:
            self._reader.target(event.path)
        return self._uids(targets, event.start)

    # ---- expect ----

    def expect(self, expect: written.Expect) -> None:
        """Read what is expected."""
        expected = self._expected(expect)
        if expected is not None:
            text = self._reader.text(expect.start, expect.end).removeprefix("expect ")
            self.expectations.append(plan.Expectation(text, self.line(expect.start), expected))

    def _expected(self, expect: written.Expect) -> plan.Expected | None:
        written_one = expect.expectation
        if isinstance(written_one, Claim):
            return self._claim(written_one)
        if isinstance(written_one, written.ExpectedRuns):
            uids, pairs = self._nodes(written_one.nodes)
            port = written_one.port.text if written_one.port is not None else None
            if port is None and any(self._mission.input_port(uid) is None for uid in uids):
                message = "the node has not just one input port; name one in brackets: `(port) runs`"
                self._complain(written_one.start, message)
            values = tuple(word.text for word in written_one.values)
            return plan.ExpectedValues(uids, values, pairs, port) if uids else None
        if isinstance(written_one, written.Finally):
            condition = self._reader.condition(written_one.condition)
            return plan.ExpectedEnd(condition) if condition is not None else None
        if isinstance(written_one, written.ExpectedVerdict):
            name = written_one.name.text
            if name not in self._mission.requirements.all:
                self._complain(written_one.start, f"unknown requirement `{name}`")
                return None
            return plan.WantedVerdict(name, " ".join(word.raw for word in written_one.words) or "satisfied")
        if isinstance(written_one, written.ExpectedOutcome):
            return plan.WantedEnd(_ENDS[written_one.word.raw])
        return plan.WantedEnd("does not end") if written_one is not None else None

    def _claim(self, claim: Claim) -> plan.ExpectedClaims | None:
        resolved = claim_of(self._reader, claim)
        if resolved is None:
            return None
        if resolved.subject is None:
            resolved = replace(resolved, subject=MissionRun(self._reader.mission))
        place = self._reader.place(Span(claim.start, claim.end))
        name = f"expectation {len(self.expectations) + 1}"
        requirement = ResolvedRequirement(name, place, None, None, False, (), (resolved,))
        applied = tuple(by_subject(self._reader.store, self._reader.viewpoint, requirement))
        return plan.ExpectedClaims(requirement, applied)


def _values(pairs: Iterable[Pair]) -> tuple[tuple[str, str], ...]:
    return tuple((pair.key.text, pair.value.text) for pair in pairs if pair.value is not None)


def _literal(word: Word) -> float | int | str | bool:
    """A value as an entry holds it; of a quantity the number, in the unit that is written."""
    if word.kind == NUMBER:
        return float(word.raw) if any(sign in word.raw for sign in ".eE") else int(word.raw)
    if word.kind == QUANTITY and (quantity := parse_quantity(word.raw)) is not None:
        return quantity[0]
    return word.raw == "true" if word.raw in ("true", "false") else word.text


_VALUES: Final = 1  # how specific values of ports are
_PATH: Final = 2
_OF_FILE: Final = -4  # less than anything in the scenario
_LATER: Final = 8  # more than anything that was given at the start
_RESULTS: Final = {"succeeds": SUCCESS, "fails": FAILURE, "skips": SKIPPED, "does": RUNNING}
_ENDS: Final = {"fails": "fails", "halts": "is halted"}
_TIMES: Final = {"once": 1, "twice": 2}
