"""Messages for unexpected exceptions: one line for users; developers find the traceback in the log.

One invariant: reporting raises nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from traceback import walk_tb

WHERE = "report it in btq's issue tracker"


def internal_error(error: BaseException, otherwise: str = "") -> str:
    """`internal error: KeyError: 'x' while reading a.btq; report it …`, on one line.

    Args:
        otherwise: the text in place of `while reading …` if no file is involved.
    """
    from btq_lang.workspace.loader import shown  # a server imports this module at its start, and seldom needs that one

    message = " ".join(str(error).split())
    what = f"{type(error).__name__}: {message}" if message else type(error).__name__
    path = next(_files(error), None)
    doing = f"while reading {shown(path)}" if path is not None else otherwise
    return f"internal error: {what}{f' {doing}' if doing else ''}; {WHERE}"


def place(error: BaseException) -> object:
    """Where an exception was raised: equal for the same bug, however often it occurs."""
    frames = [*walk_tb(error.__traceback__)][:_FRAMES]
    return type(error), tuple((frame.f_code, line) for frame, line in frames)


def _files(error: BaseException) -> Iterator[str]:
    """The files in use in the traceback, innermost first."""
    from btq_lang.workspace.file import SUFFIXES  # as above

    for frame, _ in reversed([*walk_tb(error.__traceback__)]):
        path = frame.f_locals.get("path")
        if isinstance(path, str) and path.endswith((*SUFFIXES, ".xml")):
            yield path


_FRAMES = 40  # the innermost frames of an infinite recursion differ each time
