"""Where a command's text goes: to a file, whole or not at all, or to standard output."""

from __future__ import annotations

import os
import sys

from btq_lang.commands.files import write_stdout
from btq_lang.loader import LoadProblem, absolute, write_whole


def write_output(command: str, path: str | None, text: str) -> int:
    """Write a text; the command's exit code.

    Args:
        path: the file; None or `-`: standard output.
    """
    if path is None or path == "-":
        write_stdout(text)
        return 0
    target = absolute(path)
    try:
        os.makedirs(os.path.dirname(target), exist_ok=True)
        write_whole(target, text)
    except OSError as error:
        print(f"btq {command}: {LoadProblem(target, f'cannot be written: {error.strerror}')}", file=sys.stderr)
        return 2
    return 0
