"""Constants for the ports of subtrees, spelt so that every version of the engine accepts them.

Up to 4.8 the engine keeps the value of a SubTree's port as text, and the node that reads it converts it.  From 4.9.1 on
a text that is a number becomes an `int`, an `int64_t` or a `double`, and loading fails if a node below has another type
on that entry: `level = 30` above a `double`, `limit = 500` above the `msec` of a Timeout.  So a number is spelt as the
type of the node below: `30.0` is a `double`; one with a trailing blank stays text and is still read as the number, for
the engine ignores what follows the digits.  (Tried with 4.6.2, 4.8.4 and 4.10.0.)

If the port is read as numbers of several types, text fits all of them.  If it is read as text, no spelling of a number
stays text in newer engines; the rule `number-for-text` reports that.

One invariant: a value that is not a number, or for which no type is known, does not change.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.syntax.tree import Tree
from btq_lang.workspace.port_types import declared_type, is_number, is_text, meetings
from btq_lang.workspace.workspace import Scope


def fitting(types: tuple[str, ...], raw: str) -> str:
    """A constant for a port of a subtree, spelt so that the nodes below, which read it as these types, accept it."""
    if not types or not is_number(raw) or any(map(is_text, types)):
        return raw
    is_whole = _WHOLE.fullmatch(raw) is not None
    if types == ("double",):
        return f"{raw}.0" if is_whole else raw
    if types == ("int",):
        return raw if is_whole and -_INT <= int(raw) < _INT else f"{raw} "
    if types == ("bool",):
        return _BOOLS.get(raw, raw)
    return f"{raw} " if _NUMBERS.issuperset(types) else raw


def types_below(scope: Scope, target: str, tree: str, port: str) -> tuple[str, ...]:
    """The types as which a port is read in its tree or in those below; if there are none, the declared one."""
    types_met = tuple(dict.fromkeys(meeting.type for meeting in meetings(scope, target, tree, port)))
    definition = scope.find(Kind.TREE, tree)
    if types_met or definition is None or not isinstance(definition.symbol.target, Tree):
        return types_met
    declared = declared_type(definition.symbol.target.ports, port)
    return (declared,) if declared else ()


_INT: Final = 2**31
_WHOLE: Final = re.compile(r"-?[0-9]+")
_BOOLS: Final = {"0": "false", "1": "true"}
_NUMBERS: Final = frozenset(
    (
        *("int", "double", "float", "unsigned int", "unsigned", "long", "unsigned long", "short", "unsigned short"),
        "size_t",
        *(f"{std}{sign}int{bits}_t" for std in ("", "std::") for sign in ("", "u") for bits in (8, 16, 32, 64)),
    )
)
