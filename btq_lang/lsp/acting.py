"""Code actions, renamed files, and formatting.

A text with a syntax error is not formatted.  The reason is only logged: the error is underlined already, and a message
box would open at every save that formats.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import Server
from btq_lang.lsp.protocol import Plain

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


KINDS = [
    types.CodeActionKind.QuickFix,
    types.CodeActionKind.RefactorExtract,
    types.CodeActionKind.RefactorInline,
    types.CodeActionKind.RefactorRewrite,
    "source.fixAll.btq",
    "source.organizeImports.btq",
]
_ALL = types.FileOperationFilter(types.FileOperationPattern("**/*"), scheme="file")


def register(server: Server) -> None:
    convert = server.convert

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(code_action_kinds=KINDS), [])
    def actions(params: types.CodeActionParams) -> list[Plain]:
        workspace, path = server.at(params.text_document, reads=True)
        only = [str(getattr(kind, "value", kind)) for kind in params.context.only or ()]
        found = features.actions.code_actions(
            workspace, path, convert.span(workspace, path, params.range), only, server.session.diagnostics(path)
        )
        return [convert.action(workspace, path, action, server.versions_for_edits()) for action in found]

    @server.feature(types.WORKSPACE_WILL_RENAME_FILES, types.FileOperationRegistrationOptions([_ALL]))
    def will_rename(params: types.RenameFilesParams) -> types.WorkspaceEdit | None:
        moves = {convert.path(file.old_uri): convert.path(file.new_uri) for file in params.files}
        found = [(each, features.moves.moved_files(each, moves)) for each in server.session.workspaces()]
        edits = [each for each in found if each[1]]
        return convert.workspace_edit(server.versions_for_edits(), *edits) if edits else None

    @server.feature(types.TEXT_DOCUMENT_ON_TYPE_FORMATTING, types.DocumentOnTypeFormattingOptions("\n", [")"]), [])
    def typed(params: types.DocumentOnTypeFormattingParams) -> list[types.TextEdit]:
        answer = server.ask(params, partial(features.on_type.on_type, typed=params.ch))
        return convert.edits(*answer)

    @server.feature(types.TEXT_DOCUMENT_LINKED_EDITING_RANGE)
    def linked(params: types.LinkedEditingRangeParams) -> types.LinkedEditingRanges | None:
        workspace, path, spans = server.ask(params, features.on_type.linked_ranges)
        return types.LinkedEditingRanges([convert.range(workspace, path, span) for span in spans]) if spans else None

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    @server.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
    def formatted(
        params: types.DocumentFormattingParams | types.DocumentRangeFormattingParams,
    ) -> list[types.TextEdit] | None:
        place = server.at(params.text_document)
        if _is_refused(server, *place):
            return None
        from btq_lang.formatter import format_range, format_text  # imported on use, like features

        text = place[0].files[place[1]].text
        if isinstance(params, types.DocumentFormattingParams):
            return convert.edits(*place, format_text(text).edits)
        return convert.edits(*place, format_range(text, *convert.span(*place, params.range)))


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
