"""Progress of work on many files, for editors that show it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from lsprotocol import types

from btq_lang.lsp.editor import Server

MANY_FILES = 50


@asynccontextmanager
async def checking(server: Server, files: int) -> AsyncIterator[Callable[[int], None]]:
    """Show progress while files are checked, unless they are few; yields a function that reports how many are done."""
    window = server.client_capabilities.window
    if files < MANY_FILES or window is None or not window.work_done_progress:
        yield lambda _: None
        return
    server.count += 1
    token = f"btq/check/{server.count}"
    shown = server.work_done_progress
    await asyncio.shield(shown.create_async(token))  # the request is completed even if the caller is cancelled
    shown.begin(token, types.WorkDoneProgressBegin("btq", message="checking", percentage=0))
    try:
        yield lambda done: shown.report(token, types.WorkDoneProgressReport(percentage=100 * max(done, 0) // files))
    finally:
        shown.end(token, types.WorkDoneProgressEnd(message=f"{files} files checked"))
