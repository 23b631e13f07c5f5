"""The entries that C++ sets on a blackboard, from the text alone: any function of a program may do it.

One invariant: a name counts only if a string has it, at `set` or at a function that gives its first parameter to `set`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from itertools import accumulate
from typing import Final

from btq_lang.util.record import Record


class SetEntries(Record):
    """The entries that sources set.

    Attributes:
        has_unseen: whether they set others, too, whose names are not strings.
    """

    names: frozenset[str]
    has_unseen: bool


def set_entries(sources: Iterable[str]) -> SetEntries:
    """The entries that some sources set, of one program."""
    texts = tuple(sources)
    setters = frozenset[str]().union(*(_setters(text) for text in texts)) - {""}
    set_in_texts = [_named(text, setters) for text in texts]
    has_unseen = any(unseen for _, unseen in set_in_texts) or any("" in _setters(text) for text in texts)
    return SetEntries(frozenset[str]().union(*(names for names, _ in set_in_texts)), has_unseen)


@lru_cache(1_000)  # each file of trees asks for the same sources
def _setters(source: str) -> frozenset[str]:
    """The functions that give their first parameter to `set`; an empty name for each name that is not a string."""
    return frozenset([_setter(source, each.start(), each[1]) for each in _SETS_UNQUOTED(source)])


def _setter(source: str, at: int, name: str) -> str:
    """The function around a place whose first parameter has a name; empty if there is none."""
    around = [
        function[1]
        for function in _FUNCTION.finditer(source, 0, at)
        if function[2] == name and _is_open(source[function.end() : at])
    ]
    return next((each for each in reversed(around) if each not in _STATEMENTS), "")


def _is_open(code: str) -> bool:
    """Whether the block that code begins has not ended."""
    depth = list(accumulate(1 if brace == "{" else -1 for brace in code if brace in "{}"))
    return min(depth, default=0) >= 0


@lru_cache(1_000)
def _named(source: str, setters: frozenset[str]) -> tuple[frozenset[str], bool]:
    """The entries that a source sets, and whether it gives one of some functions a name that is not a string."""
    names = {*_SETS(source)}
    if not setters:
        return frozenset(names), False
    calls = rf"\b(?:{'|'.join(sorted(setters))}){_GIVEN}"
    names.update(re.findall(rf'{calls}"([A-Za-z_][\w.]*)"\s*[,)]', source))
    return frozenset(names), re.search(rf"{calls}[\w.:]+\s*,", source) is not None


_GIVEN: Final = r"\s*(?:<[^;(){}]*>)?\s*\(\s*"
_SETS: Final = re.compile(rf'(?:->|\.)\s*set{_GIVEN}"([A-Za-z_][\w.]*)"\s*,').findall
_SETS_UNQUOTED: Final = re.compile(
    rf"(?:[bB]lackboard|BLACKBOARD|board|bb)\w*(?:\(\))?\s*(?:->|\.)\s*set{_GIVEN}(?!\"[\w.]*\"\s*,)([^\s,;][^,;]*?)\s*,"
).finditer
_FUNCTION: Final = re.compile(r"(\w+)(?:\s*=\s*\[[^\]]*\])?\s*\([^(){};,]*?(\w+)\s*(?:,[^();]*)?\)[^(){};]*\{")
_STATEMENTS: Final = frozenset(("if", "for", "while", "switch", "catch"))
