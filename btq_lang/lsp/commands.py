"""Commands of the server, whose results an editor uses as it likes.

Their names begin with `btq.server.`, so that an editor's plug-in can have commands of its own.
"""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import Handlers, RequestRefused, Server, UnknownDocument
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from collections.abc import Iterable

    from btq_lang.projects.messages import CommandOutput
    from btq_lang.workspace.workspace import Workspace

NODE_PATH = "btq.server.nodePath"
XML = "btq.server.xml"
PICTURE = "btq.server.picture"
OVERVIEW = "btq.server.overview"
BUILD = "btq.server.build"
IMPORT = "btq.server.import"
USES = "btq.server.uses"


handlers = Handlers()


@handlers.command(NODE_PATH)
def path_of_node(server: Server, place: types.TextDocumentPositionParams) -> str | None:
    """The path of the node at a position."""
    with suppress(UnknownDocument):
        return server.ask(place, features.navigation.node_path, reads=True)[2]
    return None


@handlers.command(XML)
def xml(server: Server, document: types.TextDocumentIdentifier) -> str:
    """The XML that `btq build` would write for a document in its current state, saved or not."""
    workspace, path = mission_at(server, document)
    from btq_lang.btcpp.document import write  # large, and not needed by most sessions
    from btq_lang.btcpp.outputs import as_xml

    export = as_xml(workspace, path).export
    for problem in export.problems:
        raise RequestRefused(f"cannot write this as XML: {problem.message}")
    return write(export.document)


@handlers.command(PICTURE)
def picture(server: Server, document: types.TextDocumentIdentifier, *folded: str) -> dict[str, object]:
    """The trees of a document as SVG, and the range of each node in the text, by the node's key."""
    workspace, path = mission_at(server, document, reads=True)
    from btq_lang.graph.picture import picture as draw  # as above

    evidence = server.session.evidence(workspace)
    if evidence is None:
        drawing = draw(workspace, path, folded)
    else:
        from btq_lang.ide.verdicts import measured_in  # few projects have logs

        drawing = draw(workspace, path, folded, measured_in(workspace, path, evidence))
    places = {key: server.convert.range(workspace, path, span).start for key, span in drawing.places.items()}
    return {"svg": drawing.svg, "nodes": places}


@handlers.command(OVERVIEW)
def overview(server: Server, document: types.TextDocumentIdentifier) -> str:
    """The page that `btq trace --format html` writes for a document in its current state, saved or not."""
    workspace, path = mission_at(server, document, reads=True)
    from btq_lang.trace.judged import judged_runs, together  # as above
    from btq_lang.trace.missions import trace_tables

    evidence = server.session.evidence(workspace)
    table = trace_tables([(workspace, (path,))], verdicts_of=evidence.verdicts_of if evidence is not None else None)
    written = evidence.missions.get(path) if evidence is not None else None
    judged = together(judged_runs(written.sources)) if written is not None else None
    return replace(table, overview=replace(table.overview, judged=judged)).write("html")


@handlers.command(BUILD)
def build(server: Server, document: types.TextDocumentIdentifier) -> dict[str, object]:
    """Write the XML of a mission as `btq build` does, with the editor's texts of open files."""
    _, path = mission_at(server, document)
    if not document.uri.startswith("file:"):
        raise RequestRefused("save this document to a file first")
    from btq_lang.projects.build_files import BuildOptions, build_files  # as above
    from btq_lang.projects.files import Files

    files = Files()
    files.overlay = {**server.session.open}
    result = build_files(BuildOptions((path,), report="concise"), files)
    return _outcome(server, result.code, result.files, result.messages)


@handlers.command(IMPORT)
def import_(server: Server, document: types.TextDocumentIdentifier) -> dict[str, object]:
    """Write the .btq file for XML as `btq import` does, beside it."""
    workspace, path = mission_at(server, document, reads=True)
    from btq_lang.workspace.loader import read  # as above

    file = workspace.files[path]
    if not file.is_foreign:
        raise RequestRefused("this is a .btq file already")
    if not document.uri.startswith("file:") or read(path)[0] != file.source:
        raise RequestRefused("save this document to a file first")
    from btq_lang.projects.import_files import ImportOptions, import_files

    result = import_files(ImportOptions((path,)))
    return _outcome(server, result.code, result.missions, result.messages)


@handlers.command(USES)
def uses(server: Server, places: list[types.Location]) -> None:
    """Show locations in an editor without a list for them: go to a single one, or show a message that names all."""
    if len(places) == 1 and server.supports("window.show_document"):
        (place,) = places
        server.window_show_document(types.ShowDocumentParams(place.uri, take_focus=True, selection=place.range))
        return
    from btq_lang.workspace.config import Project  # as above

    shown = Project(folders=server.session.folders).shown
    named = [f"{shown(server.convert.path(place.uri))}:{place.range.start.line + 1}" for place in places]
    server.window_show_message(types.ShowMessageParams(types.MessageType.Info, "\n".join(named)))


def mission_at(server: Server, document: types.TextDocumentIdentifier, *, reads: bool = False) -> tuple[Workspace, str]:
    """The workspace and the path of a document; without any, the request is refused."""
    try:
        return server.at(document, reads=reads)
    except UnknownDocument:
        what = "neither a .btq file nor BehaviorTree.CPP's XML" if reads else "not a .btq file"
        raise RequestRefused(f"this is {what} of the open folders") from None


def _outcome(server: Server, code: int, files: Iterable[str], messages: CommandOutput) -> dict[str, object]:
    if code:
        raise RequestRefused(messages.text())
    return {"files": [server.convert.uri(file) for file in files], "said": messages.text()}
