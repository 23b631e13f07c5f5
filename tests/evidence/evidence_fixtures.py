"""Fixtures for logs and stores."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from evidence_logs import Verify


@pytest.fixture
def verify(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Verify:
    """`btq verify` in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return Verify(tmp_path, capsys)


@pytest.fixture
def polars() -> str:
    """The URL of the second engine; where all that tests need is installed (`BTQ_CI`), nothing is skipped."""
    if not os.environ.get("BTQ_CI"):
        for module in ("ibis", "polars"):  # half a gigabyte with what they need, so not everybody has them
            pytest.importorskip(module, reason=f"{module} is not installed: pip install -e '.[test]'")
    return "polars://"
