"""Finds the positions of keys and values in a TOML file: the standard reader gives values only.

It searches line by line, and for a key in an inline table after the key of that table.  Invariant: the result is a
position in the text, or None; it never raises, even for a text that is not TOML.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from btq_lang.util.text import LineIndex, Position

_LONG_STRING = re.compile(r""""{3}.*?"{3}|'{3}.*?'{3}""", re.DOTALL)
_KEY_LINE = re.compile(
    r"""^[ \t]*(?:\[{1,2}([^\[\]\n]+)\]|((?:[\w.\- \t]|"[^"\n]*"|'[^'\n]*')+?)[ \t]*=)""", re.MULTILINE
)
_WORD = re.compile(r"""[\w\-]+|"[^"\n]*"|'[^'\n]*'|[^\r\n]*""")
_NAME = re.compile(r"""[\w\-]+|"[^"]*"|'[^']*'""")


def find_key(text: str, keys: tuple[str, ...], value: str | None = None) -> Position | None:
    """The position of a key, given from the outermost table's name on, or of a string in its value.

    Args:
        keys: `[0]` after the name of a list of tables is the first of them.
    """
    text = _LONG_STRING.sub(lambda string: re.sub(r"[^\n]", " ", string[0]), text)
    place, depth, end = -1, 0, len(text)
    is_numbered = any(key.startswith("[") for key in keys)
    for path, start, stop in _key_lines(text):
        if not is_numbered:
            path = tuple(key for key in path if not key.startswith("["))
        shared = min(len(path), len(keys))
        if path[:shared] == keys[:shared] and shared > depth:
            place, depth, end = start, shared, stop
    if place < 0:
        return None
    words = [
        *(rf"(?<![\w-]){re.escape(key)}(?![\w-])" for key in keys[depth:]),
        *([f"[\"']{re.escape(value)}[\"']"] if value is not None else []),
    ]
    for word in words:
        match = re.compile(word).search(text, place + 1, end)
        place = match.start() if match else place
    return LineIndex(text).position(place)


def word_end(text: str, start: int) -> int:
    """The end of the key or value that begins at an offset; the end of the line if none does."""
    word = _WORD.match(text, start)
    return word.end() if word else start


def _key_lines(text: str) -> Iterator[tuple[tuple[str, ...], int, int]]:
    """The full name in each line that has one, with the number of the table in a list, where it begins, and where the
    next such line begins.
    """
    lines = list(_KEY_LINE.finditer(text))
    table: tuple[str, ...] = ()
    numbers: dict[tuple[str, ...], int] = {}
    for line, following in zip(lines, [*lines[1:], None], strict=True):
        names = tuple(name.strip("\"'") for name in _NAME.findall(line[1] or line[2]))
        if line[0].lstrip().startswith("[["):
            numbers[names] = numbers.get(names, -1) + 1
        within = next((size for size in range(1, len(names) + 1) if names[:size] in numbers), 0) if line[1] else 0
        if within:
            names = (*names[:within], f"[{numbers[names[:within]]}]", *names[within:])
        path = names if line[1] else table + names
        table = names if line[1] else table
        yield path, line.start(1 if line[1] else 2), following.start() if following else len(text)
