"""What an item defines and refers to: a summary made from its tree alone.

One invariant: a summary depends on nothing but the item, so it is made once and holds for as long as the item does.
Which definition a use means is the workspace's to say.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum

from btq_lang.record import Record
from btq_lang.syntax import (
    Apply,
    Context,
    Item,
    Model,
    Models,
    Node,
    NodeClause,
    QualityDecl,
    QualityPath,
    ReqRef,
    Requirement,
    Root,
    Satisfices,
    Satisfies,
    Signal,
    Tags,
    Tree,
    Word,
    shape,
    walk,
)
from btq_lang.text import Span
from btq_lang.tokens import NAME

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import TypeAlias


class Kind(Enum):
    """What a name can name."""

    TREE = "tree"
    MODEL = "node model"
    REQUIREMENT = "requirement"
    SIGNAL = "signal"
    CONTEXT = "context"
    QUALITY = "quality"

    __hash__ = object.__hash__  # half of all keys are a kind and a name, and Enum's own hash is slow


Target: TypeAlias = Tree | Model | Requirement | Signal | Context | QualityDecl


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
        node: the node it stands at, where it stands at one.
    """

    kind: Kind
    name: str
    span: Span
    node: Node | None = None


class Summary(Record):
    """All that an item defines and refers to, in the order of the text."""

    symbols: tuple[Symbol, ...]
    uses: tuple[Use, ...]


NOTHING = Summary((), ())


def summarize(item: Item) -> Summary:
    """The summary of an item."""
    symbols: list[Symbol] = []
    uses: list[Use] = []
    for found in _names(item):
        if isinstance(found, Symbol):
            symbols.append(found)
        else:
            uses.append(found)
    return Summary(tuple(symbols), tuple(uses)) if symbols or uses else NOTHING


def requirements_at(clauses: tuple[NodeClause, ...]) -> Iterator[Requirement | ReqRef]:
    """The requirements that clauses attach, defined in place or named."""
    for clause in clauses:
        if isinstance(clause, Satisfies):
            yield from clause.uses
        elif isinstance(clause, Satisfices):
            for quality in clause.qualities:
                yield from quality.requirements


def asked_for(item: Item) -> frozenset[str]:
    """The names in an item's conditions, bounds and arguments: what a signal or a context has to be there for."""
    if isinstance(item, Context):
        return _words_in(item.condition)
    if isinstance(item, Requirement):
        return _asked_by(item)
    if isinstance(item, Apply):
        return _words_in(tuple(use.arguments for use in item.uses))
    if not isinstance(item, Tree):
        return frozenset()
    attached = [*requirements_at(item.clauses)]
    for node in item.walk():
        if node.clauses:
            attached += requirements_at(node.clauses)
    return frozenset().union(
        *(_asked_by(each) if isinstance(each, Requirement) else _words_in(each.arguments) for each in attached)
    )


def same_requirement(first: Requirement, second: Requirement) -> bool:
    """Whether two definitions say the same (language.md §4): texts compare after folding blanks."""
    return _saying(first) == _saying(second)


def _asked_by(requirement: Requirement) -> frozenset[str]:
    """What a requirement asks for in its clauses; without any, its text may hold some behind `FailureIf`."""
    if requirement.clauses or requirement.text is None:
        return _words_in((requirement.parameters, requirement.clauses))
    return (
        frozenset(re.findall(r"\w+", requirement.text.text)) if "if" in requirement.text.text.lower() else frozenset()
    )


def _words_in(part: object) -> frozenset[str]:
    """Each name, and of `a-b`, which may be meant as a subtraction, both sides, too."""
    names = [word.text for word in walk(part) if isinstance(word, Word) and word.kind == NAME]
    return frozenset([*names, *(side for name in names if "-" in name for side in name.split("-"))])


def _saying(requirement: Requirement) -> object:
    text = " ".join(requirement.text.text.split()) if requirement.text else None
    return text, shape(requirement.quality), shape(requirement.parameters), shape(requirement.clauses)


def _names(item: Item) -> Iterator[Symbol | Use]:
    if isinstance(item, Tree):
        if item.name is not None:
            yield _defines(Kind.TREE, item.name, item)
        yield from _clauses(item.clauses, None)
        for node in item.walk():
            yield from _node(node)
    elif isinstance(item, Model):
        if item.name is not None:
            yield _defines(Kind.MODEL, item.name, item)
    elif isinstance(item, Models):
        for model in item.models:
            if isinstance(model, Model) and model.name is not None:
                yield _defines(Kind.MODEL, model.name, model)
    elif isinstance(item, Requirement):
        yield from _requirement(item, None)
    elif isinstance(item, Signal):
        if item.name is not None:
            yield _defines(Kind.SIGNAL, item.name, item)
    elif isinstance(item, Context):
        if item.name is not None:
            yield _defines(Kind.CONTEXT, item.name, item)
    elif isinstance(item, QualityDecl):
        if item.name is not None:
            yield _defines(Kind.QUALITY, item.name, item)
        yield from _quality(item.parent, None)
    elif isinstance(item, Apply):
        for reference in item.uses:
            yield _uses(Kind.REQUIREMENT, reference.name, None)
    elif isinstance(item, Root):
        for name in (item.name, *(pair.value for pair in item.attributes if pair.key.text == "main_tree_to_execute")):
            if name is not None:
                yield _uses(Kind.TREE, name, None)


def _node(node: Node) -> Iterator[Symbol | Use]:
    if node.kind is not None and node.kind.raw == "SubTreePlus" and (tree := node.attribute("ID")) is not None:
        yield _uses(Kind.TREE, tree, node)  # version 3's word for SubTree
    elif node.id is not None:
        is_subtree = node.category is not None and node.category.raw == "SubTree"
        yield _uses(Kind.TREE if is_subtree else Kind.MODEL, node.id, node)
    yield from _clauses(node.clauses, node)


def _clauses(clauses: tuple[NodeClause, ...], node: Node | None) -> Iterator[Symbol | Use]:
    for clause in clauses:
        if isinstance(clause, Tags):
            continue
        if isinstance(clause, Satisfices):
            for quality in clause.qualities:
                yield from _quality(quality.path, node)
        for requirement in requirements_at((clause,)):
            if isinstance(requirement, ReqRef):
                yield _uses(Kind.REQUIREMENT, requirement.name, node)
            else:
                yield from _requirement(requirement, node, attached=True)


def _requirement(requirement: Requirement, node: Node | None, attached: bool = False) -> Iterator[Symbol | Use]:
    """attached: it stands in a `satisfies` or `satisfices`, so without a text it refers to another place."""
    if requirement.name is not None:
        if attached and requirement.is_reference:
            yield _uses(Kind.REQUIREMENT, requirement.name, node)
        else:
            yield _defines(Kind.REQUIREMENT, requirement.name, requirement)
    yield from _quality(requirement.quality, node)


def _quality(path: QualityPath | None, node: Node | None) -> Iterator[Use]:
    if path is not None:
        yield Use(Kind.QUALITY, ".".join(name.text for name in path.names), path.span, node)


def _defines(kind: Kind, name: Word, target: Target) -> Symbol:
    return Symbol(kind, name.text, name.span, target)


def _uses(kind: Kind, name: Word, node: Node | None) -> Use:
    return Use(kind, name.text, name.span, node)
