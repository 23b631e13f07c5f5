"""Files for version 3 of the engine, translated to version 4.

One invariant: every change is reported.  The engine's own converter (convert_v3_to_v4.py) is not followed where it is
wrong: it puts braces round the `name` of a SubTree, forgets the explicit form of SequenceStar, and does not know the
ports of Parallel.

Sources: BehaviorTree.CPP 3.8, xml_parsing.cpp; 4.x, migration guide and convert_v3_to_v4.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.btcpp.document import Attribute, Element
from btq_lang.catalog.attributes import OF_VERSION_4
from btq_lang.catalog.literals import OLD_ENTRY, is_pointer
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, OLD_PORTS, available
from btq_lang.catalog.versions import VERSION_3
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.util.record import Record
from btq_lang.util.text import Span


class Change(Record):
    """A difference from the XML.

    Attributes:
        span: in the XML.
    """

    span: Span
    message: str


def is_version_3(root: Element) -> bool:
    """Whether a file is meant for version 3: it does not declare version 4, and uses nothing new."""
    format_ = root.get("BTCPP_format")
    if format_ is not None:
        return format_.strip() == "3"
    return not any(_is_new(element) for element in root.walk())


def translated(root: Element, changes: list[Change]) -> None:
    """Translate it to version 4, in place."""
    span = Span(root.start + 1, root.end - 1)
    kept = [each for each in root.attributes if each.name != "BTCPP_format"]
    if len(kept) < len(root.attributes):
        changes.append(Change(span, 'BTCPP_format="3" is now "4"'))
    else:
        changes.append(Change(span, 'BTCPP_format="4" is added'))
    root.attributes = (Attribute("BTCPP_format", "4"), *kept)
    outputs = dict(_outputs(root))
    for element in root.walk():
        translator = _Translator(element, changes)
        if element.tag != "SubTree":  # whose attributes name entries without any sign
            name = element.get("ID") if element.tag in CATEGORIES else element.tag
            translator.entries(outputs.get(name, frozenset()))
        if element.tag in _MAY_BE_OLD:
            translator.translate()


def _outputs(root: Element) -> Iterator[tuple[str | None, frozenset[str | None]]]:
    """The nodes that have models in the file, with the names of their outputs."""
    for models in root.elements:
        for model in models.elements if models.tag == "TreeNodesModel" else ():
            yield model.get("ID"), frozenset(each.get("name") for each in model.elements if each.tag == "output_port")


class _Translator:
    """Translates one element."""

    def __init__(self, element: Element, changes: list[Change]) -> None:
        self.element: Final = element
        self.changes: Final = changes

    def translate(self) -> None:
        element = self.element
        is_explicit = element.tag in ("Action", "Condition", "Control", "Decorator")
        identity = element.get("ID") if is_explicit else element.tag
        if identity in ("SubTree", "SubTreePlus"):
            if not any(child.tag.endswith("_port") for child in element.elements):
                self.subtree(identity == "SubTreePlus")
            else:
                self.subtree_model()
            return
        known = KNOWN_WORDS.get(identity or "")
        if known is not None and known.replacement is not None:
            self.rename(is_explicit, known.replacement)
            identity = known.replacement
        elif known is not None and known.until == VERSION_3:
            self.report(f"{known.why}: kept unchanged")
        for attribute in element.attributes:
            port = OLD_PORTS.get((identity or "", attribute.name))
            if port is not None:
                self.report(f"{attribute.name} of {identity} is now {port}", attribute)
                self.replace(attribute, self.changed(attribute, name=port))

    def entries(self, outputs: frozenset[str | None]) -> None:
        """Put braces round the entries that version 3 knows without: `${key}`, and `key` for an output."""
        for attribute in self.element.attributes:
            raw = attribute.raw
            if attribute.name in ("ID", "name"):
                continue
            if OLD_ENTRY.fullmatch(raw):
                self.report(f'{attribute.name}="{raw}" names an entry: now "{raw[1:]}"', attribute)
                self.replace(attribute, self.changed(attribute, raw=raw[1:]))
            elif attribute.name in outputs and raw not in ("", "=") and not is_pointer(attribute.value):
                self.report(f'{attribute.name}="{raw}" names the entry of an output: now "{{{raw}}}"', attribute)
                self.replace(attribute, self.changed(attribute, raw=f"{{{raw}}}"))

    def rename(self, is_explicit: bool, new: str) -> None:
        element = self.element
        if is_explicit:
            for attribute in element.attributes:
                if attribute.name == "ID":
                    self.report(f"{attribute.raw} is now {new}", attribute)
                    self.replace(attribute, self.changed(attribute, raw=new))
        else:
            self.report(f"{element.tag} is now {new}")
            element.tag = new

    def subtree(self, is_plus: bool) -> None:
        """Translate a SubTree, which maps keys to keys, or a SubTreePlus, which maps keys to values as SubTree does
        now."""
        element = self.element
        if is_plus:
            self.report("SubTreePlus is now SubTree")
            element.tag = "SubTree"
        found: list[Attribute] = []
        for attribute in element.attributes:
            key, said = attribute.name, attribute.value
            if key == "__shared_blackboard":
                if said.strip().lower() in ("true", "1"):
                    self.report('__shared_blackboard is now _autoremap="true"', attribute)
                    found.append(self.changed(attribute, "_autoremap", "true"))
                else:
                    self.report("__shared_blackboard is left out: version 4 shares only what is mapped", attribute)
            elif key == "__autoremap":
                self.report("__autoremap is now _autoremap", attribute)
                found.append(self.changed(attribute, "_autoremap"))
            elif is_plus or key in ("ID", "name") or key.startswith("_") or said.startswith("{"):
                found.append(attribute)
            elif said == "":
                self.report(f"`{key}` of a SubTree names no entry: kept unchanged", attribute)
                found.append(attribute)
            else:
                self.report(
                    f'{key}="{attribute.raw}" of a SubTree names an entry: now "{{{attribute.raw}}}"', attribute
                )
                found.append(self.changed(attribute, raw=f"{{{attribute.raw}}}"))
        element.attributes = tuple(found)

    def subtree_model(self) -> None:
        """Remove two ports from the model of a SubTree: version 4 would require them at each use."""
        element = self.element
        for child in list(element.elements):
            if child.get("name") in ("__shared_blackboard", "__autoremap"):
                message = f"the port {child.get('name')} of a SubTree's model is left out: version 4 would require it"
                self.changes.append(Change(Span(child.start, child.end), message))
                element.children.remove(child)

    def replace(self, attribute: Attribute, other: Attribute) -> None:
        self.element.attributes = tuple(other if each is attribute else each for each in self.element.attributes)

    def changed(self, attribute: Attribute, name: str | None = None, raw: str | None = None) -> Attribute:
        """An attribute with another name or value, in its place."""
        place = self.element.place(attribute)
        return Attribute(attribute.name if name is None else name, attribute.raw if raw is None else raw, place)

    def report(self, message: str, attribute: Attribute | None = None) -> None:
        """Report a change of an attribute, or of the element's tag."""
        if attribute is None:
            self.changes.append(Change(self.element.tag_span, message))
        else:
            start, value_start = self.element.place(attribute)
            self.changes.append(Change(Span(start, value_start + len(attribute.raw) + 1), message))


def _is_new(element: Element) -> bool:
    """Whether only version 4 understands an element: its tag, or one of its attributes."""
    if element.tag in _NEW_NODES:
        return True
    return any(attribute.name in OF_VERSION_4 for attribute in element.attributes)


# The tags of elements that may have to be translated because of their tag or their ID.
_MAY_BE_OLD: Final = frozenset((*KNOWN_WORDS, *(tag for tag, _ in OLD_PORTS), *CATEGORIES))
_NEW_NODES: Final = frozenset(tag for tag, kind in BUILTINS.items() if not available(kind, VERSION_3))
