"""Folds a tree: what each node does follows from what its children do, without a run.

One invariant: what is folded is what runs come to, with skills that are independent of each other and of their own
past; where that is not certain, the fold raises `NotExact` and gives no number.  A program ticks every `PERIOD`
milliseconds and when a timer goes off, as in `prediction/runs.py`, so a skill ends at the first of these ticks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import Final, TypeAlias

from btq_lang.prediction.exact.folded import Folded, FoldedOutcome, Memory, NotExact, folded
from btq_lang.prediction.exact.parallel import Ends, depends_on_order, together
from btq_lang.prediction.exact.times import Times, added, at, of_skill
from btq_lang.prediction.skill import Probability, Skill
from btq_lang.simulator import controls, decorators, leaves, timers
from btq_lang.simulator.nodes import FAILURE, SUCCESS, Flow, SimulatedNode
from btq_lang.simulator.ports import key_of, read_whole
from btq_lang.workspace.project_driver import Driver

Place: TypeAlias = "tuple[Probability, Times]"  # how likely one comes there, and after how long


def exact_success(root: SimulatedNode, skills: Mapping[int, Skill]) -> Probability:
    """How likely a tree succeeds: a fraction if that depends on no duration.

    Args:
        root: of the tree as it is loaded.
        skills: what its actions do, by the numbers of the nodes.

    Raises:
        NotExact: it cannot be folded.
    """
    return TreeFold(skills).of(root).success


class TreeFold:
    """Folds nodes whose actions do what is known of them.

    Attributes:
        changed: values of ports in place of the written ones, by the numbers of nodes and the ports.
    """

    def __init__(
        self,
        skills: Mapping[int, Skill],
        changed: Mapping[tuple[int, str], int] | None = None,
        stepped: Callable[[], None] = lambda: None,
    ) -> None:
        """Know skills, by the numbers of nodes; `stepped`: called before each step; what it raises ends the fold."""
        self._stepped: Final = stepped
        self._skills: Final = skills
        self.changed: Final = changed or {}
        self._folded: Final[dict[tuple[int, Memory], Folded]] = {}
        self._keeping: Final[dict[int, frozenset[int]]] = {}
        self._steps = 0

    def of(self, node: SimulatedNode, memory: Memory = frozenset()) -> Folded:
        """What an activation of a node does.

        Args:
            memory: what nodes below have kept.

        Raises:
            NotExact: it cannot be folded.
        """
        below = self.keeping(node)
        own = frozenset(pair for pair in memory if pair[0] in below)
        key = node.uid, own
        if key not in self._folded:
            self._folded[key] = self._made(node, own)
        return self._folded[key]

    def _made(self, node: SimulatedNode, memory: Memory) -> Folded:
        if node.conditions or any(name.startswith("_") for name in node.scripts):
            raise NotExact(node, "scripts decide what it does, by entries")
        flow = node.rules.flow
        if flow in _OF_LEAVES:
            return _OF_LEAVES[flow](self, node)
        if flow not in _FOLDS:
            raise NotExact(node, _REASONS.get(flow, "what it does depends on more than its children"))
        if not node.children:
            raise NotExact(node, "it has no child")
        return _FOLDS[flow](self, node, memory)

    def keeping(self, node: SimulatedNode) -> frozenset[int]:
        """The nodes that keep their place, of it and all below it."""
        if node.uid not in self._keeping:
            own = {node.uid} if node.rules.flow is controls.tick_sequence_with_memory else set()
            self._keeping[node.uid] = frozenset(own).union(*map(self.keeping, node.children))
        return self._keeping[node.uid]

    # ---- leaves ----

    def skill(self, node: SimulatedNode) -> Folded:
        skill = self._skills.get(node.uid)
        if skill is None:
            raise NotExact(node, "it is a condition, whose answers are not independent")
        if skill.keys:
            raise NotExact(node, "scripts say what it writes, by entries")
        return folded(
            FoldedOutcome(
                each.result, each.probability, of_skill(each.takes, PERIOD) if each.takes is not None else None
            )
            for each in skill.outcomes()
        )

    def success(self, node: SimulatedNode) -> Folded:
        return folded([FoldedOutcome(SUCCESS, _SURE, _NO_TIME)])

    def failure(self, node: SimulatedNode) -> Folded:
        return folded([FoldedOutcome(FAILURE, _SURE, _NO_TIME)])

    def sleep(self, node: SimulatedNode) -> Folded:
        return folded([FoldedOutcome(SUCCESS, _SURE, at(self.number(node, "msec", 0)))])

    # ---- one child after the other ----

    def sequence(self, node: SimulatedNode, memory: Memory) -> Folded:
        return self._in_order(node, memory, SUCCESS)

    def fallback(self, node: SimulatedNode, memory: Memory) -> Folded:
        return self._in_order(node, memory, FAILURE)

    def sequence_with_memory(self, node: SimulatedNode, memory: Memory) -> Folded:
        first = dict(memory).get(node.uid, 0)
        before = frozenset(pair for pair in memory if pair[0] != node.uid)
        return self._in_order(node, before, SUCCESS, first, keeps_place=True)

    def _in_order(
        self, node: SimulatedNode, memory: Memory, goes_on: int, first: int = 0, keeps_place: bool = False
    ) -> Folded:
        """Children in order from `first` on, while they have the result `goes_on`."""
        walk = _Walk(self, memory)
        passed = [each for each in node.children if goes_on == SUCCESS and _only_looks(each)]
        for place in range(first, len(node.children)):
            if node.children[place] in passed and len(passed) < len(node.children):
                continue  # it succeeds at once, or is skipped
            kept = frozenset({(node.uid, place)}) if keeps_place and place else frozenset()
            walk.step(node.children[place], goes_on, kept)
        return walk.ended(goes_on)

    def repeat(self, node: SimulatedNode, memory: Memory) -> Folded:
        return self._again(node, memory, "num_cycles", SUCCESS)

    def retry(self, node: SimulatedNode, memory: Memory) -> Folded:
        return self._again(node, memory, "num_attempts", FAILURE)

    def _again(self, node: SimulatedNode, memory: Memory, port: str, counted: int) -> Folded:
        """The child until it has had the result `counted` so many times, or once another."""
        most = self.number(node, port, -1)
        if most < 1:
            raise NotExact(node, "it goes on without an end" if most == -1 else "it never runs its child")
        walk = _Walk(self, memory)
        for _ in range(most):
            walk.step(node.child, counted)
        return walk.ended(counted)

    # ---- one child ----

    def subtree(self, node: SimulatedNode, memory: Memory) -> Folded:
        return self.of(node.child, memory)

    def inverter(self, node: SimulatedNode, memory: Memory) -> Folded:
        return self._mapped(node, memory, {SUCCESS: FAILURE, FAILURE: SUCCESS})

    def force_success(self, node: SimulatedNode, memory: Memory) -> Folded:
        return self._mapped(node, memory, {FAILURE: SUCCESS})

    def force_failure(self, node: SimulatedNode, memory: Memory) -> Folded:
        return self._mapped(node, memory, {SUCCESS: FAILURE})

    def _mapped(self, node: SimulatedNode, memory: Memory, results: Mapping[int, int]) -> Folded:
        child = self.of(node.child, memory)
        outcomes = [
            FoldedOutcome(results.get(each.result, each.result), each.probability, each.takes, each.memory)
            for each in child.outcomes
        ]
        return folded(outcomes, child.doubt)

    def delay(self, node: SimulatedNode, memory: Memory) -> Folded:
        wait = at(self.number(node, "delay_msec", 0))
        child = self.of(node.child, memory)
        outcomes = [
            FoldedOutcome(each.result, each.probability, added(wait, each.takes) if each.takes else None, each.memory)
            for each in child.outcomes
        ]
        return folded(outcomes, child.doubt)

    def timeout(self, node: SimulatedNode, memory: Memory) -> Folded:
        limit = self.number(node, "msec", 0)
        if not limit:
            return self.of(node.child, memory)
        self._refuse_memory(node, "halts")
        child = self.of(node.child)
        outcomes: list[FoldedOutcome] = []
        doubt = child.doubt
        for each in child.outcomes:
            if each.takes is None:
                outcomes.append(FoldedOutcome(FAILURE, each.probability, at(limit)))
                continue
            share = each.takes.below(limit)
            if share:
                outcomes.append(FoldedOutcome(each.result, each.probability * share, each.takes.cut(limit)))
            outcomes.append(FoldedOutcome(FAILURE, each.probability * (1 - share), at(limit)))
            doubt += float(each.probability) * each.takes.doubt(limit)
        return folded(outcomes, doubt)

    # ---- all children ----

    def parallel(self, node: SimulatedNode, memory: Memory) -> Folded:
        size = len(node.children)
        needed, allowed = (
            number if number >= 0 else max(size + number + 1, 0)
            for number in (self.number(node, port, None) for port in ("success_count", "failure_count"))
        )

        def ends(successes: int, failures: int) -> int | None:
            if successes >= needed:
                return SUCCESS
            return FAILURE if size - failures < needed or failures >= allowed else None

        return self._together(node, ends, max(needed, allowed))

    def parallel_all(self, node: SimulatedNode, memory: Memory) -> Folded:
        size = len(node.children)
        number = self.number(node, "max_failures", None)
        allowed = number if number >= 0 else max(size + number + 1, 0)

        def ends(successes: int, failures: int) -> int | None:
            if successes + failures < size:
                return None
            return FAILURE if failures >= allowed else SUCCESS

        return self._together(node, ends, allowed)

    def _together(self, node: SimulatedNode, ends: Ends, most: int) -> Folded:
        size = len(node.children)
        if most > size or ends(0, 0) is not None:
            raise NotExact(node, "the number of children is less than a threshold, or the threshold is 0")
        self._refuse_memory(node, "may halt")
        below = [each for child in node.children for each in _with_all_below(child)]
        for each in below:
            ports = _TIMES.get(each.rules.flow)
            if ports is not None and (not (wait := self.number(each, ports, 0)) or wait % PERIOD):
                raise NotExact(each, f"beside other nodes, only timers of whole multiples of {PERIOD} ms are exact")
            if each.rules.yields and depends_on_order(size, ends):
                raise NotExact(node, f"which of its children ends first may depend on how often {each.name} yields")
        return together([self.of(child) for child in node.children], ends)

    # ---- what they have in common ----

    def number(self, node: SimulatedNode, port: str, least: int | None) -> int:
        """The whole number at a port; `least`: the least that can be folded, if not any."""
        if (node.uid, port) in self.changed:
            return self.changed[node.uid, port]
        if key_of(node.ports.get(port, ""), port) is not None:
            raise NotExact(node, f"its {port} is an entry")
        number = read_whole(node, port)
        if number is None or (least is not None and number < least):
            raise NotExact(node, f"the engine cannot use its {port}")
        return number

    def count(self, node: SimulatedNode) -> None:
        """Count that durations are added up.

        Raises:
            NotExact: that was very often.
        """
        self._stepped()
        self._steps += 1
        if self._steps > _MOST_STEPS:
            raise NotExact(node, "there are too many ways to come to it")

    def _refuse_memory(self, node: SimulatedNode, halts: str) -> None:
        if self.keeping(node):
            raise NotExact(node, f"it {halts} a node that keeps its place")


class _Walk:
    """Activations one after the other: how likely which one has come how far."""

    def __init__(self, fold: TreeFold, memory: Memory) -> None:
        self._fold: Final = fold
        self._places: dict[Memory, Place] = {memory: (_SURE, _NO_TIME)}
        self._ways: Final[list[FoldedOutcome]] = []
        self._doubt = 0.0

    def step(self, child: SimulatedNode, goes_on: int, kept: Memory = frozenset()) -> None:
        """Have a child run; with the result `goes_on` all goes on.

        Args:
            kept: what is kept in addition, if it ends here.
        """
        outcomes: list[FoldedOutcome] = []
        below = self._fold.keeping(child)
        for memory, (probability, takes) in self._places.items():
            child_folded = self._fold.of(child, memory)
            others = frozenset(pair for pair in memory if pair[0] not in below)
            self._doubt += float(probability) * child_folded.doubt
            for each in child_folded.outcomes:
                self._fold.count(child)
                after = added(takes, each.takes) if each.takes is not None else None
                outcomes.append(FoldedOutcome(each.result, probability * each.probability, after, others | each.memory))
        joined = folded(outcomes).outcomes
        self._places = {
            each.memory: (each.probability, each.takes)
            for each in joined
            if each.result == goes_on and each.takes is not None
        }
        self._ways.extend(
            FoldedOutcome(each.result, each.probability, each.takes, each.memory | kept)
            for each in joined
            if each.result != goes_on
        )

    def ended(self, goes_on: int) -> Folded:
        """All ways to end; `goes_on`: the result if the last child had it."""
        last = [FoldedOutcome(goes_on, *place, memory) for memory, place in self._places.items()]
        return folded([*self._ways, *last], self._doubt)


def _only_looks(node: SimulatedNode) -> bool:
    """Whether a node only gives values to entries without one: what `first_values` of `btcpp/wrappers.py` makes."""
    if node.rules.flow is not decorators.tick_run_once or node.child.rules.flow is not decorators.tick_force_success:
        return False
    return all(
        each.rules.flow in _LOOKING and not each.conditions and set(each.scripts) <= _SETTING
        for each in _with_all_below(node.child.child)
    )


def _with_all_below(node: SimulatedNode) -> Iterator[SimulatedNode]:
    yield node
    for child in node.children:
        yield from _with_all_below(child)


PERIOD: Final = Driver().period  # ms between two ticks
_MOST_STEPS: Final = 2_000
_SURE: Final = Fraction(1)
_NO_TIME: Final = at(0)
_TIMES: Final[dict[Flow, str]] = {
    timers.tick_timeout: "msec",
    timers.tick_delay: "delay_msec",
    timers.tick_sleep: "msec",
}
_OF_LEAVES: Final[dict[Flow, Callable[[TreeFold, SimulatedNode], Folded]]] = {
    leaves.tick_custom: TreeFold.skill,
    leaves.tick_always_success: TreeFold.success,
    leaves.tick_always_failure: TreeFold.failure,
    timers.tick_sleep: TreeFold.sleep,
}
_FOLDS: Final[dict[Flow, Callable[[TreeFold, SimulatedNode, Memory], Folded]]] = {
    controls.tick_sequence: TreeFold.sequence,
    controls.tick_fallback: TreeFold.fallback,
    controls.tick_sequence_with_memory: TreeFold.sequence_with_memory,
    controls.tick_parallel: TreeFold.parallel,
    controls.tick_parallel_all: TreeFold.parallel_all,
    decorators.tick_subtree: TreeFold.subtree,
    decorators.tick_inverter: TreeFold.inverter,
    decorators.tick_force_success: TreeFold.force_success,
    decorators.tick_force_failure: TreeFold.force_failure,
    decorators.tick_repeat: TreeFold.repeat,
    decorators.tick_retry: TreeFold.retry,
    timers.tick_delay: TreeFold.delay,
    timers.tick_timeout: TreeFold.timeout,
}
_LOOKING: Final = (controls.tick_parallel_all, leaves.tick_was_entry_updated)
_SETTING: Final = {"_onFailure"}
_REACTIVE: Final = "it asks children again at each tick"
_ENTRIES: Final = "what it does depends on entries, or entries depend on it"
_REASONS: Final[dict[Flow, str]] = {
    controls.tick_reactive_sequence: _REACTIVE,
    controls.tick_reactive_fallback: _REACTIVE,
    controls.tick_while_do_else: _REACTIVE,
    controls.tick_if_then_else: "a condition decides",
    controls.tick_switch: _ENTRIES,
    decorators.tick_precondition: _ENTRIES,
    decorators.tick_skip_unless_updated: _ENTRIES,
    decorators.tick_wait_value_update: _ENTRIES,
    decorators.tick_loop: _ENTRIES,
    leaves.tick_script: _ENTRIES,
    leaves.tick_script_condition: _ENTRIES,
    leaves.tick_set_blackboard: _ENTRIES,
    leaves.tick_unset_blackboard: _ENTRIES,
    leaves.tick_was_entry_updated: _ENTRIES,
    decorators.tick_keep_running_until_failure: "it goes on without an end",
    decorators.tick_run_once: "it remembers that it has run",
}
