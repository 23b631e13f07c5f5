"""The texts that the benchmark of the parser's growth reads."""

from __future__ import annotations

import hostile


def test_hostile_texts_are_as_long_as_asked_for() -> None:
    assert len(hostile.SHAPES) >= 30
    for shape in hostile.SHAPES:
        assert 0.95 * hostile.SHORT <= len(hostile.text(shape, hostile.SHORT)) <= hostile.SHORT, shape
