"""Attributes: unknown, given twice, or silently ignored by the engine."""

from __future__ import annotations

import re
from collections.abc import Iterator

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.names import is_port_name, port_name_problem
from btq_lang.catalog.versions import UNDERSCORES
from btq_lang.checks.known_ports import known_ports
from btq_lang.checks.pointers import pointed_at, remaps_all
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Include, Meta, Pair, Port, Root, Tree, Word, models_in, written
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span
from btq_lang.workspace.resolved import ResolvedNode


def unknown_attribute(view: View) -> Iterator[Diagnostic]:
    """`_skipif`: neither a port nor anything the engine reads, which it does not report."""
    if isinstance(view.item, Tree):
        for pair in view.item.attributes:
            kind = RESERVED_ATTRIBUTES.get(pair.key.text)
            if kind is not None and kind.is_script:
                message = f"`{pair.key.text}` has no effect on a BehaviorTree: move it to the tree's node"
                yield Diagnostic("unknown-attribute", pair.key.span, message)
    for resolved in view.seen.given:
        for pair in resolved.node.attributes:
            key = pair.key.text
            if is_port_name(key) or key in NAMES_OF_NODES:
                meant = attribute_meant(key, view.target)
                if meant is not None and known_ports(view, resolved) is None:
                    yield from _without_underscore(resolved, pair.key, meant)
                continue
            if not UNDERSCORES.holds(view.target):
                if resolved.category != "SubTree" and key != "_description":
                    message = f"{view.target} takes `{key}` for a port, and refuses {resolved.shown_kind}"
                    yield Diagnostic("unknown-attribute", pair.key.span, message, severity=Severity.ERROR)
                continue
            if key in _KEPT:
                continue
            if resolved.is_subtree and key[:1] != "_":
                yield from _dropped(view, resolved, pair)
                continue
            if key.casefold() in _WISHED and pair.value is not None:
                yield _wished(view, pair, pair.value)
                continue
            likely = (_OF_TODAY[key],) if key in _OF_TODAY else near(key, _KEPT)
            if not likely:
                kept = "from 4.7 on the engine keeps it for the node's own code"
                refused = f"{view.target} reads it as a port, and refuses a node without a port of that name"
                is_port = is_port_name(key, view.target)
                note, severity = (refused, Severity.WARNING) if is_port else (kept, Severity.HINT)
                message = f"the engine does not read `{key}`"
                yield Diagnostic("unknown-attribute", pair.key.span, message, notes=(note,), severity=severity)
            elif not (key in _OF_TODAY and _is_off(pair.value)):
                fixes = tuple(replace_fix(f"Replace `{key}` with `{name}`", pair.key.span, name) for name in likely)
                message = f"the engine silently ignores `{key}`{did_you_mean(likely)}"
                yield Diagnostic("unknown-attribute", pair.key.span, message, fixes=fixes)


def duplicate_attribute(view: View) -> Iterator[Diagnostic]:
    """Two values for one attribute: the first counts."""
    for pairs, before_brackets in _attribute_lists(view):
        keys = {pair.key.text for pair in pairs}
        if len(keys) == len(pairs) and keys.isdisjoint(before_brackets):
            continue
        first: dict[str, Word | Pair] = {key: word for key, word in before_brackets.items() if word is not None}
        for pair in pairs:
            key = pair.key.text
            if key in first:
                related = (Related(Place(first[key].span), "first value, which takes effect"),)
                yield Diagnostic("duplicate-attribute", pair.key.span, f"duplicate value for `{key}`", related=related)
            first.setdefault(key, pair)


def may_remap_all(resolved: ResolvedNode) -> bool:
    """Whether a SubTree gets every entry under its own name, or has an attribute of version 3 that means it."""
    values = [resolved.node.attribute(key) for key in ("_autoremap", *_OF_TODAY)]
    return any(value is not None and not _is_off(value) for value in values)


def attribute_meant(key: str, version: str) -> str | None:
    """The attribute that a name without `_` or in another case means, if the engine has such attributes."""
    return _ATTRIBUTES.get(_plain(key)) if UNDERSCORES.holds(version) else None


def _dropped(view: View, seen: ResolvedNode, pair: Pair) -> Iterator[Diagnostic]:
    """An argument of a SubTree that does not reach its tree, because of its name."""
    key = pair.key.text
    is_same = pair.value is not None and pointed_at(key, pair.value.text) == key
    if is_port_name(key, view.target) or (is_same and remaps_all(seen)):
        return
    reason = port_name_problem(key, view.target) or "it does not begin with a letter"
    notes = (
        "rename it here and in its tree",
        *(("releases before 4.8.4 pass it on",) if is_port_name(key, "4.6") else ()),
    )
    message = f"the engine drops the argument `{key}` because of its name: {reason}"
    yield Diagnostic("unknown-attribute", pair.key.span, message, notes=tuple(notes))


def _wished(view: View, pair: Pair, value: Word) -> Diagnostic:
    """An attribute that no version has, with the one that does what it says."""
    key, is_negated = pair.key.text, _WISHED[pair.key.text.casefold()]
    script = f"!({value.text})" if is_negated else value.text
    changes = [FixEdit(Place(pair.key.span), "_skipIf")]
    inner = Span(value.start + 1, value.end - 1)
    if is_negated and not value.quoted:
        changes.append(FixEdit(Place(value.span), written(script)))
    elif is_negated and _REFERRED.search(value.text[1:-1]):  # XML spells it in pieces: change the first and the last
        changes.append(FixEdit(Place(Span(inner.start, inner.start + 1)), f"!({value.text[0]}"))
        changes.append(FixEdit(Place(Span(inner.end - 1, inner.end)), f"{value.text[-1]})"))
    elif is_negated:
        changes.append(FixEdit(Place(inner), script))
    fix = Fix(f'Write `_skipIf="{script}"`', tuple(changes))
    message = f"no version of the engine has `{key}`, and it ignores it silently; did you mean `_skipIf`?"
    return Diagnostic("unknown-attribute", pair.key.span, message, notes=(f'write `_skipIf="{script}"`',), fixes=(fix,))


def _without_underscore(resolved: ResolvedNode, key: Word, meant: str) -> Iterator[Diagnostic]:
    """`skipIf` on a node whose ports are unknown; elsewhere it is an unknown port."""
    if key.text.islower() and "_" not in key.text and not resolved.is_subtree:
        return  # `while` and `post` may be ports
    message = f"the engine takes `{key.text}` for a port; did you mean `{meant}`?"
    fix = replace_fix(f"Replace `{key.text}` with `{meant}`", key.span, meant)
    yield Diagnostic("unknown-attribute", key.span, message, fixes=(fix,))


def _attribute_lists(view: View) -> Iterator[tuple[tuple[Pair, ...], dict[str, Word | None]]]:
    """Every list of attributes in an item, with the attributes that are written before the brackets."""
    item = view.item
    if isinstance(item, Tree):
        yield item.attributes, {"ID": item.name}
        for port in item.ports:
            if port.attributes:
                yield port.attributes, _before_brackets(port)
        for resolved in view.seen.given:
            node = resolved.node
            if len(node.attributes) > 1 or node.label is not None or node.category is not None:
                yield node.attributes, {"name": node.label, "ID": node.kind if node.category else None}
    elif isinstance(item, Include):
        yield item.attributes, {"path": item.path}
    elif isinstance(item, Root):
        yield item.attributes, {"main_tree_to_execute": item.name}
    for model in models_in(item):
        if model.attributes:
            yield model.attributes, {"ID": model.name}
        for part in model.body:
            if isinstance(part, Port) and part.attributes:
                yield part.attributes, _before_brackets(part)
            elif isinstance(part, Meta):
                yield part.attributes, {}


def _before_brackets(port: Port) -> dict[str, Word | None]:
    return {"name": port.name, "type": port.type, "default": port.default}


def _is_off(value: Word | None) -> bool:
    return value is not None and value.text in ("false", "False", "FALSE", "0")


def _plain(key: str) -> str:
    return key.replace("_", "").casefold()


NAMES_OF_NODES = frozenset(("ID", "name"))
_REFERRED = re.compile('[<&"]')
# Attributes that people miss, in small letters, and whether `_skipIf` says the opposite.
_WISHED = {
    **dict.fromkeys(
        ("_onlyif", "_runif", "_executeif", "_tickif", "_doif", "_if", "_when", "_enableif", "_enabledif"), True
    ),
    **dict.fromkeys(("_unless", "_notif", "_ignoreif", "_disableif", "_disabledif"), False),
}
# Version 3's attributes of a SubTree, and their successors.
_OF_TODAY = {"__shared_blackboard": "_autoremap", "__autoremap": "_autoremap"}
_KEPT = frozenset(RESERVED_ATTRIBUTES) - frozenset(_OF_TODAY)
# The attributes that the engine reads, as one writes them who forgets the `_`.
_ATTRIBUTES = {_plain(name): name for name in _KEPT if RESERVED_ATTRIBUTES[name].group != "tool"}
