"""Formatting."""

from __future__ import annotations

from lsprotocol import types

from btq_lang.editor import Server


def register(server: Server) -> None:
    convert = server.convert

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def formatting(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        place = server.at(params.text_document)
        if place is None:
            return []
        from btq_lang.formatter import format_text  # imported when it is asked for, as features are

        workspace, path = place
        return convert.edits(*place, format_text(workspace.files[path].text).edits)

    @server.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
    def range_formatting(params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
        place = server.at(params.text_document)
        if place is None:
            return []
        from btq_lang.formatter import format_range  # as above

        workspace, path = place
        return convert.edits(*place, format_range(workspace.files[path].text, *convert.span(*place, params.range)))
