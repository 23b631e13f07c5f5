"""The appearance of each word: its token type and modifiers, by what it names, or else by its token.

One invariant: an appearance is the end of a semantic token in JSON: the number of its type and a bit for each modifier,
each after a comma.  The legend, which editors get first, gives their meaning.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from btq_lang.catalog.nodes import lookup
from btq_lang.grammar.claim_words import HAPPENINGS, VERB_WORDS
from btq_lang.grammar.clauses import ACTIONS as ON_VIOLATION
from btq_lang.grammar.clauses import AVERAGE, EXPERIMENTS, METHODS, TIME
from btq_lang.grammar.conditions import FUNCTIONS, HEADS, METADATA_HEADS
from btq_lang.grammar.scenario_words import DURATIONS, ORDINALS, RESULTS, STEPS, TIMES, VERDICTS
from btq_lang.ide.legend import MODIFIERS, TYPES
from btq_lang.syntax.tokens import (
    BRACED,
    CATEGORIES,
    COMMENT,
    DIRECTIONS,
    NAME,
    NODE_CLAUSES,
    NUMBER,
    QUANTITY,
    STRING,
    SYMBOL,
)
from btq_lang.workspace.references import What


@lru_cache(2_000)  # most kinds occur in a file many times
def appearance_of_node(name: str, kind: int) -> str:
    """The appearance of a node's kind, by its name and the kind of its token."""
    if kind == SYMBOL:
        return _SIGN
    builtin = lookup(name, kind == STRING)
    if builtin is None:
        return OWN_NODE
    return _ACTION if builtin.category in ("Action", "Condition") else _BUILTIN


def plain_appearance(kind: int, raw: str, before: str) -> str | None:
    """The appearance of a token that names nothing, after another one; None if it has no colour."""
    if kind != NAME:
        return PLAIN.get(kind)
    if before == "=":
        return TEXT
    if raw in KEYWORDS:
        return _KEYWORD
    return _TYPE if before == ":" else None


def _appearance(type_: str, modifier: str | None = None) -> str:
    return f",{TYPES.index(type_)},{1 << MODIFIERS.index(modifier) if modifier is not None else 0}"


_KEYWORD: Final = _appearance("keyword")
_TYPE: Final = _appearance("type")
TEXT: Final = _appearance("string")
PLAIN: Final = {
    COMMENT: _appearance("comment"),
    STRING: TEXT,
    NUMBER: _appearance("number"),
    QUANTITY: _appearance("number"),
    SYMBOL: _appearance("operator"),
    BRACED: _appearance("variable"),
}
_SIGN: Final = _appearance("operator", "defaultLibrary")
_ACTION: Final = _appearance("function", "defaultLibrary")
_BUILTIN: Final = _appearance("type", "defaultLibrary")
OWN_NODE: Final = _appearance("function")
NEW_NODE: Final = _appearance("function", "definition")
STANDARD_QUALITY: Final = _appearance("enumMember", "defaultLibrary")
OWN_QUALITY: Final = _appearance("enumMember")
NEW_QUALITY: Final = _appearance("enumMember", "definition")
VALUE: Final = _appearance("variable", "readonly")
WRITTEN: Final = _appearance("variable", "modification")
_TYPES: Final = {
    What.TREE: "class",
    What.REQUIREMENT: "interface",
    What.HAZARD: "interface",
    What.SIGNAL: "variable",
    What.CONTEXT: "variable",
    What.PARAMETER: "parameter",
    What.PORT: "property",
    What.ATTRIBUTE: "property",
    What.KEY: "variable",
    What.INSTANCE: "label",
    What.TAG: "decorator",
    What.INCLUDE: "string",
    What.QUANTITY: "number",
    What.UNIT: "type",
    What.EDITION: "enumMember",
}
USED: Final = {what: _appearance(type_) for what, type_ in _TYPES.items()}
DEFINED: Final = {what: _appearance(type_, "definition") for what, type_ in _TYPES.items()}
# Every word that the grammar knows by its place; a name that looks like one has the colour of what it names.
KEYWORDS: Final = frozenset(
    {"BehaviorTree", "Root", "include", "signal", "context", "apply", "quality", "qualities", "QualityReq"}
    | {"TreeNodesModel", "xml", "parameters", "metadata", "Quality", "ID", "description", "true", "false"}
    | {"and", "or", "not", "if", "else", "node", "at", "to", "except", "of", "per", "under", "tagged", "within"}
    | {"most", "least", "less", "more", "than", "between", "after", "violation", "probability", "last", "by", "fresh"}
    | {"for", "assuming", "order", TIME, AVERAGE}
    | {"from", "level", "counter", "gauge", "initially", *ON_VIOLATION, *METHODS}
    | CATEGORIES
    | NODE_CLAUSES
    | DIRECTIONS
    | HEADS
    | METADATA_HEADS
    | {"hazard", "severity", "scenario", "verifies", "writes", "then", "times", "finally", "have", "passed", "the"}
    | {"end", "and", "does", *STEPS, *RESULTS, *DURATIONS, *TIMES, *ORDINALS}
    | {word for verdict in VERDICTS for word in verdict}
    | VERB_WORDS
    | HAPPENINGS
    | EXPERIMENTS
    | FUNCTIONS
)
