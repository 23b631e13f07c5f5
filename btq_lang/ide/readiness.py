"""What the first questions about a file would wait for, made before they are asked.

One invariant: no answer changes by it, only the time to the first one; what is made is what a question would make.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module

from btq_lang.workspace.workspace import Workspace

_A_STEP = 50  # items, of some 20 nodes each: a few milliseconds


def getting_ready(workspace: Workspace, path: str) -> Iterator[None]:
    """Get ready for questions about a file; whoever does it may do something else between two steps."""
    for name in ("ports", "proposals", "completion", "hover", "navigation"):
        import_module(f"{__package__}.{name}")
        yield
    file = workspace.files[path]
    for done, facts in enumerate(file.facts.values(), 1):
        _ = facts.kinds
        if done % _A_STEP == 0:
            yield
    from btq_lang.ide.completion import complete  # they are there by now
    from btq_lang.ide.hover import hover

    line = _INDENTED.search(file.text)
    if line is not None:
        yield
        hover(workspace, path, line.end())
        yield
        complete(workspace, path, line.end())


_INDENTED = re.compile(r"^[ \t]+(?=[^\s])", re.MULTILINE)  # as most lines are where somebody types
