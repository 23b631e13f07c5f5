"""What the last runs of scenarios show in their files, until a text that they depend on changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


class TestedScenarios:
    """The diagnostics of scenarios that were run, by their files."""

    def __init__(self) -> None:
        self._of: Final[dict[str, tuple[dict[str, str], dict[int, Sequence[str]]]]] = {}  # the texts; by number

    def add(self, workspace: Workspace, path: str, number: int, diagnostics: Sequence[str]) -> None:
        """Keep what a run of a scenario shows instead of what it showed before.

        Args:
            workspace: as it was when the run began.
            number: of the scenario in its file.
            diagnostics: as JSON.
        """
        texts = _texts(workspace, path)
        if self._of.get(path, ({}, {}))[0] != texts:
            self._of[path] = texts, {}
        self._of[path][1][number] = diagnostics

    def diagnostics(self, workspace: Workspace, path: str) -> Sequence[str]:
        """The diagnostics of a file, if all is as it was."""
        if path not in self._of:
            return ()
        texts, by_number = self._of[path]
        if texts != _texts(workspace, path):
            return ()
        return [diagnostic for _, diagnostics in sorted(by_number.items()) for diagnostic in diagnostics]


def _texts(workspace: Workspace, path: str) -> dict[str, str]:
    """The texts of all files on which scenarios of a file depend."""
    return {each: workspace.files[each].source for each in workspace.registered_with(path)}
