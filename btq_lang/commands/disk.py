"""The working tree, as one side of a comparison with another revision."""

from __future__ import annotations

import os

from btq_lang.commands.files import Files
from btq_lang.workspace.loader import read
from btq_lang.workspace.workspace import Workspace


class Disk:
    """The files on the disk."""

    def is_file(self, path: str) -> bool:
        return os.path.isfile(path)

    def text(self, path: str) -> str | None:
        return read(path)[0]

    def workspace(self, path: str, known: dict[str, str]) -> Workspace | None:
        files = Files()
        files.overlay.update(known)
        groups, problems = files.groups(known)
        group = next((group for group in groups if path in group.given), None)
        return None if problems or group is None else group.workspace
