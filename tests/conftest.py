"""Fixtures for every test."""

from __future__ import annotations

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of inputs made by other people (corpus, facts, the authors' example): `BTQ_SHARED` or ../shared."""
    folder = Path(os.environ.get("BTQ_SHARED") or Path(__file__).resolve().parents[2] / "shared")
    if not (folder / "facts").is_dir():
        pytest.skip(f"no shared inputs at {folder}: set BTQ_SHARED to the folder that holds facts/, corpus/, original/")
    return folder
