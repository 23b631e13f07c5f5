"""Processes of Python that work for the server."""

from __future__ import annotations

import asyncio
import os
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Sequence
from typing import Final


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


_LONGEST: Final = 1 << 24  # bytes of a line
