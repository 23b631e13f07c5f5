"""Checks many files in several processes.

Each process has the whole workspace, so that includes are available, and parses only what its own files need.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.checks import check_each, findings
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.util.processes import pool
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

_CHUNK = 20  # files sent to a process at a time

_store: Store[Workspace] | None = None


def check_all(workspace: Workspace, paths: tuple[str, ...], workers: int) -> Iterator[tuple[Diagnostic, ...]]:
    """The diagnostics of each path, in order."""
    try:
        processes = pool(workers, _begin, (workspace,))
    except NotImplementedError:  # there are no processes in a browser
        yield from check_each(workspace, paths)
        return
    with processes:
        yield from processes.map(_check, paths, chunksize=_CHUNK)


def _begin(workspace: Workspace) -> None:
    global _store
    _store = Store(workspace)


def _check(path: str) -> tuple[Diagnostic, ...]:
    assert _store is not None, "every process begins with _begin"
    diagnostics = findings(_store, path).diagnostics
    _store.sweep()
    return diagnostics
