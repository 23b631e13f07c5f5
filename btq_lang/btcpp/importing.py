"""A BehaviorTree.CPP XML file as a .btq file: the way in, with nothing lost.

One invariant: a .btq file made here has one element for each of the XML, in order, with its attributes in order and its
comments where they were (language.md §6), and is laid out as the formatter lays it out; what has no words in the
language stands in it as `xml "…"`, and the little that has no form at all is told.  What the words mean is not looked
at, save for what version 3 said in other words (`version3`).
"""

from __future__ import annotations

import gc

from btq_lang.btcpp.document import Attribute, Comment, Content, Document, Element, Text
from btq_lang.btcpp.generated import without_generated
from btq_lang.btcpp.reader import read
from btq_lang.btcpp.version3 import Change, is_version_3, translated
from btq_lang.btcpp.wording import comment, is_kept, kind, name, string, string_of, type_, value
from btq_lang.diagnostics import Diagnostic
from btq_lang.places import Places
from btq_lang.record import record
from btq_lang.rules import RULES, Severity
from btq_lang.syntax import is_name
from btq_lang.text import Span
from btq_lang.tokens import CATEGORIES

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Final, TypeAlias

    # A word of a line, and what it was made of: start and end in the XML.
    Piece: TypeAlias = tuple[str, int, int]


@record
class Imported:
    """An XML file in this language.

    Attributes:
        text: the .btq file; empty where the XML could not be read.
        changes: what it says otherwise than the XML did, in the order of the XML.
        diagnostics: what is wrong with the XML itself; spans count from its start.
        places: what in `text` was made of what in the XML.
    """

    text: str
    changes: tuple[Change, ...]
    diagnostics: tuple[Diagnostic, ...]
    places: Places

    @property
    def is_complete(self) -> bool:
        """Whether the XML was read to its end."""
        return all((each.severity or RULES[each.rule].severity) is not Severity.ERROR for each in self.diagnostics)


def import_xml(text: str, keep_v3: bool = False, symbols: bool = True) -> Imported:
    """Read an XML file as a .btq file.

    Args:
        text: the XML, any string at all.
        keep_v3: leave what version 3 of the engine says as it is, instead of saying it as version 4 does.
        symbols: write `->` for Sequence and so on.
    """
    collecting = gc.isenabled()
    gc.disable()  # as in `reader`: nothing made here is garbage
    try:
        done = read(text)
        if done.document is None:
            return Imported("", (), done.problems, Places(()))
        root = done.document.root
        if root.tag != "root":
            note = 'put the tree into <root BTCPP_format="4"><BehaviorTree ID="…"> … </BehaviorTree></root>'
            span = Span(root.start + 1, root.start + 1 + len(root.tag))
            problem = Diagnostic("xml-root", span, f"the document element is <{root.tag}>, not <root>", notes=(note,))
            return Imported("", (), (*done.problems, problem), Places(()))
        writer = _Writer(text, symbols)
        without_generated(done.document, writer.changes)
        if not keep_v3 and is_version_3(root):
            translated(root, writer.changes)
        writer.document(done.document)
        changes = tuple(sorted(writer.changes, key=_start))
        return Imported("".join(writer.out), changes, (*done.problems, *writer.ignored), Places(writer.places))
    finally:
        if collecting:
            gc.enable()


def _start(change: Change) -> Span:
    return change.span


class _Writer:
    """A .btq file, written up to some line."""

    def __init__(self, source: str, symbols: bool) -> None:
        self.source: Final = source
        self.symbols: Final = symbols
        self.out: Final[list[str]] = []
        self.size = 0  # of all that is in `out`
        self.places: Final[list[tuple[int, int, int, int]]] = []
        self.changes: Final[list[Change]] = []
        self.ignored: Final[list[Diagnostic]] = []

    def document(self, document: Document) -> None:
        """The comments before the root, the root, its items, and the comments behind it."""
        contents = document.contents
        at = contents.index(document.root)
        for content in contents[:at]:
            self.comment_line(content, 0)
        if at:
            self.put("\n")
        behind = contents[at + 1 :]
        level = 1 if behind else 0
        self.root(document.root, level)
        for content in behind:
            self.comment_line(content, 0)

    def root(self, root: Element, level: int) -> None:
        """ "Root" [ Name ] [ Attributes ], and its items below it: in a block, only if something stands behind it"""
        attributes = root.attributes
        head: list[Piece] = [("Root", root.start + 1, root.start + 5)]
        if len(attributes) == 2 and _is(attributes[0], "BTCPP_format", "4") and _is_main_tree(attributes[1]):
            head.append(_word(name(attributes[1].raw), attributes[1]))
            self.line(0, head)
        elif attributes and _is_main_tree(attributes[0]):
            head.append(_word(name(attributes[0].raw), attributes[0]))
            self.line(0, head, attributes[1:])
        else:
            self.line(0, head, attributes)
        above = ""  # the kind of the line above
        for child in root.children:
            if isinstance(child, Text):
                self.lost_text(child)
            elif isinstance(child, Comment):
                if above != "comment" and (above != "" or level == 0):
                    self.put("\n")
                self.comment_line(child, level)
                above = "comment"
            elif isinstance(child, Element):
                one_line = child.tag == "include" and not child.children
                if above != "comment" and (above != "" or level == 0) and not (one_line and above == "line"):
                    self.put("\n")
                self.item(child, level)
                above = "line" if one_line else "block"

    def item(self, element: Element, level: int) -> None:
        """BehaviorTree, include, TreeNodesModel; anything else as it is."""
        attributes = element.attributes
        first = attributes[0] if attributes else None
        tag = (element.tag, element.start + 1, element.start + 1 + len(element.tag))
        if element.tag == "BehaviorTree":
            identity = self.first(element, "ID")
            if identity is None:
                self.line(level, [tag], attributes)
            else:
                others = [each for each in attributes if each is not identity]
                self.line(level, [tag, _word(name(identity.raw), identity)], others)
            self.nodes(element, level + 1)
        elif element.tag == "include" and (path := self.first(element, "path")) and not element.children:
            others = [each for each in attributes if each is not path]
            self.line(level, [tag, _word(string(path.raw), path)], others)
        elif element.tag == "TreeNodesModel" and first is None:
            self.line(level, [tag])
            self.models(element, level + 1)
        else:
            self.verbatim(element, level)

    def first(self, element: Element, key: str) -> Attribute | None:
        """The attribute that this language writes first; told where it was not."""
        for index, attribute in enumerate(element.attributes):
            if attribute.name == key:
                if index:
                    span = Span(attribute.start, attribute.start + len(key))
                    self.changes.append(Change(span, f"`{key}` of <{element.tag}> stands before its other attributes"))
                return attribute
        return None

    # ---- trees ----

    def nodes(self, parent: Element, level: int) -> None:
        """All nodes below an element, with the comments between them; not by recursion, for trees are deep."""
        stack = [iter(parent.children)]
        has_nodes = _has_elements(parent)  # the innermost open element: a comment behind its line is the first in it
        empty = True  # nothing of it is written yet
        while stack:
            child = next(stack[-1], None)
            if child is None:
                stack.pop()
                level -= 1
                empty = has_nodes = False
            elif isinstance(child, Element):
                self.node(child, level, first=empty and len(stack) == 1)
                empty = has_nodes = False
                if child.children:
                    stack.append(iter(child.children))
                    level += 1
                    has_nodes = _has_elements(child)
                    empty = True
                else:
                    has_nodes = True
                    continue
            elif isinstance(child, Comment):
                if child.beside and has_nodes and "\n" not in child.text:
                    self.comment_behind(child)
                else:
                    self.comment_line(child, level)
                has_nodes = False
            elif isinstance(child, Text):
                self.lost_text(child)

    def node(self, element: Element, level: int, first: bool) -> None:
        """Kind [ Label ] [ Attributes ]"""
        attributes = element.attributes
        tag, start = element.tag, element.start + 1
        index = 0
        if tag not in CATEGORIES:
            has_code = tag not in _MAY_BE_PLACEHOLDERS or element.get("code") is not None
            word = kind(tag, False, has_code, self.symbols)
            head: list[Piece] = [(word, start, start + len(tag))]
        else:
            head = [(tag, start, start + len(tag))]
            if attributes and attributes[0].name == "ID":
                index = 1
                raw = attributes[0].raw
                word = name(raw) if tag == "SubTree" else kind(raw, True, element.get("code") is not None)
                head.append(_word(word, attributes[0]))
        if index < len(attributes) and attributes[index].name == "name" and (index or tag not in CATEGORIES):
            head.append(_word(name(attributes[index].raw), attributes[index]))
            index += 1
        self.line(level, head, attributes[index:] if index else attributes)

    # ---- models ----

    def models(self, element: Element, level: int) -> None:
        """The models of a TreeNodesModel, with the comments between them."""
        for child in element.children:
            if isinstance(child, Text):
                self.lost_text(child)
            elif isinstance(child, Comment):
                self.comment_line(child, level)
            elif isinstance(child, Element):
                identity = self.first(child, "ID") if child.tag in CATEGORIES else None
                if identity is None:
                    self.verbatim(child, level)
                else:
                    self.model(child, identity, level)

    def model(self, element: Element, identity: Attribute, level: int) -> None:
        """( "Action" | … | "SubTree" ) Name [ Attributes ] [ STRING ], and its ports below"""
        start = element.start + 1
        head = [(element.tag, start, start + len(element.tag)), _word(name(identity.raw), identity)]
        children = element.children
        others = [each for each in element.attributes if each is not identity]
        text = _text_of(children[0]) if children and _is_description(children[0]) else None
        self.line(level, head, others, text)
        was_metadata = False
        for child in children[text is not None :]:
            if isinstance(child, Text):
                self.lost_text(child)
            elif isinstance(child, Comment):
                self.comment_line(child, level + 1)
            if not isinstance(child, Element):
                continue
            if child.tag in _DIRECTIONS and all(isinstance(part, Text) for part in child.children):
                self.port(child, level + 1)
            elif child.tag == "MetadataFields" and not was_metadata and _is_metadata(child):
                for part in child.elements:
                    word = ("metadata", part.start + 1, part.start + 1 + len(part.tag))
                    self.line(level + 1, [word], part.attributes)
            else:
                self.verbatim(child, level + 1)
            was_metadata = child.tag == "MetadataFields"

    def port(self, element: Element, level: int) -> None:
        """( "input" | "output" | "inout" ) [ NAME ] [ ":" … ] [ "=" Value ] [ Attributes ] [ STRING ]"""
        attributes = element.attributes
        start = element.start + 1
        head: list[Piece] = [(_DIRECTIONS[element.tag], start, start + len(element.tag))]
        count = len(attributes)
        index = 0
        if index < count and attributes[index].name == "name" and is_name(attributes[index].raw):
            head.append(_word(attributes[index].raw, attributes[index]))
            index += 1
        if index < count and attributes[index].name == "type":
            head.append((":", 0, 0))
            head.append(_word(type_(attributes[index].raw), attributes[index]))
            index += 1
        if index < count and attributes[index].name == "default":
            head.append(("=", 0, 0))
            head.append(_word(value(attributes[index].raw), attributes[index]))
            index += 1
        text = "".join(part.text for part in element.children if isinstance(part, Text)) or None
        self.line(level, head, attributes[index:], text)

    # ---- lines ----

    def line(
        self, level: int, head: list[Piece], attributes: Sequence[Attribute] | None = None, text: str | None = None
    ) -> None:
        """One line: words, then attributes in brackets and a string; broken as the formatter breaks it.

        Args:
            attributes: None: there are no brackets; empty ones are for `Root ()` alone.
        """
        places = self.places
        indent = _INDENT * level
        out = indent
        at = self.size + len(indent)
        for word, start, end in head:
            if word == ":" or word == "=":
                out += f" {word}"
                at += 2
                continue
            if out is not indent:
                out += " "
                at += 1
            out += word
            if start >= 0:
                places.append((at, at + len(word), start, end))
            at += len(word)
        behind = "" if text is None else f" {string_of(text)}"
        if attributes or (attributes is not None and head[0][0] in _KEEPS_BRACKETS and len(head) + len(attributes) < 9):
            pairs = [(name(each.name), value(each.raw), each) for each in attributes or ()]
            group = " ".join([f"{key} = {said}" for key, said, _ in pairs])
            column = len(out) - out.rfind("\n") if "\n" in out else len(out) + 1
            if _fits(f"({group}){behind}", column) or (
                _fits(f"({group})", column) and (not behind or not _fits(f"){behind}", len(indent)))
            ):
                opening, between, closing = " (", " ", ")"
            else:
                opening, between, closing = f" (\n{indent}{_INDENT}", f"\n{indent}{_INDENT}", f"\n{indent})"
            if not pairs:
                opening, closing = " (", ")"
            at += len(opening)
            for key, said, each in pairs:
                start = each.start
                if start >= 0:
                    places.append((at, at + len(key), start, start + len(each.name)))
                    behind_key = at + len(key) + 3
                    start = each.value_start
                    raw = each.raw
                    if said[0] == '"' and raw and len(said) == len(raw) + 2:
                        places.append((behind_key + 1, behind_key + 1 + len(raw), start, start + len(raw)))
                    else:
                        places.append((behind_key, behind_key + len(said), start, start + len(raw)))
                at += len(key) + len(said) + 3 + len(between)
            out += opening + between.join([f"{key} = {said}" for key, said, _ in pairs]) + closing
            if "&#" in group or any("&#" in each.raw for _, _, each in pairs):
                self.lost_returns(attributes or ())
        out += f"{behind}\n"
        self.put(out)

    def verbatim(self, element: Element, level: int) -> None:
        """xml STRING: the element as it stands in the XML."""
        said = self.source[element.start : element.close]
        self.line(level, [("xml", element.start, element.end), (string_of(said), element.start, element.close)])

    def comment_line(self, content: Content, level: int) -> None:
        """A comment on a line of its own."""
        if not isinstance(content, Comment):
            return
        indent = _INDENT * level
        self.place_comment(content, self.size + len(indent))
        self.put(f"{indent}{comment(content.text)}\n")

    def comment_behind(self, content: Comment) -> None:
        """A comment behind the line above."""
        self.out[-1] = self.out[-1][:-1] + "  "
        self.size += 1
        self.place_comment(content, self.size)
        self.put(f"{comment(content.text)}\n")

    def place_comment(self, content: Comment, at: int) -> None:
        end = content.start + len(content.text) + len("<!---->")
        self.places.append((at, at + len(comment(content.text)), content.start, end))
        if not is_kept(content.text):
            self.changes.append(
                Change(Span(content.start, end), "`*/` in a comment is written `* /`, or its last blank goes")
            )

    def put(self, text: str) -> None:
        self.out.append(text)
        self.size += len(text)

    # ---- what cannot be kept ----

    def lost_text(self, text: Text) -> None:
        said = text.text.strip()
        begin = text.start + len(text.text) - len(text.text.lstrip())
        shown = said if len(said) <= 20 else f"{said[:20]}…"
        span = Span(begin, begin + len(said))
        message = f"the engine ignores this text: `{shown}`"
        note = "remove it, or write <!-- … --> round it; a node is written <Name/>"
        self.ignored.append(Diagnostic("xml-ignored", span, message, notes=(note,)))
        self.changes.append(Change(span, f"text that the engine ignores is left out: {shown}"))

    def lost_returns(self, attributes: Sequence[Attribute]) -> None:
        for each in attributes:
            if "\r" in each.value.replace("\r\n", "") and "\r" not in each.raw:
                span = Span(each.value_start, each.value_start + len(each.raw))
                self.changes.append(Change(span, f"a carriage return in `{each.name}` is written as a line end"))


def _word(word: str, attribute: Attribute) -> Piece:
    """A word made of an attribute's value."""
    return word, attribute.value_start, attribute.value_start + len(attribute.raw)


def _fits(text: str, column: int) -> bool:
    """Whether a text keeps within the columns of the formatter, from a column on."""
    if "\n" not in text:
        return column + len(text) <= _COLUMNS
    first, *others = text.split("\n")
    return column + len(first) <= _COLUMNS and all(len(line) <= _COLUMNS for line in others)


def _is(attribute: Attribute, key: str, raw: str) -> bool:
    return attribute.name == key and attribute.raw == raw


def _is_main_tree(attribute: Attribute) -> bool:
    return attribute.name == "main_tree_to_execute"


def _has_elements(element: Element) -> bool:
    return any(isinstance(child, Element) for child in element.children)


def _is_description(content: Content) -> bool:
    return isinstance(content, Element) and content.tag == "description" and bool(_text_of(content))


def _text_of(content: Content) -> str:
    """The text of an element that has nothing else; empty for any other."""
    if not isinstance(content, Element) or content.attributes or not content.children:
        return ""
    return "".join(child.text if isinstance(child, Text) else "" for child in content.children) * all(
        isinstance(child, Text) for child in content.children
    )


def _is_metadata(element: Element) -> bool:
    """Whether `metadata` lines say all of a <MetadataFields>."""
    parts = element.children
    return (
        bool(parts)
        and not element.attributes
        and all(
            isinstance(part, Element) and part.tag == "Metadata" and not part.children and bool(part.attributes)
            for part in parts
        )
    )


_INDENT: Final = "    "
_COLUMNS: Final = 100
_DIRECTIONS: Final = {"input_port": "input", "output_port": "output", "inout_port": "inout"}
_MAY_BE_PLACEHOLDERS: Final = frozenset(("Script", "ScriptCondition", "ScriptAction"))
_KEEPS_BRACKETS: Final = frozenset(("Root",))
