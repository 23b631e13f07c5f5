"""Bounds that can never be kept or never be broken, and `uses` of signals without consumption.

A clause about the mission comes out the same in every run if it asks what happens before or after the run: a run is
judged by itself, and the mission starts once in it, before all else, and ends after all else.

One invariant: what is only likely to come out the same is not reported.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from math import ceil, floor, isfinite
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.units import Dimension, parse_unit
from btq_lang.catalog.verbs import VERBS, words
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, write_fix
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import NUMBER, QUANTITY
from btq_lang.util.text import Span


def impossible_bound(view: View) -> Iterator[Diagnostic]:
    """A fractional number of attempts, a negative time, and a claim that every run answers alike."""
    for requirement, claim in _claims(view):
        bound, verb = claim.bound, claim.row
        operand = VERBS[verb].operand
        is_count = operand in _COUNTED
        if (diagnostic := same_in_every_run(view, claim)) is not None:
            yield diagnostic
        elif bound is not None:
            for amount in syntax.walk(bound):
                if not isinstance(amount, syntax.Amount):
                    continue
                number, what = _value(amount)
                is_lower = bound.relation in (">=", ">") or (bound.relation == "between" and amount is bound.value)
                if what == "count" and is_count and not claim.every and not is_rate_meant(view, claim):
                    yield from _count(requirement, claim, amount, number, is_lower)
                    continue
                is_never = what == "time" and operand in _TIMED and (number < 0 or (number == 0 and not is_lower))
                if is_never and not (VERBS[verb].limits and _is_enforceable(view, requirement)):
                    message = f"a duration must be longer than zero, found `{_shown(amount)}`"
                    yield Diagnostic("impossible-bound", amount.word.span, message)


def span_outside_run(view: View) -> Iterator[Diagnostic]:
    """`from … until …` that begins when the mission ends, or ends when it starts."""
    for _, requirement in view.requirements:
        for clause in requirement.clauses:
            if isinstance(clause, syntax.FromUntil) and (problem := _outside_run(view, clause.first, clause.last)):
                yield Diagnostic("impossible-bound", Span(clause.start, clause.end), problem[0], notes=problem[1:])


def uses_of_gauge(view: View) -> Iterator[Diagnostic]:
    """`uses … of` a signal that is neither a counter nor a level, so that its use is undefined."""
    for _, claim in _claims(view):
        if (
            claim.resource is None
            or (declaration := view.ask(lookups.declaration, Kind.SIGNAL, claim.resource.text)) is None
        ):
            continue
        signal = declaration.symbol.target
        if not isinstance(signal, syntax.Signal) or signal.unit is None or signal.unit.text in ("bool", "text"):
            continue
        if signal.behaviour and signal.behaviour.raw != "gauge":
            continue
        span = signal.behaviour.span if signal.behaviour else Span(*[(signal.source or signal.unit).end] * 2)
        place = Place(span, declaration.path, declaration.owner.item)
        words = ("level", "counter") if signal.unit.text == "%" else ("counter", "level")
        message = f"`{claim.resource.text}` is neither a counter nor a level, so its use is undefined"
        fixes = tuple(
            Fix(f"Declare it as a {word}", (FixEdit(place, word if signal.behaviour else f" {word}"),))
            for word in words
        )
        notes = ("the use of a counter is its final minus its initial value; the use of a level is the opposite",)
        related = (Related(declaration.place, "declared here"),)
        yield Diagnostic("uses-of-gauge", claim.resource.span, message, related=related, notes=notes, fixes=fixes)


def _claims(view: View) -> Iterator[tuple[syntax.Requirement, syntax.Claim]]:
    for _, requirement in view.requirements:
        for clause in requirement.clauses:
            if isinstance(clause, syntax.Claim):
                yield requirement, clause


def _value(amount: syntax.Amount) -> tuple[float, str]:
    """A number, and "count" or "time"; an empty text for any other value, which another rule reports."""
    word = amount.word
    number, what = 0.0, ""
    if word.kind == NUMBER:
        number, what = float(word.raw), "count"
    elif word.kind == QUANTITY and (quantity := parse_quantity(word.raw)) is not None:
        number, what = quantity[0], _dimensions().get(quantity[1].dimension, "")
    return (-number if amount.negative else number), what if isfinite(number) else ""


def _count(
    requirement: syntax.Requirement, claim: syntax.Claim, amount: syntax.Amount, number: float, is_lower: bool
) -> Iterator[Diagnostic]:
    what, is_rate = _NAMES.get(claim.row, "starts"), claim.row == "runs"
    has_scope = any(isinstance(clause, syntax.ScopeClause) for clause in requirement.clauses)
    notes: tuple[str, ...] = ()
    if claim.row == "starts per" and number == 0 and not is_lower and not has_scope:
        yield _never_starts(claim, amount)
        return
    if number < 0 or number != int(number):
        message = f"expected a whole number of {what}, found `{_shown(amount)}`"
        if is_rate and number > 0:
            notes = ("write a whole number and a longer time: `runs at least 1 per 2 s`",)
        elif claim.row == "fails per" and 0 < number < 1 and not is_lower:
            notes = ("a failure rate is per a time: `fails at most 1 per 200 h`",)
    elif what == "attempts" and not is_lower and number < 1 and not has_scope:
        message = "a node that starts makes at least one attempt, so only a node that never starts keeps this bound"
        notes = ("the first start counts as well: write `tries at most 1` to allow no second one",)
    else:
        return
    fixes: tuple[Fix, ...] = ()
    whole = max(1, ceil(number) if is_lower else floor(number))
    is_looser = not is_lower and 0 < number < 1
    if amount.word.kind == NUMBER and not amount.negative and not is_rate and not is_looser:
        fixes = (write_fix(str(whole), amount.word.span),)
    yield Diagnostic("impossible-bound", amount.word.span, message, notes=notes, fixes=fixes)


def _never_starts(claim: syntax.Claim, amount: syntax.Amount) -> Diagnostic:
    """The finding for `X starts at most 0 per run`, which only runs without X keep."""
    subject = claim.subject
    name = _path_text(subject) if isinstance(subject, syntax.Path) else "X"
    of_run = isinstance(claim.per, syntax.Word) and isinstance(subject, syntax.Path)
    instead = f"mission never node {name}"
    fixes = (write_fix(instead, Span(claim.start, claim.end)),) if of_run else ()
    message = f"no start at all is demanded, which is written `{instead}`"
    return Diagnostic("impossible-bound", amount.word.span, message, fixes=fixes)


def is_rate_meant(view: View, claim: syntax.Claim) -> bool:
    """Whether a claim is meant as a failure rate, and reported for how it is written: `fails at most 1e-6 per h`."""
    if not claim.form:
        return False
    from btq_lang.requirements.clauses import rate_unit  # few clauses count anything
    from btq_lang.requirements.nodes import find

    unit = rate_unit(claim)
    return claim.per is None or (bool(unit) and not view.ask(find, (unit,)))


def _shown(amount: syntax.Amount) -> str:
    return f"-{amount.word.raw}" if amount.negative else amount.word.raw


def _is_enforceable(view: View, written: syntax.Requirement) -> bool:
    """Whether the engine is to enforce the times of a requirement; limit-too-small reports them then."""
    from btq_lang.requirements.definitions import requirement  # few files have claims about times

    resolved, _ = view.ask(requirement, written.name.text) if written.name is not None else (None, ())
    return resolved is not None and resolved.is_enforceable


@cache
def _dimensions() -> dict[Dimension, str]:
    units = ("1", "count"), ("times", "count"), ("s", "time")
    return {unit.dimension: what for symbol, what in units if (unit := parse_unit(symbol)) is not None}


def same_in_every_run(view: View, claim: syntax.Claim) -> Diagnostic | None:
    """The diagnostic for a claim that every run answers alike; None if runs may differ."""
    problem = _of_subject(view, claim) or _of_event(view, claim) or _of_span(view, claim)
    if problem is None:
        return None
    message, note = problem
    return Diagnostic("impossible-bound", Span(claim.start, claim.end), message, notes=(note,))


def _of_subject(view: View, claim: syntax.Claim) -> tuple[str, str] | None:
    """The message and the note for a claim about how often, or after what, a mission starts."""
    verb, event = claim.verb.raw, claim.event
    if not (claim.row in _STARTS and _is_mission(view, claim.subject)):
        return None
    if event is None:
        message = f"a mission starts only once in a run, so `{verb}` does not apply to it"
        return message, "name the node whose starts to count: `MoveBase tries at most 3`"
    note = "name the node that is meant: `Dock starts within 2 s after Batch succeeds`"
    if verb == "follows" and isinstance(event, syntax.Event) and event.condition is not None:
        note = "for what must hold when it starts, write `mission needs …`"
    return "a mission starts before all else in its run, not after it", note


def _of_event(view: View, claim: syntax.Claim) -> tuple[str, str] | None:
    """The message and the note for a claim about what happens after the mission has ended, or what runs before it."""
    if VERBS[claim.row].operand == "answer":
        return None
    event = claim.event if isinstance(claim.event, syntax.Event) else None
    for atom in claim.event.atoms if claim.event is not None else ():
        if atom is not None and atom.happening != "starts" and _is_of_mission(view, atom):
            return f"nothing happens in a run after `{_event_text(atom)}`", _BY_ITSELF
    if event is None or not _is_of_mission(view, event):
        return None
    if claim.verb.raw != "ends" or not _starts_first(view) or _is_mission(view, claim.subject):
        return None
    ending = _path_text(claim.subject) if isinstance(claim.subject, syntax.Path) else "…"
    note = f"for the time from there on, write `from mission starts to {ending} finishes takes at most …`"
    return f"no other node runs yet at `{_event_text(event)}`", note


def _of_span(view: View, claim: syntax.Claim) -> tuple[str, str] | None:
    """The message and the note for a claim about a time that begins when the mission ends, or ends when it starts."""
    subject = claim.subject
    if isinstance(subject, syntax.Between):
        first, last = subject.first, subject.last
    elif isinstance(subject, syntax.EachEvent) and claim.event is not None:
        first, last = subject.event, claim.event
    else:
        return None
    return _outside_run(view, first, last)


def _outside_run(
    view: View, first: syntax.Event | syntax.AnyEvent | None, last: syntax.Event | syntax.AnyEvent | None
) -> tuple[str, str] | None:
    """The message and the note for a time that begins when the mission ends, or ends when it starts."""
    for event, side, is_outside in ((first, "after", False), (last, "before", True)):
        for atom in event.atoms if event is not None else ():
            if atom is not None and (atom.happening == "starts") is is_outside and _is_of_mission(view, atom):
                return f"nothing happens in a run {side} `{_event_text(atom)}`", _BY_ITSELF
    return None


def _is_of_mission(view: View, event: syntax.Event) -> bool:
    return event.condition is None and bool(event.happening) and (event.path is None or _is_mission(view, event.path))


def _is_mission(view: View, subject: syntax.Subject | None) -> bool:
    """Whether a subject means the mission, by that word or by the name of its root.  The root must have children, and
    no other tree may run it: a single action is rather a part of a mission."""
    if not isinstance(subject, syntax.Path):
        return isinstance(subject, syntax.Mission)
    from btq_lang.requirements.nodes import callers, find, mission  # few clauses need them

    root = view.ask(mission)
    if root is None or not root.children or view.is_used_elsewhere or view.ask(callers, root.tree):
        return False
    return [target.node for target in view.ask(find, tuple(name.text for name in subject.names))] == [root]


def _starts_first(view: View) -> bool:
    """Whether the mission's root is known to start before its children in a log."""
    from btq_lang.requirements.nodes import mission  # as above

    root = view.ask(mission)
    return root is not None and root.flow in _SEEN_FIRST


def _event_text(event: syntax.Event) -> str:
    return f"{_path_text(event.path) if event.path is not None else 'mission'} {event.happening}"


def _path_text(path: syntax.Path) -> str:
    return "/".join(name.raw for name in path.names)


_COUNTED: Final = ("count", "rate")
_NAMES: Final = {
    **{"tries": "attempts", "starts per": "attempts"},
    **{"succeeds per": "successes", "fails per": "failures", "finishes per": "results"},
}
_TIMED: Final = ("duration", "deadline", "rate", "reaction", "answer", "stretch")
# Verbs about when, and how often, a node starts.
_STARTS: Final = words(operands=("count", "rate", "event")) | {"starts"}
_SEEN_FIRST: Final = ("sequence", "fallback", "parallel", "parallel-all", "choice", "retry", "repeat")
_BY_ITSELF: Final = "each run is judged by itself"
