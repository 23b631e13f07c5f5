"""The processes that a language server starts."""

from __future__ import annotations

from pathlib import Path

import pytest
from lsp_editor import Editor


def children(editor: Editor) -> list[str]:
    """The processes that the server has started, and that have not ended."""
    lists = Path(f"/proc/{editor.process.pid}/task").glob("*/children")
    return [child for each in lists for child in each.read_text().split()]


needs_proc = pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="it looks for processes in /proc")
