"""Between the protocol's terms and ours: URIs and paths, positions and offsets, and what features answer.

One invariant: offsets become lines and columns here and nowhere else, in the encoding that the editor agreed to; and
what stands in a file that is written in XML is shown where it stands there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING
from urllib.parse import unquote, urlsplit
from urllib.request import pathname2url, url2pathname

from lsprotocol import types

from btq_lang.diagnostics import Diagnostic, Place, Tag
from btq_lang.rules import Severity, page_path
from btq_lang.text import Edit, Encoding, LineIndex, Position, Span

if TYPE_CHECKING:  # all these import the checks, and an editor waits for the server to start
    from btq_lang.features.actions import Action
    from btq_lang.features.completion import Completion
    from btq_lang.features.outline import Match, Outline
    from btq_lang.features.signature import Signature
    from btq_lang.features.structure import Fold
    from btq_lang.workspace import Workspace


class Converter:
    """The way between an editor's places and ours.

    Attributes:
        encoding: what the editor counts columns in.
        uris: the URIs of files as the editor writes them, by path.
    """

    def __init__(self) -> None:
        self.encoding: Encoding = "utf-16"
        self.uris: dict[str, str] = {}

    def agree(self, encoding: str | types.PositionEncodingKind | None) -> None:
        """Count columns as the editor does."""
        kind = types.PositionEncodingKind(encoding) if encoding else types.PositionEncodingKind.Utf16
        self.encoding = _ENCODINGS[kind]

    # ---- from the editor ----

    def path(self, uri: str) -> str:
        """The path of a file; what is no file (an untitled buffer) goes by its URI, as if that stood at the top."""
        from btq_lang.loader import absolute  # it knows workspaces, which are not needed to start

        parts = urlsplit(uri)
        return absolute(url2pathname(parts.path) if parts.scheme == "file" else f"/{unquote(uri)}")

    def offset(self, workspace: Workspace, path: str, position: types.Position) -> int:
        place = Position(position.line, position.character)
        return workspace.files[path].lines.offset(place, self.encoding)

    def offset_made(self, workspace: Workspace, path: str, position: types.Position) -> int | None:
        """As `offset`; of a file in XML, where in this language that is; None: nowhere."""
        file = workspace.files[path]
        if file.origin is None:
            return self.offset(workspace, path, position)
        place = Position(position.line, position.character)
        return file.origin.places.made(file.source_lines.offset(place, self.encoding))

    def span(self, workspace: Workspace, path: str, range_: types.Range) -> Span:
        start, end = (self.offset(workspace, path, position) for position in (range_.start, range_.end))
        return Span(start, max(start, end))

    # ---- to the editor ----

    def uri(self, path: str) -> str:
        return self.uris.get(path) or ("file://" + pathname2url(path) if path.startswith("/") else path)

    def range(self, workspace: Workspace, path: str, span: Span) -> types.Range:
        """A span of a file's text, where it stands on the disk."""
        file = workspace.files[path]
        if file.origin is not None:
            span = file.origin.places.origin(span)
        return self.plain_range(file.source_lines, span)

    def plain_range(self, lines: LineIndex, span: Span) -> types.Range:
        start, end = (lines.position(offset, self.encoding) for offset in span)
        return types.Range(types.Position(*start), types.Position(*end))

    def location(self, workspace: Workspace, path: str, span: Span) -> types.Location:
        return types.Location(self.uri(path), self.range(workspace, path, span))

    def edits(self, workspace: Workspace, path: str, edits: Iterable[Edit]) -> list[types.TextEdit]:
        return [types.TextEdit(self.range(workspace, path, edit.span), edit.text) for edit in edits]

    def workspace_edit(
        self, workspace: Workspace, edits: Mapping[str, Iterable[Edit]], versions: Mapping[str, int] | None
    ) -> types.WorkspaceEdit:
        """Edits of several files.

        Args:
            versions: of the open files, for an editor that wants them named; None: it knows no versions here.
        """
        changes = {path: self.edits(workspace, path, made) for path, made in edits.items()}
        if versions is None:
            return types.WorkspaceEdit(changes={self.uri(path): made for path, made in changes.items()})
        documents = [
            types.TextDocumentEdit(
                types.OptionalVersionedTextDocumentIdentifier(self.uri(path), versions.get(path)), [*made]
            )
            for path, made in changes.items()
        ]
        return types.WorkspaceEdit(document_changes=[*documents])

    def diagnostic(self, workspace: Workspace, path: str, found: Diagnostic) -> types.Diagnostic:
        """A diagnostic; its spans count in the text on the disk already."""

        def location(place: Place) -> types.Location:
            target = place.path or path
            return types.Location(self.uri(target), self.plain_range(workspace.files[target].source_lines, place.span))

        return types.Diagnostic(
            self.plain_range(workspace.files[path].source_lines, found.span),
            "\n".join((found.message, *found.notes)),
            severity=_SEVERITIES[found.effective_severity],
            code=found.rule,
            code_description=types.CodeDescription(self.uri(page_path(found.rule))),
            source="btq",
            tags=[_TAGS[tag] for tag in found.tags],
            related_information=[
                types.DiagnosticRelatedInformation(location(related.place), related.message)
                for related in found.related
            ],
        )

    def action(
        self, workspace: Workspace, path: str, action: Action, versions: Mapping[str, int] | None
    ) -> types.CodeAction:
        mends = action.diagnostic
        return types.CodeAction(
            action.title,
            kind=action.kind,
            diagnostics=[self.diagnostic(workspace, path, mends)] if mends is not None else None,
            is_preferred=True if action.preferred else None,
            edit=self.workspace_edit(workspace, action.edits, versions),
        )

    def merged(self, edits: Iterable[types.WorkspaceEdit]) -> types.WorkspaceEdit:
        """Several edits of different files as one."""
        merged = types.WorkspaceEdit()
        for edit in edits:
            if edit.changes is not None:
                merged.changes = {**(merged.changes or {}), **edit.changes}
            if edit.document_changes is not None:
                merged.document_changes = [*(merged.document_changes or ()), *edit.document_changes]
        return merged

    def outline(self, workspace: Workspace, path: str, outline: Outline) -> types.DocumentSymbol:
        children = [self.outline(workspace, path, child) for child in outline.children]
        whole, name = self.range(workspace, path, outline.span), self.range(workspace, path, outline.name_span)
        if workspace.files[path].origin is not None:  # in XML the parts need not stand in the order of this language
            whole = _around(whole, name, *(child.range for child in children))
        return types.DocumentSymbol(
            outline.name, SYMBOL_KINDS[outline.kind], whole, name, detail=outline.detail, children=children
        )

    def symbol(self, workspace: Workspace, match: Match) -> types.WorkspaceSymbol:
        location = self.location(workspace, match.path, match.span)
        return types.WorkspaceSymbol(location, match.name, SYMBOL_KINDS[match.kind], container_name=match.container)

    def fold(self, workspace: Workspace, path: str, fold: Fold) -> types.FoldingRange:
        range_ = self.range(workspace, path, fold.span)
        kind = {"comment": types.FoldingRangeKind.Comment, "includes": types.FoldingRangeKind.Imports}.get(fold.kind)
        return types.FoldingRange(range_.start.line, range_.end.line, kind=kind)

    def selection(self, workspace: Workspace, path: str, spans: tuple[Span, ...]) -> types.SelectionRange:
        found: types.SelectionRange | None = None
        for span in reversed(spans):
            found = types.SelectionRange(self.range(workspace, path, span), parent=found)
        assert found is not None, "the whole file is around every place"
        return found

    def signature(self, found: Signature) -> types.SignatureHelp:
        parameters = [
            types.ParameterInformation(one.label, documentation=markdown(one.documentation)) for one in found.parameters
        ]
        signature = types.SignatureInformation(found.label, parameters=parameters, active_parameter=found.active)
        return types.SignatureHelp([signature], active_signature=0, active_parameter=found.active)

    def completion(self, workspace: Workspace, path: str, found: Completion, *, snippets: bool) -> types.CompletionList:
        range_ = self.range(workspace, path, found.span)
        items = []
        for number, one in enumerate(found.proposals):
            snippet = one.snippet if snippets else None
            text = snippet if snippet is not None else one.insert
            items.append(
                types.CompletionItem(
                    one.label,
                    kind=_COMPLETION_KINDS[one.kind],
                    detail=one.detail or None,
                    filter_text=one.filter or None,
                    sort_text=f"{number:05}",
                    insert_text_format=types.InsertTextFormat.Snippet if snippet is not None else None,
                    text_edit=types.TextEdit(range_, text),
                    tags=[types.CompletionItemTag.Deprecated] if one.old else None,
                    data={"path": path, "kind": one.kind, "name": one.name, "include": one.include},
                )
            )
        return types.CompletionList(is_incomplete=False, items=items)


def _around(*ranges: types.Range) -> types.Range:
    starts, ends = [one.start for one in ranges], [one.end for one in ranges]
    return types.Range(min(starts), max(ends))


def markdown(text: str) -> types.MarkupContent:
    return types.MarkupContent(types.MarkupKind.Markdown, text)


_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.INFO: types.DiagnosticSeverity.Information,
    Severity.HINT: types.DiagnosticSeverity.Hint,
}
_TAGS = {
    Tag.UNNECESSARY: types.DiagnosticTag.Unnecessary,
    Tag.DEPRECATED: types.DiagnosticTag.Deprecated,
}
_ENCODINGS: dict[types.PositionEncodingKind, Encoding] = {
    types.PositionEncodingKind.Utf8: "utf-8",
    types.PositionEncodingKind.Utf16: "utf-16",
    types.PositionEncodingKind.Utf32: "code-points",
}
SYMBOL_KINDS = {
    "mission": types.SymbolKind.Namespace,
    "include": types.SymbolKind.File,
    "tree": types.SymbolKind.Class,
    "control": types.SymbolKind.Operator,
    "decorator": types.SymbolKind.Event,
    "action": types.SymbolKind.Function,
    "condition": types.SymbolKind.Boolean,
    "subtree": types.SymbolKind.Module,
    "node": types.SymbolKind.Function,
    "port": types.SymbolKind.Field,
    "model": types.SymbolKind.Interface,
    "requirement": types.SymbolKind.Property,
    "signal": types.SymbolKind.Variable,
    "context": types.SymbolKind.Constant,
    "quality": types.SymbolKind.EnumMember,
    "apply": types.SymbolKind.Package,
}
_COMPLETION_KINDS = {
    "keyword": types.CompletionItemKind.Keyword,
    "node": types.CompletionItemKind.Function,
    "tree": types.CompletionItemKind.Class,
    "requirement": types.CompletionItemKind.Interface,
    "quality": types.CompletionItemKind.EnumMember,
    "signal": types.CompletionItemKind.Variable,
    "context": types.CompletionItemKind.Constant,
    "parameter": types.CompletionItemKind.TypeParameter,
    "port": types.CompletionItemKind.Field,
    "attribute": types.CompletionItemKind.Property,
    "key": types.CompletionItemKind.Variable,
    "unit": types.CompletionItemKind.Unit,
    "file": types.CompletionItemKind.File,
    "rule": types.CompletionItemKind.Reference,
    "tag": types.CompletionItemKind.Color,
    "instance": types.CompletionItemKind.Module,
    "enum": types.CompletionItemKind.Value,
}
