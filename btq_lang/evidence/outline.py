"""What identifies a mission and the places of its clauses in later texts, without building it."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.requirements.model import Applied, NodeTarget, ResolvedClaim, ResolvedRequirement
from btq_lang.util.record import Record, fields_of
from btq_lang.workspace.resolved import ResolvedNode, ResolvedTree

if TYPE_CHECKING:
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
    def text(self) -> str:
        """The clause as typed, with all that counts for its requirement."""
        requirement = self.requirement
        of_all = (*requirement.scopes, requirement.odds, requirement.window)
        parts = [self.claim.text, *(each.text for each in of_all if each is not None)]
        return " ".join([*parts, f"goal {requirement.goal.text}"] if requirement.goal is not None else parts)


def demands(found: Requirements) -> Iterator[Demand]:
    """The clauses that logs can show, in the order in which they are judged."""
    seen: Counter[tuple[str, str, str]] = Counter()
    used: set[tuple[str, str]] = set()
    for applied in found.applied:
        for claim in applied.requirement.claims if not applied.requirement.is_verified_by_people else ():
            used.add((applied.requirement.name, claim.text))
            at = _place(applied)
            key = applied.requirement.name, claim.text, at
            yield Demand(applied.requirement, claim, applied, f"{at} {seen[key]}")
            seen[key] += 1
    for requirement in found.all.values():
        for claim in requirement.claims if not requirement.is_verified_by_people else ():
            if (requirement.name, claim.text) not in used:
                yield Demand(requirement, claim, None, "")


def outline(found: Requirements) -> str:
    """A digest of what all trees do, and of what signals and contexts mean, whatever the layout, comments and
    requirements.
    """
    trees = [_text(tree) for tree in found.nodes.trees]
    words = [_meaning(each) for each in (*found.signals.values(), *found.contexts.items())]
    return hashlib.sha256("\n".join([*trees, *words]).encode()).hexdigest()[:_DIGITS]


def _place(applied: Applied) -> str:
    node = applied.node
    if node is None:
        return ""
    through = applied.subject.through if isinstance(applied.subject, NodeTarget) else ()
    return "/".join((*through, node.tree or "", node.shown))


def _text(tree: ResolvedTree) -> str:
    lines = [f"tree {tree.name}"]
    for each in tree.all:
        pairs = (f"{pair.key.text}={pair.value.text if pair.value else ''}" for pair in each.node.attributes)
        lines.append(f"{sum(1 for _ in each.ancestors())} {each.shown} {' '.join(pairs)}")
    return "\n".join(lines)


def _meaning(part: object) -> str:
    """A record of `requirements/model` in words, without its places."""
    if isinstance(part, ResolvedNode):
        return f"{part.tree} {part.shown}"
    if hasattr(part, "__match_args__"):  # it is a record
        fields = [getattr(part, name) for name in fields_of(part) if name != "place"]
        return f"{type(part).__name__}{_meaning(fields)}"
    return f"({' '.join(map(_meaning, part))})" if isinstance(part, tuple | list) else repr(part)


_DIGITS: Final = 16
