"""Which request asks which feature: three to five lines each, the protocol in, a feature called, its answer out."""

from __future__ import annotations

from btq_lang.editor import Server
from btq_lang.handlers import (
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


def register(server: Server) -> None:
    """Tell pygls who answers what."""
    for group in (lifecycle, documents, navigation, explaining, structure, colours, layout, acting, hints, commands):
        group.register(server)
