"""The trees of a file of XML as Nav2 lists them before it registers the file."""

from __future__ import annotations

from btq_lang.util.record import Record


class ListedTrees(Record):
    """The trees of a file.

    Attributes:
        ids: of all trees that have one, in order.
        main: the tree that it names as the main one.
    """

    ids: tuple[str, ...]
    main: str | None


def listed_trees(xml: str) -> ListedTrees | None:
    """The trees of a file; None if it cannot be parsed."""
    from lxml import etree  # as the rest of this room, only where there is XML

    try:
        root = etree.fromstring(xml.encode(), etree.XMLParser(resolve_entities=False, encoding="utf-8"))
    except etree.XMLSyntaxError:
        return None
    found = (each.get("ID") for each in root.findall("BehaviorTree"))
    return ListedTrees(tuple(each for each in found if each is not None), root.get("main_tree_to_execute"))
