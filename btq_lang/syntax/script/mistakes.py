"""The diagnostics for scripts that the newest engine refuses, or loads but fails to run.

One invariant: a safe fix mends its mistake and adds no other.  `tokens` and `parser` detect mistakes; what there
is to say about one is here, unless it is a single sentence.
"""

from __future__ import annotations

from typing import Final

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix
from btq_lang.util.text import Span

# Spellings of other languages, of XML and of typeset text, and what they mean here.
MEANT: Final = {
    "=>": ">=",
    "=<": "<=",
    "<>": "!=",
    "===": "==",
    "!==": "!=",
    "and": "&&",
    "or": "||",
    "not": "!",
    "&lt;": "<",
    "&gt;": ">",
    "&lt;=": "<=",
    "&gt;=": ">=",
    "&amp;": "&",
    "&amp;&amp;": "&&",
    "≤": "<=",
    "≥": ">=",
    "≠": "!=",
    "∧": "&&",
    "∨": "||",
    "¬": "!",
    "×": "*",
    "÷": "/",
    "−": "-",
}

# What has no counterpart here, and what to do instead.
_NO_SUCH: Final = {
    "**": "scripts have no power operator; multiply instead",
    "//": "scripts have neither comments nor integer division; `/` divides",
    "<<": "scripts have no shifts; multiply by a power of two",
    ">>": "scripts have no shifts; divide by a power of two",
    "%": "scripts have no remainder operator",
    ",": "unexpected `,` in a script; statements are separated by `;`, and the decimal sign is `.`",
    ".": "unexpected `.`: only numbers contain it, `..` joins strings, and names of entries have none",
    "[": "scripts have no lists",
    "]": "scripts have no lists",
    "{": "braces belong to ports; in a script, write the entry without them",
    "}": "braces belong to ports; in a script, write the entry without them",
    "$": "in a script, write the entry without `$`",
    "#": "scripts have no comments",
    "@": "`@` must be followed at once by the name of an entry of the root blackboard",
    "'": "missing closing quote for this string",
    '"': "missing closing quote for this string; strings in scripts go in single quotes: '…'",
    "not": "`not` is written `!` in a script, which binds more tightly: put what it negates in brackets, `!(a == b)`",
    "\\": "scripts have no escapes; a string may contain anything but a single quote",
}

_OPERATOR_CHARACTERS: Final = frozenset("=<>!&|*/+-:.")
_POSTFIX: Final = {"+": "`x += 1`", "-": "`x -= 1`"}


def error(span: Span, message: str, *fixes: Fix, notes: tuple[str, ...] = ()) -> Diagnostic:
    return Diagnostic("script-error", span, message, notes=notes, fixes=fixes)


def empty(text: str) -> Diagnostic:
    message = "empty script: the engine refuses it, or fails when it ticks the node"
    return Diagnostic("empty-script", Span(0, len(text)), message)


# ---- tokens ----


def misspelt(text: str, span: Span) -> Diagnostic:
    """A spelling of `MEANT`, or a `not` with the blanks after it."""
    raw = text[span.start : span.end].rstrip()
    meant = MEANT[raw.lower()]
    # Insert a blank next to another operator, so that the two do not become one.
    before = " " if text[span.start - 1 : span.start] in _OPERATOR_CHARACTERS else ""
    after = " " if text[span.end : span.end + 1] in _OPERATOR_CHARACTERS else ""
    return error(span, f"`{raw}` is written `{meant}` in a script", _write(meant, span, before, after))


def wrong_quotes(span: Span, content: str) -> Diagnostic:
    message = "strings in scripts go in single quotes: '…'"
    if "'" in content:
        return error(span, f"{message}; a string cannot contain a single quote")
    if "\n" in content or "\r" in content:  # perhaps the quotes of the attribute are missing
        return error(span, message)
    return error(span, message, _write(f"'{content}'", span))


def braced(text: str, span: Span, name: str) -> Diagnostic:
    message = f"in a script, write the entry without braces: `{name}`"
    beside = text[span.start - 1 : span.start] + text[span.end : span.end + 1]
    if any(
        character.isalnum() or character in "_@{}." for character in beside
    ):  # without the braces they would join the word
        return error(span, message)
    return error(span, message, _write(name, span))


def foreign_name(span: Span, name: str) -> Diagnostic:
    return error(span, f"invalid name `{name}`: names in scripts contain only the letters A to Z, digits and `_`")


def number(span: Span, raw: str, meant: str | None) -> Diagnostic:
    """A number in a form that the engine does not read."""
    if meant is not None:
        return error(span, f"the engine does not read `{raw}` as a number; write `{meant}`", _write(meant, span))
    note = "scripts have no units, and no name begins with a digit"
    return error(span, f"the engine does not read `{raw}` as a number", notes=(note,) if raw[-1].isalpha() else ())


def too_large(span: Span, raw: str) -> Diagnostic:
    hexadecimal = raw[:2] in ("0x", "0X")
    if not hexadecimal and not raw.isdecimal():
        return error(span, f"`{raw}` is too large for a number; the engine refuses it")
    fixes = () if hexadecimal else (replace_fix(f"Write `{raw}.0`", span, f"{raw}.0"),)
    message = f"`{raw}` is too large for a whole number: the newest engine reads it as 0, older ones refuse it"
    return error(span, message, *fixes)


def no_such(text: str, span: Span) -> Diagnostic:
    """An invalid token; an open quote extends to the end of the text."""
    raw = text[span.start : span.end]
    message = _NO_SUCH.get(raw[0] if raw[0] in "'\"" else raw.lower())
    return error(span, message or f"unexpected `{raw}` in a script")


# ---- grammar ----


def missing_operand(text: str, before: Span | None, place: Span) -> Diagnostic:
    """A missing operand at `place`; `before`: the operator that needs it, None at the start of a statement."""
    following = text[place.start : place.end]
    if before is None:
        return error(place, f"missing operand before `{following}`")
    operator = text[before.start : before.end]
    if operator == "(" and following == ")":
        return error(Span(before.start, place.end), "missing expression between the brackets")
    if operator in _POSTFIX and (following == operator or text.endswith(operator, 0, before.start)):
        return error(before, f"scripts have no `{operator}{operator}`; write {_POSTFIX[operator]}")
    what = "right-hand side of" if operator == ":=" else "operand after"
    return error(before, f"missing {what} `{operator}`")


def unary_plus(text: str, span: Span) -> Diagnostic:
    message = "unexpected `+`: numbers in scripts take no sign `+`"
    if text.endswith("=", 0, span.start):  # `x =+ 1` may have meant `x += 1`
        return error(span, message)
    return error(span, message, replace_fix("Remove the `+`", span, "", safe=True))


def unclosed_bracket(text: str, bracket: Span, place: Span) -> Diagnostic:
    if place.start == len(text):
        end = len(text.rstrip())
        return error(bracket, "missing `)` for this `(`", replace_fix("Add the `)`", Span(end, end), ")"))
    if text[place.start] == ";":
        return error(place, "unexpected `;` inside brackets")
    return error(bracket, f"missing `)` before `{text[place.start : place.end]}`")


def not_assignable(operator: Span, is_equals: bool) -> Diagnostic:
    """An assignment to something other than a blackboard entry."""
    message = "only an entry can be assigned to: the engine loads this and fails at the tick"
    if not is_equals:
        return error(operator, message)
    fix = replace_fix("Compare with `==`", operator, "==")
    return error(operator, f"{message}; to compare, write `==`", fix)


def too_deep(span: Span, limit: int) -> Diagnostic:
    return error(span, f"more than {limit} nested operators; use several statements")


def prose(text: str, start: int) -> Diagnostic:
    """Prose instead of a script: words without operators from `start` on."""
    whole = Span(len(text) - len(text.lstrip()), len(text.rstrip()))
    words = " ".join(text[start:].split()[:3])
    note = "since 4.9 the engine may load it and fail at the first tick, when it looks for variables of these names"
    return error(whole, f"this is prose, not a script: `{words} …` has no operator", notes=(note,))


def two_operands(text: str, left: Span, right: Span) -> Diagnostic:
    place, word = Span(left.start, right.end), text[left.start : left.end]
    if word == "if":
        return error(place, "scripts have no `if`; write `condition ? this : that`")
    return error(place, f"missing operator between `{word}` and `{text[right.start : right.end]}`")


def _write(meant: str, span: Span, before: str = "", after: str = "") -> Fix:
    return Fix(f"Write `{meant}`", (FixEdit(Place(span), f"{before}{meant}{after}"),), safe=True)
