"""A mission and all that is registered with it, by includes or by its factory, as one document.

One invariant: each file is written as it would be by itself; only the includes between them are gone, and the models
are in one place.
"""

from __future__ import annotations

from typing import Final

from btq_lang.btcpp.document import Content, Document, Element
from btq_lang.btcpp.export import Export, export
from btq_lang.btcpp.source import Remark
from btq_lang.catalog.name_kinds import Kind
from btq_lang.workspace.workspace import Workspace


def bundle(workspace: Workspace, path: str, *, verbatim: bool = False) -> Export:
    """A file and all that is registered with it, XML files too, as one document; the others come first."""
    paths = workspace.registered_with(path)
    exports = [
        export(workspace, each, verbatim=verbatim, included_as=lambda _: _IN_BUNDLE, is_bundled=True) for each in paths
    ]
    main = exports[-1].document
    root = Element("root", main.root.attributes)
    palette = Element("TreeNodesModel")
    includes: dict[str, Element] = {}
    for done in exports:
        _merge(done.document, root.children, palette, includes, keep_outer=done is not exports[-1])
    root.children[:0] = includes.values()
    if palette.children:
        root.children.append(palette)
    contents = [root if content is main.root else content for content in main.contents]
    return Export(
        Document(contents),
        tuple(remark for done in exports for remark in done.repairs),
        (*(remark for done in exports for remark in done.problems), *_twice(workspace, paths)),
        {key: element for done in exports for key, element in done.elements.items()},
        {name: category for done in exports for name, category in done.guessed.items()},
    )


def _merge(
    document: Document, contents: list[Content], palette: Element, includes: dict[str, Element], keep_outer: bool
) -> None:
    """Add the contents of a document's root and, for the main file (`keep_outer`), the comments around the root."""
    for content in document.contents:
        if content is not document.root:
            if keep_outer:
                contents.append(content)
            continue
        for child in document.root.children:
            if not isinstance(child, Element):
                contents.append(child)
            elif child.tag == "include":
                path = child.get("path")
                if path is not None and path != _IN_BUNDLE:  # files of packages, which only the robot can resolve
                    includes.setdefault(f"{child.get('ros_pkg')}/{path}", child)
            elif child.tag == "TreeNodesModel":
                _add_models(palette, child)
            else:
                contents.append(child)


def _add_models(palette: Element, models: Element) -> None:
    """Add models: a node that two files declare gets one, the first, plus the ports that only the second has."""
    known = {_named(model): model for model in palette.elements if model.get("ID") is not None}
    for content in models.children:
        first = known.get(_named(content)) if isinstance(content, Element) else None
        if first is None or not isinstance(content, Element):
            palette.children.append(content)
            continue
        ports = {port.get("name") for port in first.elements}
        new = [port for port in content.elements if port.tag.endswith("_port") and port.get("name") not in ports]
        first.children.extend(new)


def _named(model: Element) -> tuple[bool, str | None]:
    """What a model declares; a tree and a node may share a name."""
    return model.tag == "SubTree", model.get("ID")


def _twice(workspace: Workspace, paths: tuple[str, ...]) -> list[Remark]:
    """The trees whose ID another tree has already."""
    known: set[str] = set()
    found = []
    for path in paths:
        for definition in workspace.files[path].defined:
            if definition.symbol.kind is Kind.TREE:
                name = definition.symbol.name
                if name in known:
                    found.append(Remark(path, definition.span, f"a bundle cannot hold two trees called `{name}`"))
                known.add(name)
    return found


_IN_BUNDLE: Final = "/"  # no file can have this name
