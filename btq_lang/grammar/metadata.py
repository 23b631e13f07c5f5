"""The part of the parser that reads the clauses that demand nothing: where a requirement is from, what it refines and
mitigates, how important it is, and who has approved it.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

from typing import Final

from btq_lang.diagnostics.model import Fix, replace_fix
from btq_lang.grammar.claim_words import VERB_WORDS
from btq_lang.grammar.conditions import HEADS, METADATA_HEADS
from btq_lang.grammar.cursor import Cursor
from btq_lang.syntax.scan import line_end, path_end
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, NODE_CLAUSES, NUMBER, QUANTITY, STRING
from btq_lang.syntax.tree import Approval, Clause, Mitigates, Priority, Refines, Source, Word, quote
from btq_lang.util.text import Span


def begins_metadata(cursor: Cursor) -> bool:
    """Whether the current word of `METADATA_HEADS`, at the start of a clause, begins one of its own; else it is the
    subject of a claim.
    """
    following = cursor.index + 1
    if cursor.kinds[following] == NAME:
        return cursor.raws[following] not in VERB_WORDS
    return cursor.kinds[following] in _VALUES or cursor.raws[following] in (":", "=")


def is_metadata(cursor: Cursor) -> bool:
    """Whether the current word begins such a clause where a title without quotes may be meant."""
    following = cursor.index + 1
    if cursor.raw not in METADATA_HEADS or not begins_metadata(cursor):
        return False
    if cursor.raw == "source":
        return cursor.kinds[following] == STRING
    if cursor.raw == "approved":
        return cursor.raws[following] == "by"
    if cursor.kinds[following] == NEWLINE:
        return False
    after = following + 1
    return cursor.kinds[after] in (NEWLINE, CLOSE) or cursor.raws[after] == "," or cursor.raws[after] in _BEGINNINGS


def parse_metadata(cursor: Cursor) -> Clause:
    """Source | Refines | Mitigates | Priority | Approval"""
    word = cursor.raw
    if word == "source":
        return parse_source(cursor)
    if word == "refines":
        return parse_refines(cursor)
    if word == "mitigates":
        return parse_mitigates(cursor)
    if word == "priority":
        return parse_priority(cursor)
    return parse_approval(cursor)


def parse_source(cursor: Cursor) -> Source:
    """ "source" STRING"""
    start = cursor.take().start
    text = parse_text(cursor, "the source")
    return Source(start, cursor.last_end(), text)


def parse_refines(cursor: Cursor) -> Refines:
    """ "refines" Name { "," Name }"""
    start, names = _ids(cursor, "the ID of a requirement")
    return Refines(start, cursor.last_end(), names)


def parse_mitigates(cursor: Cursor) -> Mitigates:
    """ "mitigates" Name { "," Name }"""
    start, names = _ids(cursor, "the ID of a hazard")
    return Mitigates(start, cursor.last_end(), names)


def _ids(cursor: Cursor, meant: str) -> tuple[int, tuple[Word, ...]]:
    """Where a clause begins, and the IDs after its word."""
    start = cursor.take().start
    cursor.skip_sign(":", "=")
    return start, cursor.listed(lambda cursor: parse_requirement_id(cursor, meant), list_goes_on)


def parse_priority(cursor: Cursor) -> Priority:
    """ "priority" Name"""
    start = cursor.take().start
    tag = parse_tag(cursor, "a priority: high, must, …")
    return Priority(start, cursor.last_end(), tag)


def parse_approval(cursor: Cursor) -> Approval:
    """ "approved" "by" STRING "on" STRING [ "of" STRING ]"""
    start = cursor.take().start
    cursor.skip_sign(":", "=")
    by = on = of = None
    if cursor.expect_word("by", forgotten=cursor.kind == STRING):
        by = parse_text(cursor, "a name", " on ")
    if by is not None and cursor.expect_word("on", forgotten=cursor.kind == STRING):
        on = parse_text(cursor, "the date", " of ")
    if on is not None and cursor.accept_word("of"):
        of = parse_text(cursor, "the fingerprint, which `btq approve` writes,")
    return Approval(start, cursor.last_end(), by, on, of)


def parse_text(cursor: Cursor, what: str, until: str = " #") -> Word | None:
    """STRING; one without quotes is reported, as it is up to `until`"""
    cursor.skip_sign(":", "=")
    if cursor.kind == STRING:
        return cursor.take()
    begin = cursor.here().start
    rest = cursor.text[begin : line_end(cursor.text, begin)].partition(" #")[0].partition(until)[0].rstrip()
    fix = replace_fix("Put quotes around it", Span(begin, begin + len(rest)), quote(rest))
    cursor.expected(f"{what} in quotes", (), (fix,) if rest and not cursor.group else ())
    return None


def parse_tag(cursor: Cursor, what: str) -> Word | None:
    """Name"""
    cursor.skip_sign(":", "=")
    if cursor.kind == NAME or cursor.kind == STRING:
        return cursor.take()
    fixes: tuple[Fix, ...] = (cursor.put_in_quotes(),) if cursor.kind == NUMBER else ()
    cursor.expected(what, (), fixes)
    return None


def parse_requirement_id(cursor: Cursor, what: str) -> Word | None:
    """Name; `REQ.001`, `1.2` and `4711` are accepted, and reported to need quotes"""
    start = cursor.start()
    first = cursor.starts[cursor.index]
    if cursor.kind in (NUMBER, QUANTITY):
        end = max(path_end(cursor.text, first), first + len(cursor.raw))
    elif cursor.kind == NAME and cursor.is_operator(cursor.index + 1, ".") and cursor.adjacent(cursor.index + 1):
        end = path_end(cursor.text, first)
    else:
        return cursor.name(what)
    text = cursor.text[first:end].rstrip(",:")
    fix = replace_fix("Put quotes around it", Span(first, first + len(text)), quote(text), safe=True)
    cursor.complain(Span(first, first + len(text)), "this ID needs quotes", fix)
    while cursor.kind != NEWLINE and cursor.starts[cursor.index] < first + len(text):
        cursor.advance()
    return Word(NAME, start, text)


# ---- what productions ask and report ----


def list_goes_on(cursor: Cursor) -> bool:
    """Skip the comma of a list in a clause, or report and skip `and`; in brackets and after `satisfies` a comma belongs
    to the list of requirements.
    """
    return not cursor.lists_requirements() and (cursor.accept_and() or cursor.accept(","))


_VALUES: Final = frozenset((STRING, NUMBER, QUANTITY, NEWLINE))
_BEGINNINGS: Final = VERB_WORDS | HEADS | METADATA_HEADS | NODE_CLAUSES | {"QualityReq"}
