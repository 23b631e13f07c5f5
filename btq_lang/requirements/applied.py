"""A requirement and what it applies to: small frozen records, as in `model`."""

from __future__ import annotations

from typing import Literal

from btq_lang.diagnostics.model import Place
from btq_lang.requirements.model import (
    Bounded,
    DurationSum,
    Interval,
    MissionRun,
    NodeTarget,
    ResolvedEachEvent,
    ResolvedRequirement,
    events_of,
)
from btq_lang.util.record import Record
from btq_lang.workspace.resolved import ResolvedNode


class Applied(Record):
    """A requirement and what it applies to.

    Attributes:
        requirement: with arguments in place of its parameters, and only the claims that apply to `subject`.
        subject: a node, the mission, a span, a sum, or each occurrence of an event.
        place: of what attached it: the reference at the node, the `apply`, or the claim that names its subject.
        how: `subject`, `satisfies` or `apply`.
    """

    requirement: ResolvedRequirement
    subject: NodeTarget | MissionRun | Interval | DurationSum | ResolvedEachEvent
    arguments: tuple[ResolvedArgument, ...]
    place: Place
    how: Literal["subject", "satisfies", "apply"]

    @property
    def node(self) -> ResolvedNode | None:
        """The node that it applies to; None for a span, a sum, an event, and an unknown mission."""
        return self.subject.node if isinstance(self.subject, NodeTarget | MissionRun) else None

    @property
    def argument_list(self) -> str:
        """Its arguments, `(limit = 5 min)`; empty without any."""
        arguments = ", ".join(f"{each.name} = {each.value.text}" for each in self.arguments)
        return f"({arguments})" if arguments else ""

    @property
    def tree(self) -> str | None:
        """The tree to whose root it applies, if the claim names the root by its tree."""
        node = self.node
        if self.how != "subject" or isinstance(self.subject, MissionRun) or node is None or node.parent is not None:
            return None
        claim = self.requirement.claims[0]
        last = claim.text.partition(f" {claim.head} ")[0].rpartition("/")[2]
        return node.tree if last == node.tree else None

    @property
    def shown(self) -> str:
        """Its node as a message names it: as the mission or as a tree if the claim does so; empty if there is no
        node."""
        if self.node is None:
            return ""
        if isinstance(self.subject, MissionRun):
            return "`mission`"
        return f"`{self.tree}`" if self.tree is not None else self.node.shown

    @property
    def nodes(self) -> tuple[ResolvedNode, ...]:
        """The nodes that its subject names; for a span, and for an event, those of the events."""
        if isinstance(self.subject, DurationSum):
            return tuple(target.node for target in self.subject.targets)
        events = events_of(self.subject)
        parts: list[NodeTarget | MissionRun | None] = [atom.subject for event in events for atom in event.atoms]
        if isinstance(self.subject, NodeTarget | MissionRun):
            parts.append(self.subject)
        return tuple(part.node for part in parts if part is not None and part.node is not None)


class ResolvedArgument(Record):
    """The value of a parameter: as given, or its default."""

    name: str
    value: Bounded


class Attachment(Record):
    """An attachment of a requirement to a node, before it is decided which of several counts.

    Attributes:
        rank: how specific it is.
        place: the reference.
    """

    requirement: str
    target: NodeTarget
    arguments: tuple[ResolvedArgument, ...]
    rank: int
    how: Literal["satisfies", "apply"]
    place: Place


class Trace(Record):
    """A node that satisfies a requirement whose claims name their own subjects: a link without a verdict."""

    requirement: str
    node: ResolvedNode
