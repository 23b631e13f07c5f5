"""A browser without a window."""

from __future__ import annotations

import shutil
from pathlib import Path

ARTIFACTS = Path(__file__).parent / "artifacts"


# The shell starts with a quarter of the work of a browser that can have a window.
CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"))), None
)


FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-extensions")
