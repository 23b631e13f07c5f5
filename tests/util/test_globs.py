"""Patterns of paths."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.util.globs import glob_matcher


@pytest.mark.parametrize(
    ("pattern", "matching", "others"),
    [
        ("old.btq", ["old.btq", "a/old.btq", "a/b/old.btq"], ["aold.btq", "old.btqx", "oldxbtq"]),
        ("*.old.btq", ["x.old.btq", "a/.old.btq"], ["x.btq", "old.btq"]),
        ("generated", ["generated", "generated/", "a/generated/"], ["generated/x.btq", "generated2"]),
        ("generated/", ["generated/", "a/generated/"], ["generated"]),
        ("a/generated", ["a/generated", "a/generated/"], ["b/a/generated", "generated"]),
        ("/top.btq", ["top.btq"], ["a/top.btq"]),
        ("a/*.btq", ["a/x.btq"], ["a/b/x.btq", "b/a/x.btq"]),
        ("a/**/x.btq", ["a/x.btq", "a/b/x.btq", "a/b/c/x.btq"], ["x.btq", "a/bx.btq"]),
        ("**/gen/", ["gen/", "a/b/gen/"], ["agen/"]),
        ("a/**", ["a/x", "a/b/", "a/b/c"], ["a/", "b"]),
        ("?.btq", ["x.btq"], ["xy.btq", ".btq"]),
        ("a[b].btq", ["a[b].btq"], ["ab.btq"]),
    ],
)
def test_patterns(pattern: str, matching: list[str], others: list[str]) -> None:
    matcher = glob_matcher([pattern])
    assert matcher
    assert [path for path in matching if not matcher.fullmatch(path)] == []
    assert [path for path in others if matcher.fullmatch(path)] == []


def test_several_patterns_and_none() -> None:
    matcher = glob_matcher(["a", "b/c"])
    assert matcher
    assert [path for path in ("a", "x/a", "b/c", "c") if matcher.fullmatch(path)] == ["a", "x/a", "b/c"]
    assert glob_matcher([]) is None
    assert glob_matcher(["", "/"]) is None


@given(st.lists(st.text(max_size=8), max_size=3))
def test_every_string_is_a_pattern(patterns: list[str]) -> None:
    matcher = glob_matcher(patterns)
    for pattern in patterns:
        if pattern.strip("/") and not set("*?") & set(pattern) and "\n" not in pattern:
            assert matcher
            assert matcher.fullmatch(pattern.lstrip("/"))
