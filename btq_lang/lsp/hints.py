"""What is shown beside a text: call hierarchy, inlay hints, code lenses, hover, signature help and completion."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.acting import exploring
from btq_lang.lsp.commands import USES
from btq_lang.lsp.convert import markdown
from btq_lang.lsp.editor import Handlers, Server
from btq_lang.lsp.protocol import Json
from btq_lang.lsp.scenarios import SHOW
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


SHOW_REFERENCES = "btq.showReferences"  # a command of the editor, which opens its own list
RUN_SCENARIO = "btq.runScenario"  # likewise


handlers = Handlers()


@handlers.feature(types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY)
def prepare(server: Server, params: types.CallHierarchyPrepareParams) -> list[types.CallHierarchyItem] | None:
    workspace, _, tree = server.ask(params, features.navigation.prepare_calls, reads=True)
    return [_hierarchy_item(server, workspace, tree)] if tree else None


@handlers.feature(types.CALL_HIERARCHY_INCOMING_CALLS)
def incoming(server: Server, params: types.CallHierarchyIncomingCallsParams) -> list[types.CallHierarchyIncomingCall]:
    return [types.CallHierarchyIncomingCall(*call) for call in _calls(server, params.item, features.navigation.callers)]


@handlers.feature(types.CALL_HIERARCHY_OUTGOING_CALLS)
def outgoing(server: Server, params: types.CallHierarchyOutgoingCallsParams) -> list[types.CallHierarchyOutgoingCall]:
    return [types.CallHierarchyOutgoingCall(*call) for call in _calls(server, params.item, features.navigation.called)]


@handlers.feature(types.TEXT_DOCUMENT_INLAY_HINT, otherwise=[])
def hints(server: Server, params: types.InlayHintParams) -> list[types.InlayHint]:
    workspace, path = server.at(params.text_document)
    if not server.session.is_on("inlayHints"):
        return []
    return [
        types.InlayHint(
            server.convert.range(workspace, path, Span(hint.offset, hint.offset)).start,
            hint.label,
            kind=types.InlayHintKind.Type,
            tooltip=markdown(hint.tooltip),
            padding_left=not hint.label.startswith(":"),
        )
        for hint in features.hints.inlay_hints(workspace, path, server.convert.span(workspace, path, params.range))
    ]


@handlers.feature(types.TEXT_DOCUMENT_CODE_LENS, otherwise=[])
def lenses(server: Server, params: types.CodeLensParams) -> list[types.CodeLens]:
    workspace, path = server.at(params.text_document, reads=True)
    if not server.session.is_on("codeLens"):
        return []
    code_lenses = []
    for lens in features.hints.code_lenses(
        workspace,
        path,
        server.session.side_file(path),
        server.session.evidence(workspace),
        server.outlooks.of(path),
    ):
        range_ = server.convert.range(workspace, path, lens.span)
        uses = [server.convert.location(workspace, *use) for use in lens.places]
        if lens.runs:
            name = RUN_SCENARIO if server.knows_command(RUN_SCENARIO) else SHOW
            document = types.TextDocumentIdentifier(server.convert.uri(path))
            command = types.Command(lens.title, name, arguments=[document, lens.runs])
        elif lens.explores:
            command = exploring(server, path, lens.title, lens.explores)
        elif not uses:
            command = types.Command(lens.title, "")  # a plain title: there is nothing to open
        elif server.knows_command(SHOW_REFERENCES):
            command = types.Command(
                lens.title, SHOW_REFERENCES, arguments=[server.convert.uri(path), range_.start, uses]
            )
        else:
            command = types.Command(lens.title, USES, arguments=[uses])
        code_lenses.append(types.CodeLens(range_, command))
    return code_lenses


@handlers.feature(types.TEXT_DOCUMENT_HOVER)
def show(server: Server, params: types.HoverParams) -> Json | None:
    side = server.session.side_file(server.convert.path(params.text_document.uri))
    workspace, path, hover = server.ask(
        params,
        lambda workspace, path, offset: features.hover.hover(
            workspace, path, offset, side, server.session.evidence(workspace), server.has_message
        ),
        reads=True,
    )
    return server.convert.hover(workspace, path, hover) if hover else None


@handlers.feature(
    types.TEXT_DOCUMENT_SIGNATURE_HELP,
    types.SignatureHelpOptions(trigger_characters=["("], retrigger_characters=["=", " ", ","]),
)
def signature(server: Server, params: types.SignatureHelpParams) -> types.SignatureHelp | None:
    *_, signatures = server.ask(params, features.hover.signature_help)
    return server.convert.signature(signatures) if signatures else None


@handlers.feature(
    types.TEXT_DOCUMENT_COMPLETION,
    types.CompletionOptions(trigger_characters=list('({=.<"@:/,['), resolve_provider=True),
)
def completion(server: Server, params: types.CompletionParams) -> Json | None:
    context = params.context or types.CompletionContext(types.CompletionTriggerKind.Invoked)
    feature = partial(
        features.completion.complete,
        asked=context.trigger_kind == types.CompletionTriggerKind.Invoked,
        trigger=context.trigger_character or "",
        snippets=server.supports("text_document.completion.completion_item.snippet_support"),
    )
    place = server.at(params.text_document, reads=True)
    return server.convert.completion(*place, feature(*place, server.convert.offset(*place, params.position)))


@handlers.feature(types.COMPLETION_ITEM_RESOLVE)
def resolve(server: Server, item: types.CompletionItem) -> types.CompletionItem:
    data = item.data if isinstance(item.data, dict) else {}
    path = str(data.get("path"))
    workspace = server.session.workspace_of(path)
    if workspace is not None:
        text = features.describe.documentation(workspace, path, str(data.get("kind")), str(data.get("name")))
        item.documentation = markdown(text) if text else None
        edits = features.describe.include_edits(workspace, path, str(data.get("include") or ""))
        item.additional_text_edits = server.convert.edits(workspace, path, edits) or None
    return item


def _calls(
    server: Server,
    item: types.CallHierarchyItem,
    feature: Callable[[Workspace, features.navigation.TreeItem], tuple[features.navigation.TreeCall, ...]],
) -> Iterator[tuple[types.CallHierarchyItem, list[types.Range]]]:
    data = item.data if isinstance(item.data, dict) else {}
    workspace = server.session.workspace_of(str(data.get("path")))
    if workspace is not None:
        tree = features.navigation.TreeItem(item.name, data["path"], Span(*data["span"]), Span(*data["name"]))
        for call in feature(workspace, tree):
            yield (
                _hierarchy_item(server, workspace, call.tree),
                [server.convert.range(workspace, call.path, span) for span in call.places],
            )


def _hierarchy_item(
    server: Server, workspace: Workspace, tree: features.navigation.TreeItem
) -> types.CallHierarchyItem:
    return types.CallHierarchyItem(
        tree.name,
        types.SymbolKind.Class,
        server.convert.uri(tree.path),
        server.convert.range(workspace, tree.path, tree.span),
        server.convert.range(workspace, tree.path, tree.name_span),
        data={"path": tree.path, "span": [*tree.span], "name": [*tree.name_span]},
    )
