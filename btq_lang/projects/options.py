"""The options that are needed before, or without, all others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.util.record import Record

if TYPE_CHECKING:
    from argparse import ArgumentParser


class Refused(Exception):
    """A command line is wrong, or cannot be obeyed; each argument is a reason."""


def refuse(*problems: object) -> None:
    """Raise `Refused` if there is a problem."""
    if reasons := [*filter(None, problems)]:
        raise Refused(*reasons)


class CheckOptions(Record):
    """The options of `btq check` and their defaults.

    A plain `btq check PATH …` uses this alone: importing argparse takes longer than checking a small file.
    """

    paths: Sequence[str] = (".",)
    stdin_filename: str | None = None
    output_format: str | None = None  # None: see `form_of` of reporting.py
    output_file: str | None = None
    statistics: bool = False
    exit_zero: bool = False
    select: Sequence[str] = ()
    ignore: Sequence[str] = ()
    severity: str = "hint"
    target: str | None = None
    nav2_params: Sequence[str] = ()
    since: str | None = None
    baseline: str | None = None
    update_baseline: bool = False
    add_ignore: str | None = None
    fix: bool = False
    diff: bool = False
    watch: bool = False
    jobs: int = 0
    quiet: bool = False
    show_files: bool = False
    show_settings: bool = False
    color: str = "auto"


class ServerOptions(Record):
    """The options of the language server.

    Attributes:
        tcp: the port to serve on; None: standard input and output.
        log: the least severity of what is logged.
    """

    tcp: str | None
    log: str


def add_server_options(parser: ArgumentParser) -> None:
    """The options of `btq lsp` and of `btq-lsp`."""
    parser.add_argument("--stdio", action="store_true", help="over standard input and output: the default")
    parser.add_argument("--tcp", metavar="PORT", help="one editor, over a port of this machine")
    parser.add_argument("--log", choices=("error", "warning", "info", "debug"), default="error", help="default: error")
