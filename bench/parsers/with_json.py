"""json.loads on the same trees: what a parser in C that makes Python objects reaches."""

from __future__ import annotations

import json
import platform
from collections.abc import Callable
from typing import Any

VERSION = platform.python_version()


def load() -> Callable[[str], object]:
    return json.loads


def count(mission: Any) -> int:
    stack = [tree["top"] for tree in mission["trees"]]
    nodes = 0
    while stack:
        nodes += 1
        stack += stack.pop().get("children", ())
    return nodes
