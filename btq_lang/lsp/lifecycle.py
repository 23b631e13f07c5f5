"""Initialisation, folders, settings, and files that change on the disk."""

from __future__ import annotations

import asyncio
import gc

from lsprotocol import types

from btq_lang.lsp.editor import Handlers, Server
from btq_lang.lsp.progress import checking

handlers = Handlers()


@handlers.feature(types.INITIALIZE)
def initialize(server: Server, params: types.InitializeParams) -> None:
    server.convert.agree(server.workspace.position_encoding)
    server.protocol.trace = params.trace or types.TraceValue.Off
    server.initial_settings = params.initialization_options
    if params.process_id is not None:
        server.end_with(params.process_id)


@handlers.feature(types.INITIALIZED)
async def initialized(server: Server, _: types.InitializedParams) -> None:
    # Not in `initialize`: the editor waits for its result, and modules that read files take long to import.
    folders = [*server.workspace.folders] or [root for root in (server.workspace.root_uri,) if root]
    server.session.work_in(tuple(map(server.convert.path, folders)))
    gc.freeze()  # imported objects stay alive
    gc.set_threshold(10_000, 500, 10)  # most objects stay alive; 100 000 at once would delay a key by 40 ms
    try:
        await _register_watchers(server)
        if server.supports("workspace.configuration"):
            await _ask_settings(server)
        await _first_check(server)
    finally:
        server.scanned.set()
    server.on_scanned()


@handlers.feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
async def did_change_configuration(server: Server, params: types.DidChangeConfigurationParams) -> None:
    if server.supports("workspace.configuration"):
        await _ask_settings(server)
    else:
        settings = params.settings
        server.session.configure(settings.get("btq", settings) if isinstance(settings, dict) else None)
    server.reload()


@handlers.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
def did_change_workspace_folders(server: Server, params: types.DidChangeWorkspaceFoldersParams) -> None:
    removed = {server.convert.path(folder.uri) for folder in params.event.removed}
    new = [server.convert.path(folder.uri) for folder in params.event.added]
    session = server.session
    session.work_in((*(folder for folder in session.folders if folder not in removed), *new))
    server.reload()


@handlers.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
def did_change_watched_files(server: Server, params: types.DidChangeWatchedFilesParams) -> None:
    changed = {server.convert.path(change.uri) for change in params.changes}
    if server.session.concerns(changed):
        server.reload()
    elif any(map(server.session.is_side_file, changed)):
        server.refresh_lenses()  # nothing else is asked for again, or depends on it


async def _register_watchers(server: Server) -> None:
    """Register file watchers with the editor, if it supports that."""
    if not server.supports("workspace.did_change_watched_files.dynamic_registration"):
        return
    endings = server.session.watched
    patterns = [f"**{ending}" if ending[0] == "/" else f"**/*{ending}" for ending in endings]
    watchers = [types.FileSystemWatcher(pattern) for pattern in patterns]
    # If a folder is deleted as a whole, an editor reports only the folder.
    watchers.append(types.FileSystemWatcher("**/*", types.WatchKind.Delete))
    options = types.DidChangeWatchedFilesRegistrationOptions(watchers)
    registration = types.Registration("watch", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
    await server.client_register_capability_async(types.RegistrationParams([registration]))


async def _ask_settings(server: Server) -> None:
    params = types.ConfigurationParams([types.ConfigurationItem(section="btq")])
    answer = await server.workspace_configuration_async(params)
    server.session.configure(answer[0] if answer else None)


async def _first_check(server: Server) -> None:
    """Check all files of the folders, after the open ones; with progress if there are many."""
    server.schedule.check_soon(server.session.paths())
    await asyncio.sleep(_TO_OPEN)
    paths = server.session.paths() if server.session.has_read else server.session.reload()
    server.scanned.set()
    if server.pulls:
        server.schedule.check_soon(paths)
        return
    async with checking(server, len(paths)) as report_done:
        server.schedule.check_soon(paths)
        while server.schedule.task is not None and not server.schedule.task.done():
            report_done(len(paths) - len(server.schedule.waiting))
            await asyncio.wait((server.schedule.task,), timeout=0.2)


_TO_OPEN = 0.02  # seconds, in which an editor opens its visible files: these are checked first
