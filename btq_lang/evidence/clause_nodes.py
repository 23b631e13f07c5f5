"""The nodes of a log that a clause holds for, and the events that it names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.history import near
from btq_lang.evidence.model import ROOT
from btq_lang.requirements.model import (
    DurationSum,
    Interval,
    MissionRun,
    NodeTarget,
    ResolvedEachEvent,
    events_of,
)

if TYPE_CHECKING:
    from btq_lang.evidence.clause_findings import ClauseFindings
    from btq_lang.evidence.identity import Joined
    from btq_lang.requirements.model import (
        ResolvedAnyEvent,
        ResolvedClaim,
        ResolvedEvent,
        ResolvedSpan,
        Subject,
    )


def judged_together(
    claim: ResolvedClaim, subject: Subject | None, joined: Joined, findings: ClauseFindings
) -> list[tuple[int, ...]]:
    """The nodes of a log that a clause holds for, in groups that are judged as one node.

    Args:
        findings: of the clause; gets the paths of the nodes, and which of them the log lacks.
    """
    if isinstance(subject, Interval):
        firsts = _instances_of(joined, subject.first, findings)
        groups: dict[tuple[tuple[int, ...], ...], tuple[int, ...]] = {}
        lasts = [_instances(joined, _node_of(atom.subject), findings) for atom in subject.last.atoms]
        for uid in firsts:
            together = tuple(near(uid, of_atom, joined.tree) for of_atom in lasts)
            groups[together] = (*groups.get(together, ()), uid)
        return [*groups.values()] if not findings.missing else []
    if isinstance(subject, ResolvedEachEvent):
        answers = claim.event.atoms if claim.event is not None else ()
        firsts = [*_instances_of(joined, subject.event, findings)]
        for atom in answers:
            _instances(joined, _node_of(atom.subject), findings)
        return [(uid,) for uid in firsts] if not findings.missing else []
    if isinstance(subject, DurationSum):
        uids = [uid for target in subject.targets for uid in _instances(joined, target, findings)]
        return [tuple(uids)] if uids and not findings.missing else []
    own = _instances(joined, _node_of(subject), findings)
    if VERBS[claim.verb].operand == "failures":  # together, for they share the exposure
        return [tuple(own)] if own else []
    return [(uid,) for uid in own]


def events_in(claim: ResolvedClaim, subject: Subject | None, span: ResolvedSpan | None) -> tuple[ResolvedEvent, ...]:
    """The events that a clause names."""
    events = (*events_of(subject), *([claim.event] if claim.event is not None else ()))
    events += (span.first, span.last) if span is not None else ()
    return tuple(atom for event in events for atom in event.atoms)


def _instances_of(joined: Joined, event: ResolvedEvent | ResolvedAnyEvent, findings: ClauseFindings) -> Iterable[int]:
    """The uids of the nodes of an event; that of the root for a condition."""
    uids: dict[int, None] = {}
    for atom in event.atoms:
        own = _instances(joined, _node_of(atom.subject), findings) if atom.condition is None else [ROOT]
        uids.update(dict.fromkeys(own))
    return uids


def _instances(joined: Joined, target: NodeTarget | None, findings: ClauseFindings) -> list[int]:
    """The uids of a node's instances; notes those missing from the log."""
    uids: list[int] = []
    for path, uid in joined.instances(target) if target is not None else ():
        findings.paths[path] = None
        if uid is not None:
            uids.append(uid)
        else:
            findings.missing = findings.missing or joined.lost(path)
    return uids


def _node_of(subject: Subject | None) -> NodeTarget | None:
    """The node of a subject, if the subject is a node."""
    if isinstance(subject, MissionRun) and subject.node is not None:
        return NodeTarget(subject.node)
    return subject if isinstance(subject, NodeTarget) else None
