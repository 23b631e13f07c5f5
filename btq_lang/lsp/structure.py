"""Outline, folding, selection and links."""

from __future__ import annotations

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import Server


def register(server: Server) -> None:
    convert = server.convert

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def outline(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        place = server.at(params.text_document, reads=True)
        return [convert.outline(*place, each) for each in features.outline.document_symbols(*place)] if place else []

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    def folds(params: types.FoldingRangeParams) -> list[types.FoldingRange]:
        place = server.at(params.text_document)
        return [convert.fold(*place, each) for each in features.structure.folding_ranges(*place)] if place else []

    @server.feature(types.TEXT_DOCUMENT_SELECTION_RANGE)
    def selections(params: types.SelectionRangeParams) -> list[types.SelectionRange]:
        found = [
            server.ask(params.text_document, position, features.structure.selection_range)
            for position in params.positions
        ]
        return [convert.selection(*each) for each in found if each is not None]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_LINK)
    def links(params: types.DocumentLinkParams) -> list[types.DocumentLink]:
        place = server.at(params.text_document, reads=True)
        return [
            types.DocumentLink(convert.range(*place, link.span), target=convert.uri(link.target))
            for link in (features.structure.document_links(*place) if place else ())
            if place and link.target is not None
        ]
