"""An XML document: elements with attributes as they are spelt, comments and texts, and how to write it.

One invariant: an attribute keeps its value as the file spells it (`raw`), for the engine keeps a line end inside a
value and strict readers turn it into a blank, unless it is written `&#10;`. It does not know what the elements mean.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final, TypeAlias

from btq_lang.util.record import Record
from btq_lang.util.text import Span


class Attribute:
    """`name="raw"`.

    Attributes:
        raw: the text between the quotes, with its references.
        place: where name and value begin in the file that it was read from; None if it was made, or if its element can
            find it.
    """

    __slots__ = ("name", "place", "raw")

    def __init__(self, name: str, raw: str, place: tuple[int, int] | None = None) -> None:
        self.name: Final = name
        self.raw: Final = raw
        self.place: Final = place

    @property
    def value(self) -> str:
        """The value as the engine reads it."""
        return unescape(self.raw) if "&" in self.raw else self.raw


class Element:
    """An element.

    Attributes:
        attributes: shared by many elements, so never changed in place: assign another sequence.
        children: in order.
        source, start, end: the file it was read from, and the span of its start tag; -1 if it was made.
        close: the end of its end tag, likewise.
    """

    __slots__ = ("_places", "attributes", "children", "close", "end", "source", "start", "tag")

    def __init__(
        self,
        tag: str,
        attributes: Iterable[Attribute] | None = None,
        children: Iterable[Content] | None = None,
        source: str = "",
        start: int = -1,
        end: int = -1,
    ) -> None:
        self.tag = tag
        self.attributes = tuple(attributes) if attributes else ()
        self.children: Final = list(children) if children else []
        self.source: Final = source
        self.start: Final = start
        self.end: Final = end
        self._places: dict[str, tuple[int, int]] | None = None
        self.close = end  # the reader sets it again when the end tag comes

    @property
    def elements(self) -> Iterator[Element]:
        """The children that are elements."""
        return (child for child in self.children if isinstance(child, Element))

    def walk(self) -> Iterator[Element]:
        """This element and all below it, in no particular order."""
        stack = [self]
        while stack:
            yield (element := stack.pop())
            stack += element.elements

    @property
    def tag_span(self) -> Span:
        """Where its tag's name is in the file that it was read from."""
        return Span(self.start + 1, self.start + 1 + len(self.tag))

    def get(self, name: str) -> str | None:
        """The value of an attribute; None if the element does not have it."""
        for attribute in self.attributes:
            if attribute.name == name:
                return attribute.value
        return None

    def place(self, attribute: Attribute) -> tuple[int, int]:
        """Where name and value of an attribute begin in the file that it was read from; -1 if it was made."""
        if attribute.place is not None:
            return attribute.place
        if self._places is None:  # looked up on demand, for few are needed
            matches = attribute_matches(self.source, max(self.start, 0), self.end)
            self._places = {match[1]: (match.start(1), match.start(3)) for match in matches}
        return self._places.get(attribute.name, _NOWHERE)


class XmlComment(Record):
    """`<!--text-->`.

    Attributes:
        beside: whether it is on the line on which the previous content ends.
    """

    text: str
    beside: bool = False
    start: int = -1


class XmlText(Record):
    """Character data that is not blank: the text of a port or a description, unescaped."""

    text: str
    start: int = -1


class Raw(Record):
    """One element as the user spelt it, from its `<` to its `>`; only made, never read."""

    text: str


Content: TypeAlias = "Element | XmlComment | XmlText | Raw"


class Document:
    """A whole file: the document element and the comments before and after it."""

    __slots__ = ("contents",)

    def __init__(self, contents: Iterable[Content]) -> None:
        self.contents: Final = list(contents)

    @property
    def root(self) -> Element:
        """The document element."""
        return next(content for content in self.contents if isinstance(content, Element))


def attribute_matches(text: str, start: int, end: int) -> Iterator[re.Match[str]]:
    """The well-formed attributes of the start tag at this place: name, quote and value."""
    name = _TAG_NAME(text, start)
    return ATTRIBUTE.finditer(text, name.end() if name else start, end)


def write(document: Document) -> str:
    """The text of a document: one element a line, two blanks a level, `\\n` at line ends."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    stack: list[tuple[Iterator[Content], str]] = [(iter(document.contents), "")]
    blanks = ""
    while stack:
        contents, closing = stack[-1]
        for content in contents:
            if isinstance(content, Element):
                if not content.children:
                    lines.append(f"{blanks}<{_start_tag(content)}/>")
                elif _has_text(content):  # blanks around a text would be part of it
                    inside = "".join(map(_inline, content.children))
                    lines.append(f"{blanks}<{_start_tag(content)}>{inside}</{content.tag}>")
                else:
                    lines.append(f"{blanks}<{_start_tag(content)}>")
                    stack.append((iter(content.children), f"{blanks}</{content.tag}>"))
                    blanks += _STEP
                    break
            elif isinstance(content, XmlComment) and content.beside:
                lines[-1] += f" {_inline(content)}"
            else:
                lines.append(f"{blanks}{_inline(content)}")
        else:
            stack.pop()
            blanks = blanks[: -len(_STEP)]
            if closing:
                lines.append(closing)
    return "\n".join(lines) + "\n"


def _has_text(element: Element) -> bool:
    """Whether its contents go on one line: a text, perhaps with comments."""
    has_text = False
    for child in element.children:
        if isinstance(child, Element):
            return False
        has_text = has_text or isinstance(child, XmlText)
    return has_text


def _inline(content: Content) -> str:
    if isinstance(content, XmlText):
        return escape_text(content.text)
    if isinstance(content, XmlComment):
        return f"<!--{content.text}-->"
    return content.text if isinstance(content, Raw) else f"<{_start_tag(content)}/>"


def _start_tag(element: Element) -> str:
    text = element.tag
    for attribute in element.attributes:
        text += f' {attribute.name}="{attribute.raw}"'
    return text


# ---- spelling values ------------------------------------------------------------------------------------------------


def escape(value: str) -> str:
    """A value as it is spelt in an attribute: line ends, tabs and what XML forbids there as references."""
    return value.translate(_IN_ATTRIBUTE) if _SPECIAL(value) else value


def escape_text(text: str) -> str:
    """A text as it is spelt between tags."""
    return text.translate(_IN_TEXT)


def unescape(raw: str) -> str:
    """The value that the engine reads: it resolves XML's five named references and numbers, and keeps the others."""
    return _REFERENCE.sub(_referred, raw)


def _referred(match: re.Match[str]) -> str:
    name = match[1]
    if name in _NAMED:
        return _NAMED[name]
    code = int(name[2:], 16) if name[1] == "x" else int(name[1:])
    return chr(code) if 0 < code <= 0x10FFFF and not 0xD800 <= code < 0xE000 else match[0]


_NOWHERE: Final = (-1, -1)
_STEP: Final = "  "
# As the engine reads it: a name, a value in quotes, blanks around the sign.  A name consists of letters, digits, `_:.-`
# and all that is not ASCII; the set is negated because `re` takes long to compile sets of so many characters.
IN_WORD: Final = r"[^\x00-,/;-@\[-\^`{-\x7f]"
WORD: Final = rf"[^\x00-9;-@\[-\^`{{-\x7f]{IN_WORD}*"
SPACE: Final = r"[ \t\n\v\f\r]*"
_TAG_NAME: Final = re.compile(rf"<{SPACE}{WORD}").match
ATTRIBUTE: Final = re.compile(rf"({WORD}){SPACE}={SPACE}([\"'])(.*?)\2", re.DOTALL)
_NAMED: Final = {"lt": "<", "gt": ">", "amp": "&", "quot": '"', "apos": "'"}
_REFERENCE: Final = re.compile(r"&(lt|gt|amp|quot|apos|#[0-9]{1,7}|#x[0-9A-Fa-f]{1,6});")
_IN_TEXT: Final = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", "\r": "&#13;"})
_IN_ATTRIBUTE: Final = _IN_TEXT | str.maketrans({'"': "&quot;", "\n": "&#10;", "\t": "&#9;"})
_SPECIAL: Final = re.compile('[&<>"\r\n\t]').search
