"""Elements of XML that the engine refuses, or drops without a word, outside of trees.

One invariant: the result does not depend on trees.  An unknown element that resembles no known one may be of another
tool, so it is a hint.

Source: loadDocImpl, loadSubtreeModel and VerifyXML in src/xml_parsing.cpp of 3.8.6, 4.6.2, 4.8.4 and 4.10.0.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.versions import PORTS_OF_SUBTREE
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.syntax.tree import Include, Models, Port, Root, Tree, Verbatim, models_in
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Placed, Span

if TYPE_CHECKING:
    from btq_lang.btcpp.document import Element


def refused_element(view: View) -> Iterator[Diagnostic]:
    """An element, or a missing attribute, with which the engine does not load the file."""
    item = view.item
    is_model_read = any(map(PORTS_OF_SUBTREE.holds, view.engines))
    is_palette = lookups.is_palette(item)
    first = view.ask(lookups.first_palette) if is_palette or isinstance(item, Verbatim) else None
    if is_palette and first is not None and first is not view.facts:
        related = (Related(Place(_head(first.item), view.path, first.item), "the first one"),)
        message = "the engine refuses a second TreeNodesModel in one file"
        yield _refused(view, item, message, "move its models into the first one", related)
    for owner in view.owners if is_model_read else ():
        for port in owner.ports if isinstance(owner, Tree) or owner.category.raw == "SubTree" else ():
            if port.id is None:
                tree = f"`{owner.name.text}`" if owner.name is not None else "a tree"
                likely = _near_key(port, "name")
                message = f"the engine refuses a port without a name in the model of {tree}{likely}"
                yield _refused(view, port, message, 'write `name="…"`')
    if isinstance(item, Models) and is_model_read:
        for element, part in _spelt(item.models):
            if element.tag == "SubTree" and element.get("ID") is None:
                message = f"the engine refuses the model of a SubTree without an ID{_near_attribute(element, 'ID')}"
                yield _refused(view, part, message, 'write `ID="…"`, the name of the tree')
    for element, part in _spelt((item,)):
        if element.tag == "include" and element.get("path") is None:
            message = f"the engine refuses an include without a path{_near_attribute(element, 'path')}"
            yield _refused(view, part, message, 'write `path="…"`')
        elif element.tag in CATEGORIES and element.get("ID") is None and first is not None:
            message = f"the engine refuses <{element.tag}> without an ID directly below <root>, beside a TreeNodesModel"
            yield _refused(view, part, message, "put it into the TreeNodesModel, with an ID")


def ignored_element(view: View) -> Iterator[Diagnostic]:
    """An element or an attribute that the engine drops."""
    item = view.item
    for element, part in _spelt((item,)):
        yield from _below_root(element, part)
    for element, part in _spelt(item.models) if isinstance(item, Models) else ():
        yield from _below_models(element, part)
    for model in models_in(item):
        for element, part in _spelt(model.body):
            yield from _below_model(element, part)
        for port in model.ports:
            if port.id is None and model.category.raw != "SubTree":
                yield _ignored(port, f"a port without a name declares nothing{_near_key(port, 'name')}")
    yield from _attributes(view)


def _near_key(port: Port, name: str) -> str:
    """The end of a message about a port that lacks an attribute, if another one is nearly called so."""
    return did_you_mean((name,)) if any(near(pair.key.text, (name,)) for pair in port.attributes) else ""


def _near_attribute(element: Element, name: str) -> str:
    is_meant = any(
        attribute.name.casefold() == name.casefold() or near(attribute.name, (name,))
        for attribute in element.attributes
    )
    return did_you_mean((name,)) if is_meant else ""


def _below_root(element: Element, part: Placed) -> Iterator[Diagnostic]:
    tag = element.tag
    if tag in _OF_ROOT or tag in _OF_TOOLS or ":" in tag:
        return
    meant = near(tag, _OF_ROOT, 1)
    ignored = f"the engine ignores <{tag}>"
    if meant in (("BehaviorTree",), ("include",)):
        name = element.get("ID" if meant == ("BehaviorTree",) else "path")
        what = "the tree" if meant == ("BehaviorTree",) else "the trees of"
        lost = f", and with it {what} `{name}`" if name else ""
        yield _ignored(part, f"{ignored}{lost}; did you mean <{meant[0]}>?", severity=Severity.ERROR)
    elif meant:
        yield _ignored(part, f"{ignored}; did you mean <{meant[0]}>?")
    elif tag in CATEGORIES:
        yield _ignored(part, f"{ignored} directly below <root>", "put it into <TreeNodesModel>")
    elif tag in BUILTINS:
        yield _ignored(part, f"{ignored} directly below <root>", 'put it into <BehaviorTree ID="…">')
    else:
        yield _ignored(part, f"{ignored} directly below <root>", severity=Severity.HINT)


def _below_models(element: Element, part: Placed) -> Iterator[Diagnostic]:
    tag = element.tag
    if tag in _OF_TOOLS:
        return
    ignored = f"the engine ignores <{tag}> in <TreeNodesModel>"
    if tag in CATEGORIES:
        if element.get("ID") is None and tag != "SubTree":
            yield _ignored(part, f"a model without an ID declares nothing{_near_attribute(element, 'ID')}")
    elif tag in _OF_ROOT:
        yield _ignored(part, ignored, "put it directly below <root>", severity=Severity.ERROR)
    elif meant := near(tag, CATEGORIES, 1):
        yield _ignored(part, f"{ignored}; did you mean <{meant[0]}>?")
    elif tag in _PORTS:
        yield _ignored(part, ignored, "put it into the model of a node")
    else:
        yield _ignored(part, ignored, severity=Severity.HINT)


def _below_model(element: Element, part: Placed) -> Iterator[Diagnostic]:
    tag = element.tag
    if tag in _OF_TOOLS or tag in _PORTS:
        return
    port = _port_meant(tag)
    ignored = f"the engine and its tools ignore <{tag}> in a model"
    if port is None:
        yield _ignored(part, ignored, severity=Severity.HINT)
        return
    name = element.get("name") or element.get("label")
    shown = f'<{port} name="{name}"/>' if name is not None else f"<{port}>"
    notes = (f"version 2 wrote <{tag}>; now it is `{shown}`",) if tag == "Parameter" else ()
    yield _ignored(part, f"{ignored}; did you mean `{shown}`?", *notes)


def _port_meant(tag: str) -> str | None:
    """The element of a port that a tag was probably meant to be."""
    folded = "".join(filter(str.isalpha, tag.casefold()))
    likely = near(tag, _PORTS, 1) if folded not in ("inport", "outport") else ()
    if likely:
        return likely[0]
    if "port" not in folded and "param" not in folded and folded not in ("input", "output", "inout"):
        return None
    if folded.startswith(("bi", "inout", "io")):
        return "inout_port"
    return "output_port" if folded.startswith("out") else "input_port"


def _attributes(view: View) -> Iterator[Diagnostic]:
    """Attributes of the root, of includes and of ports that are misspelt."""
    item = view.item
    ports = (port for owner in view.owners for port in owner.ports if port.id is not None)  # else that is reported
    lists = [(port.attributes, _OF_PORT) for port in ports]
    if isinstance(item, Root | Include):
        lists.append((item.attributes, _OF_ROOT_TAG if isinstance(item, Root) else _OF_INCLUDE))
    for pairs, keys in lists:
        present = {pair.key.text for pair in pairs}
        for pair in pairs:
            key = pair.key.text
            is_other = key not in keys and key not in _TOOL_ATTRIBUTES
            free = keys.difference(present)
            meant = (
                (near(key, free, 1) or tuple(free.intersection(_CALLED.get(key.casefold(), ())))) if is_other else ()
            )
            if meant:
                yield _ignored(pair.key, f"the engine ignores `{key}`{did_you_mean(meant)}")


def _spelt(parts: tuple[object, ...]) -> Iterator[tuple[Element, Verbatim]]:
    """The elements that the language has no words for, as far as they can be read."""
    for part in parts:
        if isinstance(part, Verbatim) and part.text is not None:
            from btq_lang.btcpp.reader import read  # few files have such elements

            document = read(part.text.text).document
            if document is not None:
                yield document.root, part


def _refused(view: View, part: Placed, message: str, note: str, related: tuple[Related, ...] = ()) -> Diagnostic:
    return Diagnostic("refused-element", _head(part), message, related, (note,))


def _ignored(part: Placed, message: str, *notes: str, severity: Severity | None = None) -> Diagnostic:
    return Diagnostic("xml-ignored", _head(part), message, notes=notes, severity=severity)


def _head(part: Placed) -> Span:
    """The first word of a part: in XML the tag of its element."""
    if isinstance(part, Port):
        return part.direction.span
    if isinstance(part, Verbatim | Models):
        return Span(part.start, part.start + len("xml" if isinstance(part, Verbatim) else "TreeNodesModel"))
    return Span(part.start, part.end)


_OF_ROOT: Final = frozenset(("BehaviorTree", "TreeNodesModel", "include"))
_PORTS: Final = frozenset(("input_port", "output_port", "inout_port"))
_OF_TOOLS: Final = frozenset(("MetadataFields", "Metadata", "description"))  # of MoveIt Pro and Groot
_OF_PORT: Final = frozenset(("name", "type", "default", "description"))
_OF_ROOT_TAG: Final = frozenset(("BTCPP_format", "main_tree_to_execute"))
_OF_INCLUDE: Final = frozenset(("path", "ros_pkg"))
# Other words for these attributes; no known tool writes them.
_CALLED: Final = {
    **dict.fromkeys(
        ("main_tree", "maintree", "main_tree_id", "main", "main_tree_name", "entry_point"), ("main_tree_to_execute",)
    ),
    **dict.fromkeys(("format", "btcpp_version", "btcpp"), ("BTCPP_format",)),
    **dict.fromkeys(("file", "filename", "src", "href"), ("path",)),
}
_TOOL_ATTRIBUTES: Final = frozenset(("required", "editable", "project_name"))
