"""An XML document: elements, comments and texts, with the bytes of their attributes, and how it is written.

One invariant: an attribute keeps its value as the file spells it (`raw`), for the engine keeps a line end inside a
value and strict readers turn it into a blank, unless it is written `&#10;`: only the spelling says which it was.
It does not know what the elements mean.
"""

from __future__ import annotations

import re

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from typing import Final, TypeAlias


class StartTag:
    """A start tag in a file that was read: it knows where the attributes stand, and looks when somebody asks.

    Not the element's business, or each element and its attributes would be a circle that only the collector of garbage
    can break.
    """

    __slots__ = ("_places", "end", "source", "start")

    def __init__(self, source: str, start: int, end: int) -> None:
        self.source: Final = source
        self.start: Final = start
        self.end: Final = end
        self._places: dict[str, tuple[int, int]] | None = None

    @property
    def places(self) -> dict[str, tuple[int, int]]:
        """Where name and value begin, by name."""
        if self._places is None:
            found = attribute_matches(self.source, self.start, self.end)
            self._places = {match[1]: (match.start(1), match.start(3)) for match in found}
        return self._places


class Attribute:
    """`name="raw"`.

    Attributes:
        raw: what stands between the quotes, references as they are.
        origin: where name and value begin in the file it was read from, or the start tag that knows it.
    """

    __slots__ = ("name", "origin", "raw")

    def __init__(self, name: str, raw: str, origin: StartTag | tuple[int, int] = (-1, -1)) -> None:
        self.name: Final = name
        self.raw: Final = raw
        self.origin: Final = origin

    @property
    def place(self) -> tuple[int, int]:
        """Where name and value begin in the file it was read from; -1 where it was made."""
        return self.origin if isinstance(self.origin, tuple) else self.origin.places[self.name]

    @property
    def start(self) -> int:
        """Where the name begins."""
        return self.place[0]

    @property
    def value_start(self) -> int:
        """Where `raw` begins."""
        return self.place[1]

    @property
    def value(self) -> str:
        """What the engine reads."""
        return unescape(self.raw) if "&" in self.raw else self.raw

    def __repr__(self) -> str:
        return f'{self.name}="{self.raw}"'


class Element:
    """An element.

    Attributes:
        children: what stands in it, in order.
        start, end: its start tag in the file it was read from; -1 where it was made.
        close: where its end tag ends, likewise.
    """

    __slots__ = ("attributes", "children", "close", "end", "start", "tag")

    def __init__(
        self,
        tag: str,
        attributes: Iterable[Attribute] = (),
        children: Iterable[Content] = (),
        start: int = -1,
        end: int = -1,
    ) -> None:
        self.tag = tag
        self.attributes: Final = list(attributes) if attributes else []
        self.children: Final = list(children) if children else []
        self.start: Final = start
        self.end: Final = end
        self.close = end  # set once more, by the reader, when the end tag comes

    @property
    def elements(self) -> Iterator[Element]:
        """The children that are elements."""
        return (child for child in self.children if isinstance(child, Element))

    def get(self, name: str) -> str | None:
        """The value of an attribute; None where it has none of that name."""
        for attribute in self.attributes:
            if attribute.name == name:
                return attribute.value
        return None

    def __repr__(self) -> str:
        return f"<{self.tag} {self.attributes} {len(self.children)} children>"


class Comment:
    """`<!--text-->`.

    Attributes:
        beside: it stands on the line on which what comes before it ends.
    """

    __slots__ = ("beside", "start", "text")

    def __init__(self, text: str, beside: bool = False, start: int = -1) -> None:
        self.text: Final = text
        self.beside: Final = beside
        self.start: Final = start

    def __repr__(self) -> str:
        return f"<!--{self.text}-->"


class Text:
    """Character data that is not blank: the text of a port or a description, as it reads."""

    __slots__ = ("start", "text")

    def __init__(self, text: str, start: int = -1) -> None:
        self.text: Final = text
        self.start: Final = start

    def __repr__(self) -> str:
        return repr(self.text)


class Raw:
    """One element as somebody has spelt it, from its `<` to its `>`; only made, never read."""

    __slots__ = ("text",)

    def __init__(self, text: str) -> None:
        self.text: Final = text

    def __repr__(self) -> str:
        return self.text


Content: TypeAlias = "Element | Comment | Text | Raw"


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
    """The attributes of the start tag there, whose shape is right: name, quote and value."""
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
            elif isinstance(content, Comment) and content.beside:
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
    """Whether all in it stands on one line: a text, perhaps with comments."""
    found = False
    for child in element.children:
        if isinstance(child, Element):
            return False
        found = found or isinstance(child, Text)
    return found


def _inline(content: Content) -> str:
    if isinstance(content, Text):
        return escape_text(content.text)
    if isinstance(content, Comment):
        return f"<!--{content.text}-->"
    return content.text if isinstance(content, Raw) else f"<{_start_tag(content)}/>"


def _start_tag(element: Element) -> str:
    text = element.tag
    for attribute in element.attributes:
        text += f' {attribute.name}="{attribute.raw}"'
    return text


# ---- spelling values ------------------------------------------------------------------------------------------------


def escape(value: str) -> str:
    """A value as it stands in an attribute: line ends, tabs and what XML forbids there as references."""
    return value.translate(_IN_ATTRIBUTE) if _SPECIAL(value) else value


def escape_text(text: str) -> str:
    """A text as it stands between tags."""
    return text.translate(_IN_TEXT)


def unescape(raw: str) -> str:
    """What the engine reads from a value: the five names and numbers of XML; other references stay as they are."""
    return _REFERENCE.sub(_referred, raw)


def _referred(match: re.Match[str]) -> str:
    name = match[1]
    if name in _NAMED:
        return _NAMED[name]
    code = int(name[2:], 16) if name[1] == "x" else int(name[1:])
    return chr(code) if 0 < code <= 0x10FFFF and not 0xD800 <= code < 0xE000 else match[0]


_STEP: Final = "  "
# As the engine reads it: a name, a value in quotes, blanks around the sign.
WORD: Final = r"[A-Za-z_:\x80-\U0010ffff][A-Za-z0-9_:.\-\x80-\U0010ffff]*"
SPACE: Final = r"[ \t\n\v\f\r]*"
_TAG_NAME: Final = re.compile(rf"<{SPACE}{WORD}").match
ATTRIBUTE: Final = re.compile(rf"({WORD}){SPACE}={SPACE}([\"'])(.*?)\2", re.DOTALL)
_NAMED: Final = {"lt": "<", "gt": ">", "amp": "&", "quot": '"', "apos": "'"}
_REFERENCE: Final = re.compile(r"&(lt|gt|amp|quot|apos|#[0-9]{1,7}|#x[0-9A-Fa-f]{1,6});")
_IN_TEXT: Final = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", "\r": "&#13;"})
_IN_ATTRIBUTE: Final = _IN_TEXT | str.maketrans({'"': "&quot;", "\n": "&#10;", "\t": "&#9;"})
_SPECIAL: Final = re.compile('[&<>"\r\n\t]').search
