"""Questions about what can happen, as they are typed: `PutDown starts before Grasp succeeds`.

One invariant: events, conditions and paths are read by the grammar of the language, entries in conditions as in
scenarios; only the words around them are read here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final, TypeAlias

from btq_lang.grammar.claims import parse_event
from btq_lang.grammar.conditions import parse_cond, parse_path
from btq_lang.grammar.cursor import Cursor
from btq_lang.requirements.entries import key_of, line_of_text
from btq_lang.syntax.tokens import BRACED, CLOSE, NEWLINE, OPEN
from btq_lang.syntax.tree import AnyEvent, Condition, Event, Path, Word
from btq_lang.util.record import Record


class Order(Record):
    """An event, or one before or after another: before means that the other one has not occurred yet.

    Attributes:
        word: before or after; empty: no other event.
    """

    event: Event | AnyEvent
    word: str = ""
    other: Event | AnyEvent | None = None


class Holds(Record):
    """A condition."""

    condition: Condition


class ReadsUnset(Record):
    """`Grasp reads {cup_pose} unset`."""

    path: Path
    key: str


class EndlessRun(Record):
    """`mission does not end`."""


Asked: TypeAlias = Order | Holds | ReadsUnset | EndlessRun


class Question(Record):
    """A question.

    Attributes:
        text: as typed.
        keys: the entries that it names.
    """

    text: str
    asked: Asked
    keys: tuple[str, ...] = ()


class NoQuestion(Exception):
    """A text cannot be read as a question; the message says what is wrong."""


def parse_question(text: str) -> Question:
    """Read a question.

    Raises:
        NoQuestion: the text cannot be read as one.
    """
    if " ".join(text.split()) == "mission does not end":
        return Question(text, EndlessRun())
    cursor = line_of_text(" ".join(text.split()))
    asked = _reads_unset(cursor) or _asked(cursor)
    if cursor.kind != NEWLINE and not cursor.problems:
        cursor.expected("`before`, `after` or the end of the question")
    problems = [*cursor.problems, *cursor.lexer.problems]
    if problems or asked is None:
        raise NoQuestion(_mixed(text) or (f"{problems[0].message}; {_FORMS}" if problems else _FORMS))
    return Question(text, asked, tuple(dict.fromkeys(key_of(word) for word in _entries(cursor))))


def _entries(cursor: Cursor) -> Iterator[Word]:
    cursor.go_to(0)
    while cursor.kind != NEWLINE:
        word = cursor.take()
        if word.kind == BRACED:
            yield word


def _mixed(text: str) -> str:
    """What to say of an event and a condition in one question; empty if it has no such two."""
    event, node = _EVENT_IN_TEXT.search(text), _NODE_IN_TEXT.search(text)
    if event is None or _JOINT.search(text) is None:
        return ""
    return (
        f"an event (`{event[0]}`) cannot be part of a condition; ask for it alone, "
        f"or for what happens after it: `{node[1] if node is not None else 'Pick'} starts after {event[0]}`"
    )


def _reads_unset(cursor: Cursor) -> ReadsUnset | None:
    """ReadsUnset = Path "reads" BRACED "unset" """
    if "reads" not in cursor.raws or cursor.raws[-2:-1] != ["unset"]:
        return None
    path = parse_path(cursor, "a node")
    if path is None or not cursor.expect_word("reads"):
        return None
    if cursor.kind != BRACED:
        cursor.expected("an entry: `{cup_pose}`")
        return None
    key = key_of(cursor.take())
    return ReadsUnset(path, key) if cursor.expect_word("unset") else None


def _asked(cursor: Cursor) -> Asked | None:
    """Order | Cond"""
    if cursor.problems:
        return None
    if not _has_event(cursor):
        condition = parse_cond(cursor)
        return Holds(condition) if condition is not None else None
    event = _event(cursor)
    if event is None:
        return None
    for word in ("before", "after"):
        if cursor.accept_word(word):
            other = _event(cursor)
            return Order(event, word, other) if other is not None else None
    return Order(event)


def _event(cursor: Cursor) -> Event | AnyEvent | None:
    """Event | "(" Event ")"; `or` joins events before `before` joins them, so the brackets may as well be left out."""
    if cursor.kind != OPEN:
        return parse_event(cursor)
    cursor.advance()
    event = parse_event(cursor)
    if event is not None:
        if cursor.kind != CLOSE:
            cursor.expected("`)`")
            return None
        cursor.advance()
    return event


def _has_event(cursor: Cursor) -> bool:
    words = [word for word in cursor.raws if word != "("]
    return words[0] in ("when", "mission") or (words[0] not in ("node", "not") and not _EVENT_WORDS.isdisjoint(words))


_EVENT_WORDS: Final = frozenset(("starts", "succeeds", "fails", "finishes", "halts", "before", "after"))
_EVENT_IN_TEXT: Final = re.compile(r"(?:[\w/]+|'[^']*'|\"[^\"]*\") (?:starts|succeeds|fails|finishes|halts)\b")
_NODE_IN_TEXT: Final = re.compile(r"\bnode ([\w/]+)\b(?! (?:starts|succeeds|fails|finishes|halts)\b)")
_JOINT: Final = re.compile(r"\b(?:and|not|node)\b")
_FORMS: Final = (
    "a question is an event (`Pick starts`), one `before` or `after` another, a condition "
    "(`node Pick and {done} == 1`), `Pick reads {pose} unset` or `mission does not end`"
)
