"""The two judges of what is well-formed XML: lxml, and Python's own expat where lxml is missing."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from btq_lang.btcpp import strict


@contextmanager
def judged_by(name: str) -> Iterator[None]:
    """Judge as where lxml is installed, or by `expat` as where it is not."""
    with pytest.MonkeyPatch.context() as patch:
        if name == "expat":
            patch.setitem(sys.modules, "lxml", None)  # so an import of it fails
        strict.judge.cache_clear()
        assert strict.judge().__name__.endswith(name)
        yield
    strict.judge.cache_clear()
