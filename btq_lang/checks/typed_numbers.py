"""Numbers that SubTrees of XML give to ports of other types of numbers, or that are defaults of these ports.

One invariant: only known types are compared; `btq build` spells numbers as the nodes below read them, so only XML has
such ones.  Source: instantiateTreeFromXML in src/xml_parsing.cpp of 4.9.1 and 4.10.0.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.versions import TYPED_CONSTANTS
from btq_lang.checks import lookups
from btq_lang.checks.pointers import remaps_all
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Model, Word, written
from btq_lang.workspace.port_types import is_text


def number_of_another_type(view: View) -> Iterator[Diagnostic]:
    """A number that a SubTree gives to a port, where a node below expects one of another type."""
    if not view.is_xml or not TYPED_CONSTANTS.holds(view.target):
        return
    for seen in view.seen.subtrees:
        for pair in seen.node.attributes if seen.id is not None else ():
            if seen.id is not None and pair.value is not None:
                yield from _refused(view, seen.id.text, pair.key.text, pair.value)


def default_of_another_type(view: View) -> Iterator[Diagnostic]:
    """A number that is the default of a port in the model of a tree, as above, if a SubTree gives the port no value."""
    if not view.is_xml or not TYPED_CONSTANTS.holds(view.target):
        return
    for owner in view.owners:
        if owner.name is None or not isinstance(owner, Model) or owner.category.raw != "SubTree":
            continue
        for port in owner.ports:
            if port.id is not None and port.initial is not None:
                refused = tuple(_refused(view, owner.name.text, port.id.text, port.initial))
                yield from refused if refused and _is_left_out(view, owner.name.text, port.id.text) else ()


def _is_left_out(view: View, tree: str, port: str) -> bool:
    from btq_lang.requirements.nodes import callers  # few files have such a default

    runs = callers(view.store, view.path, tree)
    return any(resolved.node.attribute(port) is None and not remaps_all(resolved) for resolved in runs)


def _refused(view: View, tree: str, port: str, value: Word) -> Iterator[Diagnostic]:
    """The diagnostic if the value of a port of a tree is a number of another type than a node below expects."""
    if not _NUMBER(value.text) or not is_port_name(port):
        return
    met = view.ask(lookups.types_below, tree, port, view.target)
    if any(is_text(plain_type(type_)) for *_, type_ in met):
        return  # which number-for-text reports
    others = [each for each in met if is_known_type(plain_type(each[3]))]
    others = [each for each in others if plain_type(each[3]) != _type(value.text)]
    if others:
        yield _diagnostic(view, value, others[0], {plain_type(type_) for *_, type_ in met})


def _diagnostic(view: View, value: Word, other: tuple[Place, str, str, str], types: set[str]) -> Diagnostic:
    from btq_lang.btcpp.constants import fitting  # few files have such a number

    place, name, node, type_ = other
    number = value.text
    message = (
        f"BehaviorTree.CPP {TYPED_CONSTANTS.since} and later refuse to load this tree: `{number}` is of the type "
        f"{_type(number)}, `{name}` of `{node}` of {type_}"
    )
    fit = fitting(tuple(sorted(types)), number)
    notes = (
        f"write `{fit}`: with a blank at its end it stays a text, which the node reads as the number",
    ) * fit.endswith(" ")
    fixes = (replace_fix(f"Write `{fit}`", value.span, fit if _NUMBER(fit) else written(fit)),) if fit != number else ()
    # A project that does not name its engine may have an earlier one.
    severity = None if view.project.pinned else Severity.HINT
    related = (Related(place, f"read here as {type_}"),)
    return Diagnostic("entry-with-two-types", value.span, message, related, notes, fixes, severity=severity)


def _type(number: str) -> str:
    """The type that the engine gives to a number."""
    if not number.lstrip("-").isdigit():
        return "double"
    whole = int(number)
    return "int" if -(2**31) <= whole < 2**31 else "long" if -(2**63) <= whole < 2**63 else "double"


_NUMBER: Final = re.compile(r"-?(?:[0-9]{1,30}\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?").fullmatch
