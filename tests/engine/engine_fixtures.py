"""The engines that tests run files through: those of `BTQ_ENGINE`, else the one that CMake finds."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from engine_loader import Engine, NoEngine, build_engine

from btq_lang.scenarios.installed_engine import InstalledEngine, installed_engine

PREFIXES = [prefix for prefix in os.environ.get("BTQ_ENGINE", "").split(os.pathsep) if prefix]


@pytest.fixture(
    scope="session", params=(*PREFIXES,) or (None,), ids=[Path(each).name for each in PREFIXES] or ["installed"]
)
def any_engine(request: pytest.FixtureRequest) -> Engine:
    """An installed BehaviorTree.CPP, of any version; every test that asks for it runs once for each of them."""
    try:
        return build_engine(request.param, _cache(request.config))
    except NoEngine as missing:
        if request.param:
            raise  # somebody asked for this one
        pytest.skip(f"{missing}: install BehaviorTree.CPP, or set BTQ_ENGINE to where it is (tests/README.md)")


@pytest.fixture(scope="session")
def engine(any_engine: Engine) -> Engine:
    """One of a version that files are written for."""
    if any_engine.is_old:
        pytest.skip("no file is written for an engine before 4.6")
    return any_engine


@pytest.fixture
def installed(engine: Engine, pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch) -> InstalledEngine:
    """The same engine as `btq test --engine` finds it, with its program in pytest's cache."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(_cache(pytestconfig)))
    return installed_engine(engine.prefix or "")


def _cache(config: pytest.Config) -> Path:
    worker = os.environ.get("PYTEST_XDIST_WORKER", "")  # two at once would build in one folder
    return Path(config.cache.mkdir(f"btq-engine{worker}"))
