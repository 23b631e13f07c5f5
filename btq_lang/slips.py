"""What was probably meant by a string, value or unit that is wrong, as diagnostics and fixes.

One invariant: it looks at the text around a place and nothing else: who asks knows what is wrong there.
"""

from __future__ import annotations

from functools import lru_cache

from btq_lang.diagnostics import Diagnostic, Fix, replace_fix
from btq_lang.scan import line_end, number_end
from btq_lang.syntax import quote
from btq_lang.text import Span
from btq_lang.units import nearest_units

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


def close_string(text: str, start: int) -> Fix:
    """Close the string that begins at `start` on its line, before what is probably no part of it."""
    end = line_end(text, start)
    said = start + 1 + len(text[start + 1 : end].rstrip(" \t,"))
    depth = 0
    for at in range(start + 1, said):
        depth += (text[at] == "(") - (text[at] == ")")
        if depth < 0:  # it closes brackets that were opened before the string
            said = start + 1 + len(text[start + 1 : at].rstrip(" \t,"))
            break
    return replace_fix(f"Close it with {text[start]}", Span(said, said), text[start])


def value_meant(text: str, start: int, end: int, *, safe: bool) -> Fix:
    """What is probably meant by a word that is no value: an entry, a number without its sign, a text.

    Args:
        safe: whether a text may stand there, and nothing else went wrong.
    """
    word = text[start:end]
    if word[0] == "@":
        return replace_fix(f"Write the entry `{{{word}}}`", Span(start, end), f"{{{word}}}")
    if word[0] == "+" and word[1:2].isdecimal() and number_end(word, 1) == len(word):
        return replace_fix(f"Write `{word[1:]}`", Span(start, start + 1), "", safe=safe)
    return replace_fix("Put quotes around it", Span(start, end), quote(word), safe=safe)


def unknown_unit(text: str, start: int, end: int) -> Diagnostic:
    """What stands there is no unit; the fixes replace it by what was probably meant."""
    word = text[start:end]
    glued = start > 0 and text[start - 1].isdigit()
    symbols = _nearest_units(word)
    fixes = tuple(
        replace_fix(f"Replace `{word}` by `{symbol}`", Span(start, end), f" {symbol}" if glued else symbol)
        for symbol in symbols
    )
    notes = (
        ("a name that begins with a digit is written in quotes",)
        if glued and (not symbols or word[:1].isupper())
        else ()
    )
    message = f"`{word}` is no unit" + (f": did you mean `{symbols[0]}`?" if symbols else "")
    return Diagnostic("unknown-unit", Span(start, end), message, notes=notes, fixes=fixes)


_nearest_units: Final = lru_cache(maxsize=256)(nearest_units)  # the same mistake is often made again
