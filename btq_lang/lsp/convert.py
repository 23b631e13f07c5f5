"""Converts between the protocol's terms and ours: URIs and paths, positions and offsets, and results of features.

One invariant: offsets become lines and columns only here, in the negotiated encoding; and places in a file written in
XML are mapped to that XML.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from itertools import chain
from json.encoder import encode_basestring_ascii as as_json
from typing import TYPE_CHECKING
from urllib.parse import quote, unquote, urlsplit

from lsprotocol import types

from btq_lang.diagnostics.model import Diagnostic, Tag
from btq_lang.diagnostics.rules import RULES, Severity, page_path
from btq_lang.lsp.protocol import Json, Plain
from btq_lang.util.text import Edit, Encoding, LineIndex, Position, Span

if TYPE_CHECKING:  # all these import the checks; the server must start fast
    from btq_lang.ide.completion import Completion
    from btq_lang.ide.hover import Hover, Signature
    from btq_lang.ide.outline import Match, Outline
    from btq_lang.ide.refactor import Action
    from btq_lang.ide.scenarios import ScenarioFailure
    from btq_lang.ide.structure import Fold
    from btq_lang.workspace.findings import FileFindings
    from btq_lang.workspace.loader import LoadProblem
    from btq_lang.workspace.workspace import Workspace


Range = tuple[int, int, int, int]  # line and column of its start, then those of its end
_MOST_KEPT = 2_000  # texts, of about 300 characters each


class Converter:
    """Converts an editor's positions to ours and back.

    Attributes:
        encoding: the unit of the editor's columns.
    """

    def __init__(self) -> None:
        self.encoding: Encoding = "utf-16"
        self._uris: dict[str, str] = {}  # in the editor's spelling, by path
        self._spellings = 0  # how many spellings have been learnt

    def agree(self, encoding: str | types.PositionEncodingKind | None) -> None:
        """Set the negotiated encoding of columns."""
        kind = types.PositionEncodingKind(encoding) if encoding else types.PositionEncodingKind.Utf16
        self.encoding = _ENCODINGS[kind]

    # ---- from the editor ----

    def path(self, uri: str) -> str:
        """The path of a file; an untitled buffer's is that of the file to be, or without one its URI, as if at the
        root.
        """
        from btq_lang.workspace.loader import absolute  # it imports workspaces, which are not needed to start

        parts = urlsplit(uri)
        is_of_file = parts.scheme == "file" or (parts.scheme == "untitled" and parts.path.startswith("/"))
        return absolute(_path_of(parts.path) if is_of_file else f"/{unquote(uri)}")

    def changed(self, lines: LineIndex, changes: Sequence[types.TextDocumentContentChangeEvent]) -> str:
        """The text after changes, each of which applies to the result of the previous one."""
        for change in changes[:-1]:
            lines = lines.replaced(self._span_in(lines, change), change.text)
        for change in changes[-1:]:  # usually the only one; the line index is not needed after it
            start, end = self._span_in(lines, change)
            return lines.text[:start] + change.text + lines.text[end:]
        return lines.text

    def _span_in(self, lines: LineIndex, change: types.TextDocumentContentChangeEvent) -> Span:
        """The span that a change replaces."""
        if not isinstance(change, types.TextDocumentContentChangePartial):
            return Span(0, len(lines.text))
        start, end = (self._offset_in(lines, place) for place in (change.range.start, change.range.end))
        return Span(start, max(start, end))

    def offset(self, workspace: Workspace, path: str, position: types.Position) -> int:
        """The offset in the file as the editor has it."""
        return self._offset_in(workspace.files[path].source_lines, position)

    def _offset_in(self, lines: LineIndex, position: types.Position) -> int:
        return lines.offset(Position(position.line, position.character), self.encoding)

    def span(self, workspace: Workspace, path: str, range_: types.Range) -> Span:
        start, end = (self.offset(workspace, path, position) for position in (range_.start, range_.end))
        return Span(start, max(start, end))

    # ---- to the editor ----

    def uri(self, path: str) -> str:
        return self._uris.get(path) or _uri_of(path)

    def link(self, target: str, line: int) -> str:
        """The URI of a path and a line, which counts from 1 if it matters, or of a web page."""
        if "://" in target:
            return target
        return self.uri(target) + (f"#L{line}" if line else "")

    def learn_uri(self, path: str, uri: str) -> None:
        """Remember the editor's spelling of a file's URI."""
        self._uris[path] = uri
        self._spellings += 1

    def range(self, workspace: Workspace, path: str, span: Span) -> types.Range:
        """The range in the original file of a span that a feature returns, which counts in the imported text."""
        file = workspace.files[path]
        return self.plain_range(file.source_lines, file.on_disk(span))

    def plain_range(self, lines: LineIndex, span: Span) -> types.Range:
        start, end = (lines.position(offset, self.encoding) for offset in span)
        return types.Range(types.Position(*start), types.Position(*end))

    def position(self, workspace: Workspace, path: str, line: int, column: int) -> types.Position:
        """The position of a character of the original file, both from 0."""
        lines = workspace.files[path].source_lines
        return types.Position(*lines.position(lines.offset(Position(line, column), "code-points"), self.encoding))

    def location(self, workspace: Workspace, path: str, span: Span) -> types.Location:
        return types.Location(self.uri(path), self.range(workspace, path, span))

    def edits(self, workspace: Workspace, path: str, edits: Iterable[Edit]) -> list[types.TextEdit]:
        """Edits, which always count in the original file."""
        lines = workspace.files[path].source_lines
        return [types.TextEdit(self.plain_range(lines, edit.span), edit.text) for edit in edits]

    def workspace_edit(
        self, versions: Mapping[str, int] | None, *edits: tuple[Workspace, Mapping[str, Iterable[Edit]]]
    ) -> types.WorkspaceEdit:
        """A workspace edit of several files, with the versions of open ones, if the editor supports versions here."""
        changes = {
            path: self.edits(workspace, path, file_edits)
            for workspace, of_files in edits
            for path, file_edits in of_files.items()
        }
        if versions is None:
            return types.WorkspaceEdit(changes={self.uri(path): file_edits for path, file_edits in changes.items()})
        documents = [
            types.TextDocumentEdit(
                types.OptionalVersionedTextDocumentIdentifier(self.uri(path), versions.get(path)), [*file_edits]
            )
            for path, file_edits in changes.items()
        ]
        return types.WorkspaceEdit(document_changes=[*documents])

    def findings(self, workspace: Workspace, path: str, file_findings: FileFindings) -> Json:
        """All diagnostics of a file, as a JSON list.

        All of them are sent after every keystroke, but most items are unchanged or only moved: the JSON of an item is
        cached with lines counted from those of the items, and if only these differ, they are filled in again.
        """
        files, encoding = workspace.files, self.encoding
        written: list[str] = []
        for reported, starts in file_findings.of_items:
            begins = [files[place_path].item_places[id(item)] for place_path, item in reported.items]
            ends = [
                files[place_path].source_lines.ends(span, encoding)
                for place_path, span in reported.fixed
                if place_path in files
            ]
            lines = [*(line for line, _ in begins), 0]
            where = self._spellings, [before for _, before in begins], ends
            cached: _Written | None = reported.written
            if cached is None or cached.where != where:
                template, ranges = self._diagnostics(workspace, path, reported.placed(starts))
                cached = _Written(where, template, list(zip(reported.counted_from(), ranges, strict=True)), lines)
                if reported.items:  # in files that are not edited it would only take memory
                    reported.written = cached
            written.append(cached.at(lines))
        return Json(f"[{', '.join(written)}]")

    def problems(self, text: str, load_problems: Iterable[LoadProblem]) -> Json:
        """The problems of a project file, as a JSON list of diagnostics."""
        from btq_lang.util.toml_places import word_end  # few files have problems

        lines = LineIndex(text)
        written: list[str] = []
        for problem in load_problems:
            start = lines.offset(problem.position or Position(0, 0))
            range_ = self._range_as_json(lines, Span(start, word_end(text, start)))
            written.append(
                f'{{"range": {range_}, "severity": 1, "source": "btq", "message": {as_json(problem.message)}}}'
            )
        return Json(f"[{', '.join(written)}]")

    def _diagnostics(
        self, workspace: Workspace, path: str, diagnostics: Iterable[Diagnostic]
    ) -> tuple[str, list[Range]]:
        """Diagnostics as JSON with `%d` in place of lines and columns, and these, of their spans and related places;
        their spans already refer to the original file.
        """
        written: list[str] = []
        ranges: list[Range] = []
        encoding, files = self.encoding, workspace.files
        ends = files[path].source_lines.ends
        for diagnostic in diagnostics:
            ranges.append(ends(diagnostic.span, encoding))
            related_places: list[tuple[str, str]] = []
            for related in diagnostic.related:
                related_path = related.place.path or path
                # The place in a log is its start: a log has no lines.
                ranges.append(
                    files[related_path].source_lines.ends(related.place.span, encoding)
                    if related_path in files
                    else (0, 0, 0, 0)
                )
                related_places.append((self.uri(related_path), related.message))
            written.append(
                _template(
                    diagnostic.rule,
                    diagnostic.message,
                    diagnostic.notes,
                    diagnostic.severity,
                    diagnostic.tags,
                    tuple(related_places),
                )
            )
        return ", ".join(written), ranges

    def failure(self, workspace: Workspace, path: str, failure: ScenarioFailure) -> str:
        """What a run of a scenario shows, as a diagnostic in JSON."""
        members = {"message": failure.message, "severity": 1 if failure.is_error else 2, "source": "btq test"}
        written = f'{{"range": {self._range_as_json(workspace.files[path].source_lines, failure.span)}'
        written += f", {json.dumps(members)[1:-1]}"
        if failure.place is not None:
            place, line = failure.place
            range_ = _RANGE % (line - 1, 0, line - 1, 0)
            location = f'{{"uri": {as_json(self.uri(place))}, "range": {range_}}}'
            written += f', "relatedInformation": [{{"location": {location}, "message": {as_json(failure.happened)}}}]'
        return f"{written}}}"

    def _range_as_json(self, lines: LineIndex, span: Span) -> str:
        return _RANGE % lines.ends(span, self.encoding)

    def action(self, workspace: Workspace, path: str, action: Action, versions: Mapping[str, int] | None) -> Plain:
        preferred, diagnostics = {"isPreferred": True} if action.preferred else {}, {}
        if action.diagnostic is not None:
            template, ranges = self._diagnostics(workspace, path, [action.diagnostic])
            diagnostics = {"diagnostics": [json.loads(template % tuple(chain.from_iterable(ranges)))]}
        edit = self.workspace_edit(versions, (workspace, action.edits))
        return {"title": action.title, "kind": action.kind, **preferred, **diagnostics, "edit": edit}

    def outline(self, workspace: Workspace, path: str, outline: Outline) -> types.DocumentSymbol:
        children = [self.outline(workspace, path, child) for child in outline.children]
        whole, name = self.range(workspace, path, outline.span), self.range(workspace, path, outline.name_span)
        if workspace.files[path].is_foreign:  # in XML the parts may be in another order
            parts = [whole, name, *(child.range for child in children)]
            whole = types.Range(min(one.start for one in parts), max(one.end for one in parts))
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
        selection: types.SelectionRange | None = None
        for span in reversed(spans):
            selection = types.SelectionRange(self.range(workspace, path, span), parent=selection)
        assert selection is not None, "the whole file is around every place"
        return selection

    def signature(self, help: Signature) -> types.SignatureHelp:
        parameters = [
            types.ParameterInformation(parameter.label, documentation=markdown(parameter.documentation))
            for parameter in help.parameters
        ]
        signature = types.SignatureInformation(help.label, parameters=parameters, active_parameter=help.active)
        return types.SignatureHelp([signature], active_signature=0, active_parameter=help.active)

    def hover(self, workspace: Workspace, path: str, hover: Hover) -> Json:
        """A hover, as plain data: the first one made of lsprotocol's classes would compile a converter for each."""
        file = workspace.files[path]
        contents = f'{{"kind": "markdown", "value": {as_json(hover.markdown)}}}'
        return Json(
            f'{{"contents": {contents}, "range": {self._range_as_json(file.source_lines, file.on_disk(hover.span))}}}'
        )

    def completion(self, workspace: Workspace, path: str, completion: Completion) -> Json:
        """Proposals as JSON: an editor waits, and they may be hundreds.  Their span counts in the XML, if it is XML."""
        range_, of_path = self._range_as_json(workspace.files[path].source_lines, completion.span), as_json(path)
        items = []
        for number, proposal in enumerate(completion.proposals):
            label = as_json(proposal.label)
            text = proposal.insert if proposal.snippet is None else proposal.snippet
            written = label if text == proposal.label else as_json(text)
            name = label if proposal.name == proposal.label else as_json(proposal.name)
            more = f', "detail": {as_json(proposal.detail)}' if proposal.detail else ""
            if proposal.filter:
                more += f', "filterText": {as_json(proposal.filter)}'
            if proposal.snippet is not None:
                more += f', "insertTextFormat": {_SNIPPET}'
            items.append(
                f'{{"label": {label}, "kind": {_COMPLETION_KINDS[proposal.kind]}, '
                f'"sortText": "{number:05}", "textEdit": {{"range": {range_}, "newText": {written}}}, '
                f'"data": {{"path": {of_path}, "kind": "{proposal.kind}", "name": {name}, '
                f'"include": {as_json(proposal.include)}}}{more}}}'
            )
        return Json(f'{{"isIncomplete": false, "items": [{", ".join(items)}]}}')


class _Written:
    """The diagnostics of an item as JSON, wherever the items begin that it counts from.

    Attributes:
        where: what else the JSON depends on.
    """

    __slots__ = ("_lines", "_ranges", "_template", "_text", "where")

    def __init__(self, where: object, template: str, ranges: list[tuple[int, Range]], lines: list[int]) -> None:
        """ranges: what fills the template in, each after the index of what it counts from in `lines`."""
        self.where = where
        self._template = template
        self._ranges = [
            (index, (first - lines[index], start, last - lines[index], end))
            for index, (first, start, last, end) in ranges
        ]
        self._lines: list[int] = []
        self._text = ""

    def at(self, lines: list[int]) -> str:
        """The JSON where the items begin in these lines."""
        if lines != self._lines:
            numbers: list[int] = []
            for at, (first, start, last, end) in self._ranges:
                by = lines[at]
                numbers += (first + by, start, last + by, end)
            self._lines, self._text = lines, self._template % tuple(numbers)
        return self._text


@lru_cache(_MOST_KEPT)
def _template(
    rule: str,
    message: str,
    notes: tuple[str, ...],
    severity: Severity | None,
    tags: tuple[Tag, ...],
    related: tuple[tuple[str, str], ...],
) -> str:
    """A diagnostic as a JSON object, with `%d` in place of lines and columns."""
    members = {
        "message": "\n".join((message, *notes)),
        "severity": _SEVERITIES[severity or RULES[rule].severity],
        "code": rule,
        "codeDescription": {"href": _uri_of(page_path(rule))},
        "source": "btq",
        "tags": [_TAGS[tag] for tag in tags],
    }
    information = [
        f'{{"location": {{"uri": {_literal(as_json(uri))}, "range": {_RANGE}}}, "message": {_literal(as_json(note))}}}'
        for uri, note in related
    ]
    own = _literal(json.dumps(members)[1:-1])
    return f'{{"range": {_RANGE}, {own}, "relatedInformation": [{", ".join(information)}]}}'


def _literal(text: str) -> str:
    """A JSON string, escaped for use in a format string."""
    return text.replace("%", "%%")


@lru_cache(_MOST_KEPT)  # every place in a diagnostic has one
def _uri_of(path: str) -> str:
    if path[1:3] == ":/":  # a drive of Windows
        return f"file:///{path[:2]}{quote(path[2:])}"
    return f"file://{quote(path)}" if path.startswith("/") else path


def _path_of(url: str) -> str:
    """The path that a URL names, as in urllib.request, which takes long to import."""
    if os.name != "nt":
        return unquote(url)
    from urllib.request import url2pathname

    return url2pathname(url)


def markdown(text: str) -> types.MarkupContent:
    return types.MarkupContent(types.MarkupKind.Markdown, text)


_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.INFO: types.DiagnosticSeverity.Information,
    Severity.HINT: types.DiagnosticSeverity.Hint,
}
_TAGS = {Tag.UNNECESSARY: types.DiagnosticTag.Unnecessary, Tag.DEPRECATED: types.DiagnosticTag.Deprecated}
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
    "hazard": types.SymbolKind.Key,
    "scenario": types.SymbolKind.Method,
    "signal": types.SymbolKind.Variable,
    "context": types.SymbolKind.Constant,
    "quality": types.SymbolKind.EnumMember,
    "apply": types.SymbolKind.Package,
}
_RANGE = '{"start": {"line": %d, "character": %d}, "end": {"line": %d, "character": %d}}'
_SNIPPET = types.InsertTextFormat.Snippet.value
_COMPLETION_KINDS = {
    "keyword": types.CompletionItemKind.Keyword.value,
    "node": types.CompletionItemKind.Function.value,
    "tree": types.CompletionItemKind.Class.value,
    "requirement": types.CompletionItemKind.Interface.value,
    "hazard": types.CompletionItemKind.Event.value,
    "external": types.CompletionItemKind.Reference.value,
    "quality": types.CompletionItemKind.EnumMember.value,
    "signal": types.CompletionItemKind.Variable.value,
    "context": types.CompletionItemKind.Constant.value,
    "parameter": types.CompletionItemKind.TypeParameter.value,
    "port": types.CompletionItemKind.Field.value,
    "attribute": types.CompletionItemKind.Property.value,
    "key": types.CompletionItemKind.Variable.value,
    "unit": types.CompletionItemKind.Unit.value,
    "file": types.CompletionItemKind.File.value,
    "rule": types.CompletionItemKind.Reference.value,
    "tag": types.CompletionItemKind.Color.value,
    "instance": types.CompletionItemKind.Module.value,
    "enum": types.CompletionItemKind.Value.value,
    "snippet": types.CompletionItemKind.Snippet.value,
}
