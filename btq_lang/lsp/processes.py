"""Processes of Python that work for the server."""

from __future__ import annotations

import asyncio
import json
import os
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncGenerator, Sequence
from contextlib import suppress
from typing import Any, Final

from btq_lang.lsp.editor import RequestRefused


async def start_python(folder: str, program: str, words: Sequence[str] = (), *, stdin: int = PIPE) -> Process:
    """Start a program in a folder, by the Python and with the packages that run this server."""
    paths = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    return await asyncio.create_subprocess_exec(
        sys.executable,
        "-c",
        program,
        *words,
        cwd=folder,
        env=paths,
        stdin=stdin,
        stdout=PIPE,
        stderr=PIPE,
        limit=_LONGEST,
    )


async def answers_of(folder: str, program: str, asked: dict[str, object]) -> AsyncGenerator[dict[str, Any], None]:
    """What a program answers to a line of JSON, a line of JSON each; what runs ends with this iterator.

    Raises:
        RequestRefused: the program fails.
    """
    process = await start_python(folder, program)
    assert process.stdin is not None, "it is a pipe"
    assert process.stdout is not None, "likewise"
    assert process.stderr is not None, "likewise"
    errors = asyncio.ensure_future(process.stderr.read())
    try:
        process.stdin.write(f"{json.dumps(asked)}\n".encode())
        async for line in process.stdout:
            yield json.loads(line)
        if await process.wait():
            reason = (await errors).decode(errors="replace").strip()
            raise RequestRefused(f"this could not be run: {reason}")
    finally:
        with suppress(ProcessLookupError):
            process.kill()


_LONGEST: Final = 1 << 24  # bytes of a line
