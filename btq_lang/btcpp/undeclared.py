"""Models of nodes that are used and nowhere declared: Groot opens no tree with a node that it does not know.

One invariant: such a model says what the uses suggest and no more, so it can be told from one that somebody wrote; the
files of a mission suggest the same of a node, and nothing of one that a file which they are included by declares.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from weakref import WeakKeyDictionary

from btq_lang.btcpp.document import Attribute, Element, escape
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.names import is_port_name, legal_name
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, PLACEHOLDERS, xml_tag
from btq_lang.file import File
from btq_lang.name_kinds import Kind
from btq_lang.placeholders import is_placeholder
from btq_lang.syntax import Model, Models, Node, Tree
from btq_lang.workspace import Workspace

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


class CustomNode:
    """A node that is none of the engine's, as its uses have it.

    Attributes:
        said: the category that a use says; None: none does.
        children: how many a use has, at most.
        ports: each with whether a blackboard entry is given to it somewhere.
    """

    __slots__ = ("children", "ports", "said")

    def __init__(self) -> None:
        self.said: str | None = None
        self.children = 0
        self.ports: Final[dict[str, bool]] = {}

    @property
    def category(self) -> str:
        """What it is, or may be as far as the number of its children goes."""
        return self.said or likely_category(self.children)

    def add(self, use: Node, said: str | None) -> None:
        """What a use tells; said: its category, where the use says it."""
        self.said = self.said or said
        self.children = max(self.children, len(use.children))
        for pair in use.attributes:
            key = pair.key.text
            if pair.value is not None and is_port_name(key):
                self.ports[key] = pair.value.text.startswith("{") or self.ports.get(key, False)


def undeclared(workspace: Workspace, path: str) -> dict[str, CustomNode]:
    """The nodes that a file uses and that nobody declares: neither it, nor what it includes, nor what includes it."""
    scope = workspace.scope(path)
    used = _custom_nodes(workspace.files[path])
    missing = [name for name in used if scope.find(Kind.MODEL, name) is None]
    if missing and path in workspace.included_files:
        above = [workspace.scope(other) for other in workspace.files if path in workspace.closure(other)]
        missing = [name for name in missing if not any(scope.find(Kind.MODEL, name) for scope in above)]
    if not missing:
        return {}
    known = _of_mission(workspace, path)
    return {name: known[name] for name in sorted(missing, key=lambda name: (_ORDER[known[name].category], name))}


def likely_category(children: int) -> str:
    """The category of a custom node of so many children, where nothing says it."""
    return ("Action", "Decorator", "Control")[min(children, 2)]


def suggested_model(name: str, node: CustomNode) -> Element:
    """The model of a node as its uses suggest it."""
    # A literal can only go in; what an entry is for, nobody says.
    ports = [
        Element("inout_port" if is_entry else "input_port", [Attribute("name", port)])
        for port, is_entry in node.ports.items()
    ]
    return Element(node.category, [Attribute("ID", escape(name))], [*ports])


def made_models(workspace: Workspace, path: str) -> frozenset[str]:
    """The nodes of an XML file whose models are such as a build adds by itself."""
    known = _of_mission(workspace, path)
    return frozenset(
        name for name, model in _models(workspace.files[path]) if name in known and _may_be_made(model, known[name])
    )


def _of_mission(workspace: Workspace, path: str) -> Mapping[str, CustomNode]:
    """The custom nodes in all files that are linked by includes with a file, by ID."""
    missions = _MISSIONS.setdefault(workspace, {})
    mission = workspace.missions[path]
    if mission not in missions:
        found = missions[mission] = {}
        for other, name in sorted(workspace.missions.items()):
            if name == mission:
                _add_custom_nodes(workspace.files[other], found)
    return missions[mission]


def _custom_nodes(file: File) -> Mapping[str, CustomNode]:
    found: dict[str, CustomNode] = {}
    _add_custom_nodes(file, found)
    return found


def _add_custom_nodes(file: File, found: dict[str, CustomNode]) -> None:
    for entry in file.parsed.entries:
        if isinstance(entry.item, Tree):
            for node in entry.item.walk():
                name, said = _named(node)
                if name and name not in BUILTINS:
                    found.setdefault(name, CustomNode()).add(node, said)


def _named(node: Node) -> tuple[str, str | None]:
    """The ID of a node, as it is written, and the category that it says; no ID of a SubTree."""
    kind = node.kind
    if is_placeholder(node):
        return legal_name(node.name.text if node.name else ""), PLACEHOLDERS[node.head.raw]
    said = node.category.raw if node.category is not None else None
    if said is None and kind is not None and kind.quoted and kind.text in CATEGORIES:
        said = kind.text  # in quotes: the tag of an explicit form
    if said is not None:
        word = node.id if node.category is not None else node.attribute("ID")
    else:
        word = kind
        if kind is not None and not kind.quoted and kind.raw in KNOWN_WORDS:
            said = KNOWN_WORDS[kind.raw].category
    tag = xml_tag(word.text, word.quoted, len(node.children)) if word is not None else ""
    return ("", None) if said == "SubTree" or tag == "SubTreePlus" else (tag, said)


def _models(file: File) -> Iterator[tuple[str, Model]]:
    for entry in file.parsed.entries:
        item = entry.item
        for model in item.models if isinstance(item, Models) else (item,):
            if isinstance(model, Model) and model.name is not None:
                yield model.name.text, model


def _may_be_made(model: Model, node: CustomNode) -> bool:
    """Whether a model says no more than a node's uses suggest; files that are not here may use more of its ports."""
    names = {port.name.text for port in model.ports if port.name is not None}
    says_more = any(port.type or port.default or port.attributes or port.text for port in model.ports)
    is_plain = len(names) == len(model.body) and not model.attributes and model.text is None
    return is_plain and not says_more and model.category.raw == node.category and names >= node.ports.keys()


# What was found once, for as long as anybody has the workspace.
_MISSIONS: Final[WeakKeyDictionary[Workspace, dict[str, dict[str, CustomNode]]]] = WeakKeyDictionary()
_ORDER: Final[dict[str, int]] = {category: index for index, category in enumerate(CATEGORIES)}
