"""Definition, references and rename; outline, folding, selection and links."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import Asked, Handlers, RequestRefused, Server
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


handlers = Handlers()


@handlers.feature(types.TEXT_DOCUMENT_DECLARATION, otherwise=[])
@handlers.feature(types.TEXT_DOCUMENT_DEFINITION, otherwise=[])
def definition(
    server: Server,
    params: types.DefinitionParams | types.DeclarationParams,
) -> list[types.LocationLink] | list[types.Location]:
    return _links(server, params, features.navigation.goto_definition)


@handlers.feature(types.TEXT_DOCUMENT_IMPLEMENTATION, otherwise=[])
def implementation(
    server: Server, params: types.ImplementationParams
) -> list[types.LocationLink] | list[types.Location]:
    return _links(server, params, features.navigation.goto_implementation)


@handlers.feature(types.TEXT_DOCUMENT_TYPE_DEFINITION, otherwise=[])
def type_definition(
    server: Server, params: types.TypeDefinitionParams
) -> list[types.LocationLink] | list[types.Location]:
    return _links(server, params, features.navigation.goto_type)


@handlers.feature(types.TEXT_DOCUMENT_REFERENCES, otherwise=[])
def references(server: Server, params: types.ReferenceParams) -> list[types.Location]:
    feature = partial(features.navigation.find_references, include_definition=params.context.include_declaration)
    workspace, _, places = server.ask(params, feature, reads=True)
    return [server.convert.location(workspace, path, span) for path, span in places]


@handlers.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, otherwise=[])
def document_highlights(server: Server, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
    workspace, path, highlights = server.ask(params, features.navigation.highlights, reads=True)
    kinds = {True: types.DocumentHighlightKind.Write, False: types.DocumentHighlightKind.Read}
    return [
        types.DocumentHighlight(server.convert.range(workspace, path, highlight.span), kinds[highlight.writes])
        for highlight in highlights
    ]


@handlers.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
def prepare(server: Server, params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
    workspace, path, target = server.ask(params, features.rename.prepare_rename, reads=True)
    if isinstance(target, features.rename.RenameRefusal):
        raise RequestRefused(target.reason)
    return types.PrepareRenamePlaceholder(server.convert.range(workspace, path, target.span), target.name)


@handlers.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
def rename_all(server: Server, params: types.RenameParams) -> types.WorkspaceEdit | None:
    workspace, _, renaming = server.ask(params, partial(features.rename.rename, name=params.new_name), reads=True)
    if isinstance(renaming, features.rename.RenameRefusal):
        raise RequestRefused(renaming.reason)
    return server.convert.workspace_edit(server.versions_for_edits(), (workspace, renaming.edits))


@handlers.feature(types.WORKSPACE_SYMBOL)
def symbols(server: Server, params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
    return [
        server.convert.symbol(workspace, match)
        for workspace in server.session.workspaces()
        for match in features.outline.workspace_symbols(workspace, params.query)
    ]


@handlers.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL, otherwise=[])
def outline(server: Server, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
    place = server.at(params.text_document, reads=True)
    return [server.convert.outline(*place, each) for each in features.outline.document_symbols(*place)]


@handlers.feature(types.TEXT_DOCUMENT_FOLDING_RANGE, otherwise=[])
def folds(server: Server, params: types.FoldingRangeParams) -> list[types.FoldingRange]:
    place = server.at(params.text_document)
    return [server.convert.fold(*place, each) for each in features.structure.folding_ranges(*place)]


@handlers.feature(types.TEXT_DOCUMENT_SELECTION_RANGE, otherwise=[])
def selections(server: Server, params: types.SelectionRangeParams) -> list[types.SelectionRange]:
    positions = [types.TextDocumentPositionParams(params.text_document, each) for each in params.positions]
    selected = [server.ask(position, features.structure.selection_range) for position in positions]
    return [server.convert.selection(*selection) for selection in selected]


@handlers.feature(types.TEXT_DOCUMENT_DOCUMENT_LINK, otherwise=[])
def includes(server: Server, params: types.DocumentLinkParams) -> list[types.DocumentLink]:
    place = server.at(params.text_document, reads=True)
    return [
        types.DocumentLink(server.convert.range(*place, link.span), target=server.convert.link(link.target, link.line))
        for link in features.structure.document_links(*place)
        if link.target is not None
    ]


def _links(
    server: Server,
    params: Asked,
    feature: Callable[[Workspace, str, int], tuple[features.navigation.NavigationTarget, ...]],
) -> list[types.LocationLink] | list[types.Location]:
    def targets_at(
        workspace: Workspace, path: str, offset: int
    ) -> tuple[Workspace, tuple[features.navigation.NavigationTarget, ...]]:
        from btq_lang.catalog.nav2 import FILES  # as all of the catalog, after the start

        targets = feature(workspace, path, offset)
        if any(target.path in FILES.values() for target in targets):  # the code has more than the table
            workspace = server.session.with_code_of_nav2(workspace)
            targets = feature(workspace, path, offset)
        return workspace, targets

    _, path, (workspace, targets) = server.ask(params, targets_at, reads=True)
    if not server.supports("text_document.definition.link_support"):
        return [server.convert.location(workspace, target.path, target.name) for target in targets]
    return [
        types.LocationLink(
            server.convert.uri(target.path),
            server.convert.range(workspace, target.path, Span(*target.span)),
            server.convert.range(workspace, target.path, target.name),
            server.convert.range(workspace, path, target.origin),
        )
        for target in targets
    ]
