"""What is missing is skipped, and in CI a failure where it had been installed."""

from __future__ import annotations

from pathlib import Path

import installed
import pytest


@pytest.mark.parametrize(
    ("ci", "record", "outcome"),
    [
        ("1", "package\nvscode\n", "install.sh has installed VS Code, and it is not there"),
        ("1", "package\nvscode-other\n", "VS Code is not installed: tests/editors/install.sh"),
        ("", "vscode\n", "VS Code is not installed: tests/editors/install.sh"),
        ("1", None, "VS Code is not installed: tests/editors/install.sh"),
    ],
)
def test_what_is_missing(
    ci: str, record: str | None, outcome: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(installed, "STORE", tmp_path)
    monkeypatch.setenv("BTQ_CI", ci)
    if record is not None:
        (tmp_path / "installed.txt").write_text(record)
    failure = pytest.fail.Exception if "has installed" in outcome else pytest.skip.Exception
    with pytest.raises(failure, match=outcome):
        installed.there(tmp_path / "nothing", "VS Code", "vscode")
    assert installed.there(tmp_path, "VS Code", "vscode") == tmp_path
