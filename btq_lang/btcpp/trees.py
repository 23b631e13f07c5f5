"""Trees as XML: one element a node, in order (docs/language.md).

One invariant: each change that makes the engine accept the file is recorded as a repair; with `verbatim`, nothing is
changed.  It knows neither what is around the trees nor requirements.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.btcpp.attributes import attributes_of, only_first
from btq_lang.btcpp.constants import fitting
from btq_lang.btcpp.descriptions import description, lines_from_elsewhere
from btq_lang.btcpp.document import Attribute, Element, escape
from btq_lang.btcpp.source import ExportSource
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.names import is_port_name, is_xml_name, legal_name, model_name_problem
from btq_lang.catalog.nodes import BUILTINS, PLACEHOLDERS, NodeKind, inspects_children, is_by_children
from btq_lang.catalog.versions import NO_EXPLICIT_CHILD, UNIQUE_SUBTREES
from btq_lang.syntax.tree import Entry, Node, Tree, Verbatim, Word
from btq_lang.workspace.comments import NO_COMMENTS
from btq_lang.workspace.custom_nodes import likely_category, tag_in
from btq_lang.workspace.node_names import is_placeholder
from btq_lang.workspace.port_types import is_number


class Trees:
    """The trees of a file, made one after the other.

    Attributes:
        elements: the element of each node, by `id(node)`.
    """

    def __init__(self, source: ExportSource) -> None:
        self.elements: Final[dict[int, Element]] = {}
        self._source: Final = source
        self._tags: Final[dict[str, tuple[str, NodeKind | None]]] = {}
        self._placeholders: Final[dict[str, tuple[str, str]]] = {}  # the text and the ID of a name, by spelling
        self._other_lines: Final = {} if source.verbatim else lines_from_elsewhere(source)
        self._names: set[str] = set()  # of the SubTrees in the current tree

    def element(self, entry: Entry, tree: Tree) -> Element:
        """The element of a tree with all that is in it."""
        source = self._source
        attributes = []
        if tree.name is not None:
            attributes.append(Attribute("ID", source.spelt_tree(tree.name)))
            if source.tree_id(tree.name.text) != tree.name.text:
                message = f"the tree `{tree.name.text}` is written as `{source.tree_id(tree.name.text)}`"
                source.repair(entry, tree.name, message)
        attributes += attributes_of(source, entry, tree.attributes)
        if tree.name is None and not source.verbatim and not any(each.name == "ID" for each in attributes):
            attributes.insert(0, Attribute("ID", "BehaviorTree_0"))  # the name that the engine gives a tree without one
        top = Element("BehaviorTree", only_first(attributes))
        self._describe(entry, tree, top)
        self._names = set()
        waiting: list[tuple[Node | Tree, Element]] = [(tree, top)]
        while waiting:
            waiting += reversed(tuple(self._fill(entry, *waiting.pop())))
        return top

    def _fill(self, entry: Entry, part: Node | Tree, element: Element) -> Iterator[tuple[Node, Element]]:
        """Fill an element with the nodes in the block of a part; yield those that have a block of their own."""
        source = self._source
        comments = source.comments
        contents = element.children
        own = comments.get(entry.start + part.start, NO_COMMENTS) if comments else NO_COMMENTS
        if own.first:
            contents += source.written(own.first, beside=True)
        if comments:
            for clause in part.clauses:
                contents += source.written(source.around(entry, clause).before)
        for child in part.children:
            around = comments.get(entry.start + child.start, NO_COMMENTS) if comments else NO_COMMENTS
            if isinstance(child, Verbatim):
                source.put(contents, source.raw(entry, child), around)
                continue
            child_element = self._node(entry, child, element)
            if around is NO_COMMENTS:
                contents.append(child_element)
            else:
                source.put(contents, child_element, around)
            if child.children or child.clauses or around is not NO_COMMENTS:
                yield child, child_element
        if own.last:
            contents += source.written(own.last)

    def _node(self, entry: Entry, node: Node, parent: Element) -> Element:
        kind = node.kind
        if node.category is not None:
            element = self._explicit(entry, node, node.category.raw, parent)
        elif kind is not None and kind.raw in PLACEHOLDERS and is_placeholder(node):
            element = self._placeholder(entry, node)
        else:
            element = self._compact(entry, node, parent)
        if node.clauses or id(node) in self._other_lines:
            self._describe(entry, node, element)
        self.elements[id(node)] = element
        return element

    def _compact(self, entry: Entry, node: Node, parent: Element) -> Element:
        """`MoveBase (…)`."""
        kind = node.kind
        assert kind is not None, "a node without a category has a kind"
        cached = self._tags.get(kind.raw)
        if cached is None:
            tag = self._tag(kind, node)
            cached = tag, BUILTINS.get(tag)
            if not is_by_children(kind.raw):
                self._tags[kind.raw] = cached
        tag, builtin = cached
        if tag in CATEGORIES:  # in quotes: the tag of an explicit form
            return self._explicit(entry, node, tag, parent)
        if tag == "SubTreePlus":
            return Element(tag, self._subtree_attributes(entry, node))
        attributes = attributes_of(self._source, entry, node.attributes, builtin, node.label)
        if builtin is None and not is_xml_name(tag):
            return self._as_explicit(entry, node, likely_category(len(node.children)), attributes, parent)
        return Element(tag, attributes)

    def _tag(self, word: Word, node: Node) -> str:
        return tag_in(self._source.workspace, self._source.path, word, len(node.children))

    def _explicit(self, entry: Entry, node: Node, category: str, parent: Element) -> Element:
        """`Action MoveBase (…)`, `SubTree PickPlace`, `SubTree (ID = PickPlace)`."""
        source = self._source
        if category == "SubTree":
            return Element(category, self._subtree_attributes(entry, node))
        word = node.id if node.category is not None else node.attribute("ID")
        name = "" if word is None else self._tag(word, node)
        attributes = attributes_of(source, entry, node.attributes, BUILTINS.get(name), node.label)
        in_brackets = next((index for index, each in enumerate(attributes) if each.name == "ID"), None)
        if in_brackets is not None:
            attributes[in_brackets] = Attribute("ID", escape(name))
        elif word is not None:
            attributes.insert(0, Attribute("ID", escape(name)))
        if not inspects_children(parent.tag) or source.verbatim or word is None:
            return Element(category, attributes)
        if not is_xml_name(name) or model_name_problem(name, source.target) is not None:
            if NO_EXPLICIT_CHILD.holds(source.target):
                self._refused_here(entry, word)
            return Element(category, attributes)
        message = f"`{category} {name}` is written in the short form: here the engine refuses the explicit one"
        source.repair(entry, word, message)
        return Element(name, [each for each in attributes if each.name != "ID"])

    def _as_explicit(
        self, entry: Entry, node: Node, category: str, attributes: list[Attribute], parent: Element
    ) -> Element:
        """A node whose ID cannot be a tag."""
        source = self._source
        name = node.head.text
        if source.verbatim:
            source.problem(entry, node.head, f"`{name}` cannot be an XML tag: write `{category} {node.head.raw}`")
        elif inspects_children(parent.tag) and NO_EXPLICIT_CHILD.holds(source.target):
            self._refused_here(entry, node.head)
        else:
            source.repair(entry, node.head, f"`{name}` is written as `{category} {name}`: it cannot be an XML tag")
        return Element(category, [Attribute("ID", escape(name)), *attributes])

    def _refused_here(self, entry: Entry, name: Word) -> None:
        message = f"the engine refuses `{name.text}` directly in a ReactiveSequence: put it in a Sequence of its own"
        self._source.problem(entry, name, message)

    def _placeholder(self, entry: Entry, node: Node) -> Element:
        """`ScriptAction (name = "MoveBase")`: the custom node whose ID the name becomes."""
        source = self._source
        name = node.name
        assert name is not None, "a placeholder has a name"
        text, tag = self._placeholders.get(name.raw) or self._new_placeholder(entry, name)
        attributes = attributes_of(source, entry, node.attributes, None, node.label)
        if tag == text:
            attributes = [each for each in attributes if each.name != "name"]
        return Element(tag, attributes)

    def _new_placeholder(self, entry: Entry, name: Word) -> tuple[str, str]:
        text = name.text
        tag = legal_name(text)
        other = next((each for each, taken in self._placeholders.values() if taken == tag and each != text), None)
        if other is not None:
            self._source.problem(entry, name, f"`{other}` and `{text}` both become the node ID `{tag}`")
        elif tag in BUILTINS:
            self._source.problem(entry, name, f"`{text}` becomes the node ID `{tag}`, which is a built-in node")
        self._placeholders[name.raw] = text, tag
        return text, tag

    def _subtree_attributes(self, entry: Entry, node: Node) -> list[Attribute]:
        source = self._source
        attributes = attributes_of(source, entry, node.attributes, BUILTINS["SubTree"], node.label)
        name = node.id if node.category is not None else node.attribute("ID")
        if name is not None:
            raw = source.spelt_tree(name)
            in_brackets = next((index for index, each in enumerate(attributes) if each.name == "ID"), None)
            if in_brackets is None:
                attributes.insert(0, Attribute("ID", raw))
            else:
                attributes[in_brackets] = Attribute("ID", raw)
            if not source.verbatim:
                attributes = [self._constant(entry, node, name.text, each) for each in attributes]
        if not source.verbatim and node.name is not None and UNIQUE_SUBTREES.holds(source.target):
            return self._with_unique_name(entry, node.name, attributes)
        return attributes

    def _constant(self, entry: Entry, node: Node, tree: str, attribute: Attribute) -> Attribute:
        """The value of a SubTree's port, spelt so that every version of the engine accepts it."""
        if not is_number(attribute.raw) or not is_port_name(attribute.name):
            return attribute
        source = self._source
        raw = fitting(source.types_below(tree, attribute.name), attribute.raw)
        if raw == attribute.raw:
            return attribute
        written_value = next((pair.value for pair in node.attributes if pair.key.text == attribute.name), None)
        source.respelt(entry, written_value or node, attribute.raw, raw)
        return Attribute(attribute.name, raw)

    def _with_unique_name(self, entry: Entry, name: Word, attributes: list[Attribute]) -> list[Attribute]:
        """Give a SubTree a name that is unique in its tree and not empty, as the engine demands."""
        text = name.text
        if text and text not in self._names:
            self._names.add(text)
            return attributes
        if not text:
            self._source.repair(entry, name, "the empty name of this SubTree is left out: the engine refuses it")
            return [each for each in attributes if each.name != "name"]
        number = 2
        while f"{text}_{number}" in self._names:
            number += 1
        unique = f"{text}_{number}"
        self._names.add(unique)
        message = (
            f"the second SubTree `{text}` of this tree is written as `{unique}`: the engine refuses two of one name"
        )
        self._source.repair(entry, name, message)
        return [Attribute("name", escape(unique)) if each.name == "name" else each for each in attributes]

    def _describe(self, entry: Entry, part: Node | Tree, element: Element) -> None:
        """Put the clauses of a part into the element's `_description`."""
        if self._source.verbatim:
            return
        attributes = element.attributes
        index = next((index for index, each in enumerate(attributes) if each.name == "_description"), None)
        own = None if index is None else attributes[index].raw
        raw = description(self._source, entry, part.clauses, own, self._other_lines.get(id(part), ()))
        if raw is None:
            return
        position = len(attributes) if index is None else index
        element.attributes = (*attributes[:position], Attribute("_description", raw), *attributes[position + 1 :])
