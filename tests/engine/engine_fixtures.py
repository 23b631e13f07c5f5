"""The engines that tests run files through: those of `BTQ_ENGINE`, else the one that CMake finds."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from engine_loader import Engine, NoEngine, build_engine

PREFIXES = [prefix for prefix in os.environ.get("BTQ_ENGINE", "").split(os.pathsep) if prefix]


@pytest.fixture(
    scope="session", params=(*PREFIXES,) or (None,), ids=[Path(each).name for each in PREFIXES] or ["installed"]
)
def any_engine(request: pytest.FixtureRequest) -> Engine:
    """An installed BehaviorTree.CPP, of any version; every test that asks for it runs once for each of them."""
    worker = os.environ.get("PYTEST_XDIST_WORKER", "")  # two at once would build in one folder
    try:
        return build_engine(request.param, Path(request.config.cache.mkdir(f"btq-engine{worker}")))
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
