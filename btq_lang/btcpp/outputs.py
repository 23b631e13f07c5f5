"""The texts that `btq build` writes: the XML of each mission, and its side file if it says more than the XML.

One invariant: it does not use the disk; the same workspace and places give the same texts.  In a bundle each file is
written as it would be by itself; only the includes between them are left out, and the models are in one place.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Final

from btq_lang.btcpp.document import Content, Document, Element, XmlComment, write
from btq_lang.btcpp.enforcement import Enforcement, enforced
from btq_lang.btcpp.export import Export, IncludedAs, export, is_mission, xml_name
from btq_lang.btcpp.marks import generated_mark
from btq_lang.btcpp.side_file import BuiltFile, side_file
from btq_lang.btcpp.source import Remark
from btq_lang.catalog.name_kinds import Kind
from btq_lang.syntax.tree import Tree
from btq_lang.util.record import Record
from btq_lang.workspace.workspace import Workspace


class MissionOutput(Record):
    """A mission as it is written.

    Attributes:
        path: of the mission.
        place: of its XML.
        done: the document, and how its requirements are enforced.
        text: the XML; empty if `done.export` has problems.
        side: the side file; None if the XML says everything.
    """

    path: str
    place: str
    done: Enforcement
    text: str
    side: str | None


class OutputPlaces:
    """Where the XML of each file is written: beside it, or below a folder, at the path of the file below the folder
    common to all."""

    def __init__(self, folder: str | None = None, sources: Sequence[str] = ()) -> None:
        """folder: absolute; None: beside the files; sources: all files that are built."""
        self._folder = folder
        self._above = posixpath.commonpath([posixpath.dirname(each) for each in sources]) if folder and sources else ""

    def of(self, source: str) -> str:
        """The place of the XML of one of the files."""
        if self._folder is None:
            return xml_name(source)
        return posixpath.normpath(posixpath.join(self._folder, posixpath.relpath(xml_name(source), self._above)))

    def seen_from(self, source: str, included: str, workspace: Workspace) -> str:
        """How the XML of `source` names an included file: the XML made from it, or an XML file itself."""
        place = self.of(included) if is_mission(workspace, included) else included
        return posixpath.relpath(place, posixpath.dirname(self.of(source)) or ".")


def outputs(
    workspace: Workspace,
    requested: Sequence[str],
    places: OutputPlaces,
    *,
    bundled: bool = False,
    verbatim: bool = False,
    enforce: bool = True,
) -> tuple[MissionOutput, ...]:
    """What a build writes: an output for each requested file and each file they include, or one for each mission with
    all that is registered with it.

    Args:
        requested: the files to build.
        bundled: write all that is registered with a mission into its file.
        verbatim: write exactly what is in the files, without side files.
        enforce: add the nodes that enforce requirements.
    """
    build = partial(as_xml, workspace, bundled=bundled, verbatim=verbatim, enforce=enforce)
    exports = {
        path: build(path, included_as=partial(places.seen_from, path, workspace=workspace))
        for path in (missions(workspace, requested) if bundled else sources(workspace, requested))
    }
    if any(enforcement.export.problems for enforcement in exports.values()):
        return tuple(MissionOutput(path, places.of(path), built, "", None) for path, built in exports.items())
    written = []
    for path, enforcement in exports.items():
        place, text = places.of(path), _text(path, enforcement.export.document, verbatim)
        side = None if verbatim else _side_text(workspace, path, place, text, exports, bundled)
        written.append(MissionOutput(path, place, enforcement, text, side))
    return tuple(written)


def as_xml(
    workspace: Workspace,
    path: str,
    *,
    bundled: bool = False,
    verbatim: bool = False,
    enforce: bool = True,
    included_as: IncludedAs | None = None,
) -> Enforcement:
    """A file as a build writes it, see `outputs`; without the nodes that enforce requirements if the file cannot be
    written."""
    if bundled:
        exported = bundle(workspace, path, verbatim=verbatim)
    else:
        exported = export(workspace, path, verbatim=verbatim, included_as=included_as)
    if verbatim or not enforce or exported.problems:
        return Enforcement(exported, ())
    return enforced(workspace, path, exported, bundled)


def sources(workspace: Workspace, requested: Sequence[str]) -> tuple[str, ...]:
    """The requested files and all that they include, without XML."""
    loaded = loaded_files(workspace, requested)
    paths = dict.fromkeys(loaded)
    for path in loaded:
        paths.update(dict.fromkeys(workspace.closure(path)))
    return tuple(path for path in paths if is_mission(workspace, path))


def missions(workspace: Workspace, requested: Sequence[str]) -> tuple[str, ...]:
    """The requested files that no file includes; of a factory with main trees, those that define one; all requested
    files, if there are none."""
    included = workspace.included_files
    requested = loaded_files(workspace, requested)
    mains = workspace.factory.main if workspace.factory is not None else ()
    not_included = [path for path in requested if path not in included]
    tops = [path for path in not_included if any(workspace.files[path].defines(Kind.TREE, name) for name in mains)]
    return tuple(tops or not_included or requested)


def loaded_files(workspace: Workspace, requested: Sequence[str]) -> tuple[str, ...]:
    """The requested files without those of scenarios, which no program loads."""
    included = workspace.included_files
    return tuple(path for path in requested if path in included or not workspace.files[path].has_only_scenarios)


def without_tree(workspace: Workspace, requested: Sequence[str]) -> Iterator[str]:
    """The requested files that have no tree and declare nothing that another file could use."""
    for path in loaded_files(workspace, requested):
        if path in workspace.included_files or not is_mission(workspace, path) or workspace.files[path].defined:
            continue
        entries = (entry for each in workspace.closure(path) for entry in workspace.files[each].parsed.entries)
        if not any(isinstance(entry.item, Tree) for entry in entries):  # a single tree needs no name
            yield path


def _text(path: str, document: Document, verbatim: bool) -> str:
    if verbatim:
        return write(document)
    return write(Document([XmlComment(generated_mark(posixpath.basename(path))), *document.contents]))


def _side_text(
    workspace: Workspace, path: str, place: str, text: str, exports: dict[str, Enforcement], bundled: bool
) -> str | None:
    parts: tuple[Export, ...] = (exports[path].export,)
    if not bundled:  # the XML that it includes is imported
        parts = tuple(
            exports[each].export if each in exports else export(workspace, each)
            for each in workspace.registered_with(path)
        )
    elements = {key: element for part in parts for key, element in part.elements.items()}
    documents = tuple(part.document for part in parts)
    return side_file(workspace, BuiltFile(path, place, text, documents, elements, exports[path].clauses))


# ---- a mission and all that is registered with it, as one document ----


def bundle(workspace: Workspace, path: str, *, verbatim: bool = False) -> Export:
    """A file and all that is registered with it, XML files too, as one document; the others come first."""
    paths = workspace.registered_with(path)
    exports = [
        export(workspace, member, verbatim=verbatim, included_as=lambda _: _IN_BUNDLE, is_bundled=True)
        for member in paths
    ]
    main = exports[-1].document
    root = Element("root", main.root.attributes)
    palette = Element("TreeNodesModel")
    includes: dict[str, Element] = {}
    for part in exports:
        _merge(part.document, root.children, palette, includes, keep_outer=part is not exports[-1])
    root.children[:0] = includes.values()
    if palette.children:
        root.children.append(palette)
    contents = [root if content is main.root else content for content in main.contents]
    return Export(
        Document(contents),
        tuple(remark for part in exports for remark in part.repairs),
        (*(remark for part in exports for remark in part.problems), *_twice(workspace, paths)),
        {key: element for part in exports for key, element in part.elements.items()},
        {name: category for part in exports for name, category in part.guessed.items()},
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
    declared = {_named(model): model for model in palette.elements if model.get("ID") is not None}
    for content in models.children:
        first = declared.get(_named(content)) if isinstance(content, Element) else None
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
    names: set[str] = set()
    remarks = []
    for path in paths:
        for definition in workspace.files[path].defined:
            if definition.symbol.kind is Kind.TREE:
                name = definition.symbol.name
                if name in names:
                    remarks.append(Remark(path, definition.span, f"a bundle cannot hold two trees called `{name}`"))
                names.add(name)
    return remarks


_IN_BUNDLE: Final = "/"  # no file can have this name
