"""Ports and attributes: unknown, missing, given twice, or silently ignored by the engine."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nodes import OLD_PORTS, PLACEHOLDERS
from btq_lang.checks.kinds import written
from btq_lang.checks.view import SeenNode, View, subtree_ports
from btq_lang.diagnostics import Diagnostic, Place, Related, replace_fix
from btq_lang.near import near
from btq_lang.rules import Severity
from btq_lang.syntax import Entry, Include, Meta, Model, Models, Pair, Port, Root, Tree
from btq_lang.text import Span

_OWN = frozenset(("ID", "name"))


def unknown_port(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A port that the built-in, the model or the tree behind a SubTree does not have."""
    for seen in view.nodes(entry):
        known = _port_names(view, seen)
        if known is None:
            continue
        for pair in seen.node.attributes:
            key = pair.key.text
            if key in known or key in _OWN or key in RESERVED_ATTRIBUTES or not is_port_name(key):
                continue
            old = OLD_PORTS.get((seen.kind.tag, key)) if seen.kind else None
            likely = (old,) if old else near(key, known)
            fixes = tuple(replace_fix(f"Replace `{key}` by `{port}`", pair.key.span, written(port)) for port in likely)
            notes = (f"it has {', '.join(f'`{port}`' for port in known)}" if known else "it has no ports",)
            yield Diagnostic(
                "unknown-port",
                pair.key.span,
                f"{seen.shown} has no port `{key}`",
                related=_declared(view, seen),
                notes=notes,
                fixes=fixes,
                severity=Severity.WARNING if seen.is_subtree else None,  # the engine takes any port of a SubTree
            )


def missing_port(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A port without a value: one the engine asks for, or an input without default of a model."""
    for seen in view.nodes(entry):
        given = {pair.key.text for pair in seen.node.attributes}
        if seen.kind is not None:
            if is_placeholder(seen):
                continue
            known = tuple(port.name for port in seen.kind.ports)
            slips = {near(key, known, 1) for key in given.difference(known)}  # told as unknown, with a fix
            for port in seen.kind.ports:
                if port.required and port.name not in given and (port.name,) not in slips:
                    yield _missing(view, seen, port.name, port.doc, None)
        elif seen.is_subtree:
            if given & {"_autoremap", "__shared_blackboard", "__autoremap"}:
                continue
            for declared in subtree_ports(view, seen):
                if declared.name is not None and declared.default is None and declared.name.text not in given:
                    yield _missing(view, seen, declared.name.text, "", None)
        elif seen.model is not None:
            for declared in seen.model.ports:
                name = declared.name.text if declared.name else ""
                if name and declared.direction.raw == "input" and declared.default is None and name not in given:
                    yield _missing(view, seen, name, declared.text.text if declared.text else "", Severity.WARNING)


def unknown_attribute(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """`_skipif`: neither a port nor anything the engine reads, and it says nothing about it."""
    for seen in view.nodes(entry):
        for pair in seen.node.attributes:
            key = pair.key.text
            if key in RESERVED_ATTRIBUTES or key in _OWN or is_port_name(key):
                continue
            likely = near(key, RESERVED_ATTRIBUTES)
            fixes = tuple(replace_fix(f"Replace `{key}` by `{name}`", pair.key.span, name) for name in likely)
            message = f"`{key}` is no attribute that the engine reads: it ignores it without a word"
            yield Diagnostic("unknown-attribute", pair.key.span, message, fixes=fixes)


def duplicate_attribute(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """Two values for one attribute: the first counts."""
    for pairs, label in _attribute_lists(entry):
        first: dict[str, Span] = {"name": label} if label is not None else {}
        for pair in pairs:
            key = pair.key.text
            if key in first:
                related = (Related(Place(first[key]), "the first value, which counts"),)
                yield Diagnostic("duplicate-attribute", pair.key.span, f"`{key}` has a value already", related=related)
            first.setdefault(key, pair.span)


def is_placeholder(seen: SeenNode) -> bool:
    """Whether a script node without code stands for a skill (language.md §4, classic placeholders)."""
    node = seen.node
    return (
        node.category is None
        and node.kind is not None
        and not node.kind.quoted
        and node.kind.raw in PLACEHOLDERS
        and node.attribute("code") is None
        and node.name is not None
    )


def _port_names(view: View, seen: SeenNode) -> tuple[str, ...] | None:
    """The ports a node has; None where nobody knows."""
    if is_placeholder(seen):
        return None
    if seen.is_subtree:
        declared = subtree_ports(view, seen)
        return tuple(port.name.text for port in declared if port.name) if declared else None
    if seen.kind is not None:
        return tuple(port.name for port in seen.kind.ports)
    if seen.model is not None:
        return tuple(port.name.text for port in seen.model.ports if port.name)
    return None


def _declared(view: View, seen: SeenNode) -> tuple[Related, ...]:
    return (view.defined_at(seen.definition, "its ports are declared here"),) if seen.definition else ()


def _missing(view: View, seen: SeenNode, port: str, doc: str, severity: Severity | None) -> Diagnostic:
    return Diagnostic(
        "missing-port",
        seen.node.head.span,
        f"{seen.shown} needs a value for its port `{port}`",
        related=_declared(view, seen),
        notes=(f"`{port}`: {doc[0].lower()}{doc[1:]}",) if doc else (),
        severity=severity,
    )


def _attribute_lists(entry: Entry) -> Iterator[tuple[tuple[Pair, ...], Span | None]]:
    """Every list of attributes in an item, with the place of a label that is a `name` too."""
    item = entry.item
    if isinstance(item, Tree):
        yield item.attributes, None
        for port in item.ports:
            yield port.attributes, None
        for node in item.walk():
            yield node.attributes, node.label.span if node.label else None
    elif isinstance(item, Include | Root):
        yield item.attributes, None
    elif isinstance(item, Model | Models):
        for model in (item,) if isinstance(item, Model) else item.models:
            if isinstance(model, Model):
                yield model.attributes, None
                for part in model.body:
                    if isinstance(part, Port | Meta):
                        yield part.attributes, None
