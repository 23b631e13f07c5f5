"""Where the editors are that the tests drive."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NoReturn

import pytest

ROOT = Path(__file__).resolve().parents[2]
STORE = Path(os.environ.get("BTQ_EDITORS") or Path.home() / ".cache" / "btq-editors")
NVIMS = ("system", "trixie", "sid")  # the newer ones are those of Debian's suites
ARTIFACTS = Path(__file__).parent / "artifacts"


def there(path: Path | str | None, what: str, part: str) -> Path:
    """The path; the test is skipped where nothing is at it.

    Args:
        part: the function of install.sh that installs it, and its argument.
    """
    if path is None or not Path(path).exists():
        missing(what, part)
    return Path(path)


def missing(what: str, part: str) -> NoReturn:
    """Skip the test; in CI fail it where the thing was installed, for then a skip would hide that nothing is tested."""
    record = STORE / "installed.txt"
    if os.environ.get("BTQ_CI") and record.exists() and part in record.read_text().split():
        pytest.fail(f"install.sh has installed {what}, and it is not there")
    pytest.skip(f"{what} is not installed: tests/editors/install.sh")


def has_failed(item: pytest.Item) -> bool:
    """Whether the test itself, now that its fixtures end, has failed."""
    return item.stash[FAILED]


FAILED = pytest.StashKey[bool]()
