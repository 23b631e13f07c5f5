"""The language server: diagnostics while one types, and formatting, for every editor that speaks LSP.

A thin adapter: the protocol in, the pure parts called, the protocol out; what it remembers are the texts that are open.
Text is synchronised whole, because pygls cuts lines where editors do not (form feeds, U+2028).
"""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Sequence
from urllib.parse import unquote, urlsplit
from urllib.request import pathname2url, url2pathname

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from btq_lang import __version__
from btq_lang.checks import check
from btq_lang.commands.files import Files
from btq_lang.diagnostics import Diagnostic, Place, Tag
from btq_lang.formatter import format_text
from btq_lang.loader import absolute
from btq_lang.rules import Severity
from btq_lang.text import Encoding, LineIndex, Span

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
_ENCODINGS: dict[str, Encoding] = {"utf-8": "utf-8", "utf-16": "utf-16", "utf-32": "code-points"}


def main(arguments: Sequence[str] | None = None) -> int:
    """Serve over standard input and output, until the editor goes."""
    parser = argparse.ArgumentParser(prog="btq-lsp", description="The language server of btq, for editors.")
    parser.add_argument("--stdio", action="store_true", help="serve over standard input and output: the default")
    parser.add_argument("-V", "--version", action="version", version=f"btq-lsp {__version__}")
    parser.parse_args(arguments)
    logging.basicConfig(stream=sys.stderr, level=logging.WARNING)
    make_server().start_io()
    return 0


def make_server() -> LanguageServer:
    """A server that knows no file yet."""
    server = LanguageServer("btq", __version__, text_document_sync_kind=types.TextDocumentSyncKind.Full)
    files = Files()
    uris: dict[str, str] = {}

    def publish() -> None:
        """The diagnostics of every open file: an edit in one may break another."""
        groups, _ = files.groups(files.overlay)
        for group in groups:
            texts = {path: file.source_lines for path, file in group.workspace.files.items()}
            for path in group.given:
                found = [
                    _diagnostic(each, path, texts, uris, _encoding(server)) for each in check(group.workspace, path)
                ]
                server.text_document_publish_diagnostics(
                    types.PublishDiagnosticsParams(
                        uris[path], found, server.workspace.get_text_document(uris[path]).version
                    )
                )

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def did_open(params: types.DidOpenTextDocumentParams) -> None:
        path = _path(params.text_document.uri)
        uris[path] = params.text_document.uri
        files.overlay[path] = params.text_document.text
        publish()

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def did_change(params: types.DidChangeTextDocumentParams) -> None:
        uri = params.text_document.uri
        files.overlay[_path(uri)] = server.workspace.get_text_document(uri).source
        publish()

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def did_close(params: types.DidCloseTextDocumentParams) -> None:
        path = _path(params.text_document.uri)
        files.overlay.pop(path, None)
        server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uris.pop(path), []))
        publish()

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def formatting(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        text = files.overlay[_path(params.text_document.uri)]
        lines = LineIndex(text)
        return [
            types.TextEdit(_range(edit.span, lines, _encoding(server)), edit.text) for edit in format_text(text).edits
        ]

    return server


# ---- between the protocol's terms and ours ----


def _diagnostic(
    found: Diagnostic, path: str, texts: dict[str, LineIndex], uris: dict[str, str], encoding: Encoding
) -> types.Diagnostic:
    def location(place: Place) -> types.Location:
        target = place.path or path
        return types.Location(uris.get(target) or _uri(target), _range(place.span, texts[target], encoding))

    message = "\n".join((found.message, *found.notes))
    return types.Diagnostic(
        _range(found.span, texts[path], encoding),
        message,
        severity=_SEVERITIES[found.effective_severity],
        code=found.rule,
        source="btq",
        tags=[_TAGS[tag] for tag in found.tags],
        related_information=[
            types.DiagnosticRelatedInformation(location(related.place), related.message) for related in found.related
        ],
    )


def _range(span: Span, lines: LineIndex, encoding: Encoding) -> types.Range:
    return types.Range(*(types.Position(*lines.position(offset, encoding)) for offset in span))


def _encoding(server: LanguageServer) -> Encoding:
    agreed = server.workspace.position_encoding or types.PositionEncodingKind.Utf16
    return _ENCODINGS[types.PositionEncodingKind(agreed).value]


def _path(uri: str) -> str:
    """The path of a file; what is no file (an untitled buffer) goes by its whole URI."""
    parts = urlsplit(uri)
    return absolute(url2pathname(parts.path)) if parts.scheme == "file" else unquote(uri)


def _uri(path: str) -> str:
    return "file://" + pathname2url(path)


if __name__ == "__main__":
    sys.exit(main())
