"""All tokens of a text at once, for those who look at text and not at the tree: formatter, editors, comments in XML.

One invariant: the texts of `tokens()` joined are the text, for every string.  Where tokens begin and end the lexer
says; what it passes over is filled in here.
"""

from __future__ import annotations

import re

from btq_lang.lexer import Lexer
from btq_lang.tokens import BLANK, CLOSE, COMMENT, DEDENT, ERROR, INDENT, NEWLINE, OPEN, Token


def tokens(text: str) -> tuple[Token, ...]:
    """All tokens of a text, blanks and comments included, INDENT and DEDENT where blocks open and close."""
    lexer = Lexer(text)
    comments = lexer.comments
    found: list[Token] = []
    end = level = told = 0
    while lexer.open_line():
        lexer.scan()
        told = _fill(found, text, end, lexer.starts[0], comments, told)
        end = lexer.starts[0]
        step = INDENT if lexer.level > level else DEDENT
        found += [Token(step, end, "")] * abs(lexer.level - level)
        level = lexer.level
        for kind, start, raw in zip(lexer.kinds, lexer.starts, lexer.raws, strict=True):
            told = _fill(found, text, end, start, comments, told)
            found.append(Token(kind, start, raw))
            end = start + len(raw)
    _fill(found, text, end, len(text), comments, told)
    found += [Token(DEDENT, len(text), "")] * level
    return tuple(found)


def pieces(text: str) -> list[tuple[int, int, str]]:
    """Kind, start and text of all tokens but brackets, line ends, blanks and what begins nothing: a third of
    what `tokens` has, and quickly."""
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


def _fill(found: list[Token], text: str, end: int, start: int, comments: list[tuple[int, int]], told: int) -> int:
    """Add what the lexer passed over between two tokens: blanks, comments and characters that begin nothing.

    Args:
        told: how many of the comments were added before.

    Returns:
        How many are now.  (A function inside of `tokens` would hold all of these, compiled, until Python looks for
        garbage.)
    """
    while told < len(comments) and comments[told][0] < start:
        comment, behind = comments[told]
        found += _pieces(text, end, comment)
        found.append(Token(COMMENT, comment, text[comment:behind]))
        end = behind
        told += 1
    found += _pieces(text, end, start)
    return told


def _pieces(text: str, start: int, end: int) -> list[Token]:
    return [Token(BLANK if piece[1] else ERROR, piece.start(), piece[0]) for piece in _PIECE.finditer(text, start, end)]


_PIECE = re.compile(r"([ \t\r\n\ufeff]+)|[^ \t\r\n\ufeff]+")
_SILENT = (OPEN, CLOSE, NEWLINE)
