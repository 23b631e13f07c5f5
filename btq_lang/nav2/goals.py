"""The trees that goals name, as far as trees and parameters say which; scripts and other programs send goals, too."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import TREE_OF_GOAL, ports_of
from btq_lang.diagnostics.model import Place

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


def goals_in(workspace: Workspace) -> Iterator[tuple[str, Place]]:
    """The trees that nodes of Nav2 name for the goals that they send, in the files that a program registers, each with
    its place; what an entry names is not known."""
    for path in workspace.registered:
        file = workspace.files[path]
        for reference in workspace.uses_in(path) if TREE_OF_GOAL in file.text else ():
            use = reference.use
            if use.kind is not Kind.MODEL or use.node is None or TREE_OF_GOAL not in (ports_of(use.name) or ()):
                continue
            for pair in use.node.attributes:
                name = pair.value.text if pair.key.text == TREE_OF_GOAL and pair.value is not None else ""
                if name and "{" not in name and pair.value is not None:
                    span = pair.value.span.shifted(reference.entry.start)
                    yield name, Place(file.on_disk(span), path)
