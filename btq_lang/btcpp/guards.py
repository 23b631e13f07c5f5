"""What makes the engine enforce a clause: the wrappers around nodes, or why there are none.

One invariant: a clause counts as enforced if and only if it has wrappers that a test in `tests/engine` has seen at
work, or the engine meets the clause without any.  This module looks at one clause at a time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from btq_lang.btcpp.conditions import (
    NoScript,
    all_of,
    condition_script,
    no_longer_than_allowed,
    number_script,
    real,
    signal_script,
    table_in_condition,
    table_script,
)
from btq_lang.btcpp.document import Element
from btq_lang.btcpp.keys import legal
from btq_lang.btcpp.wrappers import CHECK, CONDITION, GUARD, INSIDE, LIMIT, VALUES, LeafTag, Wrapper, WrapperTag, leaf
from btq_lang.catalog.units import Unit
from btq_lang.catalog.verbs import VERBS
from btq_lang.requirements.classic import entries_in
from btq_lang.requirements.model import (
    Bounded,
    Condition,
    Interval,
    Limit,
    MissionRun,
    NodeTarget,
    Quantity,
    ResolvedAnyEvent,
    ResolvedClaim,
    ResolvedEvent,
    ResolvedRequirement,
    ResolvedSignal,
    ResolvedSpan,
    ResolvedTable,
    signals_in,
)
from btq_lang.util.record import replace
from btq_lang.workspace.resolved import ResolvedNode


class NotEnforced(Exception):
    """No wrapper makes the engine enforce a clause; the text is the reason and reads well after "because"."""


class ClauseGuard:
    """The wrappers and scripts that make the engine enforce one clause at one node.

    Attributes:
        wrappers: each with its node, from the outside in.
        initial_values: for each root blackboard entry that the mission initializes, its first value.
        signals: the signals that the scripts read.
        entries: the other blackboard entries that the scripts read, as the requirement names them.
        stop: the entry that halts the mission, if a violation does.
        notes: which parts of the clause are not enforced, or how it is interpreted.
    """

    def __init__(
        self,
        requirement: ResolvedRequirement,
        claim: ResolvedClaim,
        node: ResolvedNode,
        name: str,
        stop: str,
        shared: bool,
    ) -> None:
        """
        Args:
            name: prefix of the names of its nodes and entries.
            stop: the entry that halts the mission.
            shared: whether the file of the node is a part of several missions.

        Raises:
            NotEnforced: the engine cannot do it.
        """
        self.wrappers: list[tuple[ResolvedNode, Wrapper]] = []
        self.initial_values: Final[dict[str, str]] = {}
        self.signals: tuple[ResolvedSignal, ...] = ()
        self.entries: tuple[str, ...] = ()
        self.stop: Final = stop if requirement.action == "halt" else None
        self.notes: Final[list[str]] = []
        self.requirement: Final = requirement
        self.claim: Final = claim
        self.node: Final = node
        self.name: Final = name
        self._shared: Final = shared
        self._values: Final[list[str]] = []
        if requirement.span is not None and not VERBS[claim.verb].is_of_moments:
            raise NotEnforced(f"`{requirement.span.text}` is about `keeps` and `never`")
        if claim.verb not in _BY_VERB:
            raise NotEnforced(VERBS[claim.verb].why_monitored)
        try:
            _BY_VERB[claim.verb](self)
            self._finish()
        except NoScript as reason:
            raise NotEnforced(str(reason)) from reason

    def _finish(self) -> None:
        if self._values:
            script = self.leaf("Script", "start", "; ".join(self._values))
            values = Wrapper(VALUES, self.requirement.name, "Sequence", f"{self.name}_values", before=(script,))
            self.wrappers.insert(0, (self.node, values))
        claim = self.claim
        scopes = tuple(scope.condition for scope in self.requirement.scopes)
        read = signals_in((claim.condition, claim.limit, claim.signal, scopes)) if self.wrappers else ()
        self.signals = tuple({signal.name: signal for signal in read}.values())
        self.entries = entries_in(claim.condition)

    def wrap(
        self,
        rank: int,
        tag: WrapperTag,
        what: str,
        *,
        attributes: tuple[tuple[str, str], ...] = (),
        before: tuple[Element, ...] = (),
        after: tuple[Element, ...] = (),
        node: ResolvedNode | None = None,
    ) -> None:
        """Add a wrapper around the clause's node, or around another one."""
        wrapper = Wrapper(rank, self.requirement.name, tag, f"{self.name}_{what}", attributes, before, after)
        self.wrappers.append((node or self.node, wrapper))

    def leaf(self, tag: LeafTag, what: str, code: str, failed: str | None = None) -> Element:
        no_longer_than_allowed(code)
        return leaf(tag, self.requirement.name, f"{self.name}_{what}", code, failed)

    def condition(self, what: str, code: str) -> Element:
        """A condition whose failure breaks the clause."""
        return self.leaf("ScriptCondition", what, code, f"{self.stop} := true" if self.stop else None)

    def script(self, condition: Condition) -> str:
        """The script of a condition; its tables are read with it, not when the node starts."""
        return condition_script(condition, table_in_condition)

    def at_start(self, what: str, script: str) -> str:
        """A variable of the tree that is set to this value when the node starts."""
        key = f"_{self.name}_{what}"
        number = 1
        while any(each.startswith(f"{key} :=") for each in self._values):
            number += 1
            key = f"_{self.name}_{what}_{number}"
        self._values.append(f"{key} := {script}")
        return key

    def stored(self, table: ResolvedTable, unit: Unit | None) -> str:
        return self.at_start(
            "value", table_script(table, lambda value: number_script(value, unit, self.stored), self.stored)
        )

    def entry(self, what: str, initial: str, initializer: ResolvedNode | None = None) -> str:
        """A variable that outlives the node: an entry of the tree if `initializer`, an ancestor in the same tree,
        initializes it; otherwise an entry of the root blackboard.
        """
        if initializer is not None and _is_above(initializer, self.node):
            return f"_{self.name}_{what}"
        tree = f"_{legal(self.node.tree or '')}" if self._shared else ""
        key = f"@{self.name}{tree}_{what}"
        self.initial_values[key] = initial
        return key

    def when(self) -> str | None:
        """A variable that records whether the clause applies to this activation; None: it always does."""
        scopes = self._scopes()
        return self.at_start("when", scopes) if scopes is not None else None

    def in_scope(self, script: str) -> str:
        """A script for a condition that need hold only in scope; both are evaluated when the node starts."""
        scopes = self._scopes()
        return script if scopes is None else f"((!{scopes}) || {script})"

    def refuse_scopes(self) -> None:
        """Refuse any scope: this kind of clause cannot have one."""
        if self.requirement.scopes:
            raise NotEnforced(f"its scope, `{self.requirement.scopes[0].text}`, is evaluated only in logs")

    def _scopes(self) -> str | None:
        scopes = self.requirement.scopes
        for scope in scopes:
            if scope.word == "while":
                raise NotEnforced(f"whether `{scope.text}` holds during a whole activation is known only at its end")
        return all_of(self.script(scope.condition) for scope in scopes) if scopes else None


# ---- verbs ----


def _takes(guard: ClauseGuard) -> None:
    """`<Timeout msec="30000">X</Timeout>`: halts X at the deadline and returns FAILURE."""
    when = guard.when()
    _add_timeout(guard, _upper_bound(guard), when)
    if isinstance(guard.claim.subject, Interval):
        guard.notes.append(f"as a limit on {guard.node.shown}, which restarts whenever {guard.node.shown} starts")


def _succeeds(guard: ClauseGuard) -> None:
    """Any failure violates the clause; a Timeout turns a late success into a failure."""
    if guard.claim.limit is None and not guard.stop:
        guard.notes.append("the node's failure is the violation itself")
        return
    when = guard.when()
    if guard.claim.limit is not None:
        _add_timeout(guard, _upper_bound(guard), when)
    if guard.stop:
        stop = guard.stop
        failed = f"{stop} := true" if when is None else f"{stop} := ({stop} || {when})"
        guard.wrap(INSIDE, "Sequence", "succeeds", attributes=(("_onFailure", failed),))


def _add_timeout(guard: ClauseGuard, bound: Limit, when: str | None) -> None:
    value = bound.value
    milliseconds = (
        _milliseconds(value)
        if not isinstance(value, ResolvedTable)
        else table_script(value, _milliseconds, guard.stored)
    )
    if isinstance(value, ResolvedTable) or when is not None:
        chosen = milliseconds if when is None else f"({when} ? {milliseconds} : 0)"  # 0 means no limit for the engine
        milliseconds = f"{{{guard.at_start('ms', chosen)}}}"
    attributes: tuple[tuple[str, str], ...] = (("msec", milliseconds),)
    if not guard.stop:
        guard.wrap(LIMIT, "Timeout", "limit", attributes=attributes)
        return
    # A Timeout fails also if its child fails in time: only a node that is not done by then was late.
    completed = guard.at_start("done", "false")
    late = f"{guard.stop} := ({guard.stop} || (!{completed}))"
    guard.wrap(LIMIT, "Timeout", "limit", attributes=(*attributes, ("_onFailure", late)))
    guard.wrap(LIMIT, "Sequence", "done", attributes=(("_post", f"{completed} := true"),))


def _milliseconds(value: Bounded) -> str:
    if not isinstance(value, Quantity):
        raise NotEnforced("a Timeout takes a whole number of milliseconds, not the value of a signal")
    whole = int(value.si * 1000 + 1e-6)
    if not 0 < whole < 2**32:
        raise NotEnforced(f"a Timeout cannot be set to `{value.text}`")
    return str(whole)


def _needs(guard: ClauseGuard) -> None:
    """`<Sequence><ScriptCondition code="φ"/>X</Sequence>`"""
    code = guard.in_scope(guard.script(_condition(guard)))
    guard.wrap(CONDITION, "Sequence", "needs", before=(guard.condition("check", code),))


def _keeps(guard: ClauseGuard) -> None:
    """`<ReactiveSequence><ScriptCondition code="φ"/>X</ReactiveSequence>`: evaluated at every tick."""
    code = guard.script(_condition(guard))
    if guard.claim.verb == "never":
        code = f"(!{code})"
    if guard.requirement.span is not None:
        code = _in_span(guard, guard.requirement.span, code)
    for scope in reversed(guard.requirement.scopes):
        script = guard.script(scope.condition)
        code = f"((!{script if scope.word == 'while' else guard.at_start('when', script)}) || {code})"
    guard.wrap(GUARD, "ReactiveSequence", guard.claim.verb, before=(guard.condition("guard", code),))


def _in_span(guard: ClauseGuard, span: ResolvedSpan, code: str) -> str:
    """A script that must hold only from one event until another; scripts at these events set and reset a flag."""
    for scope in guard.requirement.scopes:
        if scope.word == "when":
            raise NotEnforced(f"whether `{scope.text}` holds at the start of that time is evaluated only in logs")
    ends = tuple(atom for atom in span.last.atoms if not _ends_run(atom))
    for atom in ends:
        _is_recorded(atom)
    flag = guard.entry("inside", "true" if _is_recorded(span.first) else "false")
    _record(guard, span.first, "from", "begun", f"{flag} := true")
    _record(guard, ResolvedAnyEvent(ends), "until", "over", f"{flag} := false")
    return f"(({flag} == false) || {code})"


def _ends_run(event: ResolvedEvent) -> bool:
    """Whether it is the end of the mission, which needs no flag."""
    return isinstance(event.subject, MissionRun) and event.happening != "starts"


def _leaves(guard: ClauseGuard) -> None:
    """`<Sequence>X<ScriptCondition code="φ"/></Sequence>`"""
    code = guard.script(_condition(guard))
    if (when := guard.when()) is not None:
        code = f"((!{when}) || {code})"
    guard.wrap(CHECK, "Sequence", "leaves", after=(guard.condition("check", code),))


def _ends_with(guard: ClauseGuard) -> None:
    """`<Sequence>X<ScriptCondition code="φ"/></Sequence>`; a failure fails anyway, and halts the mission if φ does
    not hold then.
    """
    code = guard.script(_condition(guard))
    if (when := guard.when()) is not None:
        code = f"((!{when}) || {code})"
    guard.wrap(CHECK, "Sequence", "ends", after=(guard.condition("check", code),))
    if guard.stop:
        failed = f"{guard.stop} := ({guard.stop} || (!{code}))"
        guard.wrap(INSIDE, "Sequence", "failed", attributes=(("_onFailure", failed),))


def _uses(guard: ClauseGuard) -> None:
    """The signal's value at the start, and two conditions: while the node runs, and when it has succeeded."""
    signal = guard.claim.signal
    assert signal is not None, "the clause names one"
    if signal.behaviour == "gauge":
        raise NotEnforced(f"`{signal.name}` is neither a level nor a counter")
    bound = _upper_bound(guard)
    unit = replace(signal.unit, offset=0.0) if signal.unit is not None else None
    key = signal_script(signal)
    before = guard.at_start("before", f"({key} + 0.0)")
    used = f"({before} - {key})" if signal.behaviour == "level" else f"({key} - {before})"
    code = f"({used} {bound.relation} {number_script(bound.value, unit, guard.stored)})"
    if (when := guard.when()) is not None:
        code = f"((!{when}) || {code})"
    guard.wrap(CHECK, "Sequence", "used", after=(guard.condition("check", code),))
    guard.wrap(GUARD, "ReactiveSequence", "uses", before=(guard.condition("guard", code),))


def _tries(guard: ClauseGuard) -> None:
    """A counter of starts; where the clause says `per` a node, each start of that node resets it."""
    count, most = _counter(guard)
    code = f"(({count} + 1.0) {most})"
    guard.wrap(CONDITION, "Sequence", guard.claim.head, before=(guard.condition("check", code),))
    counter = guard.leaf("Script", "counter", f"{count} := ({count} + 1.0)")
    guard.wrap(INSIDE, "Sequence", "counted", before=(counter,))
    _reset(guard, count)


def _results(guard: ClauseGuard) -> None:
    """A counter of results, and a condition after a success; a failure that is one too many is the violation itself."""
    count, most = _counter(guard)
    attribute = _RECORDED_BY[guard.claim.head]
    assert attribute is not None, "it records a result"
    is_kept = f"({count} {most})"
    if guard.claim.head != "fails":
        guard.wrap(CHECK, "Sequence", "results", after=(guard.condition("check", is_kept),))
    if guard.stop and guard.claim.head != "succeeds":
        failed = f"{guard.stop} := ({guard.stop} || (!{is_kept}))"
        guard.wrap(INSIDE, "Sequence", "failed", attributes=(("_onFailure", failed),))
    guard.wrap(INSIDE, "Sequence", "counted", attributes=((attribute, f"{count} := ({count} + 1.0)"),))
    _reset(guard, count)
    if guard.claim.head != "succeeds" and not guard.stop:
        guard.notes.append("a failure that is one too many is the violation itself")


def _counter(guard: ClauseGuard) -> tuple[str, str]:
    """The variable that counts, and how it is compared."""
    guard.refuse_scopes()
    bound = _upper_bound(guard)
    per = guard.claim.per
    holder = per.node if isinstance(per, NodeTarget) else None
    if isinstance(per, NodeTarget) and per.through:
        raise NotEnforced("its `per` path selects only some instances of the node")
    return guard.entry("count", "0.0", holder), f"{bound.relation} {number_script(bound.value, None, guard.stored)}"


def _reset(guard: ClauseGuard, count: str) -> None:
    """Let each start of the node after `per` set the counter to 0."""
    if isinstance(guard.claim.per, NodeTarget):
        reset = guard.leaf("Script", "zero", f"{count} := {real(0.0)}")
        guard.wrap(INSIDE, "Sequence", "per", before=(reset,), node=guard.claim.per.node)


def _follows(guard: ClauseGuard) -> None:
    """A flag that the event sets and the start of the node resets."""
    guard.refuse_scopes()
    event = guard.claim.event
    assert event is not None, "the clause names one"
    flag = guard.entry("seen", "true" if _is_recorded(event) else "false")
    guard.wrap(CONDITION, "Sequence", "follows", before=(guard.condition("check", f"({flag} == true)"),))
    reset = guard.leaf("Script", "taken", f"{flag} := false")
    guard.wrap(INSIDE, "Sequence", "started", before=(reset,))
    _record(guard, event, "event", "seen", f"{flag} := true")


def _is_recorded(event: ResolvedEvent | ResolvedAnyEvent) -> bool:
    """Whether an event has happened when the mission starts.

    Raises:
        NotEnforced: the engine does not notice the event.
    """
    has_happened = False
    for atom in event.atoms:
        is_start = isinstance(atom.subject, MissionRun) and atom.happening == "starts"
        if not is_start and (not isinstance(atom.subject, NodeTarget) or atom.happening not in _RECORDED_BY):
            raise NotEnforced("the engine runs no script at this event")
        if isinstance(atom.subject, NodeTarget) and atom.subject.through:
            raise NotEnforced("its event names only some instances of a node")
        has_happened = has_happened or is_start
    return has_happened


def _record(
    guard: ClauseGuard, event: ResolvedEvent | ResolvedAnyEvent, what: str, script_name: str, script: str
) -> None:
    """Have a script run at an event; none does at the start of the mission."""
    for number, atom in enumerate(event.atoms, 1):
        if not isinstance(atom.subject, NodeTarget):
            continue
        attribute = _RECORDED_BY[atom.happening]
        suffix = f"_{number}" if number > 1 else ""
        node = atom.subject.node
        if attribute is None:
            leaf_before = (guard.leaf("Script", f"{script_name}{suffix}", script),)
            guard.wrap(INSIDE, "Sequence", f"{what}{suffix}", before=leaf_before, node=node)
        else:
            guard.wrap(INSIDE, "Sequence", f"{what}{suffix}", attributes=((attribute, script),), node=node)


def _upper_bound(guard: ClauseGuard) -> Limit:
    """The upper bound of a clause."""
    limit = guard.claim.limit
    assert limit is not None, "the clause has a bound"
    if limit.relation in (">=", ">"):
        raise NotEnforced("the engine can stop a node, but cannot make it do more")
    if limit.upper is None:
        return limit
    guard.notes.append("its lower bound is only monitored")
    return Limit("<=", limit.upper)


def _condition(guard: ClauseGuard) -> Condition:
    assert guard.claim.condition is not None, "the clause has one"
    return guard.claim.condition


def _is_above(node: ResolvedNode, below: ResolvedNode) -> bool:
    """Whether a node is above another one in its tree."""
    ancestor = below.parent
    while ancestor is not None and ancestor is not node:
        ancestor = ancestor.parent
    return ancestor is node


# The attribute of the node that records an event; None: a Script before it.
_RECORDED_BY: Final[dict[str, str | None]] = {
    "starts": None,
    "succeeds": "_onSuccess",
    "fails": "_onFailure",
    "finishes": "_post",
}
_BY_VERB: Final[dict[str, Callable[[ClauseGuard], None]]] = {
    "takes": _takes,
    "succeeds": _succeeds,
    "needs": _needs,
    "keeps": _keeps,
    "never": _keeps,
    "leaves": _leaves,
    "ends with": _ends_with,
    "uses": _uses,
    "tries": _tries,
    "starts per": _tries,
    **dict.fromkeys(("succeeds per", "fails per", "finishes per"), _results),
    "follows": _follows,
}
