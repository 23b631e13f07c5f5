"""No check has anything to say of an item that it is not registered for."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from check_asserts import split_files

from btq_lang.checks import CHECKS, checks_of
from btq_lang.checks.view import View
from btq_lang.diagnostics import rules
from btq_lang.syntax.tree import Model
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

BLOCK = re.compile(r"^```btq\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PAGES = sorted(Path(rules.__file__).parent.glob("*.md"))
ALL = dict.fromkeys(check for checks in CHECKS.values() for check in checks)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_is_not_registered_finds_nothing(page: Path) -> None:
    for view in views(page):
        registered = CHECKS.get(type(view.item), ())
        others = [check for check in ALL if check not in registered]
        assert [found for check in others for found in check(view)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_is_not_asked_of_a_model_finds_nothing(page: Path) -> None:
    for view in views(page):
        if isinstance(view.item, Model):
            others = [check for check in CHECKS[Model] if check not in checks_of(view.entry)]
            assert [found for check in others for found in check(view)] == []


def views(page: Path) -> Iterator[View]:
    """Views of the items in the missions of a rule's page."""
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        files = split_files(block[1])
        workspace = Workspace.of(files)
        for path in files:
            store = Store(workspace)
            for facts in workspace.files[path].facts.values():
                yield View(store, path, facts)
