"""Open documents, and diagnostics for editors that ask for them."""

from __future__ import annotations

import asyncio

from lsprotocol import types

from btq_lang.editor import Server


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
        items: list[types.WorkspaceDocumentDiagnosticReport] = []
        await server.scanned.wait()
        for path in session.paths() if session.setting("checkClosedFiles", True) else ():
            report = server.report(path, known.get(path))
            uri, version = convert.uri(path), server.versions.get(path)
            if isinstance(report, types.RelatedUnchangedDocumentDiagnosticReport):
                unchanged = types.WorkspaceUnchangedDocumentDiagnosticReport(uri, report.result_id, version)
                items.append(unchanged)
            else:
                items.append(
                    types.WorkspaceFullDocumentDiagnosticReport(uri, report.items, version, result_id=report.result_id)
                )
            await asyncio.sleep(0)  # the editor may have given up, or changed something
        return types.WorkspaceDiagnosticReport(items)
