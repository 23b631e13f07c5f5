"""`--watch`: run a command again whenever a file changes that its last run depended on."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence

from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import absolute, collect, find_project, shown, stamp
from btq_lang.workspace.watcher import watch


def run_on_changes(
    run: Callable[[], tuple[str, ...]],
    paths: Sequence[str],
    watched: tuple[str, ...],
    suffixes: tuple[str, ...] = SUFFIXES,
) -> None:
    """Run on every change, until Ctrl+C.

    Args:
        run: performs one run; returns the files that the next one depends on.
        paths: of the command line; new files among them count as changes, too.
        watched: the files that the first run depended on.
        suffixes: of files that count below folders.
    """
    state = {"files": watched}

    def files() -> Iterator[str]:
        yield from state["files"]
        for path in paths:
            yield from collect([path], find_project(absolute(path)).project, suffixes)[0]

    changes = watch(files, stamp, time.sleep, time.monotonic)
    print("Watching for changes; press Ctrl+C to stop", file=sys.stderr)
    try:
        for changed in changes:
            names = ", ".join(shown(path) for path in changed[:3]) + (", …" if len(changed) > 3 else "")
            print(f"\n{time.strftime('%H:%M:%S')} {names} changed", file=sys.stderr)
            state["files"] = run()
    except KeyboardInterrupt:
        print(file=sys.stderr)
