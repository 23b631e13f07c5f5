"""textX, a PEG on Arpeggio.  It has no off-side rule, so a pass over the text puts block signs in; its time counts."""

from __future__ import annotations

import importlib.metadata
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import textx

VERSION = importlib.metadata.version("textx")

# What decides about blocks: strings and comments are stepped over, brackets counted; then the lines that say something.
_PIECE = re.compile(
    r"""
    (?P<skip> "(?:[^"\\]|\\.)*" | \#[^\n]* | //[^\n]* | /\*.*?\*/ )
    | (?P<bracket> [()] )
    | \n (?P<blanks> [ \t]* ) (?= [^ \t\r\n\#/] )
    """,
    re.VERBOSE | re.DOTALL,
)


def load() -> Callable[[str], object]:
    model = textx.metamodel_from_file(str(Path(__file__).parent / "classic.tx"))

    def parse(text: str) -> object:
        return model.model_from_str(with_block_signs(text))

    return parse


def with_block_signs(text: str) -> str:
    """The text with ⟦ and ⟧ where indentation opens and closes blocks."""
    pieces: list[str] = []
    columns = [0]
    done = brackets = 0
    for piece in _PIECE.finditer(text):
        if piece["bracket"]:
            brackets += 1 if piece["bracket"] == "(" else -1
        elif piece["skip"] is None and not brackets:
            column = len(piece["blanks"])
            if column == columns[-1]:
                continue
            signs = ""
            if column > columns[-1]:
                columns.append(column)
                signs = "⟦"
            while column < columns[-1]:
                columns.pop()
                signs += "⟧"
            # In front of the code, not behind the line before: there a comment may stand.
            pieces += (text[done : piece.end()], signs)
            done = piece.end()
    pieces += (text[done:], "⟧" * (len(columns) - 1))
    return "".join(pieces)


def count(model: Any) -> int:
    stack = [tree.top for tree in model.trees]
    nodes = 0
    while stack:
        nodes += 1
        stack += stack.pop().children
    return nodes
