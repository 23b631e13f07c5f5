"""Writes a command's text to a file, completely or not at all, or to standard output."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Sequence
from typing import Final

from btq_lang.projects.files import write_stdout
from btq_lang.projects.messages import CommandOutput, Kind
from btq_lang.projects.options import Refused
from btq_lang.render.colour import wants_colour
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import LoadProblem, absolute, write_whole

FOR_PEOPLE: Final = ("full", "concise", "table", "text")


def form_of(form: str | None, path: str | None, forms: Sequence[str]) -> str:
    """The format to write: the requested one, else the one that the file's suffix names, else the first."""
    named = _ENDINGS.get(_ending(path), "")
    return form or (named if named in forms else forms[0])


def form_problem(form: str | None, path: str | None, forms: Sequence[str]) -> str | None:
    """The error in the output file's name: it is a mission's, or, without a requested format, has the suffix of one
    that is not written.
    """
    ending = _ending(path)
    if problem := mission_problem("-o", path, form):
        return problem
    if form or (ending not in _OTHERS and _ENDINGS.get(ending, forms[0]) in forms):
        return None
    return f"cannot write {ending}; choose one of {', '.join(forms)} with --format, or another file name"


def page_problem(path: str | None) -> str | None:
    """The error in the name of a file that is to be a page."""
    ending = _ending(path)
    if path in (None, "-") or _ENDINGS.get(ending) == "html":
        return None
    return f"{path} is not the name of a page; choose one that ends in .html"


def mission_problem(option: str, path: str | None, form: str | None) -> str | None:
    """The error of an output file whose name is a mission's."""
    ending = _ending(path)
    if ending in SUFFIXES or (ending == ".xml" and form != "junit"):
        return f"{option} {path} may overwrite a mission; choose another file name"
    return None


def write_output(messages: CommandOutput, path: str | None, text: str, form: str | None = None) -> None:
    """Write a text to a file, or (None, `-`) add it to what is printed.

    Files are UTF-8, and so is what programs read. A text for people, which `form` says, is in the encoding of standard
    output, with what can be read instead of characters that it lacks.

    Raises:
        Refused: the file cannot be written.
    """
    if path is not None and path != "-":
        write_file(path, text)
    else:
        messages.add(text, "result" if form in FOR_PEOPLE else "document")


def write_file(path: str, content: str | bytes) -> None:
    """Write a file, whole or not at all.

    Raises:
        Refused: it cannot be written.
    """
    target = absolute(path)
    try:
        if path.endswith("/"):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        os.makedirs(os.path.dirname(target), exist_ok=True)
        write_whole(target, content)
    except OSError as error:
        raise Refused(LoadProblem(target, f"cannot be written: {error.strerror}")) from error


class Terminal(CommandOutput):
    """Prints each text as it comes."""

    def add(self, text: str, kind: Kind) -> None:
        """Print a text on the stream of its kind."""
        if kind == "document":
            write_stdout(text)
        else:
            (sys.stderr if kind == "remark" else sys.stdout).write(text)


def is_coloured(color: str, is_terminal: bool) -> bool:
    """Whether to use colours.

    Args:
        color: the value of `--color`.
        is_terminal: the text goes to a terminal.
    """
    return color == "always" or (color == "auto" and wants_colour(is_terminal, os.environ))


def terminal_width() -> int:
    """The number of columns of the terminal."""
    try:
        return os.get_terminal_size().columns
    except OSError:
        return 120


def _ending(path: str | None) -> str:
    return os.path.splitext(path or "")[1].lower()


_ENDINGS = {
    ".svg": "svg",
    **dict.fromkeys((".dot", ".gv"), "dot"),
    **dict.fromkeys((".mmd", ".mermaid"), "mermaid"),
    ".csv": "csv",
    ".json": "json",
    **dict.fromkeys((".md", ".markdown"), "markdown"),
    **dict.fromkeys((".html", ".htm"), "html"),
}
_OTHERS = frozenset((".png", ".jpg", ".jpeg", ".gif", ".pdf", ".xlsx"))
