"""The comments of a file: to which element each belongs, for all that writes a tree in another notation.

One invariant: every comment of the file has exactly one place.  An element is what begins a logical line: an item, a
node, a port, a line of clauses, a clause in the block of a requirement.  The module knows where comments belong
(docs/language.md) but no grammar; which elements another notation has, and how it writes a comment, is for the caller.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final, Protocol, TypeVar

from btq_lang.lexer import Lexer
from btq_lang.parser import Parsed
from btq_lang.util.record import Record
from btq_lang.util.text import LINE_END

if TYPE_CHECKING:

    class CodeLine(Protocol):
        """A logical line: the number of open blocks around it, and its indentation."""

        @property
        def level(self) -> int: ...
        @property
        def blanks(self) -> str: ...

    L = TypeVar("L", bound=CodeLine)


class Comment(Record):
    """A comment.

    Attributes:
        start: where it begins in the file.
        raw: as it is written, without blanks at the end of a line comment.
    """

    start: int
    raw: str

    @property
    def is_block(self) -> bool:
        """Whether it is written `/* … */`, and not to the end of a line."""
        return self.raw.startswith("/*")

    @property
    def text(self) -> str:
        """The text after `#` or `//`, or between `/*` and `*/`; line ends are `\\n`."""
        if not self.is_block:
            return self.raw.removeprefix("//") if self.raw.startswith("/") else self.raw[1:]
        inside = self.raw[2:-2] if len(self.raw) >= 4 and self.raw.endswith("*/") else self.raw[2:]
        return LINE_END.sub("\n", inside)


class Comments(Record):
    """The comments of an element, by place, each in the order of the file.

    Attributes:
        before: on lines of their own above it, in its block.
        within: on its line (or lines, if it has brackets) before its last word: in brackets, or before it.
        after: at the end of its line, if it has no block.
        first: after it on its line, if a block follows: they are the first thing in the block.
        last: on lines of their own at the end of its block; an element without a block may have them too.
    """

    before: tuple[Comment, ...] = ()
    within: tuple[Comment, ...] = ()
    after: tuple[Comment, ...] = ()
    first: tuple[Comment, ...] = ()
    last: tuple[Comment, ...] = ()


NO_COMMENTS: Final = Comments()


def comments(parsed: Parsed) -> Mapping[int, Comments]:
    """The comments of a file by the elements they belong to; elements without comments are left out.

    The key of an element is its offset in the file, `entry.start + part.start`; what does not begin a logical line,
    like a clause after a node, has none.  Comments below all items and outside of blocks are `before` the key
    `len(text)`.
    """
    if "#" not in parsed.text and "/" not in parsed.text:
        return {}
    remarks_by_line: dict[int, dict[str, list[Comment]]] = {}

    def add(line: _Line, place: str, remarks: list[Comment]) -> None:
        if remarks:
            remarks_by_line.setdefault(line.start, {}).setdefault(place, []).extend(remarks)

    open_lines: list[_Line] = []  # the line above and those whose blocks it is in
    for comment_lines, line in _lines(parsed.text):
        for blanks, remarks in comment_lines:
            owner = block_of(blanks, open_lines, line.level)
            if owner is None:
                add(line, "before", remarks)
            else:
                add(owner, "last", remarks)
        if open_lines and open_lines[-1].after:  # only now its block is known
            above = open_lines[-1]
            has_block = above.level < line.level or "last" in remarks_by_line.get(above.start, ())
            add(above, "first" if has_block else "after", above.after)
        if line.within:
            add(line, "within", line.within)
        while open_lines and open_lines[-1].level >= line.level:
            open_lines.pop()
        open_lines.append(line)
    return {
        start: Comments(**{place: tuple(remarks) for place, remarks in places.items()})
        for start, places in remarks_by_line.items()
    }


def block_of(blanks: str, open_lines: Sequence[L], level: int) -> L | None:
    """The line whose block a comment line ends (docs/language.md): the last one above it with less indentation; None if
    it belongs to the line below, for it is never further out than that.

    Args:
        blanks: the indentation of the comment line.
        open_lines: the line above and those whose blocks it is in, the outermost first.
        level: of the line below.
    """
    for line in reversed(open_lines):
        if _further_left(line.blanks, blanks):
            return line if line.level >= level else None
    return None


def _further_left(first: str, second: str) -> bool:
    """Whether the first indentation is less than the second; if tabs and blanks do not compare, a tab goes to the next
    multiple of four columns, as in the editor of the classic files."""
    if second.startswith(first) or first.startswith(second):
        return len(first) < len(second)
    return len(first.expandtabs(4)) < len(second.expandtabs(4))


class _Line:
    """A logical line.

    Attributes:
        start: of its first word.
        level: number of open blocks around it.
        blanks: the text before it on its physical line.
        within, after: its comments, before and after its last word.
    """

    __slots__ = ("after", "blanks", "level", "start", "within")

    def __init__(self, start: int, level: int, blanks: str, within: list[Comment]) -> None:
        self.start = start
        self.level: Final = level
        self.blanks: Final = blanks
        self.within: Final = within
        self.after: Final[list[Comment]] = []


def _lines(text: str) -> Iterator[tuple[list[tuple[str, list[Comment]]], _Line]]:
    """The logical lines, the end of the file as the last; each with the comment lines above it and their blanks."""
    lexer = Lexer(text)
    spans = lexer.comments
    while True:
        end, count = lexer.position, len(spans)
        opened = lexer.open_line()
        above: list[tuple[str, list[Comment]]] = []
        for start, comment_end in spans[count:]:
            between = text[end:start]
            if not above or "\n" in between or "\r" in between:
                above.append((LINE_END.split(between)[-1].lstrip("\ufeff"), []))
            above[-1][1].append(_comment(text, start, comment_end))
            end = comment_end
        if not opened:
            yield above, _Line(len(text), 0, "", [])
            return
        in_front = above.pop()[1] if above and lexer.line_start < end else []
        line = _Line(lexer.position, lexer.level, lexer.blanks, in_front)
        plain = _PLAIN.match(text, lexer.position)
        if plain is not None:
            lexer.position = plain.end()  # it has no comment, so it need not be tokenized
        else:
            count = len(spans)
            lexer.scan()
            line.start = lexer.starts[0]
            last = lexer.starts[-2] if len(lexer.starts) > 1 else line.start  # the very last is the end of the line
            for start, comment_end in spans[count:]:
                (line.within if start < last else line.after).append(_comment(text, start, comment_end))
        yield above, line


def _comment(text: str, start: int, end: int) -> Comment:
    raw = text[start:end]
    return Comment(start, raw if raw.startswith("/*") else raw.rstrip(" \t"))


# A line without a comment, its brackets and strings closed; a Root line does not match, for the lexer changes state
# after it.
_INSIDE: Final = r"""[^#/"'()\\\r\n]*"""
_QUOTED: Final = r"""(?:"[^"\\\r\n]*"|'[^'\\\r\n]*')"""
_PLAIN: Final = re.compile(rf"(?!Root\b){_INSIDE}(?:(?:{_QUOTED}|\({_INSIDE}(?:{_QUOTED}{_INSIDE})*\)){_INSIDE})*\n")
