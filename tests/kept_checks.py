"""Checks as a session makes them: what was found is kept from one edit to the next."""

from __future__ import annotations

from btq_lang.checks import findings, keep
from btq_lang.workspace.findings import FileFindings
from btq_lang.workspace.inputs import advance
from btq_lang.workspace.workspace import Workspace


class Kept:
    """A workspace that is edited."""

    def __init__(self) -> None:
        self.workspace: Workspace | None = None

    def check(self, workspace: Workspace, path: str) -> FileFindings:
        """What is found in a file of the workspace after some edits."""
        before = self.workspace
        self.workspace = Workspace(
            workspace.files, workspace.project, workspace.factory
        )  # with a store that nobody else asks
        if before is not None:
            advance(before, self.workspace)
        keep(self.workspace, path)
        return findings(self.workspace.store, path)
