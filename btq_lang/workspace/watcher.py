"""Waiting for files to change, by polling.

Polling, because the standard library offers nothing else on all systems, and because it works on network drives and in
containers, where notifications do not.  One invariant: a change is reported once, when the files have come to rest, so
that no half-written file is read; but it is also reported of a file that never rests.  Not known here: the disk and the
clock; both are arguments.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator

INTERVAL = 0.3  # seconds between looks; more if looking itself takes long
_REST, _LOOKS = 0.05, 20  # seconds between two looks at files that are changing, and the maximum number of looks
_SHARE = 10  # looking takes at most one part in this many of the time


def watch(
    files: Callable[[], Iterable[str]],
    stamp: Callable[[str], Hashable],
    wait: Callable[[float], object],
    now: Callable[[], float],
) -> Iterator[tuple[str, ...]]:
    """The paths that were added, removed or changed since the last time, sorted; for ever.

    Args:
        files: returns the paths to watch; called each time, for there may be new ones.
        stamp: returns a value that changes when a file does; None for a file that does not exist.
        wait: waits for so many seconds; an exception from it (KeyboardInterrupt) ends the watching.
        now: a clock in seconds that only goes forward.
    """

    def stamps() -> dict[str, Hashable]:
        return {path: value for path in files() if (value := stamp(path)) is not None}

    def changes(before: dict[str, Hashable]) -> Iterator[tuple[str, ...]]:
        pause = INTERVAL
        while True:
            wait(pause)
            begun = now()
            after = stamps()
            pause = max(INTERVAL, (now() - begun) * _SHARE)
            if after == before:
                continue
            for _ in range(_LOOKS):
                seen = after
                wait(_REST)
                after = stamps()
                if after == seen:
                    break
            changed = tuple(
                sorted(path for path in before.keys() | after.keys() if before.get(path) != after.get(path))
            )
            before = after
            if changed:  # else the files are as they were
                yield changed

    return changes(stamps())  # the first ones now, not at the first iteration: changes from now on are reported
