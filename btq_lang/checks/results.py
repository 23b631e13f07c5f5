"""What the nodes of a file can return, as far as their kinds, attributes and children tell.

One invariant: never less than a node can return, so what is missing here is impossible; a leaf that nobody knows can
return anything.  Only in `first` one thing is assumed: a custom action takes longer than one tick.  Not known here:
the blackboard, and so whether a condition is ever true.
"""

from __future__ import annotations

from btq_lang.checks.statuses import ANYTHING, FAILURE, RUNNING, SKIPPED, SUCCESS, of_builtin
from btq_lang.placeholders import is_placeholder
from btq_lang.record import record
from btq_lang.symbols import Kind

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

    from btq_lang.checks.view import SeenNode, View
    from btq_lang.syntax import Entry, Node
    from btq_lang.workspace import Definition


@record
class Results:
    """What a node can return: sets of statuses.

    Attributes:
        first: at the tick that starts it (a SequenceWithMemory that was halted does not start, it goes on), if actions
            in a Timeout take longer than one tick.
        usual: the same, if custom actions take longer than one tick.
        ever: at any tick.
    """

    first: int
    usual: int
    ever: int


class TreeResults:
    """The results of all nodes of a file, and of the trees that they run, worked out when first asked for."""

    def __init__(self, view: View) -> None:
        self._view = view
        self._begun: set[int] = set()
        self._trees: dict[int, Results] = {}
        self._nodes: dict[int, Results] = {}
        self._without_ports: dict[tuple[str, tuple[Results, ...]], Results] = {}

    def of(self, entry: Entry, node: object) -> Results:
        """What a node of a tree can return; for verbatim XML that is anything."""
        if id(entry) not in self._trees:
            self._work_out(entry)
        return self._nodes.get(id(node), _UNKNOWN)

    def _work_out(self, entry: Entry) -> None:
        """The trees that a tree runs come first; in a circle one of them is taken to return anything."""
        waiting = [entry]
        while waiting:
            tree = waiting[-1]
            if id(tree) in self._begun:
                waiting.pop()
                if id(tree) not in self._trees:
                    self._trees[id(tree)] = self._of_tree(tree)
                continue
            self._begun.add(id(tree))
            called = (self._called(seen) for seen in self._view.nodes(tree) if seen.is_subtree)
            waiting += [other.entry for other in called if other is not None and id(other.entry) not in self._begun]

    def _of_tree(self, entry: Entry) -> Results:
        roots = []
        for seen in reversed(self._view.nodes(entry)):  # children before their parents
            found = self._nodes[id(seen.node)] = self._of_node(seen)
            if seen.parent is None:
                roots.append(found)
        return roots[0] if len(roots) == 1 else _UNKNOWN

    def _of_node(self, seen: SeenNode) -> Results:
        found = _UNKNOWN
        if seen.is_subtree:
            called = self._called(seen)
            found = self._trees.get(id(called.entry), _UNKNOWN) if called else _UNKNOWN
        elif seen.kind is not None and not is_placeholder(seen.node):
            found = self._of_builtin(seen.kind.tag, seen.node)
        elif not seen.node.children:
            found = _CUSTOM.get(seen.category or "", _UNKNOWN_LEAF)
        added = 0
        for pair in seen.node.attributes:
            added |= _ADDED.get(pair.key.text, 0)
        return Results(found.first | added, found.usual | added, found.ever | added) if added else found

    def _of_builtin(self, tag: str, node: Node) -> Results:
        """Most nodes have no attributes and one of few kinds of children, so the same is not asked again."""
        children = tuple([self._nodes.get(id(child), _UNKNOWN) for child in node.children])
        if node.attributes:
            return _of_builtin(tag, node, children)
        key = tag, children
        found = self._without_ports.get(key)
        if found is None:
            found = self._without_ports[key] = _of_builtin(tag, node, children)
        return found

    def _called(self, seen: SeenNode) -> Definition | None:
        name = seen.node.id
        return self._view.scope.find(Kind.TREE, name.text) if name is not None else None


def _of_builtin(tag: str, node: Node, children: tuple[Results, ...]) -> Results:
    if tag == "Timeout" and len(children) == 1 and children[0].usual == RUNNING:
        first = RUNNING  # who limits the time of an action knows that it takes some
    else:
        first = of_builtin(tag, node, [child.first for child in children], starting=True)
    return Results(
        first,
        of_builtin(tag, node, [child.usual for child in children], starting=True),
        of_builtin(tag, node, [child.ever for child in children], starting=False),
    )


_UNKNOWN: Final = Results(ANYTHING, ANYTHING, ANYTHING)
_ANY_LEAF: Final = SUCCESS | FAILURE | RUNNING
_UNKNOWN_LEAF: Final = Results(_ANY_LEAF, _ANY_LEAF, _ANY_LEAF)
_CUSTOM: Final = {
    "Action": Results(_ANY_LEAF, RUNNING, _ANY_LEAF),
    "Condition": Results(SUCCESS | FAILURE, SUCCESS | FAILURE, SUCCESS | FAILURE),
}
_ADDED: Final = {"_failureIf": FAILURE, "_successIf": SUCCESS, "_skipIf": SKIPPED, "_while": SKIPPED}
