"""The texts that `btq build` writes: the XML of each mission, and its side file if it says more than the XML.

One invariant: it does not use the disk; the same workspace and places give the same texts.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Sequence
from functools import partial

from btq_lang.btcpp.bundle import bundle
from btq_lang.btcpp.document import Document, XmlComment, write
from btq_lang.btcpp.enforcement import Enforcement, enforced
from btq_lang.btcpp.export import Export, IncludedAs, export, is_mission, xml_name
from btq_lang.btcpp.marks import generated_mark
from btq_lang.btcpp.side_file import BuiltFile, side_file
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
    given: Sequence[str],
    places: OutputPlaces,
    *,
    bundled: bool = False,
    verbatim: bool = False,
    enforce: bool = True,
) -> tuple[MissionOutput, ...]:
    """What a build writes: an output for each given file and each file they include, or one for each mission with all
    that is registered with it.

    Args:
        given: the files to build.
        bundled: write all that is registered with a mission into its file.
        verbatim: write exactly what is in the files, without side files.
        enforce: add the nodes that enforce requirements.
    """
    made = partial(as_xml, workspace, bundled=bundled, verbatim=verbatim, enforce=enforce)
    exports = {
        path: made(path, included_as=partial(places.seen_from, path, workspace=workspace))
        for path in (missions(workspace, given) if bundled else sources(workspace, given))
    }
    if any(done.export.problems for done in exports.values()):
        return tuple(MissionOutput(path, places.of(path), done, "", None) for path, done in exports.items())
    found = []
    for path, done in exports.items():
        place, text = places.of(path), _text(path, done.export.document, verbatim)
        side = None if verbatim else _side_text(workspace, path, place, text, exports, bundled)
        found.append(MissionOutput(path, place, done, text, side))
    return tuple(found)


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
        done = bundle(workspace, path, verbatim=verbatim)
    else:
        done = export(workspace, path, verbatim=verbatim, included_as=included_as)
    if verbatim or not enforce or done.problems:
        return Enforcement(done, ())
    return enforced(workspace, path, done, bundled)


def sources(workspace: Workspace, given: Sequence[str]) -> tuple[str, ...]:
    """The given files and all that they include, without XML."""
    found = dict.fromkeys(given)
    for path in given:
        found.update(dict.fromkeys(workspace.closure(path)))
    return tuple(path for path in found if is_mission(workspace, path))


def missions(workspace: Workspace, given: Sequence[str]) -> tuple[str, ...]:
    """The given files that no file includes; of a factory with main trees, those that define one; all given files, if
    there are none."""
    included = workspace.included_files
    mains = workspace.factory.main if workspace.factory is not None else ()
    found = [path for path in given if path not in included]
    tops = [path for path in found if any(workspace.files[path].defines(Kind.TREE, name) for name in mains)]
    return tuple(tops or found or given)


def without_tree(workspace: Workspace, given: Sequence[str]) -> Iterator[str]:
    """The given files that have no tree and declare nothing that another file could use."""
    for path in given:
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
