"""Definition, references and rename; outline, folding, selection and links."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import Refused, Server
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


def register(server: Server) -> None:
    session, convert = server.session, server.convert

    def links(
        document: types.TextDocumentIdentifier,
        position: types.Position,
        feature: Callable[[Workspace, str, int], tuple[features.navigation.Target, ...]],
    ) -> list[types.LocationLink] | list[types.Location]:
        def found(
            workspace: Workspace, path: str, offset: int
        ) -> tuple[Workspace, tuple[features.navigation.Target, ...]]:
            from btq_lang.catalog.nav2 import FILES  # as all of the catalog, after the start

            targets = feature(workspace, path, offset)
            if any(each.path in FILES.values() for each in targets):  # the code says more than the table
                workspace = session.with_code_of_nav2(workspace)
                targets = feature(workspace, path, offset)
            return workspace, targets

        answer = server.ask(document, position, found, reads=True)
        if answer is None:
            return []
        _, path, (workspace, targets) = answer
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

    @server.feature(types.TEXT_DOCUMENT_DECLARATION)
    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    def definition(
        params: types.DefinitionParams | types.DeclarationParams,
    ) -> list[types.LocationLink] | list[types.Location]:
        return links(params.text_document, params.position, features.navigation.goto_definition)

    @server.feature(types.TEXT_DOCUMENT_IMPLEMENTATION)
    def implementation(params: types.ImplementationParams) -> list[types.LocationLink] | list[types.Location]:
        return links(params.text_document, params.position, features.navigation.goto_implementation)

    @server.feature(types.TEXT_DOCUMENT_TYPE_DEFINITION)
    def type_definition(params: types.TypeDefinitionParams) -> list[types.LocationLink] | list[types.Location]:
        return links(params.text_document, params.position, features.navigation.goto_type)

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    def references(params: types.ReferenceParams) -> list[types.Location]:
        wanted = params.context.include_declaration
        answer = server.ask(
            params.text_document,
            params.position,
            lambda *at: features.navigation.find_references(at[0], at[1], at[2], wanted),
            reads=True,
        )
        return [convert.location(answer[0], path, span) for path, span in answer[2]] if answer else []

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def highlight(params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        answer = server.ask(params.text_document, params.position, features.navigation.highlights, reads=True)
        kinds = {True: types.DocumentHighlightKind.Write, False: types.DocumentHighlightKind.Read}
        return [
            types.DocumentHighlight(convert.range(answer[0], answer[1], each.span), kinds[each.writes])
            for each in (answer[2] if answer else ())
            if answer
        ]

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        answer = server.ask(params.text_document, params.position, features.rename.prepare_rename, reads=True)
        if answer is None:
            return None
        if isinstance(answer[2], features.rename.Refusal):
            raise Refused(answer[2].reason)
        return types.PrepareRenamePlaceholder(convert.range(answer[0], answer[1], answer[2].span), answer[2].name)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def rename_all(params: types.RenameParams) -> types.WorkspaceEdit | None:
        answer = server.ask(
            params.text_document,
            params.position,
            lambda *at: features.rename.rename(at[0], at[1], at[2], params.new_name),
            reads=True,
        )
        if answer is None:
            return None
        if isinstance(answer[2], features.rename.Refusal):
            raise Refused(answer[2].reason)
        return convert.workspace_edit(answer[0], answer[2].edits, server.versions_for_edits())

    @server.feature(types.WORKSPACE_SYMBOL)
    def symbols(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        return [
            convert.symbol(workspace, match)
            for workspace in session.workspaces()
            for match in features.outline.workspace_symbols(workspace, params.query)
        ]

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
    def includes(params: types.DocumentLinkParams) -> list[types.DocumentLink]:
        place = server.at(params.text_document, reads=True)
        return [
            types.DocumentLink(convert.range(*place, link.span), target=convert.uri(link.target))
            for link in (features.structure.document_links(*place) if place else ())
            if place and link.target is not None
        ]
