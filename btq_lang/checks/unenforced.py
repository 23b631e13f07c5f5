"""`on violation fail` and `halt` where a build does not make the engine do it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.demanded import Demanded, Found, highest, judge_of, told_at
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements.model import Target

if TYPE_CHECKING:
    from btq_lang.requirements.attach import Held
    from btq_lang.requirements.model import Applied, Claim, SourceNode


def not_enforced(demanded: Demanded) -> Iterator[Found]:
    """A claim about a node that no build enforces, or only one that writes all files as one."""
    for applied, claim, node, place, why in demanded.hard:
        if place is None or _is_told_otherwise(demanded, claim, node, place):
            continue
        related = () if place == node.place else (Related(node.place, "node"),)
        if why is not None:
            yield place, _found(applied, place, why, related)
            continue
        elsewhere = next((each for each in _nodes(claim, node) if not _is_built(demanded, applied, claim, each)), None)
        if elsewhere is not None:
            from btq_lang.btcpp.judging import where_else  # few missions ask for what is in other files

            why = where_else(demanded.view.workspace, elsewhere)
            yield place, _found(applied, place, why, related, is_bundled=True)


def not_enforced_between(demanded: Demanded, held: Held) -> Iterator[Found]:
    """The same of claims about no node in particular."""
    placed = {id(applied) for _, applied in held.by_tree}
    judge = judge_of(demanded)
    for applied in held.applied:
        for claim in applied.requirement.claims if id(applied) not in placed else ():
            place = told_at(demanded.view, applied, claim)
            why = judge.why_not(applied, claim) if place is not None else None
            if place is not None and why is not None:
                yield place, _found(applied, place, why, ())


def _found(
    applied: Applied, place: Place, why: str, related: tuple[Related, ...], *, is_bundled: bool = False
) -> Diagnostic:
    requirement = applied.requirement
    asked = "this" if requirement.classic else f"`on violation {requirement.action}`"  # classic ones are hard unasked
    note = (
        "nothing stops the robot, and `btq verify` can only check it in the logs afterwards; "
        "remove `on violation`, or write `on violation warn`"
    )
    return Diagnostic(
        "not-enforced",
        place.span,
        f"the engine cannot enforce {asked}: {why}",
        related=related,
        notes=() if is_bundled or requirement.classic else (note,),
        severity=Severity.HINT if is_bundled else None,
    )


def _is_told_otherwise(demanded: Demanded, claim: Claim, node: SourceNode, place: Place) -> bool:
    """Whether a rule of its own says why the engine does not hold it."""
    if claim.signal is not None:
        return claim.signal.behaviour == "gauge"
    most = highest(claim) if VERBS[claim.verb].limits and place != node.place else None
    return most is not None and (most[0] < 0.001 or not demanded.budgets.composed(node).waits)


def _nodes(claim: Claim, node: SourceNode) -> Iterator[SourceNode]:
    """The nodes that something is put around."""
    yield node
    for other in (claim.per, claim.event.subject if claim.event is not None else None):
        if isinstance(other, Target):
            yield other.node


def _is_built(demanded: Demanded, applied: Applied, claim: Claim, node: SourceNode) -> bool:
    """Whether what is put around a node is written: in this file, or because the node's own file asks for it."""
    if node.path == demanded.view.path:
        return True
    seen = demanded.ask((_seen_in, node.path))
    asking = demanded.ask((_asking, (applied.requirement.name, node)))
    return not seen.isdisjoint(asking) or (applied.how == "subject" and claim.place.path in seen)


def _seen_in(demanded: Demanded, path: str) -> frozenset[str]:
    """The files whose requirements a file sees."""
    return frozenset(demanded.view.workspace.closure(path))


def _asking(demanded: Demanded, about: tuple[str, SourceNode]) -> frozenset[str]:
    """The files that attach a requirement to a node."""
    name, node = about
    uses = demanded.view.resolved.uses[1].get(name, ())
    return frozenset([use.path for use in uses if use.target.node is node])
