"""A BehaviorTree.CPP XML file as a .btq file, with nothing lost.

One invariant: a .btq file made here has one element for each of the XML, in order, with its attributes in order and its
comments in place (docs/language.md), and is laid out as the formatter does it; what the language cannot express becomes
`xml "…"`, and the little that cannot be kept is reported.  The meaning of words does not matter here, except for what
version 3 called otherwise (`version3`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import Final, TypeAlias

from btq_lang.btcpp.document import Attribute, Content, Document, Element, XmlComment, XmlText
from btq_lang.btcpp.generated import may_be_generated, without_generated
from btq_lang.btcpp.reader import read
from btq_lang.btcpp.version3 import VersionNote, signs, translated
from btq_lang.btcpp.wording import comment, is_kept, kind, name, pair, spelt_parts, string, string_of, type_, value
from btq_lang.catalog.nodes import PLACEHOLDERS
from btq_lang.catalog.versions import is_before_4
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import RULES, Severity
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.syntax.tree import is_name
from btq_lang.util.garbage import NotCollecting
from btq_lang.util.record import Record
from btq_lang.util.source_map import OriginMap
from btq_lang.util.text import Span
from btq_lang.workspace.config import Project
from btq_lang.workspace.engine_version import written_for
from btq_lang.workspace.file import Signs

IncludedAs: TypeAlias = Callable[[str], str]
# A word of a line and what it was made of: the value of an attribute, a span of the XML, or (None, if it is the
# first) the element's tag.
Piece: TypeAlias = tuple[str, Attribute | tuple[int, int] | None]
# A line: its number and the column of its first word, its element, the words, the pairs in brackets with what they
# were made of, and the text between them.
Mark: TypeAlias = tuple[int, int, Element | None, Sequence[Piece], Sequence[str], Sequence[Attribute] | None, str]
# How a node is written: the line without its indentation (empty: it is composed each time), the words, the
# attributes in brackets and their spelling.
NodeLine: TypeAlias = tuple[str, Sequence[Piece], Sequence[Attribute], Sequence[str]]


class Imported(Record):
    """An XML file in this language.

    Attributes:
        text: the .btq file; empty if the XML could not be read.
        changes: where it differs from the XML, in the order of the XML.
        diagnostics: what is wrong with the XML itself; spans count from its start.
        places: which part of `text` was made of which part of the XML; empty for a text for people.
        described: number of elements whose requirements or qualities a build had described; they are left out.
        defines: the IDs of the trees and models in the XML.
        signs: what the XML says of the version of the engine that it is written for.
    """

    text: str
    changes: tuple[VersionNote, ...]
    diagnostics: tuple[Diagnostic, ...]
    places: OriginMap
    described: int = 0
    defines: frozenset[str] = frozenset()
    signs: Signs = Signs()

    @property
    def is_complete(self) -> bool:
        """Whether the XML was read to its end."""
        return all((each.severity or RULES[each.rule].severity) is not Severity.ERROR for each in self.diagnostics)


def import_xml(
    text: str,
    keep_v3: bool = False,
    for_people: bool = True,
    included_as: IncludedAs | None = None,
    engines: tuple[str, ...] | None = None,
) -> Imported:
    """A BehaviorTree.CPP XML file as a .btq file.

        >>> from btq_lang import import_xml
        >>> done = import_xml('<root BTCPP_format="4"><BehaviorTree ID="Main"><Dock/></BehaviorTree></root>')
        >>> print(done.text, end="")
        Root (BTCPP_format = 4)
        <BLANKLINE>
        BehaviorTree Main
            Dock
        >>> done.changes, done.diagnostics
        ((), ())

    Args:
        text: the XML, any string at all; what is wrong with it is in `diagnostics` of the result.
        keep_v3: keep nodes of version 3 of the engine, instead of translating them to version 4.
        for_people: write `->` for Sequence and so on, and break long lines; for checks, nodes keep their names and
            lines are not broken, so that a comment silences a rule for all of an element, and places are known.
        included_as: gives the path in an `include` for that of an `<include>`; None: the same.
        engines: the versions of the engine that the XML is written for (`written_for`); None: as it says itself.
    """
    with NotCollecting():
        xml_read = read(text)
        if xml_read.document is None:
            return Imported("", (), xml_read.problems, OriginMap())
        root = xml_read.document.root
        if root.tag != "root":
            note = 'put the tree into <root BTCPP_format="4"><BehaviorTree ID="…"> … </BehaviorTree></root>'
            if root.tag.casefold() == "root":
                note = "the engine distinguishes capital letters: write <root> and </root>"
            message = f"the document element is <{root.tag}>, not <root>"
            problem = Diagnostic("xml-root", root.tag_span, message, notes=(note,))
            return Imported("", (), (*xml_read.problems, problem), OriginMap())
        writer = _Writer(text, for_people, included_as or (lambda path: path))
        described = without_generated(xml_read.document, writer.changes) if may_be_generated(text) else 0
        of_root = signs(root)
        engines = written_for(Project(), None, of_root) if engines is None else engines
        if not keep_v3 and engines and is_before_4(engines[-1]):
            translated(root, writer.changes)
        writer.document(xml_read.document)
        changes = tuple(sorted(writer.changes, key=lambda change: change.span))
        problems = (*xml_read.problems, *writer.ignored)
        places = OriginMap() if writer.marks is None else OriginMap(writer.marks, writer.out, located)
        return Imported("".join(writer.out), changes, problems, places, described, frozenset(_defined(root)), of_root)


def _defined(root: Element) -> Iterator[str]:
    for element in root.elements:
        for each in (element,) if element.tag == "BehaviorTree" else element.elements:
            if (ID := each.get("ID")) is not None:
                yield ID


class _Writer:
    """The .btq file as far as it is written."""

    def __init__(self, source: str, for_people: bool, included_as: IncludedAs) -> None:
        self.source: Final = source
        self.symbols: Final = for_people
        # By tag and attributes: many nodes are alike and share their attributes.
        self.node_lines: Final[dict[tuple[str, tuple[Attribute, ...]], NodeLine]] = {}
        self.columns: Final = _COLUMNS if for_people else len(source) * 10
        self.included_as: Final = included_as
        self.out: Final[list[str]] = []
        self.marks: Final[list[Mark] | None] = None if for_people else []
        self.has_returns: Final = _RETURN.search(source) is not None
        self.changes: Final[list[VersionNote]] = []
        self.ignored: Final[list[Diagnostic]] = []

    def document(self, document: Document) -> None:
        """Write the comments before the root, the root, its items, and the comments after it."""
        contents = document.contents
        root_index = contents.index(document.root)
        for content in contents[:root_index]:
            self.comment_line(content, 0)
        if root_index and self.symbols:  # for checks, a comment above the root silences rules on it
            self.out.append("\n")
        following = contents[root_index + 1 :]
        level = 1 if following else 0
        self.root(document.root, level)
        for content in following:
            self.comment_line(content, 0)

    def root(self, root: Element, level: int) -> None:
        """ "Root" [ Name ] [ Attributes ], and its items below it: in a block only if something follows the root"""
        attributes = root.attributes
        head: list[Piece] = [("Root", None)]
        is_of_4 = len(attributes) == 2 and (attributes[0].name, attributes[0].raw) == ("BTCPP_format", "4")
        main = attributes[1 if is_of_4 else 0] if attributes else None
        if main is not None and main.name == "main_tree_to_execute":
            head.append((name(main.raw), main))
            self.line(0, root, head, None if is_of_4 else attributes[1:])
        else:
            self.line(0, root, head, attributes)
        above = ""  # the kind of the previous line
        for child in root.children:
            if isinstance(child, XmlText):
                self.lost_text(child)
            elif isinstance(child, XmlComment):
                if above != "comment" and (above != "" or level == 0):
                    self.out.append("\n")
                self.comment_line(child, level)
                above = "comment"
            elif isinstance(child, Element):
                one_line = child.tag == "include" and not child.children
                if above != "comment" and (above != "" or level == 0) and not (one_line and above == "line"):
                    self.out.append("\n")
                self.item(child, level)
                above = "line" if one_line else "block"

    def item(self, element: Element, level: int) -> None:
        """Write a BehaviorTree, include or TreeNodesModel; anything else verbatim."""
        attributes = element.attributes
        first = attributes[0] if attributes else None
        tag = (element.tag, None)
        if element.tag == "BehaviorTree":
            identity = self.first(element, "ID")
            if identity is None:
                self.line(level, element, [tag], attributes)
            else:
                others = [each for each in attributes if each is not identity]
                self.line(level, element, [tag, (name(identity.raw), identity)], others)
            self.nodes(element, level + 1)
        elif element.tag == "include" and (path := self.first(element, "path")) and not element.children:
            others = [each for each in attributes if each is not path]
            named = path.value if element.get("ros_pkg") else self.included_as(path.value)
            if named != path.value:
                start = element.place(path)[1]
                span = Span(start, start + len(path.raw))
                self.changes.append(VersionNote(span, f"includes `{named}`"))
            word = string_of(named) if named != path.value else string(path.raw)
            self.line(level, element, [tag, (word, path)], others)
        elif element.tag == "TreeNodesModel" and first is None:
            self.line(level, element, [tag])
            self.models(element, level + 1)
        else:
            self.prefixed(element)
            self.verbatim(element, level)

    def prefixed(self, element: Element) -> None:
        """Report `<x:BehaviorTree>`, which has another meaning for tools that know namespaces."""
        local_name = element.tag.rpartition(":")[2]
        if local_name == element.tag or local_name not in ("BehaviorTree", "include", "TreeNodesModel"):
            return
        message = f"the engine ignores <{element.tag}>, because it does not support namespaces; write <{local_name}>"
        self.ignored.append(Diagnostic("xml-ignored", element.tag_span, message))

    def first(self, element: Element, key: str) -> Attribute | None:
        """The attribute that this language writes first; reported if it was not first in the XML."""
        for index, attribute in enumerate(element.attributes):
            if attribute.name == key:
                if index:
                    start = element.place(attribute)[0]
                    span = Span(start, start + len(key))
                    self.changes.append(
                        VersionNote(span, f"`{key}` is moved before the other attributes of <{element.tag}>")
                    )
                return attribute
        return None

    # ---- trees ----

    def nodes(self, parent: Element, level: int) -> None:
        """Write all nodes below an element, with the comments between them; not recursively, for trees are deep."""
        node_lines, marks, out = self.node_lines, self.marks, self.out
        stack = [iter(parent.children)]
        above: Element | None = parent  # the element of the previous line
        while stack:
            indent = _INDENT * level
            room = self.columns - len(indent)
            for child in stack[-1]:
                if isinstance(child, Element):
                    key = child.tag, child.attributes
                    node_line = node_lines.get(key)
                    if node_line is None:
                        node_line = node_lines[key] = self.node(child)
                    line, head, attributes, pairs = node_line
                    if 0 < len(line) <= room:
                        if marks is not None:
                            marks.append((len(out), len(indent), child, head, pairs, attributes, " "))
                        out.append(indent + line)
                    else:
                        self.line(level, child, head, attributes)
                    above = child
                    if child.children:
                        stack.append(iter(child.children))
                        level += 1
                        break
                elif isinstance(child, XmlComment):
                    if child.beside and above is not None and "\n" not in child.text and _may_follow(above):
                        self.comment_after(child)
                    else:
                        self.comment_line(child, level)
                    above = None
                elif isinstance(child, XmlText):
                    self.lost_text(child)
            else:
                stack.pop()
                level -= 1
                above = None

    def node(self, element: Element) -> NodeLine:
        """Kind [ Label ] [ Attributes ]: from the tag and the attributes alone"""
        attributes, tag = element.attributes, element.tag
        index = 0
        head: list[Piece]
        is_explicit = tag in CATEGORIES
        if not is_explicit:
            has_code = tag not in PLACEHOLDERS or element.get("code") is not None
            head = [(kind(tag, False, has_code, self.symbols), None)]
        else:
            head = [(tag, None)]
            if attributes and attributes[0].name == "ID":
                index = 1
                raw = attributes[0].raw
                has_code = raw not in PLACEHOLDERS or element.get("code") is not None
                word = name(raw) if tag == "SubTree" else kind(raw, True, has_code)
                head.append((word, attributes[0]))
        if index < len(attributes) and attributes[index].name == "name" and (index or not is_explicit):
            head.append((name(attributes[index].raw), attributes[index]))
            index += 1
        in_brackets = attributes[index:]
        pairs = [pair(each.name, each.raw) for each in in_brackets]
        line = " ".join([word for word, _ in head])
        if pairs:
            line += f" ({' '.join(pairs)})"
        return "" if "\n" in line or self.has_returns else f"{line}\n", head, in_brackets, pairs

    # ---- models ----

    def models(self, element: Element, level: int) -> None:
        """Write the models of a TreeNodesModel, with the comments between them."""
        for child in element.children:
            if isinstance(child, XmlText):
                self.lost_text(child)
            elif isinstance(child, XmlComment):
                self.comment_line(child, level)
            elif isinstance(child, Element):
                identity = self.first(child, "ID") if child.tag in CATEGORIES else None
                if identity is None:
                    self.verbatim(child, level)
                else:
                    self.model(child, identity, level)

    def model(self, element: Element, identity: Attribute, level: int) -> None:
        """( "Action" | … | "SubTree" ) Name [ Attributes ] [ STRING ], and its ports below"""
        head: list[Piece] = [(element.tag, None), (name(identity.raw), identity)]
        children = element.children
        others = [each for each in element.attributes if each is not identity]
        text = _described(children[0]) if children else None
        self.line(level, element, head, others, text)
        was_metadata = False
        for child in children[text is not None :]:
            if isinstance(child, XmlText):
                self.lost_text(child)
            elif isinstance(child, XmlComment):
                self.comment_line(child, level + 1)
            if not isinstance(child, Element):
                continue
            if child.tag in _DIRECTIONS and all(isinstance(part, XmlText) for part in child.children):
                self.port(child, level + 1)
            elif child.tag == "MetadataFields" and not was_metadata and _is_metadata(child):
                for part in child.elements:
                    self.line(level + 1, part, [("metadata", None)], part.attributes)
            else:
                self.verbatim(child, level + 1)
            was_metadata = child.tag == "MetadataFields"

    def port(self, element: Element, level: int) -> None:
        """( "input" | "output" | "inout" ) [ NAME ] [ ":" … ] [ "=" Value ] [ Attributes ] [ STRING ]"""
        attributes = element.attributes
        head: list[Piece] = [(_DIRECTIONS[element.tag], None)]
        index = 0
        for key, sign, spelt in (("name", "", str), ("type", ":", type_), ("default", "=", value)):
            attribute = attributes[index] if index < len(attributes) else None
            if attribute is not None and attribute.name == key and (sign or is_name(attribute.raw)):
                head += [(sign, None)] if sign else []
                head.append((spelt(attribute.raw), attribute))
                index += 1
        text = "".join(part.text for part in element.children if isinstance(part, XmlText)) or None
        self.line(level, element, head, attributes[index:], text)

    # ---- lines ----

    def line(
        self,
        level: int,
        element: Element | None,
        head: Sequence[Piece],
        attributes: Sequence[Attribute] | None = None,
        text: str | None = None,
    ) -> None:
        """Write one line: words, then attributes in brackets and a string; broken as the formatter breaks it.

        Args:
            element: whose line it is; its tag is the first word.
            attributes: None: no brackets; empty ones are for `Root ()` alone.
        """
        indent = _INDENT * level
        out = indent + head[0][0]
        for word, _ in head[1:]:
            out += f" {word}"
        suffix = "" if text is None else f" {string_of(text)}"
        pairs: list[str] = []
        between = " "
        if attributes:
            pairs = [pair(each.name, each.raw) for each in attributes]
            group = " ".join(pairs)
            line = f"{out} ({group}){suffix}\n"
            if len(line) > self.columns or line.count("\n") > 1:  # it may be too long
                columns = self.columns
                column = len(out) - out.rfind("\n") if "\n" in out else len(out) + 1
                if not _fits(f"({group}){suffix}", column, columns) and (
                    not suffix or not _fits(f"({group})", column, columns) or _fits(f"){suffix}", len(indent), columns)
                ):
                    between = f"\n{indent}{_INDENT}"
                    line = f"{out} ({between}{between.join(pairs)}\n{indent}){suffix}\n"
            if self.has_returns and element is not None:
                self.lost_returns(element, attributes)
        elif attributes is not None and head[0][0] == "Root":
            line = f"{out} ()\n"
        else:
            line = f"{out}{suffix}\n"
        if self.marks is not None:
            self.marks.append((len(self.out), len(indent), element, head, pairs, attributes, between))
        self.out.append(line)

    def verbatim(self, element: Element, level: int) -> None:
        """Write xml STRING: the element as it is spelt in the XML."""
        spelling = self.source[element.start : element.close]
        origins = (element.start, element.end), (element.end, element.close)
        self.line(level, None, [("xml", origins[0]), (string_of(spelling), origins[1])])

    def comment_line(self, content: Content, level: int) -> None:
        """Write a comment on a line of its own."""
        if isinstance(content, XmlComment):
            shown = comment(content.text)
            self.place_comment(content, shown, len(self.out), len(_INDENT) * level)
            self.out.append(f"{_INDENT * level}{shown}\n")

    def comment_after(self, content: XmlComment) -> None:
        """Write a comment at the end of the previous line."""
        above, shown = self.out[-1][:-1], comment(content.text)
        self.place_comment(content, shown, len(self.out) - 1, len(above) + 2)
        self.out[-1] = f"{above}  {shown}\n"

    def place_comment(self, content: XmlComment, shown: str, line: int, column: int) -> None:
        if self.marks is None and "*/" not in content.text:
            return
        end = content.start + len(content.text) + len("<!---->")
        if self.marks is not None:
            self.marks.append((line, column, None, [(shown, (content.start, end))], (), None, ""))
        if "*/" in content.text and not is_kept(content.text):
            message = "a `*/` in this comment is written `* /`, or the comment loses its last space"
            self.changes.append(VersionNote(Span(content.start, end), message))

    # ---- what cannot be kept ----

    def lost_text(self, text: XmlText) -> None:
        stripped = text.text.strip()
        begin = text.start + len(text.text) - len(text.text.lstrip())
        shown = stripped if len(stripped) <= 20 else f"{stripped[:20]}…"
        span = Span(begin, begin + len(stripped))
        if len(self.ignored) >= _MOST_TEXTS:
            if len(self.ignored) == _MOST_TEXTS:
                self.ignored.append(
                    Diagnostic("xml-ignored", span, "the engine ignores this text and everything after it")
                )
                self.changes.append(VersionNote(span, "text that the engine ignores is left out from here on"))
            return
        message = f"the engine ignores this text: `{shown}`"
        note = "remove it, or put <!-- … --> around it; a node is written <Name/>"
        if ":=" in stripped:
            note = f'a script goes in a port: <Script code="{shown}"/>'
        self.ignored.append(Diagnostic("xml-ignored", span, message, notes=(note,)))
        self.changes.append(VersionNote(span, f"text that the engine ignores is left out: {shown}"))

    def lost_returns(self, element: Element, attributes: Sequence[Attribute]) -> None:
        for attribute in attributes:
            if "\r" in attribute.value.replace("\r\n", "") and "\r" not in attribute.raw:
                start = element.place(attribute)[1]
                span = Span(start, start + len(attribute.raw))
                self.changes.append(
                    VersionNote(span, f"a carriage return in `{attribute.name}` is written as a line end")
                )


def located(marks: Sequence[Mark], starts: Sequence[int]) -> list[tuple[int, int, int, int]]:
    """Which parts of the lines were made of which parts of the XML: pieces for `Places`."""
    places: list[tuple[int, int, int, int]] = []
    for line, column, element, head, pairs, attributes, between in marks:
        offset = starts[line] + column
        if element is not None:
            places.append((offset, offset + len(head[0][0]), *element.tag_span))
        for word, origin in head:
            if isinstance(origin, tuple):
                places.append(_unlike(word, offset, *origin))
            elif origin is not None and element is not None and (start := element.place(origin)[1]) >= 0:
                places += _aligned(word, offset, origin.raw, start)
            offset += len(word) + 1
        if not attributes or element is None:
            continue
        offset += len("(") + (len(between) if between != " " else 0)
        for pair_text, attribute in zip(pairs, attributes, strict=True):
            key, (name_start, start) = name(attribute.name), element.place(attribute)
            if start >= 0:
                places += _aligned(key, offset, attribute.name, name_start)
                value_offset = len(key) + len(" = ")
                places += _aligned(pair_text[value_offset:], offset + value_offset, attribute.raw, start)
            offset += len(pair_text) + len(between)
    return places


def _aligned(word: str, offset: int, raw: str, start: int) -> list[tuple[int, int, int, int]]:
    """The pieces of a word and what it was made of: one if both are the same, in quotes or not; otherwise one for each
    part of it that is, and one for each reference.  All of it if it is spelt in another way altogether."""
    if word == raw:
        return [(offset, offset + len(word), start, start + len(raw))]
    if raw and word[1:-1] == raw:
        return [(offset + 1, offset + 1 + len(raw), start, start + len(raw))]
    parts = spelt_parts(raw)
    if not raw or word[1:-1] != "".join([written for written, _ in parts]):
        return [_unlike(word, offset, start, start + len(raw))]
    pieces: list[tuple[int, int, int, int]] = []
    offset += 1
    for written, part in parts:
        end = start + len(part)
        pieces.append(
            (offset, offset + len(part), start, end) if written == part else _unlike(written, offset, start, end)
        )
        offset += len(written)
        start = end
    return pieces


def _unlike(word: str, offset: int, start: int, end: int) -> tuple[int, int, int, int]:
    """The piece of a word that the XML spells in another way: never of the same length, which means the same text."""
    return offset, offset + len(word), start, end - (end - start == len(word))


def _fits(text: str, column: int, columns: int) -> bool:
    """Whether a text that begins at a column ends within the columns."""
    if "\n" not in text:
        return column + len(text) <= columns
    first, *others = text.split("\n")
    return column + len(first) <= columns and all(len(line) <= columns for line in others)


def _may_follow(element: Element) -> bool:
    """Whether a comment at the end of an element's line keeps its place: after the whole element, or first in an
    otherwise empty block."""
    return not element.children or any(isinstance(child, Element) for child in element.children)


def _described(content: Content) -> str | None:
    """The text of a <description> that contains nothing else; None for anything else, or without a text."""
    if not isinstance(content, Element) or content.tag != "description" or content.attributes:
        return None
    texts = [child.text for child in content.children if isinstance(child, XmlText)]
    return "".join(texts) or None if len(texts) == len(content.children) else None


def _is_metadata(element: Element) -> bool:
    """Whether `metadata` lines can express all of a <MetadataFields>."""
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
_MOST_TEXTS: Final = 100  # reported one by one; a file with more is hardly mended by hand
_COLUMNS: Final = 100  # the formatter's
_DIRECTIONS: Final = {"input_port": "input", "output_port": "output", "inout_port": "inout"}
_RETURN: Final = re.compile("&#(?:0*13|[xX]0*[dD]);")
