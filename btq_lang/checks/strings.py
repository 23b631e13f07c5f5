"""Places inside a value: from the text of a STRING back to its source.

One invariant: the characters of a value's text and the pieces of its source correspond one to one and in order, an
escape or a line end of two characters being one piece.
"""

from __future__ import annotations

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, relocated
from btq_lang.syntax.tree import Word, quote
from btq_lang.util.record import replace
from btq_lang.util.text import Edit, Span, apply_edits

_ESCAPED = frozenset("\"'\\nt")


def in_source(word: Word, span: Span) -> Span:
    """The span in the source for a part of a value's text, counted from the value."""
    if not word.quoted:
        return span.shifted(word.start)
    if "\\" not in word.raw and "\r" not in word.raw:
        return span.shifted(word.start + 1)
    starts = _starts(word)
    return Span(starts[span.start], starts[span.end])


def moved(diagnostic: Diagnostic, word: Word) -> Diagnostic:
    """A diagnostic that counts from the start of a value's text, with its fixes, as one of the value."""
    fixes = tuple(Fix(fix.title, _changes(fix.changes, word), fix.safe) for fix in diagnostic.fixes)
    span = in_source(word, diagnostic.span)
    placed = relocated(replace(diagnostic, fixes=()), span, lambda place: Place(in_source(word, place.span)))
    return replace(placed, fixes=fixes)


def _changes(changes: tuple[FixEdit, ...], word: Word) -> tuple[FixEdit, ...]:
    """In a STRING each change in its place; another value needs quotes once it changes."""
    if word.quoted:
        sign = word.raw[0]
        return tuple(
            FixEdit(Place(in_source(word, change.place.span)), _escaped(change.text, sign)) for change in changes
        )
    text = apply_edits(word.text, (Edit(change.place.span, change.text) for change in changes))
    return (FixEdit(Place(word.span), quote(text)),)


def _escaped(text: str, sign: str) -> str:
    return text.replace("\\", "\\\\").replace(sign, f"\\{sign}").replace("\t", "\\t")


def _starts(word: Word) -> list[int]:
    """Where each character of the text begins in the source, and where the last one ends."""
    raw = word.raw
    starts = []
    offset = 1
    for _ in word.text:
        starts.append(word.start + offset)
        pair = raw[offset : offset + 2]
        offset += 2 if pair == "\r\n" or (pair[:1] == "\\" and pair[1:] and pair[1] in _ESCAPED) else 1
    return [*starts, word.start + offset]
