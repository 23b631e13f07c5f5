"""A fixture: while a query is computed, nothing of the workspace is read but through the inputs of the store."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any

import pytest

from btq_lang.workspace import inputs
from btq_lang.workspace.file import File
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Scope, Workspace


@pytest.fixture
def strict_queries(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a query reads otherwise raises; only one that has read `inputs.everything` may read what it likes."""
    may_read: list[bool] = []  # each query that is open, and each input that is read
    compute: Callable[..., object] = Store._compute
    read: Callable[..., object] = Store._read
    ask: Callable[..., object] = Store.ask

    def computed(store: Store[Workspace], answer: object) -> object:
        may_read.append(False)
        try:
            return compute(store, answer)
        finally:
            may_read.pop()

    def reading(store: Store[Workspace], key: tuple[Any, ...]) -> object:
        may_read.append(True)
        try:
            return read(store, key)
        finally:
            may_read.pop()

    def asked(store: Store[Workspace], query: Callable[..., object], *key: Hashable) -> object:
        answer = ask(store, query, *key)
        if query is inputs.everything and may_read:
            may_read[-1] = True
        return answer

    def attribute(owner: object, name: str) -> Any:
        if may_read and not may_read[-1] and not name.startswith("__"):
            raise AssertionError(f"a query reads `{name}` of a {type(owner).__name__} past the store")
        return object.__getattribute__(owner, name)

    monkeypatch.setattr(Store, "_compute", computed)
    monkeypatch.setattr(Store, "_read", reading)
    monkeypatch.setattr(Store, "ask", asked)
    for kind in (Workspace, File, Scope):
        monkeypatch.setattr(kind, "__getattribute__", attribute)
