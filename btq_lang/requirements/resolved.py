"""What a file's requirements come to, once their words are resolved."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from btq_lang.requirements.model import Applied, Claim, Condition, Requirement, Signal, Trace
    from btq_lang.requirements.nodes import Nodes
    from btq_lang.requirements.paths import Problem
    from btq_lang.workspace.queries import Store
    from btq_lang.workspace.resolved import ResolvedNode
    from btq_lang.workspace.workspace import Workspace


class Requirements:
    """All requirements that a file sees.

    Attributes:
        store, viewpoint: where more can be asked about them, as their budgets.
        signals: by name.
        contexts: by name; None: it could not be understood.
        all: every requirement by name, in the order of their definitions, parameters in it.
        applied: what holds for what, with arguments.
        traces: `satisfies` at a node of a requirement whose claims name their subjects themselves.
        attached: names of requirements that a node or an `apply` refers to.
        problems: everything that was not understood.
        nodes: the written nodes.
        mission: the main tree's root; None where it is unknown which tree runs.
    """

    def __init__(
        self,
        store: Store[Workspace],
        viewpoint: str,
        signals: dict[str, Signal],
        contexts: dict[str, Condition | None],
        of_name: dict[str, Requirement],
        applied: tuple[Applied, ...],
        traces: tuple[Trace, ...],
        attached: frozenset[str],
        problems: tuple[Problem, ...],
        nodes: Nodes,
        mission: ResolvedNode | None,
    ) -> None:
        self.store = store
        self.viewpoint = viewpoint
        self.signals = signals
        self.contexts = contexts
        self.all = of_name
        self.applied = applied
        self.traces = traces
        self.attached = attached
        self.problems = problems
        self.nodes = nodes
        self.mission = mission

    def of(self, node: ResolvedNode) -> tuple[Applied, ...]:
        """What holds for a node."""
        return tuple(each for each in self.applied if each.node is node)

    def about_no_node(self) -> tuple[tuple[Requirement, Claim], ...]:
        """The claims that hold for nothing, of requirements that hold for something by their other claims; a
        requirement that holds for nothing at all is not used, which is another matter."""
        used = {each.requirement.name for each in self.applied}
        # Claims of one text have one subject, or none.
        held = {(each.requirement.name, claim.text) for each in self.applied for claim in each.requirement.claims}
        return tuple(
            (requirement, claim)
            for requirement in self.all.values()
            if requirement.name in used
            for claim in requirement.claims
            if (requirement.name, claim.text) not in held
        )
