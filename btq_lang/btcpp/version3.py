"""Files for version 3 of the engine: the signs that XML is for it, and its translation to version 4.

One invariant: every change is reported.  The engine's own converter (convert_v3_to_v4.py) is not followed where it is
wrong: it puts braces round the `name` of a SubTree, forgets the explicit form of SequenceStar, and does not know the
ports of Parallel.  Without a BTCPP_format, something that version 3 does not read outweighs all other signs.

Sources: BehaviorTree.CPP 3.8, xml_parsing.cpp; 4.x, migration guide and convert_v3_to_v4.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Final, TypeAlias

from btq_lang.btcpp.document import Attribute, Element
from btq_lang.catalog.attributes import OF_VERSION_4, RESERVED_ATTRIBUTES
from btq_lang.catalog.literals import OLD_ENTRY, is_pointer
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, OLD_PORTS, available
from btq_lang.catalog.versions import VERSION_3
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.file import Signs

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
    others = [each for each in root.attributes if each.name != "BTCPP_format"]
    if len(others) < len(root.attributes):
        changes.append(VersionNote(span, 'BTCPP_format="3" is now "4"'))
    else:
        changes.append(VersionNote(span, 'BTCPP_format="4" is added'))
    root.attributes = (Attribute("BTCPP_format", "4"), *others)
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
    word = KNOWN_WORDS.get(identity or "")
    new = word.replacement if word is not None else None
    if new is not None and is_explicit:
        _rewrite(element, changes, lambda each: (f"{each.raw} is now {new}", "ID", new) if each.name == "ID" else None)
    elif new is not None:
        changes.append(VersionNote(element.tag_span, f"{element.tag} is now {new}"))
        element.tag = new
    elif word is not None and word.until == VERSION_3:
        changes.append(VersionNote(element.tag_span, f"{word.why}: kept unchanged"))
    _rewrite(element, changes, partial(_port, tag=new or identity or ""))


def _rewrite(element: Element, changes: list[VersionNote], rewritten: Callable[[Attribute], Rewritten | None]) -> None:
    """Rewrite the attributes of an element, and report each that changes."""
    attributes: list[Attribute] = []
    for attribute in element.attributes:
        rewriting = rewritten(attribute)
        if rewriting is None:
            attributes.append(attribute)
            continue
        message, name, raw = rewriting
        start, value_start = element.place(attribute)
        changes.append(VersionNote(Span(start, value_start + len(attribute.raw) + 1), message))
        if name:
            attributes.append(Attribute(name, raw, (start, value_start)))
    element.attributes = tuple(attributes)


def _entry(attribute: Attribute, outputs: frozenset[str | None]) -> Rewritten | None:
    """Put braces around entries that version 3 writes otherwise: `${key}`, and `key` for an output."""
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
    key, text, raw = attribute.name, attribute.value, attribute.raw
    if key == "__shared_blackboard":
        if text.strip().lower() in ("true", "1"):
            return '__shared_blackboard is now _autoremap="true"', "_autoremap", "true"
        return "__shared_blackboard is left out: version 4 shares only what is mapped", "", ""
    if key == "__autoremap":
        return "__autoremap is now _autoremap", "_autoremap", raw
    if is_plus or key in ("ID", "name") or key.startswith("_") or text.startswith("{"):
        return None
    if text == "":
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


def signs(root: Element) -> Signs:
    """What the document element and the trees say; words that its models declare are its own and say nothing."""
    declared = (root.get("BTCPP_format") or "").strip()
    if declared not in ("", "3"):
        return Signs(declared)
    own = {model.get("ID") for models in root.elements if models.tag == "TreeNodesModel" for model in models.elements}
    refused: set[str] = set()
    old: dict[str, None] = dict.fromkeys(('BTCPP_format="3"',) if declared else ())
    for tree in root.elements:
        nodes = [*_below(tree)] if tree.tag == "BehaviorTree" else []
        entries = {each.value[1:-1] for node in nodes for each in node.attributes if is_pointer(each.value)}
        for node in nodes:
            name = node.get("ID") or "" if node.tag in CATEGORIES else node.tag
            is_own = name in own or node.tag == "SubTree"
            keys = {each.name for each in node.attributes}
            if (name in _NEW_NODES and not is_own) or not OF_VERSION_4.isdisjoint(keys):
                return Signs(declared, is_new=True)
            word = KNOWN_WORDS.get(name)
            if word is not None and word.until is not None and not is_own:
                refused.add(word.tag)
                old[word.tag] = None
            refused.update(key for key in keys if (name, key) in OLD_PORTS)
            old.update(dict.fromkeys(_old_attributes(node, name, entries)))
    return Signs(declared, old=tuple(old), is_refused=bool(refused))


def _old_attributes(node: Element, name: str, entries: set[str]) -> Iterator[str]:
    """The attributes of a node that version 4 does not read as version 3 does.

    A value of a SubTree's port names an entry if it is the name of the port itself, or of an entry beside it. In public
    files, 1,085 of the 4,925 values in files that declare no version are such names, and none of the 679 in files that
    declare version 4.
    """
    is_subtree = node.tag in ("SubTree", "SubTreePlus")
    for attribute in node.attributes:
        key, text = attribute.name, attribute.value
        if (name, key) in OLD_PORTS or (is_subtree and key.startswith("__") and key in RESERVED_ATTRIBUTES):
            yield key
        elif node.tag == "SubTree" and is_port_name(key) and (text == key or text in entries):
            yield f'{key}="{text}"'


def _below(tree: Element) -> Iterator[Element]:
    """The nodes of a tree in the order of the file."""
    stack = [*tree.elements][::-1]
    while stack:
        yield (element := stack.pop())
        stack += [*element.elements][::-1]


_NEW_NODES: Final = frozenset(tag for tag, kind in BUILTINS.items() if not available(kind, VERSION_3))
