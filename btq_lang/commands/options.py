"""What `btq check` does where the command line says nothing."""

from __future__ import annotations

from collections.abc import Sequence


class CheckOptions:
    """The options of `btq check` and their defaults.

    A plain `btq check PATH …` needs no more than this: argparse takes longer to import than a small file to check.
    """

    stdin_filename: str | None = None
    output_format = "full"
    select: Sequence[str] = []
    ignore: Sequence[str] = []
    severity = "hint"
    fix = False
    watch = False
    jobs = 0
    color = "auto"

    def __init__(self, paths: Sequence[str]) -> None:
        self.paths = paths or (".",)
