"""Clauses about the mission that come out the same in every run, because a run is judged by itself: the mission starts
once in it, before all else, and ends after all else.

One invariant: what is only likely to come out the same is not reported.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.verbs import words
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax import tree as syntax
from btq_lang.util.text import Span


def same_in_every_run(view: View, claim: syntax.Claim) -> Diagnostic | None:
    """What is wrong with a clause that each run answers alike; None if runs may differ."""
    problem = _of_subject(view, claim) or _of_event(view, claim) or _of_span(view, claim)
    if problem is None:
        return None
    message, note = problem
    return Diagnostic("impossible-bound", Span(claim.start, claim.end), message, notes=(note,))


def _of_subject(view: View, claim: syntax.Claim) -> tuple[str, str] | None:
    """Message and note, if it is about how often, or after what, a mission starts."""
    verb, event = claim.verb.raw, claim.event
    if not (verb in _STARTS and _is_mission(view, claim.subject)):
        return None
    if event is None:
        message = f"a mission starts only once in a run, so `{verb}` does not apply to it"
        return message, "name the node whose starts to count: `MoveBase tries at most 3`"
    note = "name the node that is meant: `Dock starts within 2 s after Batch succeeds`"
    if verb == "follows" and event.condition is not None:
        note = "for what must hold when it starts, write `mission needs …`"
    return "a mission starts before all else in its run, not after it", note


def _of_event(view: View, claim: syntax.Claim) -> tuple[str, str] | None:
    """The same, if it is about what happens after the mission has ended, or what runs before it."""
    event = claim.event
    if event is None or not _is_of_mission(view, event):
        return None
    if event.happening != "starts":
        return f"nothing happens in a run after `{_shown(event)}`", _BY_ITSELF
    if claim.verb.raw != "ends" or not _starts_first(view) or _is_mission(view, claim.subject):
        return None
    ending = _path_text(claim.subject) if isinstance(claim.subject, syntax.Path) else "…"
    note = f"for the time from there on, write `from mission starts to {ending} finishes takes at most …`"
    return f"no other node runs yet at `{_shown(event)}`", note


def _of_span(view: View, claim: syntax.Claim) -> tuple[str, str] | None:
    """The same, if it is about a time that begins when the mission ends, or ends when it starts."""
    if not isinstance(claim.subject, syntax.Between):
        return None
    for event, side, is_outside in ((claim.subject.first, "after", False), (claim.subject.last, "before", True)):
        if event is not None and (event.happening == "starts") is is_outside and _is_of_mission(view, event):
            return f"nothing happens in a run {side} `{_shown(event)}`", _BY_ITSELF
    return None


def _is_of_mission(view: View, event: syntax.Event) -> bool:
    return event.condition is None and bool(event.happening) and (event.path is None or _is_mission(view, event.path))


def _is_mission(view: View, subject: syntax.Subject | None) -> bool:
    """Whether it means the mission, as such or by the name of its root, which no other tree runs again and which has
    children: a single action is rather a part of a mission."""
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


def _shown(event: syntax.Event) -> str:
    return f"{_path_text(event.path) if event.path is not None else 'mission'} {event.happening}"


def _path_text(path: syntax.Path) -> str:
    return "/".join(name.raw for name in path.names)


# Verbs about when, and how often, a node starts.
_STARTS: Final = words(operands=("count", "rate", "event")) | {"starts"}
_SEEN_FIRST: Final = ("sequence", "fallback", "parallel", "parallel-all", "choice", "retry", "repeat")
_BY_ITSELF: Final = "each run is judged by itself"
