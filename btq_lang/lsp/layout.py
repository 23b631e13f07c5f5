"""Formatting.

A text with a syntax error is not changed.  The reason is only logged: the error is underlined already, and a message
box would open at every save that formats.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang.lsp.editor import Server

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


def register(server: Server) -> None:
    convert = server.convert

    def formatted(document: types.TextDocumentIdentifier, within: types.Range | None) -> list[types.TextEdit] | None:
        place = server.at(document)
        if place is None or _is_refused(server, *place):
            return None
        from btq_lang.formatter import format_range, format_text  # imported on use, like features

        text = place[0].files[place[1]].text
        edits = format_text(text).edits if within is None else format_range(text, *convert.span(*place, within))
        return convert.edits(*place, edits)

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def formatting(params: types.DocumentFormattingParams) -> list[types.TextEdit] | None:
        return formatted(params.text_document, None)

    @server.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
    def range_formatting(params: types.DocumentRangeFormattingParams) -> list[types.TextEdit] | None:
        return formatted(params.text_document, params.range)


def _is_refused(server: Server, workspace: Workspace, path: str) -> bool:
    """Whether a file has a syntax error, which is then logged."""
    from btq_lang.formatter import refused  # as above

    file = workspace.files[path]
    error = refused(file.parsed)
    if error is None:
        return False
    line, column = file.lines.position(error.span.start)
    message = f"{path}:{line + 1}:{column + 1}: cannot format a file with an error: {error.message}"
    server.window_log_message(types.LogMessageParams(types.MessageType.Warning, message))
    return True
