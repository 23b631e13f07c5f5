"""XML text to a document, as BehaviorTree.CPP reads it.

One invariant: but for a NUL character before the last tag, which it refuses, this module accepts exactly the texts that
the engine's parser (tinyxml2) accepts, and reads the same elements and values from them.  That is more lenient than the
standard in some points (`--` in comments, `<` and `&` in values, text around the document element) and stricter in
others (no processing instruction inside the document element), so `strict` judges the text as well: what only the
engine accepts is a warning.  The reader moves forward only, expands no entities that the document defines, fetches
nothing, and does not recurse.  This module does not interpret the elements.

Source: tinyxml2 11, `XMLNode::ParseDeep`, `XMLDocument::Identify`, `XMLElement::ParseAttributes`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING, Final, NoReturn, TypeAlias

from btq_lang.btcpp.document import (
    ATTRIBUTE,
    IN_WORD,
    SPACE,
    WORD,
    Attribute,
    Content,
    Document,
    Element,
    XmlComment,
    XmlText,
    attribute_matches,
    unescape,
)
from btq_lang.btcpp.strict import is_well_formed
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.util.garbage import NotCollecting
from btq_lang.util.record import Record
from btq_lang.util.text import LINE_END, Span

if TYPE_CHECKING:
    from btq_lang.btcpp.malformed import Mistake

# name, attributes (None: an end tag), is_empty, length, may_have_text (after it).  A NamedTuple takes six times as long
# to make.
Tag: TypeAlias = tuple[str, tuple[Attribute, ...] | None, bool, int, bool]

MAX_DEPTH: Final = 498  # open elements; the engine refuses the next one


class XmlRead(Record):
    """What was read from a file.

    Attributes:
        document: None if the text cannot be read at all.
        problems: the error that ended the reading, or what other XML tools refuse; spans count from the text's start.
    """

    document: Document | None
    problems: tuple[Diagnostic, ...] = ()


def read(text: str, with_prefixes: bool = True) -> XmlRead:
    """Read an XML file, any string at all; `with_prefixes`: report prefixes of names that other tools refuse, too."""
    nul = text.find("\0")
    if 0 <= nul < text.rfind(">"):
        message = "unexpected NUL character: the engine stops reading here"
        return XmlRead(None, (Diagnostic(RULE, Span(nul, nul + 1), message, notes=("remove it",)),))
    is_strict = is_well_formed(text)
    reader = _Reader(text, is_strict)
    try:
        with NotCollecting():
            contents = reader.contents()
    except _Broken as broken:
        return XmlRead(None, (broken.diagnostic,))
    roots = [content for content in contents if isinstance(content, Element)]
    if not roots:
        end = len(text.rstrip())
        message = "this file contains no element" if end else "this file is empty"
        note = 'a mission begins with <root BTCPP_format="4">'
        return XmlRead(None, (Diagnostic(RULE, Span(0, min(end, 1)), message, notes=(note,)),))
    read_by_all = (content for content in contents if isinstance(content, XmlComment) or content is roots[0])
    has_prefixes = with_prefixes and reader.has_prefixes
    return XmlRead(Document(read_by_all), tuple(_refused(text, roots[0], is_strict, has_prefixes)))


def _refused(text: str, root: Element, is_strict: bool, has_prefixes: bool) -> Iterator[Diagnostic]:
    """The first mistake in a text that the engine reads and other XML tools refuse."""
    mistakes: list[Mistake | None] = []
    if not is_strict:
        from btq_lang.btcpp.malformed import first_mistake  # few files need it, and its patterns take long to compile

        mistakes.append(first_mistake(text))
    if has_prefixes:
        from btq_lang.btcpp.prefixes import wrong_prefix  # as above

        mistakes.append(wrong_prefix(root))
    for mistake in sorted(filter(None, mistakes), key=lambda mistake: mistake.span)[:1]:
        message = f"the engine reads this, but no other XML tool does: {mistake.message}"
        yield Diagnostic("xml-not-well-formed", mistake.span, message, notes=(mistake.advice,))


RULE: Final = "xml-syntax"


class _Broken(Exception):
    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic: Final = diagnostic


class _Reader:
    """A place in a text, and the elements that are open there."""

    def __init__(self, text: str, is_strict: bool) -> None:
        self.text: Final = text
        self.is_strict: Final = is_strict  # whether duplicate attributes are excluded already
        self.open: Final[list[Element]] = []
        self.attributes: Final[dict[str, tuple[Attribute, ...]]] = {}  # by their text: many nodes have the same
        self.seen_markup_declaration = False  # whether a DOCTYPE or a CDATA section was read
        self.has_prefixes = False  # whether there may be names like `xsi:type`, which some tools refuse

    def contents(self) -> list[Content]:
        """{ Element | Comment | Text | Declaration | DOCTYPE }: the top level of the document.

        The text is cut at every `<`, and pieces are cached by their text: most tags of a mission occur more than once.
        """
        text, opened = self.text, self.open
        tags: dict[str, Tag] = {}
        top: list[Content] = []
        contents = top  # of the innermost open element
        pieces = chain.from_iterable(_pieces(text))
        last_end = 1 if text.startswith("\ufeff") else 0  # the end of what was read last
        following = len(next(pieces))  # the offset of the next `<`
        self.characters(last_end, following, contents)
        for piece in pieces:
            start = following
            following += len(piece) + 1
            if start < last_end:  # this `<` is in a comment, or in a value
                continue
            stripped = piece.rstrip(_BLANKS)
            tag = tags.get(stripped)
            if tag is None:
                end = start + 1 + len(stripped)
                match = _TAG(text, start)
                if match is None:
                    last_end = self.other(start, last_end, contents, is_first=not top)
                    if last_end != end:
                        self.characters(last_end, text.find("<", last_end), contents)
                    continue
                tag = self.tag(match, start, end)
                if match.end() <= end:
                    tags[stripped] = tag
            name, attributes, is_empty, length, may_have_text = tag
            last_end = start + length
            if attributes is None:
                if not opened:  # the engine stops reading here
                    return top
                element = opened.pop()
                if name != element.tag:
                    self.fail_mismatched(element, Span(start, last_end), name)
                element.close = last_end
                contents = opened[-1].children if opened else top
            else:
                element = Element(name, attributes, None, text, start, last_end)
                contents.append(element)
                if not is_empty:
                    opened.append(element)
                    contents = element.children
                    if len(opened) > MAX_DEPTH:
                        raise _Broken(Diagnostic("nested-too-deep", Span(start, last_end), _TOO_DEEP))
            if may_have_text:
                self.characters(last_end, text.find("<", last_end), contents)
        if opened:
            self.fail_unclosed(opened[-1])
        return top

    def tag(self, match: re.Match[str], start: int, end_of_piece: int) -> Tag:
        """A tag; text may follow it unless it is all of its piece."""
        name, pairs, slash, closing = match.groups()
        end = match.end()
        may_have_text = end != end_of_piece
        if closing is not None:
            return closing, None, False, end - start, may_have_text
        attributes = self.attributes.get(pairs)
        if attributes is None:
            attributes = self.attributes[pairs] = tuple([Attribute(key, raw) for key, _, raw in _ATTRIBUTES(pairs)])
            if _MAY_HAVE_PREFIX(pairs) and any(":" in each.name or each.name == "xmlns" for each in attributes):
                self.has_prefixes = True
        if ":" in name:
            self.has_prefixes = True
        if not self.is_strict and len({each.name for each in attributes}) < len(attributes):
            self.fail_duplicate_attribute(name, Span(start, end))
        return name, attributes, slash == "/", end - start, may_have_text

    def other(self, start: int, last_end: int, contents: list[Content], is_first: bool) -> int:
        """Read what begins with `<` but is not a tag; return where it ends."""
        text = self.text
        if text.startswith("<!--", start):
            return self.comment(start, last_end, contents)
        if text.startswith("<!", start):
            return self.markup_declaration(start, contents)
        if text.startswith("<?", start):
            return self.declaration(start, is_first)
        self.fail_malformed_tag(start)

    def characters(self, start: int, end: int, contents: list[Content]) -> None:
        """Add the text between two tags unless it is blank.

        Text after the last tag is refused after the document element and otherwise dropped, as the engine does.
        """
        if end < 0:
            end = len(self.text)
        between = self.text[start:end]
        stripped = between.strip(_BLANKS)
        if not stripped:
            return
        is_last = end == len(self.text)
        if is_last and not self.open and any(isinstance(content, Element) for content in contents):
            begin = start + between.index(stripped)
            self.fail(Span(begin, begin + len(stripped)), "unexpected text after the document element", "remove it")
        if not is_last:
            contents.append(XmlText(unescape(_line_ends(between)), start))

    def fail_mismatched(self, element: Element, span: Span, closing: str) -> NoReturn:
        """Report `</b>` where another element is open."""
        note = f"write </{element.tag}>"
        if any(other.tag == closing for other in self.open):
            note = f"close <{element.tag}> first: write </{element.tag}>, or /> where it has no children"
        elif closing.casefold() == element.tag.casefold():
            from btq_lang.catalog.nodes import engine_element  # after a mistake alone

            if (tag := engine_element(closing)) not in ("", element.tag):
                note = f"the engine's element is <{tag}>: write <{tag}> where it opens, and </{tag}> here"
        related = (Related(Place(Span(element.start, element.end)), f"<{element.tag}> opens here"),)
        self.fail(span, f"expected </{element.tag}>, found </{closing}>", note, related)

    def comment(self, start: int, last_end: int, contents: list[Content]) -> int:
        """ "<!--" … "-->"; last_end: the end of what was read last"""
        text = self.text
        end = self.closing("-->", start + 4, start, "missing --> for this comment")
        between = text[last_end:start]
        beside = last_end > 0 and "\n" not in between and "\r" not in between
        contents.append(XmlComment(_line_ends(text[start + 4 : end]), beside, start))
        return end + 3

    def markup_declaration(self, start: int, contents: list[Content]) -> int:
        """ "<![CDATA[" … "]]>", "<!" … ">"; the latter is skipped, as the engine does"""
        self.seen_markup_declaration = True
        text = self.text
        if text.startswith("<![CDATA[", start):
            end = self.closing("]]>", start + 9, start, "missing ]]> for this CDATA section")
            if start + 9 < end:
                contents.append(XmlText(_line_ends(text[start + 9 : end]), start))
            return end + 3
        self.has_prefixes = True  # a DOCTYPE may declare anything
        return self.closing(">", start + 2, start, "missing > for this declaration") + 1

    def declaration(self, start: int, is_first: bool) -> int:
        """ "<?" … "?>": the engine takes each for a declaration, which must come first"""
        end = self.closing("?>", start + 2, start, "missing ?> for this declaration") + 2
        self.has_prefixes = self.has_prefixes or ":" in self.text[start:end]
        if not is_first or self.seen_markup_declaration:
            span = Span(start, end)
            what = "an XML declaration" if self.text.startswith("<?xml ", start) else "a processing instruction"
            self.fail(span, f"{what} after other content", "the engine expects it first in the file; move or remove it")
        return end

    def closing(self, mark: str, begin: int, start: int, message: str) -> int:
        end = self.text.find(mark, begin)
        if end < 0:
            self.fail(Span(start, min(begin, len(self.text))), message, f"write {mark} where it ends")
        return end

    # ---- mistakes ----

    def fail(self, span: Span, message: str, note: str, related: tuple[Related, ...] = ()) -> NoReturn:
        raise _Broken(Diagnostic(RULE, span, message, related, (note,)))

    def fail_duplicate_attribute(self, tag: str, span: Span) -> NoReturn:
        """Report an attribute that is given twice."""
        first: dict[str, Span] = {}
        for match in attribute_matches(self.text, span.start, span.end):
            name = match[1]
            if name in first:
                break
            first[name] = Span(*match.span(1))
        related = (Related(Place(first[name]), "its first value is here"),)
        self.fail(Span(*match.span(1)), f"duplicate attribute `{name}` in <{tag}>", "keep one of them", related)

    def fail_unclosed(self, element: Element) -> NoReturn:
        message = f"<{element.tag}> is never closed"
        self.fail(Span(element.start, element.end), message, f"write </{element.tag}> where it ends")

    def fail_malformed_tag(self, start: int) -> NoReturn:
        """Report where a tag is malformed: parse it again, piece by piece."""
        text, size = self.text, len(self.text)
        name = _NAME(text, start + (2 if text.startswith("</", start) else 1))
        if name is None:
            note = "write the character as &lt;"
            if self.text.startswith("--", start + 1) or self.text.startswith("!-", start + 1):
                note = "a comment is written <!-- … -->"
            self.fail(Span(start, start + 1), "unexpected `<`: no tag begins here", note)
        offset = name.end()
        while True:
            offset = _SPACE(text, offset).end()  # type: ignore[union-attr]  # it matches nothing at least
            if offset >= size:
                self.fail(Span(start, name.end()), f"missing > for <{name[0]}", "write > or /> where the tag ends")
            key = _NAME(text, offset)
            equals = _EQUALS(text, key.end()) if key is not None else None
            if equals is None and text[offset - 1] in "\"'" and text[offset] not in "\"',;":
                span = Span(offset, key.end() if key is not None else offset + 1)
                note = "write a quote in a value as &quot;, in a script as '"
                self.fail(span, f"the value before `{text[span.start : span.end]}` ends at its second quote", note)
            if key is None:
                shown = text[offset] if text[offset].isprintable() else repr(text[offset])
                note = 'attributes are written name="value", and a tag ends with > or />'
                message = f"expected an attribute or the end of <{name[0]}>, found `{shown}`"
                self.fail(Span(offset, offset + 1), message, note)
            if equals is None:
                note = f'write {key[0]}="…", or remove it'
                self.fail(Span(offset, key.end()), f"missing value in quotes for the attribute `{key[0]}`", note)
            end = text.find(equals[1], equals.end())
            if end < 0:
                message = f"missing closing {equals[1]} for the value of `{key[0]}`"
                self.fail(Span(equals.end() - 1, equals.end()), message, f"write {equals[1]} where it ends")
            offset = end + 1


def _pieces(text: str) -> Iterator[list[str]]:
    """A text cut at every `<`, in chunks, which touches less memory."""
    start = 0
    while (end := text.find("<", start + _PART)) >= 0:
        yield text[start:end].split("<")
        start = end + 1
    yield text[start:].split("<")


def _line_ends(text: str) -> str:
    return LINE_END.sub("\n", text) if "\r" in text else text


_TOO_DEEP: Final = f"more than {MAX_DEPTH} nested elements, which BehaviorTree.CPP refuses"
_PART: Final = 32_000
_BLANKS: Final = " \t\n\v\f\r"
_PAIRS: Final = rf"((?:{SPACE}{WORD}{SPACE}={SPACE}(?:\"[^\"]*\"|'[^']*'))*)"
# No two adjacent parts can match the same characters, so a text matches in one way only, and the time is linear.
_TAG: Final = re.compile(
    rf"<(?:{SPACE}({WORD})(?!{IN_WORD}){_PAIRS}{SPACE}(/?)>|/({WORD})(?!{IN_WORD})(?:{SPACE}{WORD}{SPACE}={SPACE}(?:\"[^\"]*\"|'[^']*'))*{SPACE}>)"
).match
_MAY_HAVE_PREFIX: Final = re.compile(":|xmlns").search
_ATTRIBUTES: Final = ATTRIBUTE.findall
_NAME: Final = re.compile(WORD).match
_SPACE: Final = re.compile(SPACE).match
_EQUALS: Final = re.compile(rf"{SPACE}={SPACE}([\"'])").match
