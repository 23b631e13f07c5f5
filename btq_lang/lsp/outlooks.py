"""What is exact of the trees of open files, computed while the editor is idle.

One invariant: no editor waits for a lens: until those of an edited file are computed, it has those of before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Final
from weakref import ref

from btq_lang.workspace.queries import Cancelled

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


class Outlooks:
    """By files."""

    def __init__(self) -> None:
        self._of: Final[dict[str, tuple[ref[Workspace], dict[str, str]]]] = {}

    def of(self, path: str) -> Mapping[str, str]:
        """What is said of the trees of a file, by their names."""
        return self._of[path][1] if path in self._of else {}

    def renewed(
        self, workspace: Workspace, path: str, is_cancelled: Callable[[], bool], changed: Callable[[], None]
    ) -> Iterator[None]:
        """Compute those of a file, tree by tree, if anything may differ; the caller may do something else between two
        steps.

        Args:
            is_cancelled: whether to end a step, which is then made again.
            changed: called at the end if something differs.
        """
        if workspace.project.simulation is None or (path in self._of and self._of[path][0]() is workspace):
            if workspace.project.simulation is None and self._of.pop(path, None) is not None:
                changed()
            return
        from btq_lang.ide.outlook import outlook, trees_with_outlook  # few projects declare skills

        texts: dict[str, str] = {}
        for tree in trees_with_outlook(workspace, path):
            while True:
                yield
                try:
                    text = outlook(workspace, path, tree, is_cancelled)
                    break
                except Cancelled:
                    continue
            if text:
                texts[tree] = text
        before = self.of(path)
        self._of[path] = ref(workspace), texts
        if texts != before:
            changed()
