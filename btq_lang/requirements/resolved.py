"""What a file's requirements come to, once their words are resolved."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from btq_lang.requirements.attach import Held
    from btq_lang.requirements.model import Applied, Claim, Condition, Requirement, Signal, SourceNode, Trace
    from btq_lang.requirements.nodes import Nodes
    from btq_lang.requirements.paths import Problem
    from btq_lang.requirements.trees import TreeNodes


class Requirements:
    """All requirements that a file sees.

    Attributes:
        signals: by name.
        contexts: by name; None: it could not be understood.
        all: every requirement by name, in the order of their definitions, parameters in it.
        held: what each of these holds for, in the same order.
        attached: names of requirements that a node or an `apply` refers to.
        problems: everything that was not understood.
        nodes: the written nodes.
        mission: the main tree's root; None where nobody can say which tree runs.
        by_tree: what is applied to nodes, by the tree that they stand in; a span, too, by the node that it begins at.
    """

    def __init__(
        self,
        signals: dict[str, Signal],
        contexts: dict[str, Condition | None],
        of_name: dict[str, Requirement],
        held: list[Held],
        attached: frozenset[str],
        problems: tuple[Problem, ...],
        nodes: Nodes,
        mission: SourceNode | None,
        by_tree: dict[int, tuple[Applied, ...]],
    ) -> None:
        self.signals = signals
        self.contexts = contexts
        self.all = of_name
        self.held = held
        self.attached = attached
        self.problems = problems
        self.nodes = nodes
        self.mission = mission
        self.by_tree = by_tree

    @cached_property
    def applied(self) -> tuple[Applied, ...]:
        """What holds for what, with arguments."""
        return tuple([each for held in self.held for each in held.applied])

    @cached_property
    def traces(self) -> tuple[Trace, ...]:
        """`satisfies` at a node of a requirement whose claims name their subjects themselves."""
        return tuple([each for held in self.held for each in held.traces])

    def in_tree(self, tree: TreeNodes) -> tuple[Applied, ...]:
        """What holds for nodes of a tree, in the order of the requirements."""
        return self.by_tree.get(id(tree.item), ())

    def of(self, node: SourceNode) -> tuple[Applied, ...]:
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
