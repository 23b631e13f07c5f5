"""Commands for an editor: open texts override files, and the output is returned."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from io import StringIO

from btq_lang.commands.arguments import build_parser
from btq_lang.commands.build import build
from btq_lang.projects.files import Files


def build_open(path: str, texts: Mapping[str, str]) -> tuple[int, tuple[str, ...], str]:
    """`btq build` of one mission: the exit code, the built files, and the printed messages; texts of open files replace
    those on the disk."""
    options = build_parser().parse_args(["build", "--color", "never", path])
    options.report = "concise"
    files = Files()
    files.overlay = {**texts}
    with _printed() as printed:
        built = build(options, files)
    return built.code, built.files, printed.getvalue().strip()


def import_saved(path: str) -> tuple[int, tuple[str, ...], str]:
    """`btq import` of one file as it is on the disk: the exit code, the written missions, and the printed messages."""
    from btq_lang.commands.import_xml import import_files

    options = build_parser().parse_args(["import", "--color", "never", path])
    with _printed() as printed:
        code, files = import_files(options)
    return code, files, printed.getvalue().strip()


@contextmanager
def _printed() -> Iterator[StringIO]:
    """What is printed meanwhile: standard output belongs to the editor."""
    printed = StringIO()
    with redirect_stdout(printed), redirect_stderr(printed):
        yield printed
