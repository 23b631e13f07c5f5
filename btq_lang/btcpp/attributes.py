"""Pairs of a file as attributes of an element: their order is kept, and of two values the first counts.

One invariant: no element gets two attributes of one name, or one whose name XML does not know.
"""

from __future__ import annotations

from btq_lang.btcpp.document import Attribute
from btq_lang.btcpp.source import ExportSource
from btq_lang.btcpp.spelling import in_unit, spelt
from btq_lang.catalog.kinds import NodeKind
from btq_lang.catalog.names import is_xml_name
from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.tree import Entry, Pair, Root, Word


def attributes_of(
    source: ExportSource,
    entry: Entry,
    pairs: tuple[Pair, ...],
    builtin: NodeKind | None = None,
    label: Word | None = None,
) -> list[Attribute]:
    """The attributes for the pairs in brackets, after a label, which is the `name`; `builtin`: has the units
    of ports."""
    attributes = [] if label is None else [Attribute("name", spelt(label))]
    for pair in pairs:
        value = pair.value
        if value is None:
            continue  # a syntax error, reported by the parser
        key = pair.key.text
        if not (key.isascii() and key.isidentifier()) and not _is_attribute_name(source, key):
            source.problem(entry, pair.key, f"`{key}` cannot be the name of an XML attribute")
            continue
        raw = spelt(value) if value.kind != QUANTITY else _quantity(source, entry, key, value, builtin)
        attributes.append(Attribute(key, raw))
    return only_first(attributes) if len(attributes) > 1 else attributes


def only_first(attributes: list[Attribute]) -> list[Attribute]:
    """The attributes without those whose name occurs before."""
    first: dict[str, Attribute] = {}
    for attribute in attributes:
        first.setdefault(attribute.name, attribute)
    return attributes if len(first) == len(attributes) else list(first.values())


def _is_attribute_name(source: ExportSource, key: str) -> bool:
    """Whether XML allows the name; for `xsi:type`, whether `xsi` is declared (Namespaces in XML 1.0, section 5)."""
    prefix, colon, local = key.partition(":")
    if not colon:
        return is_xml_name(key)
    roots = (entry.item for entry in source.file.parsed.entries if isinstance(entry.item, Root))
    declared = {pair.key.text for root in roots for pair in root.attributes}
    is_declared = prefix in ("xml", "xmlns") or f"xmlns:{prefix}" in declared
    return is_declared and is_xml_name(prefix) and is_xml_name(local)


def _quantity(source: ExportSource, entry: Entry, key: str, value: Word, builtin: NodeKind | None) -> str:
    """A quantity as a number in the port's unit; as it is written if that unit is not known."""
    port = builtin.port(key) if builtin is not None else None
    number = in_unit(value, port.unit if port is not None else None)
    if number is None:
        source.problem(entry, value, f"`{value.raw}` cannot be written as a number of the port `{key}`")
        return spelt(value)
    return number
