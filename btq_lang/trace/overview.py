"""What an overview of missions says: small frozen records that the writers print, and nobody has to look anything up.

One invariant: rows name each other by keys (`n3` a node, `r1` a requirement, `q2` a quality), which are the same for
the same missions.  Lines and columns count from 1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.graph.figure import Figure
from btq_lang.util.record import Record

if TYPE_CHECKING:
    # How a clause is held: by the tree that `btq build` makes, by tools that read logs, or by people.
    Way: TypeAlias = Literal["enforced", "monitored", "reviewed"]
    # Whether a node carries a quality or a requirement: itself, through a node above it, or not at all.
    Carries: TypeAlias = Literal["own", "above", "none"]

WAYS: Final[tuple[Way, ...]] = ("enforced", "monitored", "reviewed")


class At(Record):
    """A place in a source file."""

    path: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.path}:{self.line}"


class Clause(Record):
    """A clause as it holds for a subject.

    Attributes:
        why: why no more is done about it; empty where there is nothing to say.
        asked: the engine is to enforce it.
    """

    text: str
    way: Way
    why: str = ""
    asked: bool = False


class Use(Record):
    """A requirement at what it holds for.

    Attributes:
        subject: as a reader knows it: `MoveBase ToCharger`, `from Pick starts to Place succeeds`.
        nodes: the keys of the nodes that are meant.
        how: `subject`: the claim names it; `satisfies` and `apply`: attached; `link`: the node satisfies a requirement
            whose claims name their subjects themselves.
        arguments: `(limit = 5 min)`.
    """

    subject: str
    nodes: tuple[str, ...]
    how: Literal["subject", "satisfies", "apply", "link"]
    arguments: str
    at: At
    clauses: tuple[Clause, ...]


class RequirementRow(Record):
    """A requirement.

    Attributes:
        quality: as written; None: it names none.
        quality_key: of the quality's row.
        clauses: all of them, as typed.
        uses: what it holds for; none: it is attached to nothing.
        loose: the clauses that are about no node, where others of them are about one.
        is_hard: the engine is to enforce it.
    """

    key: str
    name: str
    title: str
    quality: str | None
    quality_key: str | None
    clauses: tuple[str, ...]
    at: At
    uses: tuple[Use, ...]
    loose: tuple[str, ...]
    is_hard: bool

    @property
    def way(self) -> str:
        """How it is held: one way, `enforced, monitored` or `enforced, not attached` where clauses differ, `not
        attached`."""
        found = {clause.way for use in self.uses for clause in use.clauses}
        ways: list[str] = [way for way in WAYS if way in found] or (["linked"] if self.uses else [])
        return ", ".join(ways if ways and not self.loose else [*ways, "not attached"])

    @property
    def whys(self) -> tuple[str, ...]:
        """Why no more is done about its clauses, each reason once."""
        found = [clause.why for use in self.uses for clause in use.clauses if clause.way == "monitored" and clause.why]
        return tuple(dict.fromkeys((*found, *(f"`{clause}` applies to no node" for clause in self.loose))))

    @property
    def nodes(self) -> tuple[str, ...]:
        """The keys of all nodes that it has to do with."""
        return tuple(dict.fromkeys(key for use in self.uses for key in use.nodes))


class QualityRow(Record):
    """A quality that the missions name.

    Attributes:
        name: as first written.
        id: in the quality model, or of one's own declaration; None: nobody knows it.
        characteristic: the ISO's; None: it belongs to none.
        concerns: the keys of the nodes that satisfice it.
        requirements: the keys of those that make it measurable, those of its parts too.
    """

    key: str
    name: str
    id: str | None
    characteristic: str | None
    definition: str
    at: At
    concerns: tuple[str, ...]
    requirements: tuple[str, ...]


class NodeRow(Record):
    """A node as it is written.

    Attributes:
        name: its kind and its instance name.
        is_skill: an action or a condition that is no built-in: what the robot does.
    """

    key: str
    name: str
    tree: str
    category: str | None
    is_skill: bool
    carries: Carries
    at: At


class TreeRow(Record):
    """A tree; nodes: the keys of its nodes; figure: how it is drawn."""

    name: str
    at: At
    nodes: tuple[str, ...]
    is_bare: bool
    figure: Figure


class Total(Record):
    """What is said about one characteristic; `name` of the last one: what belongs to none.

    Attributes:
        concerns: nodes that satisfice it.
        enforced, monitored, reviewed: clauses, each counted at every subject.
    """

    id: str
    name: str
    concerns: int
    requirements: int
    enforced: int
    monitored: int
    reviewed: int


class Overview(Record):
    """All of it.

    Attributes:
        edition: of the quality model that the totals are counted by.
        files: the missions that were looked at.
        totals: of each characteristic of the edition, those nobody mentions too.
    """

    edition: str
    files: tuple[str, ...]
    requirements: tuple[RequirementRow, ...]
    qualities: tuple[QualityRow, ...]
    nodes: tuple[NodeRow, ...]
    trees: tuple[TreeRow, ...]
    totals: tuple[Total, ...]

    @property
    def unmeasured(self) -> tuple[QualityRow, ...]:
        """Qualities without a requirement."""
        return tuple(quality for quality in self.qualities if not quality.requirements)

    @property
    def unattached(self) -> tuple[RequirementRow, ...]:
        """Requirements without a node or another subject."""
        return tuple(requirement for requirement in self.requirements if not requirement.uses)

    @property
    def loose(self) -> tuple[tuple[RequirementRow, str], ...]:
        """Clauses about no node, of requirements that have a node by others."""
        return tuple((requirement, clause) for requirement in self.requirements for clause in requirement.loose)

    @property
    def unenforced(self) -> tuple[RequirementRow, ...]:
        """Hard requirements, some clause of which is only monitored somewhere, or about no node."""
        return tuple(
            requirement
            for requirement in self.requirements
            if (requirement.is_hard and requirement.loose)
            or any(clause.asked and clause.way == "monitored" for use in requirement.uses for clause in use.clauses)
        )

    @property
    def bare_nodes(self) -> tuple[NodeRow, ...]:
        """Skills that neither carry anything themselves nor stand below a node that does."""
        return tuple(node for node in self.nodes if node.is_skill and node.carries == "none")

    @property
    def bare_trees(self) -> tuple[TreeRow, ...]:
        """Trees no node of which carries anything itself."""
        return tuple(tree for tree in self.trees if tree.is_bare)

    def coverage(self) -> dict[str, int]:
        """How many skills carry something themselves, through a node above them, or not at all."""
        skills = [node.carries for node in self.nodes if node.is_skill]
        return {carries: skills.count(carries) for carries in ("own", "above", "none")}
