"""How much of what is there a server looks through in a pause."""

from __future__ import annotations

import gc

import pytest

from btq_lang.garbage import collect_in_pause


@pytest.mark.parametrize(
    ("counts", "looked_through"),
    [((4_000, 99, 99), []), ((4_001, 20, 99), [0]), ((4_001, 21, 5), [1]), ((4_001, 21, 6), [2])],
)
def test_a_pause(counts: tuple[int, int, int], looked_through: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """Counts as `gc` has them: new objects, collections of these, and collections of those that outlived them."""
    collected: list[int] = []
    monkeypatch.setattr(gc, "get_count", lambda: counts)
    monkeypatch.setattr(gc, "collect", collected.append)
    collect_in_pause()
    assert collected == looked_through
