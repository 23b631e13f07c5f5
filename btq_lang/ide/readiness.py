"""Computes in advance what the first requests about a file would wait for.

One invariant: it changes no result, only the time of the first one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module

from btq_lang.workspace.workspace import Workspace

_A_STEP = 50  # items, of some 20 nodes each: a few milliseconds


def getting_ready(workspace: Workspace, path: str) -> Iterator[None]:
    """Prepare for requests about a file; the caller may do something else between two steps."""
    for name in ("ports", "proposals", "completion", "hover", "navigation"):
        import_module(f"{__package__}.{name}")
        yield
    file = workspace.files[path]
    for count, facts in enumerate(file.facts.values(), 1):
        _ = facts.kinds
        if count % _A_STEP == 0:
            yield
    from btq_lang.ide.completion import complete  # imported already when this runs
    from btq_lang.ide.hover import hover

    line = _INDENTED.search(file.text)
    if line is not None:
        yield
        hover(workspace, path, line.end())
        yield
        complete(workspace, path, line.end())


_INDENTED = re.compile(r"^[ \t]+(?=[^\s])", re.MULTILINE)  # as most lines that are being typed
