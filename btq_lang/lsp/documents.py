"""Open documents, and pull diagnostics."""

from __future__ import annotations

import asyncio
import json

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.editor import EMPTY_REPORT, Handlers, Server
from btq_lang.lsp.progress import checking
from btq_lang.lsp.protocol import Json

handlers = Handlers()


@handlers.feature(types.TEXT_DOCUMENT_DID_OPEN)
def did_open(server: Server, params: types.DidOpenTextDocumentParams) -> None:
    path = server.convert.path(params.text_document.uri)
    if server.session.is_cpp(path):
        return
    if server.convert.uri(path) != params.text_document.uri:
        server.withdraw(path)
        server.convert.learn_uri(path, params.text_document.uri)
    server.versions[path] = params.text_document.version
    server.schedule.check_soon(server.session.edit(path, params.text_document.text))


@handlers.feature(types.TEXT_DOCUMENT_DID_CHANGE)
def did_change(server: Server, params: types.DidChangeTextDocumentParams) -> None:
    path = server.convert.path(params.text_document.uri)
    if server.session.is_cpp(path):
        return
    server.versions[path] = params.text_document.version
    server.end_explorations()
    server.schedule.check_soon(
        server.session.edit(path, server.convert.changed(server.session.lines(path), params.content_changes))
    )
    server.schedule.last_keystroke = asyncio.get_running_loop().time()  # now: handling the edit may have taken long


@handlers.feature(types.TEXT_DOCUMENT_DID_CLOSE)
def did_close(server: Server, params: types.DidCloseTextDocumentParams) -> None:
    path = server.convert.path(params.text_document.uri)
    if server.session.is_cpp(path):
        return
    server.versions.pop(path, None)
    workspace = server.session.workspace_of(path)
    if server.tokens.pop(path, None) is not None and workspace is not None:
        features.colours.forget(workspace, path, server.convert.encoding)
    server.schedule.check_soon((path, *server.session.close(path)))


@handlers.feature(
    types.TEXT_DOCUMENT_DIAGNOSTIC,
    types.DiagnosticOptions(identifier="btq", inter_file_dependencies=True, workspace_diagnostics=True),
)
async def document_diagnostic(server: Server, params: types.DocumentDiagnosticParams) -> Json:
    path = server.convert.path(params.text_document.uri)
    await server.schedule.check(path)
    return server.report(path, params.previous_result_id)


@handlers.feature(types.WORKSPACE_DIAGNOSTIC)
async def workspace_diagnostic(server: Server, params: types.WorkspaceDiagnosticParams) -> Json:
    result_ids = {server.convert.path(previous.uri): previous.value for previous in params.previous_result_ids}
    if not server.pulls_all:
        server.pulls_all = True
        server.publish_projects()
    await server.scanned.wait()
    paths = server.session.paths() if server.session.is_on("checkClosedFiles") else ()
    # Diagnostics of files that are deleted, or no longer wanted, disappear only after an empty report, also for
    # files whose result id the editor has forgotten, as VS Code does when a document is closed.
    gone_paths = (result_ids.keys() | server.shown) - set(paths) - server.session.open.keys()
    items = [_report_of(server.convert.uri(path), None, EMPTY_REPORT) for path in sorted(gone_paths)]
    other_uris = [
        previous.uri
        for previous in params.previous_result_ids
        if server.convert.uri(server.convert.path(previous.uri)) != previous.uri
    ]
    items += [_report_of(uri, None, EMPTY_REPORT) for uri in other_uris]  # the file's URI has changed since then
    expected = 0 if result_ids else len(paths)  # an editor with results asks for changes only
    async with checking(server, expected) as report_done:
        for number, path in enumerate(paths, 1):
            report = server.report(path, result_ids.get(path))
            items.append(_report_of(server.convert.uri(path), server.versions.get(path), report))
            server.session.let_go()
            if number % BATCH == 0:
                report_done(number)
                if params.partial_result_token is not None:
                    token = json.dumps(params.partial_result_token)
                    server.protocol.notify_plain(
                        types.PROGRESS, Json(f'{{"token": {token}, "value": {_all_reports(items)}}}')
                    )
                    items = []
            await asyncio.sleep(0)  # the editor may have cancelled, or changed something
    return _all_reports(items)


def _report_of(uri: str, version: int | None, report: Json) -> str:
    """A report for a file."""
    return f'{{"uri": {json.dumps(uri)}, "version": {json.dumps(version)}, {report[1:]}'


def _all_reports(items: list[str]) -> Json:
    return Json(f'{{"items": [{", ".join(items)}]}}')


BATCH = 20  # files reported together
