"""Diagnostics and fixes for wrong strings, values, units and characters: what was probably meant.

One invariant: it looks only at the text around a place; the caller knows what is wrong there.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final

from btq_lang.catalog.units import nearest_units
from btq_lang.catalog.verbs import measured
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.syntax.composed_times import composed_time
from btq_lang.syntax.scan import line_end, line_start, number_end
from btq_lang.syntax.tree import quote
from btq_lang.util.text import Span


def close_string(text: str, start: int) -> Fix:
    """Close the string that begins at `start` on its line, before what is probably not part of it."""
    end = line_end(text, start)
    end_of_string = start + 1 + len(text[start + 1 : end].rstrip(" \t,"))
    other = "'" if text[start] == '"' else '"'
    if mixed := re.compile(rf"[^\s{other}]+({other})(?=\s*$|\s*[),]|\s+[^\W\d]\w*\s*=)").match(text, start + 1, end):
        closed = text[start] + text[start + 1 : mixed.start(1)] + text[start]
        return write_fix(closed, Span(start, mixed.end(1)))
    depth = 0
    for offset in range(start + 1, end_of_string):
        depth += (text[offset] == "(") - (text[offset] == ")")
        if depth < 0:  # it closes brackets that were opened before the string
            end_of_string = start + 1 + len(text[start + 1 : offset].rstrip(" \t,"))
            break
    return replace_fix(f"Close it with {text[start]}", Span(end_of_string, end_of_string), text[start])


def value_meant(text: str, start: int, end: int, *, safe: bool) -> Fix:
    """The fix for a word that is not a value, probably meant as an entry, a number without its sign, or a text.

    Args:
        safe: whether a text is allowed there, and nothing else is wrong.
    """
    word = text[start:end]
    if word[0] == "@":
        return replace_fix(f"Write the entry `{{{word}}}`", Span(start, end), f"{{{word}}}")
    if word[0] == "+" and word[1:2].isdecimal() and number_end(word, 1) == len(word):
        return replace_fix(f"Write `{word[1:]}`", Span(start, start + 1), "", safe=safe)
    return replace_fix("Put quotes around it", Span(start, end), quote(word), safe=safe)


def unknown_unit(text: str, start: int, end: int) -> Diagnostic:
    """An unknown unit; the fixes replace it by what was probably meant."""
    word = text[start:end]
    glued = start > 0 and text[start - 1].isdigit()
    wanted = measured(_WORD.findall(text[line_start(text, 0, start) : start]))
    is_time = wanted == "s" or (not wanted and _TWO_UNITS.fullmatch(word) is not None)
    if glued and is_time and (number := _NUMBER_BEFORE.search(text, line_start(text, 0, start), start)):
        composed = composed_time(text, number.start())
        if composed is not None:
            return composed
    symbols = _nearest_units(word, wanted)
    fixes = tuple(
        replace_fix(f"Replace `{word}` with `{symbol}`", Span(start, end), f" {symbol}" if glued else symbol)
        for symbol in symbols
    )
    notes: tuple[str, ...] = ()
    if wanted == "s" and not symbols:
        notes = ("expected a unit of time: ms, s, min, h",)
    elif glued and (not symbols or word[:1].isupper()):
        notes = ("a name that begins with a digit goes in quotes",)
    message = f"unknown unit `{word}`" + (f"; did you mean `{symbols[0]}`?" if symbols else "")
    return Diagnostic("unknown-unit", Span(start, end), message, notes=notes, fixes=fixes)


def unknown_escapes(start: int, raw: str) -> tuple[Diagnostic, ...]:
    """At most one hint, for the whole string; its fix mends all escapes.

    Args:
        start: where the string begins.
        raw: its source, quotes included.
    """
    unknown = [escape for escape in _ESCAPE.finditer(raw) if escape[1] not in "\"'\\nt"]
    if not unknown:
        return ()
    shown = unknown[0][0] if unknown[0][0].isprintable() else "\\"
    places = [start + escape.start() for escape in unknown]
    fix = Fix("Write `\\\\`", tuple(FixEdit(Place(Span(offset, offset + 1)), "\\\\") for offset in places), safe=True)
    message = f"unknown escape `{shown}`; the backslash is kept"
    notes = ("the escapes are \\\" \\' \\\\ \\n and \\t",)
    span = Span(places[0], places[0] + len(shown))
    return (Diagnostic("unknown-escape", span, message, notes=notes, fixes=(fix,)),)


def no_token(text: str, start: int, end: int, *, of_signal: bool) -> Diagnostic:
    """An invalid character, once or repeated.

    Args:
        of_signal: whether it is in the line of a signal.
    """
    character = text[start]
    instead = _NO_END_SIGN if character == ";" else INSTEAD.get(character)
    instead = _UNITS_OF_SIGNALS if character == "[" and of_signal else instead
    fixes = _look_alikes(text, start)
    if character == "[" and not of_signal:
        instead, fixes = _square_brackets(text, start)
    notes = (instead,) if instead is not None else ()
    shown = repr(character) if not character.isprintable() or character.isspace() else f"`{character}`"
    return Diagnostic("syntax-error", Span(start, end), f"unexpected {shown}", notes=notes, fixes=fixes)


def _square_brackets(text: str, start: int) -> tuple[str, tuple[Fix, ...]]:
    """The probable meaning of square brackets, and the fix: attributes, a list of requirements, or children."""
    closing = text.find("]", start, line_end(text, start))
    if closing < 0:
        return ATTRIBUTES, ()
    ends = Span(start, start + 1), Span(closing, closing + 1)
    before = text[line_start(text, 0, start) : start].rstrip()
    if "=" in text[start:closing]:
        changes = tuple(FixEdit(Place(end), sign) for end, sign in zip(ends, "()", strict=True))
        is_whole = _SQUARE_ATTRIBUTES.match(text, start) is not None and "(" not in before
        return ATTRIBUTES, (Fix("Write `(` and `)`", changes, safe=is_whole),)
    if before.endswith(("satisfies", "satisfices", "tags")):
        changes = tuple(FixEdit(Place(end), "") for end in ends)
        is_whole = _SQUARE_LIST.match(text, start) is not None
        return "a list needs no brackets", (Fix("Remove the brackets", changes, safe=is_whole),)
    return CHILDREN, ()


def attributes_in_braces(text: str, start: int) -> Fix | None:
    """The fix for `{key = value}` or `{key: value}` instead of `(key = value)`, on one line."""
    match = _BRACED_ATTRIBUTES.match(text, start)
    if match is None:
        return None
    ends = Span(start, start + 1), Span(match.end() - 1, match.end())
    changes = [FixEdit(Place(end), sign) for end, sign in zip(ends, "()", strict=True)]
    for key in re.finditer(_KEY_OR_TEXT, match[0]):
        if key[2] is not None:
            changes.append(FixEdit(Place(Span(start + key.start(), start + key.end())), f"{key[2]} = "))
    is_whole = _REST.match(text, match.end()) is not None and "(" not in text[line_start(text, 0, start) : start]
    return Fix("Write `(` and `)`", tuple(changes), safe=is_whole)


def are_plain_pairs(text: str) -> bool:
    """Whether a text is nothing but `key = value`, once or several times, with values that can be nothing else."""
    return _PLAIN_PAIRS.fullmatch(text) is not None


def _look_alikes(text: str, start: int) -> tuple[Fix, ...]:
    """The fix for look-alike characters, all of those in the line: `≤`, `“`, a no-break space."""
    if text[start] == "°":
        degrees = "degC" if text[start + 1 : start + 2] == "C" else "deg"
        return (write_fix(degrees, Span(start, start + len(degrees) // 2)),)
    from unicodedata import normalize  # few files need it

    is_quote = text[start] in _OTHER_QUOTES
    changes: list[FixEdit] = []
    for offset in range(start, line_end(text, start)):
        character = text[offset]
        in_text = is_quote and len(changes) % 2 == 1
        if (not is_quote and character in "\"'") or (not in_text and text.startswith(("#", "//", "/*"), offset)):
            break  # texts and comments may contain any character
        plain = _LOOKS_LIKE.get(character) or normalize("NFKC", character)
        if plain != character and plain.isascii() and (character in _OTHER_QUOTES) == is_quote:
            changes.append(FixEdit(Place(Span(offset, offset + 1)), plain))
    return (Fix("Write plain characters", tuple(changes)),) if changes else ()


_WORD: Final = re.compile(r"\w+|,")
_PAIR: Final = r"""[^\W\d][\w-]*[ \t]*=[ \t]*(?:[\w.-]+|"[^"\r\n]*"|\{\w+\})"""
_PAIRS: Final = rf"{_PAIR}(?:(?:[ \t]*,[ \t]*|[ \t]+){_PAIR})*"
_PLAIN_PAIRS: Final = re.compile(_PAIRS)
_SQUARE_ATTRIBUTES: Final = re.compile(rf"\[[ \t]*{_PAIRS}[ \t]*\][ \t]*(?=#|[\r\n]|\Z|satisf|tags\b)")
_SQUARE_LIST: Final = re.compile(r"\[[ \t]*\w+(?:[ \t]*,[ \t]*\w+)*[ \t]*\][ \t]*(?=#|[\r\n]|\Z)")
_REST: Final = re.compile(r"[ \t]*(?=#|[\r\n]|\Z|satisf|tags\b)")
_BRACED_ATTRIBUTES: Final = re.compile(
    r"""\{[ \t]*"?[\w-]+"?[ \t]*(?:=|:[ \t]*(?=[^ \t}]))(?:[^{}"'\r\n]|"[^"\r\n]*"|'[^'\r\n]*'|\{[^{}"'\r\n]*\})*\}"""
)
_KEY_OR_TEXT: Final = r"""(?P<quote>"?)([^\W\d][\w-]*)(?P=quote)[ \t]*:[ \t]*|"[^"\r\n]*"|'[^'\r\n]*'"""  # of JSON
_nearest_units: Final = lru_cache(256)(nearest_units)  # the same mistake is often repeated
_NUMBER_BEFORE: Final = re.compile(r"(?<![\w.])\d+\Z")
_TWO_UNITS: Final = re.compile(r"[^\W\d_]+\d+[^\W\d_]+")
_ESCAPE: Final = re.compile(r"(?s)\\(.)")
_OTHER_QUOTES: Final = "“”„‟«»‘’"
_LOOKS_LIKE: Final = {
    **{"≤": "<=", "≥": ">=", "≠": "!=", "−": "-", "–": "-", "×": "*", "·": "*", "÷": "/"},
    **dict.fromkeys("“”„‟«»", '"'),
    **dict.fromkeys("‘’", "'"),
}
CHILDREN: Final = "children go on lines of their own below their parent, indented"
ATTRIBUTES: Final = "attributes go in round brackets: `(key = value)`"
_NO_END_SIGN: Final = "a line needs no sign at its end; comments begin with `#`"
_UNITS_OF_SIGNALS: Final = "a signal's unit goes after `:`: `signal distance : m`"
# What to write instead of characters that cannot be part of a value either.
INSTEAD: Final = {
    "&": "write `and`",
    "|": "write `or`; `||` is the symbol of Parallel",
    **dict.fromkeys(_OTHER_QUOTES, "strings go in straight quotes"),
    "\xa0": "this is a no-break space: use an ordinary space",
    "\ufeff": "a byte order mark belongs at the start of a file",
}
