"""Semantic tokens."""

from __future__ import annotations

from lsprotocol import types

from btq_lang import features
from btq_lang.editor import Server
from btq_lang.features.legend import MODIFIERS, TYPES


def register(server: Server) -> None:
    convert = server.convert

    def coloured(document: types.TextDocumentIdentifier, within: types.Range | None = None) -> list[int]:
        place = server.at(document)
        if place is None:
            return []
        span = convert.span(*place, within) if within else None
        workspace, path = place
        return features.encode(features.coloured(*place, span), workspace.files[path].text, convert.encoding)

    def remembered(document: types.TextDocumentIdentifier, data: list[int]) -> str:
        server.count += 1
        server.tokens[convert.path(document.uri)] = str(server.count), data
        return str(server.count)

    legend = types.SemanticTokensLegend(list(TYPES), list(MODIFIERS))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, legend)
    def full(params: types.SemanticTokensParams) -> types.SemanticTokens:
        data = coloured(params.text_document)
        return types.SemanticTokens(data, remembered(params.text_document, data))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, legend)
    def delta(params: types.SemanticTokensDeltaParams) -> types.SemanticTokens | types.SemanticTokensDelta:
        known, before = server.tokens.get(convert.path(params.text_document.uri), (None, []))
        data = coloured(params.text_document)
        result = remembered(params.text_document, data)
        if known != params.previous_result_id:
            return types.SemanticTokens(data, result)
        edit = features.delta(before, data)
        return types.SemanticTokensDelta([types.SemanticTokensEdit(*edit)] if edit else [], result)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, legend)
    def part(params: types.SemanticTokensRangeParams) -> types.SemanticTokens:
        return types.SemanticTokens(coloured(params.text_document, params.range))
