"""Files for version 3 of the engine, translated to version 4.

One invariant: every change is reported.  The engine's own converter (convert_v3_to_v4.py) is not followed where it is
wrong: it puts braces round the `name` of a SubTree, forgets the explicit form of SequenceStar, and does not know the
ports of Parallel.

Sources: BehaviorTree.CPP 3.8, xml_parsing.cpp; 4.x, migration guide and convert_v3_to_v4.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Final, TypeAlias

from btq_lang.btcpp.document import Attribute, Element
from btq_lang.catalog.literals import OLD_ENTRY, is_pointer
from btq_lang.catalog.nodes import KNOWN_WORDS, OLD_PORTS
from btq_lang.catalog.versions import VERSION_3
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.util.record import Record
from btq_lang.util.text import Span

# What becomes of an attribute: the message about that, its name, and its value; without a name it is left out.
Rewritten: TypeAlias = tuple[str, str, str]


class VersionNote(Record):
    """A difference from the XML.

    Attributes:
        span: in the XML.
    """

    span: Span
    message: str


def translated(root: Element, changes: list[VersionNote]) -> None:
    """Translate it to version 4, in place."""
    span = Span(root.start + 1, root.end - 1)
    kept = [each for each in root.attributes if each.name != "BTCPP_format"]
    if len(kept) < len(root.attributes):
        changes.append(VersionNote(span, 'BTCPP_format="3" is now "4"'))
    else:
        changes.append(VersionNote(span, 'BTCPP_format="4" is added'))
    root.attributes = (Attribute("BTCPP_format", "4"), *kept)
    outputs = dict(_outputs(root))
    for element in root.walk():
        if element.tag != "SubTree":  # whose attributes name entries without any sign
            name = element.get("ID") if element.tag in CATEGORIES else element.tag
            _rewrite(element, changes, partial(_entry, outputs=outputs.get(name, frozenset())))
        if element.tag in _MAY_BE_OLD:
            _translate(element, changes)


def _outputs(root: Element) -> Iterator[tuple[str | None, frozenset[str | None]]]:
    """The nodes that have models in the file, with the names of their outputs."""
    for models in root.elements:
        for model in models.elements if models.tag == "TreeNodesModel" else ():
            yield model.get("ID"), frozenset(each.get("name") for each in model.elements if each.tag == "output_port")


def _translate(element: Element, changes: list[VersionNote]) -> None:
    is_explicit = element.tag in ("Action", "Condition", "Control", "Decorator")
    identity = element.get("ID") if is_explicit else element.tag
    if identity in ("SubTree", "SubTreePlus"):
        if any(child.tag.endswith("_port") for child in element.elements):
            _remove_ports(element, changes)
            return
        if identity == "SubTreePlus":
            changes.append(VersionNote(element.tag_span, "SubTreePlus is now SubTree"))
            element.tag = "SubTree"
        _rewrite(element, changes, partial(_argument, is_plus=identity == "SubTreePlus"))
        return
    known = KNOWN_WORDS.get(identity or "")
    new = known.replacement if known is not None else None
    if new is not None and is_explicit:
        _rewrite(element, changes, lambda each: (f"{each.raw} is now {new}", "ID", new) if each.name == "ID" else None)
    elif new is not None:
        changes.append(VersionNote(element.tag_span, f"{element.tag} is now {new}"))
        element.tag = new
    elif known is not None and known.until == VERSION_3:
        changes.append(VersionNote(element.tag_span, f"{known.why}: kept unchanged"))
    _rewrite(element, changes, partial(_port, tag=new or identity or ""))


def _rewrite(element: Element, changes: list[VersionNote], rewritten: Callable[[Attribute], Rewritten | None]) -> None:
    """Rewrite the attributes of an element, and report each that changes."""
    kept: list[Attribute] = []
    for attribute in element.attributes:
        found = rewritten(attribute)
        if found is None:
            kept.append(attribute)
            continue
        message, name, raw = found
        start, value_start = element.place(attribute)
        changes.append(VersionNote(Span(start, value_start + len(attribute.raw) + 1), message))
        if name:
            kept.append(Attribute(name, raw, (start, value_start)))
    element.attributes = tuple(kept)


def _entry(attribute: Attribute, outputs: frozenset[str | None]) -> Rewritten | None:
    """Put braces round the entries that version 3 knows without: `${key}`, and `key` for an output."""
    name, raw = attribute.name, attribute.raw
    if name in ("ID", "name"):
        return None
    if OLD_ENTRY.fullmatch(raw):
        return f'{name}="{raw}" names an entry: now "{raw[1:]}"', name, raw[1:]
    if name in outputs and raw not in ("", "=") and not is_pointer(attribute.value):
        return f'{name}="{raw}" names the entry of an output: now "{{{raw}}}"', name, f"{{{raw}}}"
    return None


def _port(attribute: Attribute, tag: str) -> Rewritten | None:
    port = OLD_PORTS.get((tag, attribute.name))
    return None if port is None else (f"{attribute.name} of {tag} is now {port}", port, attribute.raw)


def _argument(attribute: Attribute, is_plus: bool) -> Rewritten | None:
    """Translate an attribute of a SubTree, which maps keys to keys, or of a SubTreePlus, which maps keys to values as
    SubTree does now."""
    key, said, raw = attribute.name, attribute.value, attribute.raw
    if key == "__shared_blackboard":
        if said.strip().lower() in ("true", "1"):
            return '__shared_blackboard is now _autoremap="true"', "_autoremap", "true"
        return "__shared_blackboard is left out: version 4 shares only what is mapped", "", ""
    if key == "__autoremap":
        return "__autoremap is now _autoremap", "_autoremap", raw
    if is_plus or key in ("ID", "name") or key.startswith("_") or said.startswith("{"):
        return None
    if said == "":
        return f"`{key}` of a SubTree names no entry: kept unchanged", key, raw
    return f'{key}="{raw}" of a SubTree names an entry: now "{{{raw}}}"', key, f"{{{raw}}}"


def _remove_ports(model: Element, changes: list[VersionNote]) -> None:
    """Remove two ports from the model of a SubTree: version 4 would require them at each use."""
    for port in list(model.elements):
        if port.get("name") in ("__shared_blackboard", "__autoremap"):
            message = f"the port {port.get('name')} of a SubTree's model is left out: version 4 would require it"
            changes.append(VersionNote(Span(port.start, port.end), message))
            model.children.remove(port)


# The tags of elements that may have to be translated because of their tag or their ID.
_MAY_BE_OLD: Final = frozenset((*KNOWN_WORDS, *(tag for tag, _ in OLD_PORTS), *CATEGORIES))
