"""The resolved requirements of a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.util.record import Record
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.requirements.model import Applied, Claim, Condition, Requirement, Signal, Trace
    from btq_lang.requirements.nodes import Nodes
    from btq_lang.requirements.paths import Problem


class Requirements(Record):
    """All requirements that a file sees.

    Attributes:
        store, viewpoint: for further queries, for instance of budgets.
        signals: by name.
        contexts: by name; None if not understood.
        all: every requirement by name, in the order of their definitions, with parameters.
        applied: what applies to what, with arguments.
        traces: `satisfies` at nodes, for requirements whose claims name their own subjects.
        attached: names of requirements that a node or an `apply` refers to.
        problems: all that was not understood.
        nodes: the written nodes.
        mission: the main tree's root; None if it is unknown which tree runs.
    """

    store: Store[Workspace]
    viewpoint: str
    signals: dict[str, Signal]
    contexts: dict[str, Condition | None]
    all: dict[str, Requirement]
    applied: tuple[Applied, ...]
    traces: tuple[Trace, ...]
    attached: frozenset[str]
    problems: tuple[Problem, ...]
    nodes: Nodes
    mission: ResolvedNode | None

    def of(self, node: ResolvedNode) -> tuple[Applied, ...]:
        """What applies to a node."""
        return tuple(each for each in self.applied if each.node is node)

    def about_no_node(self) -> tuple[tuple[Requirement, Claim], ...]:
        """The claims that apply to nothing, of requirements whose other claims apply to something; a requirement that
        applies to nothing at all is unused, which is reported separately."""
        used = {each.requirement.name for each in self.applied}
        # Claims with equal text have the same subject, or none.
        held = {(each.requirement.name, claim.text) for each in self.applied for claim in each.requirement.claims}
        return tuple(
            (requirement, claim)
            for requirement in self.all.values()
            if requirement.name in used
            for claim in requirement.claims
            if (requirement.name, claim.text) not in held
        )
