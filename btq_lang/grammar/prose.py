"""Clauses in the words of other notations: `must finish within 30 s`, `speed shall stay below 1 m/s`.

One invariant: it looks at the words of a line, and the caller at what they are read as.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from btq_lang.catalog.verbs import VERBS
from btq_lang.grammar.conditions import BOUNDS, RELATIONS
from btq_lang.util.spelling import near

MODALS: Final = frozenset(("must", "shall", "should", "will", "may"))


def clause_meant(words: Sequence[str], begin: int, *, is_time: bool) -> tuple[int, str] | None:
    """The words of this notation for those that begin somewhere, and where those end; None if nothing is meant.

    Args:
        words: of a line.
        begin: where the clause begins, perhaps with `must`, after its subject if it has one.
        is_time: whether the line has a time and no other value.
    """
    start = begin + len(modal(words, begin))
    for length in range(4, 0, -1):
        meant = _CLAUSES.get(tuple(word.casefold() for word in words[start : start + length]))
        if meant is not None and (is_time or meant not in _OF_TIMES):
            return start + length, meant
    if words[start] == "be" and words[start + 2 : start + 3] == ["within"] and words[start + 1].endswith(_PARTICIPLES):
        return start + 3, "succeeds within"
    if start == begin or words[start + 1 : start + 2] == ["be"]:
        return None
    if words[start] in VERBS:
        return start, ""
    likely = near(words[start], VERBS, limit=1)
    return (start + 1, likely[0]) if likely else None


def state_meant(words: Sequence[str], begin: int) -> tuple[int, str] | None:
    """The end of the words that compare a signal before them, and the comparison: `must stay below`, `is at least`."""
    start = begin + len(modal(words, begin))
    if words[start] in _STATES:
        start += 1
    elif tuple(words[start : start + 2]) != ("not", "exceed"):
        return None
    for length in range(5, 0, -1):
        meant = BOUNDS.get(tuple(words[start : start + length]))
        if meant is not None:
            return start + length, RELATIONS[meant]
    return (start + 2, "<=") if words[start + 1 : start + 2] == ["exceed"] else None


def modal(words: Sequence[str], begin: int) -> tuple[str, ...]:
    """The words like `must` that begin somewhere."""
    if words[begin].casefold() in MODALS:
        return (words[begin],)
    return tuple(words[begin : begin + 2]) if tuple(words[begin : begin + 2]) in _TWO_MODALS else ()


_TWO_MODALS: Final = (("has", "to"), ("have", "to"), ("ought", "to"), ("needs", "to"))
_PARTICIPLES: Final = ("ed", "done", "over", "ready", "there")
_STATES: Final = frozenset(("be", "stay", "stays", "remain", "remains", "is", "keep"))
_CLAUSES: Final[dict[tuple[str, ...], str]] = {
    **{
        (f"{verb}{ending}", preposition): "succeeds within"
        for verb in ("arrive", "respond")
        for ending in ("", "s", "es", "d", "ed")
        for preposition in ("within", "in")
    },
    **dict.fromkeys(
        (("not", "exceed"), ("not", "take", "more", "than"), ("not", "take", "longer", "than")), "takes at most"
    ),
    **dict.fromkeys((("not", "fail"), ("always", "succeed"), ("complete", "successfully")), "succeeds"),
    **dict.fromkeys((("last",), ("lasts",)), "takes"),
}
_OF_TIMES: Final = ("takes at most", "takes", "succeeds within")
