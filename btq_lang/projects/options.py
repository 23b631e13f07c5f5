"""The options that are needed before, or without, all others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from argparse import ArgumentParser


class Refused(Exception):
    """What a command line asks for is wrong or cannot be done; each argument says why."""


def refuse(*problems: object) -> None:
    """Raise `Refused` if there is a problem."""
    if found := [*filter(None, problems)]:
        raise Refused(*found)


class CheckOptions:
    """The options of `btq check` and their defaults.

    A plain `btq check PATH …` uses this alone: importing argparse takes longer than checking a small file.
    """

    stdin_filename: str | None = None
    output_format: str | None = None  # reporting.py says what that means
    output_file: str | None = None
    statistics = False
    exit_zero = False
    select: Sequence[str] = []
    ignore: Sequence[str] = []
    severity = "hint"
    target: str | None = None
    nav2_params: Sequence[str] = []
    since: str | None = None
    baseline: str | None = None
    update_baseline = False
    add_ignore: str | None = None
    fix = False
    diff = False
    watch = False
    jobs = 0
    quiet = False
    show_files = False
    show_settings = False
    config: str | None = None
    color = "auto"

    def __init__(self, paths: Sequence[str]) -> None:
        self.paths = paths or (".",)


def add_server_options(parser: ArgumentParser) -> None:
    """The options of `btq lsp` and of `btq-lsp`."""
    parser.add_argument("--stdio", action="store_true", help="over standard input and output: the default")
    parser.add_argument("--tcp", metavar="PORT", help="one editor, over a port of this machine")
    parser.add_argument("--log", choices=("error", "warning", "info", "debug"), default="error", help="default: error")
