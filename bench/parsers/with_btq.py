"""btq itself, in the form that is first in the path: interpreted, or compiled by mypyc."""

from __future__ import annotations

import gc
import importlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import btq_lang

# Where the function `parse` is, in the commits that are compared.
HOMES = ("btq_lang", "btq_lang.parser")

VERSION = btq_lang.__version__
PACKAGE = str(Path(btq_lang.__file__).resolve().parents[1])


def load() -> Callable[[str], Any]:
    gc.set_threshold(100_000, 50, 10)  # as in btq's programs (btq_lang/cli.py)
    for home in HOMES:
        parse: Callable[[str], Any] | None = getattr(importlib.import_module(home), "parse", None)
        if parse is not None:
            return parse
    raise ImportError(f"no function `parse` in {' or '.join(HOMES)}")


def form() -> str:
    file = str(sys.modules[load().__module__].__file__)
    return "interpreted" if file.endswith(".py") else "compiled"


FORM = form()


def count(parsed: Any) -> int:
    assert not parsed.diagnostics, f"the mission has a syntax error: {parsed.diagnostics[0]}"
    return sum(1 for tree in parsed.trees for _ in tree.walk())
