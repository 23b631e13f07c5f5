"""Where the editors are that the tests drive."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STORE = Path(os.environ.get("BTQ_EDITORS") or Path.home() / ".cache" / "btq-editors")
ARTIFACTS = Path(__file__).parent / "artifacts"


def there(path: Path | str | None, what: str) -> Path:
    """The path; the test is skipped where nothing is at it."""
    if path is None or not Path(path).exists():
        pytest.skip(f"{what} is not installed: tests/editors/install.sh")
    return Path(path)
