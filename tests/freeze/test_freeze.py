"""One case in twenty of what `python tests/freeze` compares: `btq` and `btq-lsp` do what they did at some commit."""

from __future__ import annotations

import os
from collections.abc import Iterator

import frozen
import pytest
from cases import set_shared
from comparing import compare, groups, needs_shared
from processes import HERE, Commands

EVERY = 20
HOW = (
    "`python tests/freeze --case GROUP:NUMBER` shows how; where it is as it should be, commit, then "
    "`python tests/freeze --write HEAD --group GROUP`"
)


@pytest.fixture(scope="module")
def commands() -> Iterator[Commands]:
    if not hasattr(os, "fork"):
        pytest.skip("cases are run in processes that are forked")
    if frozen.python() != frozen.THIS_PYTHON:
        pytest.skip(f"the golden file was written with Python {frozen.python()}")
    try:
        frozen.text("pyproject.toml")
    except OSError:
        pytest.skip(f"no {frozen.commit()} in the history of this checkout, where the cases come from: fetch all of it")
    with Commands(HERE) as started:
        yield started


@pytest.mark.parametrize("group", groups())
def test_it_does_what_it_did(group: str, commands: Commands, request: pytest.FixtureRequest) -> None:
    if needs_shared(group):
        set_shared(request.getfixturevalue("shared"))
    assert [str(difference) for difference in compare(commands, [group], EVERY)] == [], HOW
