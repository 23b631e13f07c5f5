"""Where a command's text goes: to a file, whole or not at all, or to standard output."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Sequence

from btq_lang.commands.files import write_stdout
from btq_lang.loader import LoadProblem, absolute, write_whole


def form_of(options: Namespace, forms: Sequence[str]) -> str:
    """Which of the forms to write: the one that is asked for, else the one that the file's name ends in, else the
    first; empty where the name ends in one that nobody writes here."""
    ending = os.path.splitext(options.output or "")[1].lower()
    form = _ENDINGS.get(ending, forms[0])
    return options.format or (form if form in forms or not form else forms[0])


def not_written(options: Namespace, forms: Sequence[str]) -> str:
    """What is wrong where that is empty."""
    ending = os.path.splitext(options.output)[1]
    return f"no {ending} is written, but {', '.join(forms)}: --format says which, whatever the name"


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


_ENDINGS = {
    ".svg": "svg",
    **dict.fromkeys((".dot", ".gv"), "dot"),
    **dict.fromkeys((".mmd", ".mermaid"), "mermaid"),
    ".csv": "csv",
    ".json": "json",
    **dict.fromkeys((".md", ".markdown"), "markdown"),
    **dict.fromkeys((".html", ".htm"), "html"),
    **dict.fromkeys((".png", ".jpg", ".jpeg", ".gif", ".pdf", ".xlsx"), ""),
}
