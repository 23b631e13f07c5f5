"""The XML in which a package tells pluginlib what its libraries export: nodes of trees among other classes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.btcpp.reader import read
from btq_lang.catalog.cpp_classes import ENGINE
from btq_lang.cpp.findings import UNSEEN
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.btcpp.document import Element


def exported_nodes(text: str) -> tuple[Diagnostic, ...] | None:
    """The nodes that a file exports, each as what cannot be seen, because the program that loads it gives the ID.

    None if it is not for pluginlib.

    Source: https://wiki.ros.org/pluginlib/PluginDescriptionFile
    """
    document = read(text).document
    if document is None or document.root.tag not in _ROOTS:
        return None
    return tuple(_nodes(document.root))


def _nodes(element: Element) -> Iterator[Diagnostic]:
    for each in element.elements:
        base = each.get("base_class_type") or ""
        if each.tag == "class" and base.startswith("BT::") and base.removeprefix("BT::") in ENGINE:
            name = each.get("type") or ""
            message = f"exports `{name}`, a {base}, to pluginlib; under which ID trees have it cannot be seen"
            yield Diagnostic(UNSEEN, Span(each.start, each.end), message)
        yield from _nodes(each)


_ROOTS: Final = ("library", "class_libraries")
