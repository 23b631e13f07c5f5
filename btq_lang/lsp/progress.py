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
    if files < MANY_FILES:
        yield lambda _: None
        return
    async with progress(server, "checking", f"{files} files checked") as report:
        yield lambda done: report(100 * max(done, 0) // files, None)


@asynccontextmanager
async def progress(
    server: Server, begun: str, ended: str | None = None
) -> AsyncIterator[Callable[[int, str | None], None]]:
    """Show progress in an editor that can; yields a function that reports a percentage, with another message or None.

    Args:
        begun, ended: the first and the last message.
    """
    if not server.supports("window.work_done_progress"):
        yield lambda *_: None
        return
    server.count += 1
    token = f"btq/{server.count}"
    shown = server.work_done_progress
    await asyncio.shield(shown.create_async(token))  # the request is completed even if the caller is cancelled
    shown.begin(token, types.WorkDoneProgressBegin("btq", message=begun, percentage=0))
    try:
        yield lambda percentage, message: shown.report(
            token, types.WorkDoneProgressReport(percentage=percentage, message=message)
        )
    finally:
        shown.end(token, types.WorkDoneProgressEnd(message=ended))
