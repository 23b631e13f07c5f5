"""The node whose duration a span measures: from the start of the first child of a Sequence to the success of its last
one is the duration of that Sequence.

One invariant: whenever the node starts, the span's first event happens in the same tick, and if the node succeeds, so
does its last one.
"""

from __future__ import annotations

from btq_lang.requirements.budgets import Budgets
from btq_lang.requirements.model import Interval, NodeTarget, ResolvedAnyEvent, ResolvedEvent
from btq_lang.workspace.resolved import ResolvedNode


def node_of(span: Interval, budgets: Budgets) -> ResolvedNode | None:
    """The innermost node whose duration a span measures, if there is one."""
    first, last = _node(span.first, ("starts",)), _node(span.last, ("succeeds", "finishes"))
    if first is None or last is None:
        return None
    beginning, ending = _chain(first, at_end=False), _chain(last, at_end=True)
    node = next((each for each in beginning if each in ending), None)
    if node is None:
        return None
    between = (*beginning[: beginning.index(node)], *ending[: ending.index(node)])
    may_be_skipped = any(budgets.of(each).skip is not None for each in between)
    return None if may_be_skipped else node


def _node(event: ResolvedEvent | ResolvedAnyEvent, happenings: tuple[str, ...]) -> ResolvedNode | None:
    """The node of an event, if the event is of these kinds and means all instances of the node; None for several
    events."""
    if isinstance(event, ResolvedAnyEvent):
        return None
    subject = event.subject
    if event.happening not in happenings or not isinstance(subject, NodeTarget) or subject.through:
        return None
    return subject.node


def _chain(node: ResolvedNode, *, at_end: bool) -> list[ResolvedNode]:
    """A node and the Sequences above it that begin, or end, with it."""
    chain = [node]
    while (parent := node.parent) is not None and _takes_no_ticks_of_its_own(parent):
        if node.index != (len(parent.node.children) - 1 if at_end else 0):
            break
        chain.append(parent)
        node = parent
    return chain


def _takes_no_ticks_of_its_own(node: ResolvedNode) -> bool:
    """Whether it is a sequence that starts with the start of its first child, and ends with the end of its last."""
    kind = node.kind
    return kind is not None and kind.flow == "sequence" and not (kind.reactive or kind.pauses)
