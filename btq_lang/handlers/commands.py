"""Commands of the server, for whatever an editor wants to do with their answers.

Their names begin with `btq.server.`, so that an editor's plug-in can have commands of its own.
"""

from __future__ import annotations

from lsprotocol import types

from btq_lang import features
from btq_lang.editor import Refused, Server

NODE_PATH = "btq.server.nodePath"
XML = "btq.server.xml"
PICTURE = "btq.server.picture"


def register(server: Server) -> None:
    session, convert = server.session, server.convert

    @server.command(NODE_PATH)
    def path_of_node(place: types.TextDocumentPositionParams) -> str | None:
        """The path of the node at a place."""
        asked = server.ask(place.text_document, place.position, features.path_of_node)
        return asked[2] if asked else None

    @server.command(XML)
    def xml(document: types.TextDocumentIdentifier) -> str:
        """What `btq build` would write for a document as it is now, saved or not."""
        path = convert.path(document.uri)
        workspace = session.workspace_of(path)
        if workspace is None:
            raise Refused("this file is in none of the editor's folders")
        from btq_lang.btcpp.document import write  # not needed by most sessions, and large
        from btq_lang.btcpp.enforcement import enforced
        from btq_lang.btcpp.export import export

        done = export(workspace, path)
        for problem in done.problems:
            raise Refused(f"this cannot be written as XML: {problem.message}")
        return write(enforced(workspace, path, done).export.document)

    @server.command(PICTURE)
    def picture(document: types.TextDocumentIdentifier) -> dict[str, object]:
        """The trees of a document as SVG, and by the key of each node in it where that stands in the text."""
        path = convert.path(document.uri)
        workspace = session.workspace_of(path)
        if workspace is None:
            raise Refused("this file is in none of the editor's folders")
        from btq_lang.graph import draw  # as above
        from btq_lang.graph.missions import figures, keyed

        places = {
            key: convert.range(workspace, path, node.node.head.span.shifted(node.entry.start)).start
            for key, node in keyed(workspace, path)
        }
        return {"svg": draw(figures(workspace, path, with_qualities=True)), "nodes": places}
