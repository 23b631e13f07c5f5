"""Open documents, and diagnostics for editors that ask for them."""

from __future__ import annotations

import asyncio

from lsprotocol import types

from btq_lang.editor import Server
from btq_lang.handlers.progress import checking


def register(server: Server) -> None:
    session, convert = server.session, server.convert
    _diagnostics(server)

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def did_open(params: types.DidOpenTextDocumentParams) -> None:
        path = convert.path(params.text_document.uri)
        convert.uris[path] = params.text_document.uri
        server.versions[path] = params.text_document.version
        server.check_soon(session.edit(path, params.text_document.text))

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def did_change(params: types.DidChangeTextDocumentParams) -> None:
        path = convert.path(params.text_document.uri)
        server.versions[path] = params.text_document.version
        for change in params.content_changes:
            server.check_soon(session.edit(path, change.text))

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def did_close(params: types.DidCloseTextDocumentParams) -> None:
        path = convert.path(params.text_document.uri)
        server.versions.pop(path, None)
        server.tokens.pop(path, None)
        server.check_soon((path, *session.close(path)))


def _diagnostics(server: Server) -> None:
    session, convert = server.session, server.convert

    @server.feature(
        types.TEXT_DOCUMENT_DIAGNOSTIC,
        types.DiagnosticOptions(identifier="btq", inter_file_dependencies=True, workspace_diagnostics=True),
    )
    def document_diagnostic(params: types.DocumentDiagnosticParams) -> types.DocumentDiagnosticReport:
        return server.report(convert.path(params.text_document.uri), params.previous_result_id)

    @server.feature(types.WORKSPACE_DIAGNOSTIC)
    async def workspace_diagnostic(params: types.WorkspaceDiagnosticParams) -> types.WorkspaceDiagnosticReport:
        known = {convert.path(one.uri): one.value for one in params.previous_result_ids}
        await server.scanned.wait()
        paths = session.paths() if session.setting("checkClosedFiles", True) else ()
        items: list[types.WorkspaceDocumentDiagnosticReport] = []
        async with checking(server, 0 if known else len(paths)) as told:  # who knows something asks for the news
            for done, path in enumerate(paths, 1):
                items.append(report_of(path, known.get(path)))
                if done % A_PART == 0:
                    told(done)
                    if params.partial_result_token is not None:
                        part = types.WorkspaceDiagnosticReport(items)
                        server.protocol.notify(types.PROGRESS, types.ProgressParams(params.partial_result_token, part))
                        items = []
                await asyncio.sleep(0)  # the editor may have given up, or changed something
        return types.WorkspaceDiagnosticReport(items)

    def report_of(path: str, previous: str | None) -> types.WorkspaceDocumentDiagnosticReport:
        report = server.report(path, previous)
        uri, version = convert.uri(path), server.versions.get(path)
        if isinstance(report, types.RelatedUnchangedDocumentDiagnosticReport):
            return types.WorkspaceUnchangedDocumentDiagnosticReport(uri, report.result_id, version)
        return types.WorkspaceFullDocumentDiagnosticReport(uri, report.items, version, result_id=report.result_id)


A_PART = 20  # of the files, told together
