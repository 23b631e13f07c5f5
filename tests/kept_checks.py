"""Checks as a session makes them: what was found is kept from one edit to the next."""

from __future__ import annotations

from btq_lang.checks import findings, keep
from btq_lang.checks.lookups import advanced
from btq_lang.workspace.findings import Findings
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


class Kept:
    """The store of a workspace that is edited."""

    def __init__(self) -> None:
        self.store: Store[Workspace] | None = None

    def check(self, workspace: Workspace, path: str) -> Findings:
        """What is found in a file of the workspace after some edits."""
        self.store = Store(workspace) if self.store is None else advanced(self.store, workspace)
        keep(self.store, path)
        return findings(self.store, path)
