"""A browser without a window."""

from __future__ import annotations

import shutil
from pathlib import Path

ARTIFACTS = Path(__file__).parent / "artifacts"


CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-extensions")
