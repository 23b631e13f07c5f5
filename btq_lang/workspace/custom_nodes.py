"""Custom nodes as their uses suggest them: their categories, and their ports with directions and types.

One invariant: the result is the same for all files of a mission.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Final

from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.literals import check_literal
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name, legal_name
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, PLACEHOLDERS, xml_tag
from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.tree import Node, Tree, Word
from btq_lang.util.record import Record
from btq_lang.workspace import inputs
from btq_lang.workspace.file import File
from btq_lang.workspace.node_names import is_placeholder
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


class LikelyPort(Record):
    """A port as the uses of its node suggest it; type: empty if they do not suggest one."""

    direction: str
    name: str
    type: str


class CustomNode:
    """A node that is not the engine's, as its uses suggest it.

    Attributes:
        stated_category: the category that a use names, if any does.
        children: the largest number in a use.
        uses: how many there are.
    """

    def __init__(self, uses: Sequence[tuple[Node, str | None]]) -> None:
        """uses: each with the category that it names, if it does."""
        self.stated_category = next((category for _, category in uses if category), None)
        self.children = max([len(node.children) for node, _ in uses], default=0)
        self.uses = len(uses)
        self._values: dict[str, dict[str, Word]] = {}  # by port and text
        for pair in chain.from_iterable(node.attributes for node, _ in uses):
            if pair.value is not None and is_port_name(pair.key.text):
                self._values.setdefault(pair.key.text, {})[pair.value.text] = pair.value

    @property
    def category(self) -> str:
        """Its category, or the one that its number of children suggests."""
        return self.stated_category or likely_category(self.children)

    @property
    def ports(self) -> tuple[LikelyPort, ...]:
        """Its ports, in the order of their first use."""
        return tuple([_likely_port(name, tuple(values.values())) for name, values in self._values.items()])


def custom_nodes(workspace: Workspace, path: str) -> Mapping[str, CustomNode]:
    """The custom nodes in all files that are linked by includes with a file, by ID."""
    return workspace.store.ask(_custom_nodes, workspace.missions[path])


def _custom_nodes(store: Store[Workspace], mission: str) -> dict[str, CustomNode]:
    workspace = store.ask(inputs.everything, mission)
    uses_by_name: dict[str, list[tuple[Node, str | None]]] = {}
    for path in sorted(workspace.linked(mission)):
        for node in _nodes(workspace.files[path]):
            name, category = _named(workspace, path, node)
            if name and name not in BUILTINS:
                uses_by_name.setdefault(name, []).append((node, category))
    return {name: CustomNode(uses) for name, uses in uses_by_name.items()}


def custom_node(workspace: Workspace, path: str, name: str) -> CustomNode:
    """One of them; only the items that name it are read."""
    uses = [
        use.node
        for other in sorted(workspace.linked(path))
        if name in workspace.files[other].names_used(Kind.MODEL)
        for facts in workspace.files[other].facts.values()
        for use in facts.summary.uses
        if use.node is not None and use.kind is Kind.MODEL and use.name == name
    ]
    return CustomNode([(node, _named(workspace, path, node)[1]) for node in uses])


def custom_nodes_of(workspace: Workspace, path: str) -> frozenset[str]:
    """The IDs of the custom nodes in one file."""
    named = (_named(workspace, path, node)[0] for node in _nodes(workspace.files[path]))
    return frozenset([name for name in named if name and name not in BUILTINS])


def tag_in(workspace: Workspace, path: str, word: Word, children: int) -> str:
    """The XML tag of a word in a file, for a node with so many children; if the mission declares a node of that name, a
    word of the published language means that one."""
    tag = xml_tag(word.text, word.quoted, children)
    is_own = tag != word.text and tag not in BUILTINS and is_declared(workspace, path, word.text)
    return word.text if is_own else tag


def is_declared(workspace: Workspace, path: str, name: str) -> bool:
    """Whether a file, what it includes, or what includes it has a model of a node."""
    if workspace.scope(path).find(Kind.MODEL, name) is not None:
        return True
    others = workspace.files if path in workspace.included_files else ()
    above = (each for each in others if path in workspace.closure(each))
    return any(workspace.scope(each).find(Kind.MODEL, name) is not None for each in above)


def likely_category(children: int) -> str:
    """The category of a custom node with so many children, if no use names it."""
    return ("Action", "Decorator", "Control")[min(children, 2)]


def _nodes(file: File) -> Iterator[Node]:
    for tree in file.of_type(Tree):
        yield from tree.walk()


def _named(workspace: Workspace, path: str, node: Node) -> tuple[str, str | None]:
    """The ID of a node in a file, as it is written, and the category that it names; a SubTree's ID does not count."""
    kind = node.kind
    if is_placeholder(node):
        return legal_name(node.name.text if node.name else ""), PLACEHOLDERS[node.head.raw]
    category = node.category.raw if node.category is not None else None
    if category is None and kind is not None and kind.quoted and kind.text in CATEGORIES:
        category = kind.text  # in quotes: the tag of an explicit form
    if category is not None:
        word = node.id if node.category is not None else node.attribute("ID")
    else:
        word = kind
        if kind is not None and not kind.quoted and kind.raw in KNOWN_WORDS:
            category = KNOWN_WORDS[kind.raw].category
    tag = tag_in(workspace, path, word, len(node.children)) if word is not None else ""
    return ("", None) if category == "SubTree" or tag == "SubTreePlus" else (tag, category)


def _likely_port(name: str, values: tuple[Word, ...]) -> LikelyPort:
    """A literal can only be an input; the direction of an entry is unknown, and other nodes determine its type."""
    if any(value.text.startswith("{") for value in values):
        return LikelyPort("inout", name, "")
    if any(value.kind == QUANTITY for value in values):
        return LikelyPort("input", name, "")  # a number, in whatever unit the port has
    return LikelyPort("input", name, next(type_ for type_ in _TYPES if all(_takes(type_, value) for value in values)))


def _takes(type_: str, value: Word) -> bool:
    if type_ == "bool":
        return value.text in ("true", "false")
    return check_literal(type_, value.text) is None


_TYPES: Final = ("bool", "int", "double", "string")  # the narrowest first
