"""What is shown beside a text: call hierarchy, inlay hints, code lenses, hover, signature help and completion."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.commands import USES
from btq_lang.lsp.convert import markdown
from btq_lang.lsp.editor import Server
from btq_lang.lsp.protocol import Json
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


SHOW_REFERENCES = "btq.showReferences"  # a command of the editor, which opens its own list


def register(server: Server) -> None:
    convert = server.convert

    def item(workspace: Workspace, tree: features.navigation.TreeItem) -> types.CallHierarchyItem:
        return types.CallHierarchyItem(
            tree.name,
            types.SymbolKind.Class,
            convert.uri(tree.path),
            convert.range(workspace, tree.path, tree.span),
            convert.range(workspace, tree.path, tree.name_span),
            data={"path": tree.path, "span": [*tree.span], "name": [*tree.name_span]},
        )

    def calls(
        given: types.CallHierarchyItem,
        feature: Callable[[Workspace, features.navigation.TreeItem], tuple[features.navigation.TreeCall, ...]],
    ) -> Iterator[tuple[types.CallHierarchyItem, list[types.Range]]]:
        data = given.data if isinstance(given.data, dict) else {}
        workspace = server.session.workspace_of(str(data.get("path")))
        if workspace is not None:
            tree = features.navigation.TreeItem(given.name, data["path"], Span(*data["span"]), Span(*data["name"]))
            for call in feature(workspace, tree):
                yield item(workspace, call.tree), [convert.range(workspace, call.path, span) for span in call.places]

    @server.feature(types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY)
    def prepare(params: types.CallHierarchyPrepareParams) -> list[types.CallHierarchyItem] | None:
        workspace, _, tree = server.ask(params, features.navigation.prepare_calls, reads=True)
        return [item(workspace, tree)] if tree else None

    @server.feature(types.CALL_HIERARCHY_INCOMING_CALLS)
    def incoming(params: types.CallHierarchyIncomingCallsParams) -> list[types.CallHierarchyIncomingCall]:
        return [types.CallHierarchyIncomingCall(*call) for call in calls(params.item, features.navigation.callers)]

    @server.feature(types.CALL_HIERARCHY_OUTGOING_CALLS)
    def outgoing(params: types.CallHierarchyOutgoingCallsParams) -> list[types.CallHierarchyOutgoingCall]:
        return [types.CallHierarchyOutgoingCall(*call) for call in calls(params.item, features.navigation.called)]

    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT, otherwise=[])
    def hints(params: types.InlayHintParams) -> list[types.InlayHint]:
        workspace, path = server.at(params.text_document)
        if not server.session.is_on("inlayHints"):
            return []
        return [
            types.InlayHint(
                convert.range(workspace, path, Span(hint.offset, hint.offset)).start,
                hint.label,
                kind=types.InlayHintKind.Type,
                tooltip=markdown(hint.tooltip),
                padding_left=not hint.label.startswith(":"),
            )
            for hint in features.hints.inlay_hints(workspace, path, convert.span(workspace, path, params.range))
        ]

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS, otherwise=[])
    def lenses(params: types.CodeLensParams) -> list[types.CodeLens]:
        workspace, path = server.at(params.text_document, reads=True)
        if not server.session.is_on("codeLens"):
            return []
        found = []
        for lens in features.hints.code_lenses(
            workspace, path, server.session.side_file(path), server.session.evidence(workspace)
        ):
            range_ = convert.range(workspace, path, lens.span)
            uses = [convert.location(workspace, *use) for use in lens.places]
            if not uses:
                command = types.Command(lens.title, "")  # a plain title: there is nothing to open
            elif server.knows_command(SHOW_REFERENCES):
                command = types.Command(lens.title, SHOW_REFERENCES, arguments=[convert.uri(path), range_.start, uses])
            else:
                command = types.Command(lens.title, USES, arguments=[uses])
            found.append(types.CodeLens(range_, command))
        return found

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    def show(params: types.HoverParams) -> Json | None:
        side = server.session.side_file(convert.path(params.text_document.uri))
        workspace, path, found = server.ask(
            params,
            lambda *at: features.hover.hover(at[0], at[1], at[2], side, server.session.evidence(at[0])),
            reads=True,
        )
        return convert.hover(workspace, path, found) if found else None

    @server.feature(
        types.TEXT_DOCUMENT_SIGNATURE_HELP,
        types.SignatureHelpOptions(trigger_characters=["("], retrigger_characters=["=", " ", ","]),
    )
    def signature(params: types.SignatureHelpParams) -> types.SignatureHelp | None:
        found = server.ask(params, features.hover.signature_help)[2]
        return convert.signature(found) if found else None

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
            snippets=server.supports("text_document.completion.completion_item.snippet_support"),
        )
        place = server.at(params.text_document, reads=True)
        return convert.completion(*place, feature(*place, convert.offset(*place, params.position)))

    @server.feature(types.COMPLETION_ITEM_RESOLVE)
    def resolve(item: types.CompletionItem) -> types.CompletionItem:
        data = item.data if isinstance(item.data, dict) else {}
        path = str(data.get("path"))
        workspace = server.session.workspace_of(path)
        if workspace is not None:
            text = features.describe.documentation(workspace, path, str(data.get("kind")), str(data.get("name")))
            item.documentation = markdown(text) if text else None
            edits = features.describe.include_edits(workspace, path, str(data.get("include") or ""))
            item.additional_text_edits = convert.edits(workspace, path, edits) or None
        return item
