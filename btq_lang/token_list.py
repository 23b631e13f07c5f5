"""All tokens of a text at once, for those who look at text and not at the tree: formatter, editors, comments in XML.

One invariant: the texts of `tokens()` joined are the text, for every string.  Where tokens begin and end the lexer
says; what it passes over is filled in here.
"""

from __future__ import annotations

from btq_lang.lexer import Lexer
from btq_lang.regex import regex
from btq_lang.scan import COMPILED
from btq_lang.tokens import BLANK, CLOSE, COMMENT, DEDENT, ERROR, INDENT, NEWLINE, OPEN, Token

if not COMPILED:
    from btq_lang.patterns import read_pieces


def tokens(text: str) -> tuple[Token, ...]:
    """All tokens of a text, blanks and comments included, INDENT and DEDENT where blocks open and close."""
    lexer = Lexer(text)
    found: list[Token] = []
    end = level = comment = 0

    def fill(start: int) -> None:
        """What the lexer passed over up to `start`: blanks, comments and characters that begin nothing."""
        nonlocal end, comment
        while comment < len(lexer.comments) and lexer.comments[comment][0] < start:
            comment_start, comment_end = lexer.comments[comment]
            found.extend(_pieces(text, end, comment_start))
            found.append(Token(COMMENT, comment_start, text[comment_start:comment_end]))
            end = comment_end
            comment += 1
        found.extend(_pieces(text, end, start))
        end = start

    while lexer.open_line():
        lexer.scan()
        fill(lexer.starts[0])
        step = INDENT if lexer.level > level else DEDENT
        found += [Token(step, lexer.starts[0], "")] * abs(lexer.level - level)
        level = lexer.level
        for kind, start, raw in zip(lexer.kinds, lexer.starts, lexer.raws, strict=True):
            fill(start)
            found.append(Token(kind, start, raw))
            end = start + len(raw)
    fill(len(text))
    found += [Token(DEDENT, len(text), "")] * level
    return tuple(found)


def pieces(text: str) -> list[tuple[int, int, str]]:
    """Kind, start and text of all tokens but brackets, line ends, blanks and what begins nothing: a third of
    what `tokens` has, and quickly."""
    if not COMPILED and (usual := read_pieces(text)) is not None:
        return usual
    lexer = Lexer(text)
    comments = lexer.comments
    found: list[tuple[int, int, str]] = []
    told = 0
    while lexer.open_line():
        lexer.scan()
        of_line = [*zip(lexer.kinds, lexer.starts, lexer.raws, strict=True)]
        if told < len(comments):
            of_line += [(COMMENT, start, text[start:end]) for start, end in comments[told:]]
            of_line.sort(key=_start_of)
            told = len(comments)
        found += [piece for piece in of_line if piece[0] not in _SILENT]
    found += [(COMMENT, start, text[start:end]) for start, end in comments[told:]]
    return found


def _start_of(piece: tuple[int, int, str]) -> int:
    return piece[1]


def _pieces(text: str, start: int, end: int) -> list[Token]:
    return [Token(BLANK if piece[1] else ERROR, piece.start(), piece[0]) for piece in _PIECE.finditer(text, start, end)]


_PIECE = regex(r"([ \t\r\n\ufeff]+)|[^ \t\r\n\ufeff]+")
_SILENT = (OPEN, CLOSE, NEWLINE)
