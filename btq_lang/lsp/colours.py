"""Semantic tokens."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.ide.legend import MODIFIERS, TYPES
from btq_lang.lsp.editor import Handlers, RequestRefused, Server
from btq_lang.lsp.protocol import Json, Plain

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


handlers = Handlers()
_LEGEND = types.SemanticTokensLegend(list(TYPES), list(MODIFIERS))
_NO_TOKENS = Json('{"data": []}')


@handlers.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, _LEGEND, _NO_TOKENS)
async def full(server: Server, params: types.SemanticTokensParams) -> Json:
    if server.convert.path(params.text_document.uri) not in server.tokens:
        server.schedule.answering += 1
        try:
            await _prepare_tokens(server, params.text_document)
        finally:
            server.schedule.answering -= 1
    return _full_report(*_new_tokens(server, params.text_document))


@handlers.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, _LEGEND, _NO_TOKENS)
def delta(server: Server, params: types.SemanticTokensDeltaParams) -> Json:
    before = server.tokens.get(server.convert.path(params.text_document.uri))
    number, tokens = _new_tokens(server, params.text_document)
    if before is None or before[0] != params.previous_result_id:
        return _full_report(number, tokens)
    changes = features.colours.delta(before[1], tokens)
    edits = [f'{{"start": {edit.start}, "deleteCount": {edit.delete_count}, "data": {edit.data}}}' for edit in changes]
    return Json(f'{{"resultId": "{number}", "edits": [{", ".join(edits)}]}}')


@handlers.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, _LEGEND, _NO_TOKENS)
def part(server: Server, params: types.SemanticTokensRangeParams) -> Plain:
    workspace, path = server.at(params.text_document, reads=True)
    _raise_if_unread(workspace, path)
    within = server.convert.span(workspace, path, params.range)
    is_xml = workspace.files[path].is_foreign
    make = features.xml_colours.encoded_in_xml if is_xml else features.colours.encoded_within
    return {"data": make(workspace, path, within, server.convert.encoding)}


class Later(RequestRefused):
    """A request that has no answer now: an editor keeps the last one."""

    CODE = -32802  # ServerCancelled


def _raise_if_unread(workspace: Workspace, path: str) -> None:
    """Keep the colours of XML while a key has made it unreadable."""
    file = workspace.files[path]
    if file.is_foreign and not file.is_understood:
        raise Later("this XML cannot be read")


async def _prepare_tokens(server: Server, document: types.TextDocumentIdentifier) -> None:
    """Compute what the tokens depend on for the first time, in steps that let other messages in; after an edit,
    continue with the new text.
    """
    is_done = False
    while not is_done:
        place = workspace, path = server.at(document, reads=True)
        is_xml = workspace.files[path].is_foreign
        for _ in () if is_xml else features.colours.making(workspace, path, server.convert.encoding):
            await asyncio.sleep(0)
            if server.at(document, reads=True) != place:
                break
        else:
            is_done = True


def _new_tokens(server: Server, document: types.TextDocumentIdentifier) -> tuple[str, features.colours.Colours]:
    workspace, path = server.at(document, reads=True)
    _raise_if_unread(workspace, path)
    is_xml = workspace.files[path].is_foreign
    make = features.xml_colours.colours_in_xml if is_xml else features.colours.colours
    server.count += 1
    numbered = server.tokens[path] = str(server.count), make(workspace, path, server.convert.encoding)
    return numbered


def _full_report(number: str, tokens: features.colours.Colours) -> Json:
    return Json(f'{{"resultId": "{number}", "data": {tokens.as_json}}}')
