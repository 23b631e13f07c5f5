"""Semantic tokens."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.ide.legend import MODIFIERS, TYPES
from btq_lang.lsp.editor import Refused, Server
from btq_lang.lsp.protocol import Json, Plain

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


def register(server: Server) -> None:
    convert = server.convert

    def colours(document: types.TextDocumentIdentifier) -> tuple[str, features.colours.Colours] | None:
        place = server.at(document, reads=True)
        if place is None:
            return None
        _raise_if_unread(*place)
        make = (
            features.colours.colours if place[0].files[place[1]].origin is None else features.xml_colours.colours_in_xml
        )
        server.count += 1
        found = server.tokens[place[1]] = str(server.count), make(*place, convert.encoding)
        return found

    async def made(document: types.TextDocumentIdentifier) -> None:
        """Compute what the tokens depend on for the first time, in steps that let other messages in; after an edit,
        continue with the new text.
        """
        place, is_done = server.at(document), False
        while place is not None and not is_done:
            for _ in features.colours.making(*place, convert.encoding):
                await asyncio.sleep(0)
                if server.at(document) != place:
                    break
            else:
                is_done = True
            place = server.at(document)

    def whole(found: tuple[str, features.colours.Colours] | None) -> Json:
        return Json(f'{{"resultId": "{found[0]}", "data": {found[1].as_json}}}') if found else Json('{"data": []}')

    legend = types.SemanticTokensLegend(list(TYPES), list(MODIFIERS))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, legend)
    async def full(params: types.SemanticTokensParams) -> Json:
        if convert.path(params.text_document.uri) not in server.tokens:
            server.answering += 1
            try:
                await made(params.text_document)
            finally:
                server.answering -= 1
        return whole(colours(params.text_document))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, legend)
    def delta(params: types.SemanticTokensDeltaParams) -> Json:
        before = server.tokens.get(convert.path(params.text_document.uri))
        found = colours(params.text_document)
        if found is None or before is None or before[0] != params.previous_result_id:
            return whole(found)
        changes = features.colours.delta(before[1], found[1])
        edits = [f'{{"start": {one.start}, "deleteCount": {one.gone}, "data": {one.come}}}' for one in changes]
        return Json(f'{{"resultId": "{found[0]}", "edits": [{", ".join(edits)}]}}')

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, legend)
    def part(params: types.SemanticTokensRangeParams) -> Plain:
        place = server.at(params.text_document, reads=True)
        if place is None:
            return {"data": []}
        workspace, path = place
        _raise_if_unread(workspace, path)
        within = convert.span(workspace, path, params.range)
        make = (
            features.colours.encoded_within
            if workspace.files[path].origin is None
            else features.xml_colours.encoded_in_xml
        )
        return {"data": make(workspace, path, within, convert.encoding)}


class Later(Refused):
    """A request that has no answer now: an editor keeps the last one."""

    CODE = -32802  # ServerCancelled


def _raise_if_unread(workspace: Workspace, path: str) -> None:
    """Keep the colours of XML while a key has made it unreadable."""
    origin = workspace.files[path].origin
    if origin is not None and not origin.is_complete:
        raise Later("this XML cannot be read")
