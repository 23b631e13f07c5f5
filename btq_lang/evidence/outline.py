"""The clauses of a mission: those that logs can show, and those that no log can.

What identifies a mission and the places of its clauses in later texts is computed without building it.

One invariant: what `demands` leaves out of a mission is open, or unknown where that is due to a mistake.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.units import Unit
from btq_lang.evidence.tally import Tally
from btq_lang.evidence.verdicts import OPEN, UNKNOWN, ClauseVerdict
from btq_lang.requirements import model
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import NodeTarget, ResolvedClaim, ResolvedRequirement, Subject
from btq_lang.util.record import Record, fields_of
from btq_lang.workspace.resolved import ResolvedNode, ResolvedTree

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import Verdict
    from btq_lang.requirements.resolve import Requirements


class Demand(Record):
    """A clause at what it holds for.

    Attributes:
        applied: None: nothing.
        place: the node's tree and the node, as they are written, and how many clauses of the requirement with the same
            text are at such a node before it.
    """

    requirement: ResolvedRequirement
    claim: ResolvedClaim
    applied: Applied | None
    place: str

    @property
    def subject(self) -> Subject | None:
        """What the clause is about; None: nothing."""
        return self.applied.subject if self.applied is not None else None

    @property
    def text(self) -> str:
        """The clause as typed, with all that counts for its requirement."""
        requirement = self.requirement
        qualifiers = (*requirement.scopes, requirement.span, *requirement.assumptions)
        of_all = (*qualifiers, requirement.odds, requirement.window)
        parts = [self.claim.text, *(part.text for part in of_all if part is not None)]
        return " ".join([*parts, f"goal {requirement.goal.text}"] if requirement.goal is not None else parts)


def demands(requirements: Requirements) -> Iterator[Demand]:
    """The clauses that logs can show, in the order in which they are judged."""
    seen: Counter[tuple[str, str, str]] = Counter()
    used: set[tuple[str, str]] = set()
    for applied in requirements.applied:
        for claim in applied.requirement.claims if not applied.requirement.is_verified_by_people else ():
            used.add((applied.requirement.name, claim.text))
            place = _place(applied)
            key = applied.requirement.name, claim.text, place
            yield Demand(applied.requirement, claim, applied, f"{place} {seen[key]}")
            seen[key] += 1
    for requirement in requirements.all.values():
        for claim in requirement.claims if not requirement.is_verified_by_people else ():
            if (requirement.name, claim.text) not in used:
                yield Demand(requirement, claim, None, "")


def outline(requirements: Requirements) -> str:
    """A digest of what all trees do, and of what signals and contexts mean, whatever the layout, comments and
    requirements.
    """
    trees = [_text(tree) for tree in requirements.nodes.trees]
    words = [_meaning(part) for part in (*requirements.signals.values(), *requirements.contexts.items())]
    return hashlib.sha256("\n".join([*trees, *words]).encode()).hexdigest()[:_DIGITS]


def _place(applied: Applied) -> str:
    node = applied.node
    if node is None:
        return ""
    through = applied.subject.through if isinstance(applied.subject, NodeTarget) else ()
    return "/".join((*through, node.tree or "", node.shown))


def _text(tree: ResolvedTree) -> str:
    lines = [f"tree {tree.name}"]
    for node in tree.all:
        pairs = (f"{pair.key.text}={pair.value.text if pair.value else ''}" for pair in node.node.attributes)
        lines.append(f"{sum(1 for _ in node.ancestors())} {node.shown} {' '.join(pairs)}")
    return "\n".join(lines)


def _meaning(part: object) -> str:
    """A record of `requirements/model` in words, without its places."""
    if isinstance(part, ResolvedNode):
        return f"{part.tree} {part.shown}"
    if hasattr(part, "__match_args__"):  # it is a record
        fields = [getattr(part, name) for name in fields_of(part) if name != "place"]
        return f"{_WORDS[type(part)]}{_meaning(fields)}"
    return f"({' '.join(map(_meaning, part))})" if isinstance(part, tuple | list) else repr(part)


# Verdicts that are kept on the disk have the digest of these words: they stay, whatever the classes are called.
_WORDS: Final[dict[type, str]] = {
    Unit: "Unit",
    model.Age: "Age",
    model.Aggregate: "Aggregate",
    model.All: "All",
    model.Any: "Any",
    model.Arithmetic: "Arithmetic",
    model.ClassicScript: "ClassicScript",
    model.Compare: "Compare",
    model.Flag: "Flag",
    model.InContext: "InContext",
    model.Minus: "Minus",
    model.Negation: "Negation",
    model.NodeTarget: "NodeTarget",
    model.Quantity: "Quantity",
    model.ResolvedCase: "ResolvedCase",
    model.ResolvedParameter: "ResolvedParameter",
    model.ResolvedScope: "ResolvedScope",
    model.ResolvedSignal: "ResolvedSignal",
    model.ResolvedTable: "ResolvedTable",
    model.Running: "Running",
    model.SignalRead: "SignalRead",
    model.TextValue: "TextValue",
}


def open_reason(requirement: ResolvedRequirement) -> str:
    """Why no log can show a requirement; empty if logs can."""
    if requirement.is_verified_by_people:
        return requirement.verification
    return "" if requirement.claims or requirement.unread else "it has no clause that can be measured"


def open_clauses(requirement: ResolvedRequirement) -> tuple[ClauseVerdict, ...]:
    """The clauses of an open requirement in a report; one without text if it has none."""
    texts = [Demand(requirement, claim, None, "").text for claim in requirement.claims]
    return tuple(_without_evidence(requirement, text, OPEN, open_reason(requirement)) for text in texts or [""])


def unread_clauses(requirement: ResolvedRequirement) -> tuple[ClauseVerdict, ...]:
    """The clauses of a requirement that were not understood."""
    texts = requirement.unread if not requirement.is_verified_by_people else ()
    return tuple(_without_evidence(requirement, text, UNKNOWN, "it has a mistake; run btq check") for text in texts)


def _without_evidence(requirement: ResolvedRequirement, text: str, verdict: Verdict, why: str) -> ClauseVerdict:
    return ClauseVerdict(
        text=text,
        path="",
        of="",
        verdict=verdict,
        why=why,
        unit="activations",
        confidence=requirement.confidence,
        histogram=None,
        **Tally(None, None).fields(),
    )


_DIGITS: Final = 16
