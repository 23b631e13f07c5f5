"""Semantic tokens."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.ide.legend import MODIFIERS, TYPES
from btq_lang.lsp.editor import RequestRefused, Server
from btq_lang.lsp.protocol import Json, Plain

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


def register(server: Server) -> None:
    convert = server.convert

    def colours(document: types.TextDocumentIdentifier) -> tuple[str, features.colours.Colours]:
        workspace, path = server.at(document, reads=True)
        _raise_if_unread(workspace, path)
        is_xml = workspace.files[path].is_foreign
        make = features.xml_colours.colours_in_xml if is_xml else features.colours.colours
        server.count += 1
        found = server.tokens[path] = str(server.count), make(workspace, path, convert.encoding)
        return found

    async def made(document: types.TextDocumentIdentifier) -> None:
        """Compute what the tokens depend on for the first time, in steps that let other messages in; after an edit,
        continue with the new text.
        """
        is_done = False
        while not is_done:
            place = workspace, path = server.at(document, reads=True)
            is_xml = workspace.files[path].is_foreign
            for _ in () if is_xml else features.colours.making(workspace, path, convert.encoding):
                await asyncio.sleep(0)
                if server.at(document, reads=True) != place:
                    break
            else:
                is_done = True

    def whole(number: str, found: features.colours.Colours) -> Json:
        return Json(f'{{"resultId": "{number}", "data": {found.as_json}}}')

    legend = types.SemanticTokensLegend(list(TYPES), list(MODIFIERS))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, legend, _NO_TOKENS)
    async def full(params: types.SemanticTokensParams) -> Json:
        if convert.path(params.text_document.uri) not in server.tokens:
            server.answering += 1
            try:
                await made(params.text_document)
            finally:
                server.answering -= 1
        return whole(*colours(params.text_document))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, legend, _NO_TOKENS)
    def delta(params: types.SemanticTokensDeltaParams) -> Json:
        before = server.tokens.get(convert.path(params.text_document.uri))
        number, found = colours(params.text_document)
        if before is None or before[0] != params.previous_result_id:
            return whole(number, found)
        changes = features.colours.delta(before[1], found)
        edits = [f'{{"start": {one.start}, "deleteCount": {one.gone}, "data": {one.come}}}' for one in changes]
        return Json(f'{{"resultId": "{number}", "edits": [{", ".join(edits)}]}}')

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, legend, _NO_TOKENS)
    def part(params: types.SemanticTokensRangeParams) -> Plain:
        workspace, path = server.at(params.text_document, reads=True)
        _raise_if_unread(workspace, path)
        within = convert.span(workspace, path, params.range)
        is_xml = workspace.files[path].is_foreign
        make = features.xml_colours.encoded_in_xml if is_xml else features.colours.encoded_within
        return {"data": make(workspace, path, within, convert.encoding)}


_NO_TOKENS = Json('{"data": []}')


class Later(RequestRefused):
    """A request that has no answer now: an editor keeps the last one."""

    CODE = -32802  # ServerCancelled


def _raise_if_unread(workspace: Workspace, path: str) -> None:
    """Keep the colours of XML while a key has made it unreadable."""
    file = workspace.files[path]
    if file.is_foreign and not file.is_understood:
        raise Later("this XML cannot be read")
