"""XML text to a document, as BehaviorTree.CPP reads it.

One invariant: what the engine's reader (tinyxml2) loads is read, with the elements and values that it sees; what it
refuses is refused.  It is more generous than the standard in some things (`--` in comments, `<` and `&` in values,
text around the document element) and stricter in others (no processing instruction inside the document element), so
lxml is asked as well: what only the engine reads is told as a warning.  Every step moves forward, nothing is expanded,
fetched or nested by recursion.  What the elements mean is not known here.

Source: tinyxml2 11, `XMLNode::ParseDeep`, `XMLDocument::Identify`, `XMLElement::ParseAttributes`.
"""

from __future__ import annotations

import gc
import re

from btq_lang.btcpp.document import Attribute, Comment, Content, Document, Element, Text, unescape
from btq_lang.btcpp.strict import not_well_formed
from btq_lang.diagnostics import Diagnostic, Place, Related
from btq_lang.record import record
from btq_lang.text import LINE_END, Span

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final, NoReturn

MAX_DEPTH: Final = 498  # open elements; the engine gives up at the next one


@record
class Read:
    """What a file says.

    Attributes:
        document: None where no reader could make sense of the text.
        problems: the mistake that ended the reading, or what other XML tools refuse; spans count from the text's start.
    """

    document: Document | None
    problems: tuple[Diagnostic, ...] = ()


def read(text: str) -> Read:
    """Read an XML file.

    Args:
        text: any string at all.
    """
    collecting = gc.isenabled()
    gc.disable()  # nothing made here is garbage, and collecting it is half of the time
    try:
        contents = _Reader(text).contents()
    except _Broken as broken:
        return Read(None, (broken.diagnostic,))
    finally:
        if collecting:
            gc.enable()
    roots = [content for content in contents if isinstance(content, Element)]
    if not roots:
        end = len(text.rstrip())
        message = "there is no element in this file" if end else "this file is empty"
        note = 'a mission begins with <root BTCPP_format="4">'
        return Read(None, (Diagnostic(RULE, Span(0, min(end, 1)), message, notes=(note,)),))
    read_by_all = (content for content in contents if isinstance(content, Comment) or content is roots[0])
    return Read(Document(read_by_all), not_well_formed(text))


RULE: Final = "xml-syntax"


class _Broken(Exception):
    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic: Final = diagnostic


class _Reader:
    """A place in a text, and the elements that are open there."""

    def __init__(self, text: str) -> None:
        self.text: Final = text
        self.open: Final[list[Element]] = []

    def contents(self) -> list[Content]:
        """{ Element | Comment | Text | Declaration | DOCTYPE }: what stands at the top of the document."""
        text = self.text
        top: list[Content] = []
        contents = top  # of the innermost open element
        opened = self.open
        tag_at, find = _TAG, text.find
        declared = True  # nothing but declarations so far
        at = 1 if text.startswith("\ufeff") else 0
        while True:
            start = find("<", at)
            if start != at:
                between = text[at:start] if start >= 0 else text[at:]
                if between.strip(_BLANKS):
                    declared = False
                    self.characters(between, at, start, contents)
            if start < 0:
                break
            tag = tag_at(text, start)
            if tag is None:
                mark = text[start : start + 2]
                if mark == "</":
                    if opened and text.startswith(f"{opened[-1].tag}>", start + 2):
                        at = start + len(opened[-1].tag) + 3
                    else:
                        at = self.end_tag(start)
                    if not opened:  # the engine reads no further
                        break
                    opened.pop().close = at
                    contents = opened[-1].children if opened else top
                elif mark == "<!":
                    at = self.marked(start, contents)
                    declared = False
                elif mark == "<?":
                    at = self.declaration(start, declared)
                else:
                    self.broken_tag(start)
                continue
            at = tag.end()
            name, pairs, slash = tag.groups()
            element = Element(name, self.attributes(name, tag.start(2), tag.end(2)) if pairs else (), (), start, at)
            contents.append(element)
            declared = False
            if slash:
                element.close = at
            else:
                opened.append(element)
                contents = element.children
                if len(opened) > MAX_DEPTH:
                    raise _Broken(Diagnostic("nested-too-deep", Span(start, at), _TOO_DEEP))
        if opened:
            self.unclosed(opened[-1])
        return top

    def attributes(self, tag: str, start: int, end: int) -> list[Attribute]:
        """{ Name "=" Value } of a start tag whose shape is known to be right."""
        found = [
            Attribute(match[1], match[3], match.start(), match.start(3)) for match in _ATTRIBUTE(self.text, start, end)
        ]
        if len(found) > 1 and len({attribute.name for attribute in found}) < len(found):
            self.twice(tag, found)
        return found

    def characters(self, between: str, at: int, end: int, contents: list[Content]) -> None:
        """Text between tags; behind the last one the engine cannot end it."""
        if end < 0 and not self.open:
            begin = at + len(between) - len(between.lstrip(_BLANKS))
            span = Span(begin, at + len(between.rstrip(_BLANKS)))
            if any(isinstance(content, Element) for content in contents):
                self.broken(span, "text behind the document element", "remove it")
        if end >= 0:
            contents.append(Text(unescape(_line_ends(between)), at))

    def end_tag(self, start: int) -> int:
        """ "</" Name { Attribute } ">"; behind the document element it ends the file for the engine."""
        text = self.text
        match = _END_TAG(text, start)
        if match is None:
            self.broken_tag(start)
        if self.open and match[1] != self.open[-1].tag:
            element = self.open[-1]
            likely = next((at for at, other in enumerate(reversed(self.open)) if other.tag == match[1]), None)
            notes = (
                (f"close <{element.tag}> first: write </{element.tag}>, or /> where it has no children",)
                if likely is not None
                else (f"write </{element.tag}>",)
            )
            related = (Related(Place(Span(element.start, element.end)), f"<{element.tag}> is open since here"),)
            message = f"</{match[1]}> stands where </{element.tag}> is expected"
            raise _Broken(Diagnostic(RULE, Span(start, match.end()), message, related, notes))
        return match.end()

    def marked(self, start: int, contents: list[Content]) -> int:
        """ "<!--" … "-->", "<![CDATA[" … "]]>", "<!" … ">"; the last is passed over, as the engine does"""
        text = self.text
        if text.startswith("<!--", start):
            end = self.closing("-->", start + 4, start, "this comment has no -->")
            line = text[max(text.rfind("\n", 0, start), text.rfind("\r", 0, start)) + 1 : start]
            contents.append(Comment(_line_ends(text[start + 4 : end]), line.strip(_BLANKS) != "", start))
            return end + 3
        if text.startswith("<![CDATA[", start):
            end = self.closing("]]>", start + 9, start, "this CDATA section has no ]]>")
            if start + 9 < end:
                contents.append(Text(_line_ends(text[start + 9 : end]), start))
            return end + 3
        return self.closing(">", start + 2, start, "this declaration has no >") + 1

    def declaration(self, start: int, declared: bool) -> int:
        """ "<?" … "?>": the engine takes every one for a declaration, and wants those first"""
        end = self.closing("?>", start + 2, start, "this declaration has no ?>") + 2
        if not declared:
            span = Span(start, end)
            what = "an XML declaration" if self.text.startswith("<?xml ", start) else "a processing instruction"
            self.broken(
                span, f"{what} behind something else", "the engine wants it first in the file: move or remove it"
            )
        return end

    def closing(self, mark: str, at: int, start: int, message: str) -> int:
        end = self.text.find(mark, at)
        if end < 0:
            self.broken(Span(start, min(at, len(self.text))), message, f"write {mark} where it ends")
        return end

    # ---- mistakes ----

    def broken(self, span: Span, message: str, note: str) -> NoReturn:
        raise _Broken(Diagnostic(RULE, span, message, notes=(note,)))

    def twice(self, tag: str, found: list[Attribute]) -> NoReturn:
        first: dict[str, Attribute] = {}
        for attribute in found:
            if attribute.name in first:
                break
            first[attribute.name] = attribute
        name = attribute.name
        place = Place(Span(first[name].start, first[name].start + len(name)))
        related = (Related(place, "it has a value already"),)
        message = f"the attribute `{name}` stands twice in <{tag}>"
        span = Span(attribute.start, attribute.start + len(name))
        raise _Broken(Diagnostic(RULE, span, message, related, ("keep one of them",)))

    def unclosed(self, element: Element) -> NoReturn:
        message = f"<{element.tag}> is never closed"
        self.broken(Span(element.start, element.end), message, f"write </{element.tag}> where it ends")

    def broken_tag(self, start: int) -> NoReturn:
        """Say where a tag stops making sense: a second look at it, piece by piece."""
        text, size = self.text, len(self.text)
        name = _NAME(text, start + (2 if text.startswith("</", start) else 1))
        if name is None:
            self.broken(Span(start, start + 1), "`<` begins no tag", "as a character it is written &lt;")
        at = name.end()
        while True:
            at = _SPACE(text, at).end()  # type: ignore[union-attr]  # it matches nothing at least
            if at >= size:
                self.broken(Span(start, name.end()), f"<{name[0]} has no >", "write > or /> where the tag ends")
            key = _NAME(text, at)
            if key is None:
                shown = text[at] if text[at].isprintable() else repr(text[at])
                note = 'attributes are written name="value", and a tag ends with > or />'
                self.broken(
                    Span(at, at + 1), f"`{shown}` where an attribute or the end of <{name[0]}> is expected", note
                )
            equals = _EQUALS(text, key.end())
            if equals is None:
                note = f'write {key[0]}="…", or remove it'
                self.broken(Span(at, key.end()), f"the attribute `{key[0]}` has no value in quotes", note)
            end = text.find(equals[1], equals.end())
            if end < 0:
                message = f"the value of `{key[0]}` has no closing {equals[1]}"
                self.broken(Span(equals.end() - 1, equals.end()), message, f"write {equals[1]} where it ends")
            at = end + 1


def _line_ends(text: str) -> str:
    return LINE_END.sub("\n", text) if "\r" in text else text


_TOO_DEEP: Final = f"more than {MAX_DEPTH} elements inside each other: the engine reads no more"
_BLANKS: Final = " \t\n\v\f\r"
_WORD: Final = r"[A-Za-z_:\x80-\U0010ffff][A-Za-z0-9_:.\-\x80-\U0010ffff]*"
_S: Final = r"[ \t\n\v\f\r]*"
_PAIRS: Final = rf"((?:{_S}{_WORD}{_S}={_S}(?:\"[^\"]*\"|'[^']*'))*)"
# No two parts of these can match the same characters, so there is one way to match, or none: the time is linear.
_TAG: Final = re.compile(rf"<{_S}({_WORD}){_PAIRS}{_S}(/?)>").match
_END_TAG: Final = re.compile(rf"</({_WORD}){_PAIRS}{_S}>").match
_ATTRIBUTE: Final = re.compile(rf"({_WORD}){_S}={_S}([\"'])(.*?)\2", re.DOTALL).finditer
_NAME: Final = re.compile(_WORD).match
_SPACE: Final = re.compile(_S).match
_EQUALS: Final = re.compile(rf"{_S}={_S}([\"'])").match
