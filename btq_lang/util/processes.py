"""Processes that share the work of a command.

In a module of its own because importing them takes longer than most commands run.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any, Final

# A forked process has all texts already, but on macOS the system's libraries have threads, which a fork may deadlock.
START: Final = "fork" if sys.platform == "linux" else "spawn"


def pool(
    workers: int, begin: Callable[..., None], arguments: tuple[Any, ...], start: str | None = None
) -> ProcessPoolExecutor:
    """Processes, at most as many as the system can wait for.

    Args:
        begin: what each process calls first, with `arguments`.
        start: how they start; None: `START`.
    """
    most = _MOST_ON_WINDOWS if sys.platform == "win32" else workers
    return ProcessPoolExecutor(min(workers, most), get_context(start or START), begin, arguments)


_MOST_ON_WINDOWS: Final = 61  # `ProcessPoolExecutor` refuses more
