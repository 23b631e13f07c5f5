"""Changes in words: a headline, and a line for each difference.

One invariant: the words are complete; colour and marks add nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import Final

from btq_lang.diff.changes import Change, Detail
from btq_lang.util.text import counted

SIGNS: Final = {"added": "+", "removed": "-", "moved": ">", "changed": "~", "renamed": "~"}
_CLAUSES: Final = {"requirement": "satisfies", "quality": "satisfices", "tag": "tags"}
_IN_WORDS: Final = ("title", "quality", "attached to", "category", "kind", "tree", "name", "by hand")
_MOST: Final = 3  # names in a list


def headline(change: Change, shown: Callable[[str], str] = str) -> tuple[str, str, str]:
    """The thing, its name, and what happened to it; `shown`: renders the names in that."""
    if change.what == "renamed":
        return change.thing, change.earlier or "", f"renamed to {shown(change.name)}"
    words: list[str] = [change.what]
    if change.below:
        words.append(f"with {counted(change.below, 'node')} below")
    if change.around:
        words.append(f"{'around' if change.what == 'added' else 'from around'} {shown(_row(change.around))}")
    if change.what == "moved" and change.earlier is not None and change.earlier != change.name:
        words.append(f"from {shown(change.earlier)}")
    return change.thing, change.name.removeprefix("apply ") if change.thing == "apply" else change.name, " ".join(words)


def lines(change: Change) -> Iterator[tuple[str, str]]:
    """The differences, each with its sign: `+`, `-` or `~`."""
    for detail in change.details:
        yield from _lines(change, detail)


def summary(changes: Iterable[Change]) -> str:
    """`2 requirements changed, 1 node added`."""
    counts = Counter((change.thing, change.what) for change in changes)
    return ", ".join(f"{number} {_plural(thing, number)} {what}" for (thing, what), number in counts.items())


def _lines(change: Change, detail: Detail) -> Iterator[tuple[str, str]]:
    kind, _, name = detail.aspect.partition(" ")
    sides = [(sign, text) for sign, text in (("-", detail.old), ("+", detail.new)) if text is not None]
    if change.thing in ("node", "tree") and kind in _CLAUSES and name:
        for sign, text in sides:
            yield sign, f"{_CLAUSES[kind]} {name}{f'({text})' if text not in ('', 'attached') else ''}"
    elif kind == "port" or (
        change.thing in ("requirement", "hazard", "scenario") and detail.aspect not in _IN_WORDS
    ):  # they are whole lines
        yield from ((sign, text or detail.aspect) for sign, text in sides)
    elif detail.aspect in _IN_WORDS or (detail.old is not None and detail.new is not None):
        sign = sides[0][0] if len(sides) == 1 else "~"
        yield sign, f"{detail.aspect}: {' -> '.join(text for _, text in sides)}"
    else:
        ((sign, text),) = sides
        yield sign, f"{detail.aspect} = {text}" if text else detail.aspect


def _row(names: tuple[str, ...]) -> str:
    more = f" and {len(names) - _MOST} more" if len(names) > _MOST else ""
    return ", ".join(names[:_MOST]) + more


def _plural(thing: str, number: int) -> str:
    if number == 1 or thing in ("xml", "apply"):
        return thing
    return "qualities" if thing == "quality" else f"{thing}s"
