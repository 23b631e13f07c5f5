"""Hover, signature help and completion."""

from __future__ import annotations

from functools import partial

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.convert import markdown
from btq_lang.lsp.editor import Server
from btq_lang.lsp.protocol import Json


def register(server: Server) -> None:
    session, convert = server.session, server.convert

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    def show(params: types.HoverParams) -> Json | None:
        side = session.side_file(convert.path(params.text_document.uri))
        answer = server.ask(
            params.text_document,
            params.position,
            lambda workspace, path, offset: features.hover.hover(
                workspace, path, offset, side, session.evidence(workspace)
            ),
            reads=True,
        )
        return convert.hover(answer[0], answer[1], answer[2]) if answer and answer[2] else None

    @server.feature(
        types.TEXT_DOCUMENT_SIGNATURE_HELP,
        types.SignatureHelpOptions(trigger_characters=["("], retrigger_characters=["=", " ", ","]),
    )
    def signature(params: types.SignatureHelpParams) -> types.SignatureHelp | None:
        answer = server.ask(params.text_document, params.position, features.hover.signature_help)
        return convert.signature(answer[2]) if answer and answer[2] else None

    @server.feature(
        types.TEXT_DOCUMENT_COMPLETION,
        types.CompletionOptions(trigger_characters=list('({=.<"@:/,['), resolve_provider=True),
    )
    def completion(params: types.CompletionParams) -> Json | None:
        context = params.context or types.CompletionContext(types.CompletionTriggerKind.Invoked)
        feature = partial(
            features.completion.complete,
            asked=context.trigger_kind == types.CompletionTriggerKind.Invoked,
            trigger=context.trigger_character or "",
            snippets=server.takes_snippets,
        )
        place = server.at(params.text_document, reads=True)
        if place is None:
            return None
        return convert.completion(*place, feature(*place, convert.offset(*place, params.position)))

    @server.feature(types.COMPLETION_ITEM_RESOLVE)
    def resolve(item: types.CompletionItem) -> types.CompletionItem:
        data = item.data if isinstance(item.data, dict) else {}
        path = str(data.get("path"))
        workspace = session.workspace_of(path)
        if workspace is not None:
            text = features.describe.documentation(workspace, path, str(data.get("kind")), str(data.get("name")))
            item.documentation = markdown(text) if text else None
            edits = features.describe.include_edits(workspace, path, str(data.get("include") or ""))
            item.additional_text_edits = convert.edits(workspace, path, edits) or None
        return item
