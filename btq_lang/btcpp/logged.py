"""The tree in a log as the XML that it was created from.

One invariant: a tree is written once, however many nodes run it, and has no attribute that the engine's loggers add:
numbers, full paths, names that are those of the kinds, defaults of ports, and models of the engine's own nodes.

Source: WriteTreeToXML in src/xml_parsing.cpp.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from btq_lang.btcpp.document import Attribute, Document, Element, escape
from btq_lang.btcpp.reader import read
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.syntax.tokens import CATEGORIES


def as_written(xml: str) -> Document:
    """The document of a tree in a log, from what a reader of logs has read."""
    document = read(xml).document
    assert document is not None
    root = document.root
    models = [each for each in root.elements if each.tag == "TreeNodesModel"]
    defaults = {
        (model.get("ID") or "", port.get("name") or ""): default
        for palette in models
        for model in palette.elements
        for port in model.elements
        if (default := port.get("default")) is not None
    }
    trees: dict[str, Element] = {}
    for tree in (each for each in root.elements if each.tag == "BehaviorTree"):
        prefix = tree.get("_fullpath") or ""
        for element in (each for top in tree.elements for each in top.walk()):
            element.attributes = _attributes(element, prefix, defaults)
        tree.attributes = tuple(each for each in tree.attributes if each.name not in _ADDED)
        trees.setdefault(tree.get("ID") or "", tree)
    for palette in models:
        palette.children[:] = [model for model in palette.elements if model.get("ID") not in BUILTINS]
    root.children[:] = [*trees.values(), *(each for each in models if each.children)]
    if trees and root.get("main_tree_to_execute") is None:
        root.attributes += (Attribute("main_tree_to_execute", escape(next(iter(trees)))),)
    return document


def _attributes(element: Element, prefix: str, defaults: Mapping[tuple[str, str], str]) -> tuple[Attribute, ...]:
    """The attributes as they were written at a node; `prefix`: the path of its tree."""
    kind = element.get("ID") or element.tag if element.tag in CATEGORIES else element.tag
    remaining = [
        attribute
        for attribute in element.attributes
        if attribute.name not in _ADDED
        and not (attribute.name == "name" and attribute.value == kind)
        and defaults.get((kind, attribute.name)) != attribute.value
    ]
    if element.tag == "SubTree":
        own = (element.get("_fullpath") or "").removeprefix(f"{prefix}/" if prefix else "")
        if own and own != f"{element.get('ID')}::{element.get('_uid')}":
            remaining.insert(1, Attribute("name", escape(own)))
    return tuple(remaining)


_ADDED: Final = ("_uid", "_fullpath")
