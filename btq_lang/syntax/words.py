"""Words of the source, and pairs of them; a tree has thousands.

One invariant: they are plain classes without decorators, so that they can be compiled (hatch_build.py).
`__match_args__` names their fields, as in a record: a compiled class has no `__slots__`.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, ClassVar, Final

from btq_lang.syntax.tokens import STRING
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from mypy_extensions import i64


class Word:
    """A word of the source: a name, a string, a symbol or a value.

    Attributes:
        kind: its token kind: NAME, STRING, NUMBER, QUANTITY, BRACED or SYMBOL.
        start: where it begins.
        raw: its source, quotes included.
    """

    __slots__ = ("kind", "raw", "start")
    __match_args__: ClassVar = ("kind", "start", "raw")

    def __init__(self, kind: i64, start: i64, raw: str) -> None:
        self.kind: Final = kind
        self.start: Final = start
        self.raw: Final = raw

    @property
    def end(self) -> i64:
        return self.start + len(self.raw)

    @property
    def span(self) -> Span:
        return Span(self.start, self.start + len(self.raw))

    @property
    def quoted(self) -> bool:
        return self.kind == STRING

    @property
    def text(self) -> str:
        """Its value: a string without its quotes and escapes, anything else verbatim."""
        return self.raw if self.kind != STRING else unquote(self.raw)

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Word) and self.raw == other.raw and self.start == other.start and self.kind == other.kind
        )

    def __hash__(self) -> int:
        return hash((self.raw, self.start))

    def __repr__(self) -> str:
        return f"{self.raw}@{self.start}"


class TypeWord(Word):
    """The type of a port, `std::string`: several words of the source, with or without blanks between them."""

    __slots__ = ()

    @property
    def text(self) -> str:
        """The type without blanks and comments."""
        return _GAPS.sub("", self.raw)


class Pair:
    """`key = value`: a port, a subtree argument, or `_skipIf`, `_while`, …; no value: it is missing."""

    __slots__ = ("key", "value")
    __match_args__: ClassVar = ("key", "value")

    def __init__(self, key: Word, value: Word | None) -> None:
        self.key: Final = key
        self.value: Final = value

    @property
    def span(self) -> Span:
        return Span(self.key.start, (self.value or self.key).end)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Pair) and self.key == other.key and self.value == other.value

    def __hash__(self) -> int:
        return hash(self.key)

    def __repr__(self) -> str:
        return f"{self.key!r} = {self.value!r}"


def unquote(raw: str) -> str:
    """The value of a STRING (docs/language.md): quotes removed, `\\" \\' \\\\ \\n \\t` decoded, line ends as `\\n`."""
    text = raw[1:-1] if len(raw) > 1 and raw[-1] == raw[0] and _closes(raw) else raw[1:]
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    if "\\" in text:
        text = _ESCAPE.sub(lambda match: _ESCAPED.get(match[1], match[1]), text)
    return text


def _closes(raw: str) -> bool:
    """Whether the last character of a string is its closing quote, not an escaped one."""
    if raw[-2] != "\\":
        return True
    backslashes = len(raw) - 1 - len(raw[:-1].rstrip("\\"))
    return backslashes % 2 == 0


_ESCAPE: Final = re.compile(r"\\([\"'\\nt])")
_GAPS: Final = re.compile(r"(?s)\s+|/\*.*?\*/")
_ESCAPED: Final = {"n": "\n", "t": "\t"}
