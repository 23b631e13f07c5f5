"""Code actions, renamed files, and formatting.

A text with a syntax error is not formatted.  The reason is only logged: the error is underlined already, and a message
box would open at every save that formats.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import Handlers, Server
from btq_lang.lsp.exploring import SHOW
from btq_lang.lsp.protocol import Plain

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


EXPLORE = "btq.explore"  # a command of the editor, which opens the run
EXPLORE_KIND = "btq.explore"
KINDS = [
    types.CodeActionKind.QuickFix,
    types.CodeActionKind.RefactorExtract,
    types.CodeActionKind.RefactorInline,
    types.CodeActionKind.RefactorRewrite,
    "source.fixAll.btq",
    "source.organizeImports.btq",
    EXPLORE_KIND,
]
_ALL = types.FileOperationFilter(types.FileOperationPattern("**/*"), scheme="file")


handlers = Handlers()


@handlers.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(code_action_kinds=KINDS), [])
def actions(server: Server, params: types.CodeActionParams) -> list[Plain]:
    workspace, path = server.at(params.text_document, reads=True)
    only = [str(getattr(kind, "value", kind)) for kind in params.context.only or ()]
    code_actions = features.actions.code_actions(
        workspace, path, server.convert.span(workspace, path, params.range), only, server.session.diagnostics(path)
    )
    plain = [server.convert.action(workspace, path, action, server.versions_for_edits()) for action in code_actions]
    if not only or any(kind in ("", EXPLORE_KIND) for kind in only):
        offset = server.convert.offset(workspace, path, params.range.start)
        requirement = features.violations.askable_at(workspace, path, offset)
        if requirement is not None:
            name = requirement.symbol.name
            title = f"Explore how `{name}` can be violated"
            command = exploring(server, requirement.path, title, name)
            plain.append({"title": title, "kind": EXPLORE_KIND, "command": command})
    return plain


def exploring(server: Server, path: str, title: str, requirement: str) -> types.Command:
    """The command that explores how a requirement can be violated, which a file defines."""
    name = EXPLORE if server.knows_command(EXPLORE) else SHOW
    return types.Command(title, name, arguments=[types.TextDocumentIdentifier(server.convert.uri(path)), requirement])


@handlers.feature(types.WORKSPACE_WILL_RENAME_FILES, types.FileOperationRegistrationOptions([_ALL]))
def will_rename(server: Server, params: types.RenameFilesParams) -> types.WorkspaceEdit | None:
    moves = {server.convert.path(file.old_uri): server.convert.path(file.new_uri) for file in params.files}
    by_workspace = [
        (workspace, features.moves.moved_files(workspace, moves)) for workspace in server.session.workspaces()
    ]
    edits = [(workspace, changes) for workspace, changes in by_workspace if changes]
    return server.convert.workspace_edit(server.versions_for_edits(), *edits) if edits else None


@handlers.feature(types.TEXT_DOCUMENT_ON_TYPE_FORMATTING, types.DocumentOnTypeFormattingOptions("\n", [")"]), [])
def typed(server: Server, params: types.DocumentOnTypeFormattingParams) -> list[types.TextEdit]:
    answer = server.ask(params, partial(features.on_type.on_type, typed=params.ch))
    return server.convert.edits(*answer)


@handlers.feature(types.TEXT_DOCUMENT_LINKED_EDITING_RANGE)
def linked(server: Server, params: types.LinkedEditingRangeParams) -> types.LinkedEditingRanges | None:
    workspace, path, spans = server.ask(params, features.on_type.linked_ranges)
    return types.LinkedEditingRanges([server.convert.range(workspace, path, span) for span in spans]) if spans else None


@handlers.feature(types.TEXT_DOCUMENT_FORMATTING)
@handlers.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
def formatted(
    server: Server,
    params: types.DocumentFormattingParams | types.DocumentRangeFormattingParams,
) -> list[types.TextEdit] | None:
    place = server.at(params.text_document)
    if _is_refused(server, *place):
        return None
    from btq_lang.formatter import format_range, format_text  # imported on use, like features

    text = place[0].files[place[1]].text
    if isinstance(params, types.DocumentFormattingParams):
        return server.convert.edits(*place, format_text(text).edits)
    return server.convert.edits(*place, format_range(text, *server.convert.span(*place, params.range)))


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
