"""Fixtures for logs."""

from __future__ import annotations

from pathlib import Path

import pytest
from evidence_logs import Verify


@pytest.fixture
def verify(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Verify:
    """`btq verify` in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return Verify(tmp_path, capsys)
