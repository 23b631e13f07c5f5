"""Commands of the server, whose results an editor uses as it likes.

Their names begin with `btq.server.`, so that an editor's plug-in can have commands of its own.
"""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import RequestRefused, Server, UnknownDocument

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


def register(server: Server) -> None:
    convert = server.convert

    @server.command(NODE_PATH)
    def path_of_node(place: types.TextDocumentPositionParams) -> str | None:
        """The path of the node at a position."""
        with suppress(UnknownDocument):
            return server.ask(place, features.navigation.node_path, reads=True)[2]
        return None

    def mission(document: types.TextDocumentIdentifier, *, reads: bool = False) -> tuple[Workspace, str]:
        try:
            return server.at(document, reads=reads)
        except UnknownDocument:
            what = "neither a .btq file nor BehaviorTree.CPP's XML" if reads else "not a .btq file"
            raise RequestRefused(f"this is {what} of the open folders") from None

    def outcome(code: int, files: Iterable[str], messages: CommandOutput) -> dict[str, object]:
        if code:
            raise RequestRefused(messages.text())
        return {"files": [convert.uri(file) for file in files], "said": messages.text()}

    @server.command(XML)
    def xml(document: types.TextDocumentIdentifier) -> str:
        """The XML that `btq build` would write for a document in its current state, saved or not."""
        workspace, path = mission(document)
        from btq_lang.btcpp.document import write  # large, and not needed by most sessions
        from btq_lang.btcpp.outputs import as_xml

        done = as_xml(workspace, path).export
        for problem in done.problems:
            raise RequestRefused(f"cannot write this as XML: {problem.message}")
        return write(done.document)

    @server.command(PICTURE)
    def picture(document: types.TextDocumentIdentifier, *folded: str) -> dict[str, object]:
        """The trees of a document as SVG, and the range of each node in the text, by the node's key."""
        workspace, path = mission(document, reads=True)
        from btq_lang.graph.picture import picture as drawn  # as above

        evidence = server.session.evidence(workspace)
        if evidence is None:
            shown = drawn(workspace, path, folded)
        else:
            from btq_lang.ide.verdicts import measured_in  # few projects have logs

            shown = drawn(workspace, path, folded, measured_in(workspace, path, evidence))
        places = {key: convert.range(workspace, path, span).start for key, span in shown.places.items()}
        return {"svg": shown.svg, "nodes": places}

    @server.command(OVERVIEW)
    def overview(document: types.TextDocumentIdentifier) -> str:
        """The page that `btq trace --format html` writes for a document in its current state, saved or not."""
        workspace, path = mission(document, reads=True)
        from btq_lang.trace.missions import trace_tables  # as above

        evidence = server.session.evidence(workspace)
        verdicts_of = evidence.verdicts_of if evidence is not None else None
        return trace_tables([(workspace, (path,))], verdicts_of=verdicts_of).write("html")

    @server.command(BUILD)
    def build(document: types.TextDocumentIdentifier) -> dict[str, object]:
        """Write the XML of a mission as `btq build` does, with the editor's texts of open files."""
        _, path = mission(document)
        if not document.uri.startswith("file:"):
            raise RequestRefused("save this document to a file first")
        from btq_lang.projects.build_files import BuildOptions, build_files  # as above
        from btq_lang.projects.files import Files

        files = Files()
        files.overlay = {**server.session.open}
        built = build_files(BuildOptions((path,), report="concise"), files)
        return outcome(built.code, built.files, built.messages)

    @server.command(IMPORT)
    def import_(document: types.TextDocumentIdentifier) -> dict[str, object]:
        """Write the .btq file for XML as `btq import` does, beside it."""
        workspace, path = mission(document, reads=True)
        from btq_lang.workspace.loader import read  # as above

        file = workspace.files[path]
        if not file.is_foreign:
            raise RequestRefused("this is a .btq file already")
        if not document.uri.startswith("file:") or read(path)[0] != file.source:
            raise RequestRefused("save this document to a file first")
        from btq_lang.projects.import_files import ImportOptions, import_files

        imported = import_files(ImportOptions((path,)))
        return outcome(imported.code, imported.missions, imported.messages)

    @server.command(USES)
    def uses(places: list[types.Location]) -> None:
        """Show locations in an editor without a list for them: go to a single one, or show a message that names all."""
        if len(places) == 1 and server.supports("window.show_document"):
            (place,) = places
            server.window_show_document(types.ShowDocumentParams(place.uri, take_focus=True, selection=place.range))
            return
        from btq_lang.workspace.config import Project  # as above

        shown = Project(folders=server.session.folders).shown
        named = [f"{shown(convert.path(place.uri))}:{place.range.start.line + 1}" for place in places]
        server.window_show_message(types.ShowMessageParams(types.MessageType.Info, "\n".join(named)))
