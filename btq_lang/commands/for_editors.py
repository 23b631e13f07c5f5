"""Commands for an editor: open texts override files, and the output is returned."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO

from btq_lang.commands.arguments import build_parser
from btq_lang.commands.build import build
from btq_lang.commands.files import Files


def build_open(path: str, texts: Mapping[str, str]) -> tuple[int, tuple[str, ...], str]:
    """`btq build` of one mission: the exit code, the built files, and the printed messages.

    Args:
        texts: override files on the disk, by path.
    """
    options = build_parser().parse_args(["build", "--color", "never", path])
    options.report = "concise"
    files = Files()
    files.overlay = {**texts}
    printed = StringIO()
    with redirect_stdout(printed), redirect_stderr(printed):  # standard output belongs to the editor
        built = build(options, files)
    return built.code, built.files, printed.getvalue().strip()
