"""Checks many files in several processes.

Each process has the whole workspace, so that includes are available, and parses only what its own files need.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor

from btq_lang.checks import check_each, findings
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

_CHUNK = 20  # files sent to a process at a time

_store: Store[Workspace] | None = None


def check_all(workspace: Workspace, paths: tuple[str, ...], workers: int) -> Iterator[tuple[Diagnostic, ...]]:
    """The diagnostics of each path, in order."""
    # A forked process has the files already; otherwise each process gets their texts once.
    context = multiprocessing.get_context("fork" if "fork" in multiprocessing.get_all_start_methods() else None)
    try:
        pool = ProcessPoolExecutor(workers, context, _begin, (workspace,))
    except NotImplementedError:  # there are no processes in a browser
        yield from check_each(workspace, paths)
        return
    with pool:
        yield from pool.map(_check, paths, chunksize=_CHUNK)


def _begin(workspace: Workspace) -> None:
    global _store
    _store = Store(workspace)


def _check(path: str) -> tuple[Diagnostic, ...]:
    assert _store is not None, "every process begins with _begin"
    found = findings(_store, path).diagnostics
    _store.sweep()
    return found
