"""Where what can be made again is kept."""

from __future__ import annotations

import os


def cache_folder() -> str:
    """The folder of btq among those that the system has for caches; it need not exist."""
    home = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or os.path.expanduser("~/.cache")
    return os.path.join(home, "btq")
