"""The protocol of editors: requests to features, and their answers back.

One invariant: only this room and `server` know pygls and lsprotocol.  Messages come in, are converted to offsets and
paths, asked of `ide`, and converted back.  Not known here: what a feature answers.

    convert.py       positions, ranges, edits: between the protocol and btq
    protocol.py      messages that are written by hand, for their number
    session.py       which files are open, and whose diagnostics an edit may have changed
    editor.py        one editor: its session, and when it is sent what
    failures.py      what happens when a handler raises
    lifecycle.py, documents.py, commands.py, progress.py …   which request asks which feature, three to five lines each
"""

from __future__ import annotations

from btq_lang.lsp import (
    acting,
    colours,
    commands,
    documents,
    explaining,
    hints,
    layout,
    lifecycle,
    navigation,
    structure,
)
from btq_lang.lsp.editor import Server


def register(server: Server) -> None:
    """Tell pygls who answers what."""
    for group in (lifecycle, documents, navigation, explaining, structure, colours, layout, acting, hints, commands):
        group.register(server)
