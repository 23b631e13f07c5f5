"""`btq lsp`: the language server, under the name that is easier to find than `btq-lsp`."""

from __future__ import annotations

from argparse import Namespace


def run(options: Namespace) -> int:
    """Serve an editor until it goes."""
    from btq_lang.server import serve  # the protocol's types take longer to import than most commands to run

    raise SystemExit(serve(options))  # standard output was the editor's and is closed: nobody may flush it
