"""`btq` run in this process: what a process of its own would print and return, without its start.

`commands/test_cli.py` says that a process does so.
"""

from __future__ import annotations

import gc
import io
import sys
from pathlib import Path

import pytest

from btq_lang.cli import main


def run_btq(*arguments: str, cwd: Path, stdin: str | bytes = "") -> tuple[int, str, str]:
    """The exit code, the output and the messages of a command that is run in a folder."""
    sent = stdin.encode() if isinstance(stdin, str) else stdin
    given, out, err = (io.TextIOWrapper(io.BytesIO(data), encoding="utf-8") for data in (sent, b"", b""))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(cwd)
        for name, stream in (("stdin", given), ("stdout", out), ("stderr", err)):
            patch.setattr(sys, name, stream)
        try:
            code = main(arguments)
        except SystemExit as end:  # so argparse ends
            code = int(end.code or 0)
    gc.unfreeze()  # `btq check` freezes what it has imported, and here all that is there
    return code, _written(out), _written(err)


def _written(stream: io.TextIOWrapper) -> str:
    stream.flush()
    stream.seek(0)
    return stream.read()
