"""Definition, references and rename; outline, folding, selection and links."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import Asked, RequestRefused, Server
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


def register(server: Server) -> None:
    convert = server.convert

    def links(
        params: Asked, feature: Callable[[Workspace, str, int], tuple[features.navigation.NavigationTarget, ...]]
    ) -> list[types.LocationLink] | list[types.Location]:
        def found(
            workspace: Workspace, path: str, offset: int
        ) -> tuple[Workspace, tuple[features.navigation.NavigationTarget, ...]]:
            from btq_lang.catalog.nav2 import FILES  # as all of the catalog, after the start

            targets = feature(workspace, path, offset)
            if any(each.path in FILES.values() for each in targets):  # the code says more than the table
                workspace = server.session.with_code_of_nav2(workspace)
                targets = feature(workspace, path, offset)
            return workspace, targets

        _, path, (workspace, targets) = server.ask(params, found, reads=True)
        if not server.supports("text_document.definition.link_support"):
            return [convert.location(workspace, target.path, target.name) for target in targets]
        return [
            types.LocationLink(
                convert.uri(target.path),
                convert.range(workspace, target.path, Span(*target.span)),
                convert.range(workspace, target.path, target.name),
                convert.range(workspace, path, target.origin),
            )
            for target in targets
        ]

    @server.feature(types.TEXT_DOCUMENT_DECLARATION, otherwise=[])
    @server.feature(types.TEXT_DOCUMENT_DEFINITION, otherwise=[])
    def definition(
        params: types.DefinitionParams | types.DeclarationParams,
    ) -> list[types.LocationLink] | list[types.Location]:
        return links(params, features.navigation.goto_definition)

    @server.feature(types.TEXT_DOCUMENT_IMPLEMENTATION, otherwise=[])
    def implementation(params: types.ImplementationParams) -> list[types.LocationLink] | list[types.Location]:
        return links(params, features.navigation.goto_implementation)

    @server.feature(types.TEXT_DOCUMENT_TYPE_DEFINITION, otherwise=[])
    def type_definition(params: types.TypeDefinitionParams) -> list[types.LocationLink] | list[types.Location]:
        return links(params, features.navigation.goto_type)

    @server.feature(types.TEXT_DOCUMENT_REFERENCES, otherwise=[])
    def references(params: types.ReferenceParams) -> list[types.Location]:
        feature = partial(features.navigation.find_references, include_definition=params.context.include_declaration)
        workspace, _, places = server.ask(params, feature, reads=True)
        return [convert.location(workspace, path, span) for path, span in places]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, otherwise=[])
    def highlight(params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        workspace, path, found = server.ask(params, features.navigation.highlights, reads=True)
        kinds = {True: types.DocumentHighlightKind.Write, False: types.DocumentHighlightKind.Read}
        return [types.DocumentHighlight(convert.range(workspace, path, one.span), kinds[one.writes]) for one in found]

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        workspace, path, found = server.ask(params, features.rename.prepare_rename, reads=True)
        if isinstance(found, features.rename.RenameRefusal):
            raise RequestRefused(found.reason)
        return types.PrepareRenamePlaceholder(convert.range(workspace, path, found.span), found.name)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def rename_all(params: types.RenameParams) -> types.WorkspaceEdit | None:
        workspace, _, found = server.ask(params, partial(features.rename.rename, name=params.new_name), reads=True)
        if isinstance(found, features.rename.RenameRefusal):
            raise RequestRefused(found.reason)
        return convert.workspace_edit(server.versions_for_edits(), (workspace, found.edits))

    @server.feature(types.WORKSPACE_SYMBOL)
    def symbols(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        return [
            convert.symbol(workspace, match)
            for workspace in server.session.workspaces()
            for match in features.outline.workspace_symbols(workspace, params.query)
        ]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL, otherwise=[])
    def outline(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        place = server.at(params.text_document, reads=True)
        return [convert.outline(*place, each) for each in features.outline.document_symbols(*place)]

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE, otherwise=[])
    def folds(params: types.FoldingRangeParams) -> list[types.FoldingRange]:
        place = server.at(params.text_document)
        return [convert.fold(*place, each) for each in features.structure.folding_ranges(*place)]

    @server.feature(types.TEXT_DOCUMENT_SELECTION_RANGE, otherwise=[])
    def selections(params: types.SelectionRangeParams) -> list[types.SelectionRange]:
        positions = [types.TextDocumentPositionParams(params.text_document, each) for each in params.positions]
        found = [server.ask(each, features.structure.selection_range) for each in positions]
        return [convert.selection(*each) for each in found]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_LINK, otherwise=[])
    def includes(params: types.DocumentLinkParams) -> list[types.DocumentLink]:
        place = server.at(params.text_document, reads=True)
        return [
            types.DocumentLink(convert.range(*place, link.span), target=convert.uri(link.target))
            for link in features.structure.document_links(*place)
            if link.target is not None
        ]
