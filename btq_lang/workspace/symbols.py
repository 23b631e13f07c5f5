"""The names that an item defines and refers to: a summary made from its tree alone.

One invariant: a summary depends only on the item, so it is made once (`references.summarize`) and is valid as long as
the item exists.  Which definition a use refers to is for the workspace.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final, TypeAlias

from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.catalog.name_kinds import Kind
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tokens import NAME
from btq_lang.util.record import Record
from btq_lang.util.text import Span

Target: TypeAlias = (
    syntax.Tree
    | syntax.Model
    | syntax.Requirement
    | syntax.Signal
    | syntax.Context
    | syntax.QualityDecl
    | syntax.Hazard
)


class Symbol(Record):
    """A name that an item defines.

    Attributes:
        span: the name, counted from the item.
        target: what is defined.
    """

    kind: Kind
    name: str
    span: Span
    target: Target


class Use(Record):
    """A name that an item refers to.

    Attributes:
        span: the name, counted from the item.
        node: the node that has it, if any.
    """

    kind: Kind
    name: str
    span: Span
    node: syntax.Node | None = None


class Summary(Record):
    """The symbols and uses of an item, in the order of the text."""

    symbols: tuple[Symbol, ...]
    uses: tuple[Use, ...]


def requirements_at(clauses: tuple[syntax.NodeClause, ...]) -> Iterator[syntax.Requirement | syntax.ReqRef]:
    """The requirements that clauses attach, defined in place or named."""
    for clause in clauses:
        if isinstance(clause, syntax.Satisfies):
            yield from clause.uses
        elif isinstance(clause, syntax.Satisfices):
            for quality in clause.qualities:
                yield from quality.requirements


def asked_for(item: syntax.Item) -> frozenset[str]:
    """The names in an item's conditions, bounds and arguments: those that may be signals or contexts."""
    if isinstance(item, syntax.Context):
        return _words_in(item.condition)
    if isinstance(item, syntax.Requirement):
        return _asked_by(item)
    if isinstance(item, syntax.Apply):
        return _words_in(tuple(use.arguments for use in item.uses))
    if isinstance(item, syntax.Given | syntax.Scenario):
        return _words_in(item)
    if not isinstance(item, syntax.Tree):
        return frozenset()
    attached = [*requirements_at(item.clauses)]
    for node in item.walk():
        if node.clauses:
            attached += requirements_at(node.clauses)
    return frozenset().union(
        *(_asked_by(each) if isinstance(each, syntax.Requirement) else _words_in(each.arguments) for each in attached)
    )


def claiming(summary: Summary) -> frozenset[str]:
    """The requirements that an item defines whose claims may name their own subjects: in clauses, or in a text."""
    requirements = [(symbol.name, symbol.target) for symbol in summary.symbols if symbol.kind is Kind.REQUIREMENT]
    return frozenset(
        [name for name, target in requirements if isinstance(target, syntax.Requirement) and _may_claim(target)]
    )


def _may_claim(requirement: syntax.Requirement) -> bool:
    if requirement.is_text:
        return requirement.text is not None and "if" in requirement.text.text.lower()
    return names_subject(requirement)


def names_subject(item: object) -> bool:
    """Whether it is a requirement with a claim that names its own subject."""
    clauses = item.clauses if isinstance(item, syntax.Requirement) else ()
    return any(isinstance(clause, syntax.Claim) and clause.subject is not None for clause in clauses)


def same_requirement(first: syntax.Requirement, second: syntax.Requirement) -> bool:
    """Whether two definitions are equivalent (docs/language.md): texts compare after folding blanks."""
    return _content(first) == _content(second)


def interface(model: syntax.Model) -> object:
    """The content of a model; equal for equivalent models, which the palettes that tools write repeat."""
    ports = tuple([(port.direction, port.name, port.type, port.default) for port in model.ports])
    return model.category.raw, syntax.shape(ports)


def differences(one: Symbol, other: Symbol) -> Iterator[str]:
    """The differences between two models of a node, as a message names them: its category, or ports by name."""
    first, second = one.target, other.target
    if not (isinstance(first, syntax.Model) and isinstance(second, syntax.Model)):
        return
    if first.category.raw != second.category.raw:
        yield f"the category ({first.category.raw}, {second.category.raw})"
    ports, others = ({port.id.text: port for port in each.ports if port.id is not None} for each in (first, second))
    for name in dict.fromkeys((*ports, *others)):
        if name not in ports or name not in others:
            yield f"the port `{name}`, which only one has"
        elif ports[name].direction.raw != others[name].direction.raw:
            yield f"the direction of `{name}`"
        else:
            if syntax.shape(ports[name].type) != syntax.shape(others[name].type):
                yield f"the type of `{name}`"
            if syntax.shape(ports[name].default) != syntax.shape(others[name].default):
                yield f"the default of `{name}`"


def has_ports_of(one: Symbol, other: Symbol) -> bool:
    """Whether a model has all ports of another, in its directions, and none of a type that is certainly different.

    Tools write types in many ways or not at all, and defaults with or without quotes.
    """
    model, shorter = one.target, other.target
    if not (isinstance(model, syntax.Model) and isinstance(shorter, syntax.Model)):
        return False
    ports = {port.id.text: port for port in model.ports if port.id is not None}
    return model.category.raw == shorter.category.raw and all(
        (own := ports.get(port.id.text)) is not None
        and own.direction.raw == port.direction.raw
        and may_be_one_type(own.type, port.type)
        for port in shorter.ports
        if port.id is not None
    )


def may_be_one_type(one: syntax.Word | None, other: syntax.Word | None) -> bool:
    """Whether two types may be the same one: only those that everyone writes alike certainly differ."""
    types = {
        plain_type(word.text) for word in (one, other) if word is not None and is_known_type(plain_type(word.text))
    }
    return len(types) < 2


def _asked_by(requirement: syntax.Requirement) -> frozenset[str]:
    """The names in a requirement's clauses; without any, its text may hold some after `FailureIf`."""
    if not requirement.is_text or requirement.text is None:
        return _words_in((requirement.parameters, requirement.clauses))
    return frozenset(_WORDS.findall(requirement.text.text) if "if" in requirement.text.text.lower() else ())


def _words_in(part: object) -> frozenset[str]:
    """The names in a part; for `a-b`, which may be meant as a subtraction, both sides too."""
    words = [word for word in syntax.walk(part) if isinstance(word, syntax.Word)]
    names = [word.text for word in words if word.kind == NAME]
    return frozenset([*names, *(side for name in names if "-" in name for side in name.split("-"))])


def _content(requirement: syntax.Requirement) -> object:
    text = " ".join(requirement.text.text.split()) if requirement.text else None
    clauses = tuple([clause for clause in requirement.clauses if not isinstance(clause, syntax.Approval)])
    return text, syntax.shape((requirement.qualities, requirement.parameters, clauses))


_WORDS: Final = re.compile(r"\w+")
