"""lxml on the same trees: what a parser in C reaches that makes Python objects only when they are asked for."""

from __future__ import annotations

from collections.abc import Callable

from lxml import etree

VERSION = etree.__version__


def load() -> Callable[[str], object]:
    return lambda text: etree.fromstring(text.encode())


def count(root: etree._Element) -> int:
    return sum(1 for _ in root.iter(etree.Element)) - 1 - len(root)  # without the root and the BehaviorTree elements
