"""The part of the parser that reads hazards.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

from typing import Final

from btq_lang.grammar.clauses import parse_because
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.metadata import parse_requirement_id, parse_source, parse_tag, parse_text
from btq_lang.grammar.nodes import no_block
from btq_lang.syntax.tokens import NEWLINE, STRING
from btq_lang.syntax.tree import Hazard, HazardClause, HazardSeverity


def parse_hazard(cursor: Cursor, level: int) -> Hazard:
    """ "hazard" Name [ STRING ] NL [ INDENT { HazardClause NL } DEDENT ]"""
    start = cursor.take().start
    cursor.skip_glued_colon()
    name = parse_requirement_id(cursor, "the hazard's ID")
    cursor.skip_sign(":", "=")
    text = None
    if name is not None and cursor.kind != NEWLINE:
        text = parse_text(cursor, "the hazard's title")
    end = cursor.end_line()
    clauses: list[HazardClause] = []
    while cursor.deeper(level):
        inner = cursor.lexer.level
        cursor.scan()
        clause = parse_hazard_clause(cursor)
        if clause is not None:
            clauses.append(clause)
        end = cursor.end_line()
        no_block(cursor, inner)
    return Hazard(start, end, name, text, tuple(clauses))


def parse_hazard_clause(cursor: Cursor) -> HazardClause | None:
    """Source | Because | Severity"""
    if cursor.at_word("source"):
        return parse_source(cursor)
    if cursor.at_word("because"):
        return parse_because(cursor)
    if cursor.at_word("severity"):
        return parse_severity(cursor)
    notes: tuple[str, ...] = ()
    if cursor.at_word("mitigates"):
        notes = ("a requirement mitigates a hazard: write `mitigates` in the block of the QualityReq",)
    elif cursor.kind == STRING:
        notes = ("a hazard has one title, after its ID",)
    cursor.expected("source, because or severity", notes, cursor.replaced_by(HAZARD_HEADS))
    return None


def parse_severity(cursor: Cursor) -> HazardSeverity:
    """ "severity" Name"""
    start = cursor.take().start
    tag = parse_tag(cursor, "a severity: high, catastrophic, …")
    return HazardSeverity(start, cursor.last_end(), tag)


HAZARD_HEADS: Final = ("source", "because", "severity")
