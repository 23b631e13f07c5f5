"""The Language Server Protocol: passes requests to features and returns their results.

One invariant: only this package and `server` import pygls and lsprotocol.  Handlers convert positions and URIs to
offsets and paths, call `ide`, and convert the result back.  Features are implemented elsewhere.

    convert.py       positions, ranges, edits: between the protocol and btq
    protocol.py      messages serialised by hand, for speed
    session.py       the open files, and whose diagnostics an edit may have changed
    editor.py        one client: its session, its capabilities, and what is published
    schedule.py      when files are checked
    processes.py     processes of Python that work for the server
    logs.py          the process that judges a project's logs, and its summary
    scenarios.py     the process that runs scenarios, and its results
    exploring.py     the process that explores what can violate a requirement
    tested.py        what the last runs show, as long as it holds
    outlooks.py      what is exact of the trees of open files, computed while the editor is idle
    progress.py      progress of work on many files
    lifecycle.py, documents.py, navigation.py, hints.py, colours.py, acting.py, commands.py
                     the handlers, most of a few lines
"""

from __future__ import annotations

from btq_lang.lsp import (
    acting,
    colours,
    commands,
    documents,
    exploring,
    hints,
    lifecycle,
    logs,
    navigation,
    scenarios,
)
from btq_lang.lsp.editor import Server


def register(server: Server) -> None:
    """Register all handlers with pygls."""
    for group in (lifecycle, documents, navigation, colours, acting, hints, commands, logs, scenarios, exploring):
        group.handlers.register(server)
    logs.watch_logs(server)
