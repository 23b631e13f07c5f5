"""YAML as values with their places, and what cannot be read."""

from __future__ import annotations

from typing import TypeAlias

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.nav2.yaml_reader import YamlProblem, YamlValue, read_yaml

Plain: TypeAlias = "str | list[Plain] | dict[str | None, Plain] | None"


def plain(value: YamlValue) -> Plain:
    if value.entries:
        return {key.text: plain(below) for key, below in value.entries}
    return [plain(each) for each in value.items] if value.text is None else value.text


def test_values() -> None:
    text = "a: &x\n  b: [1, 'two', \"three\"]\n  c:\n    - d\n    - e: f\ng: *x\nh: |\n  i\n"
    inner = {"b": ["1", "two", "three"], "c": ["d", {"e": "f"}]}
    assert plain(read_yaml(text)) == {"a": inner, "g": inner, "h": "i\n"}


def test_places() -> None:
    text = "a: {b: 'ä'}\nc:\n  - d # e\n  - f\n\n# g\n"
    top = read_yaml(text)
    found = [*top.entries, *top.entries[0][1].entries, *((each, each) for each in top.entries[1][1].items)]
    assert [text[value.span.start : value.span.end] for _, value in found] == [
        "{b: 'ä'}",
        "- d # e\n  - f",
        "'ä'",
        "d",
        "f",
    ]
    assert [text[key.span.start : key.span.end] for key, _ in top.entries] == ["a", "c"]


def test_keys_by_a_merge_are_those_of_the_mapping() -> None:
    top = read_yaml("d: &d {a: 1, b: 2}\ne: &e {b: 3, c: 4}\nx:\n  <<: [*d, *e]\n  a: 5\n").get("x")
    assert top is not None
    assert {name: plain(value) for name in "abc" if (value := top.get(name))} == {"a": "5", "b": "2", "c": "4"}


def test_only_the_first_document_counts() -> None:
    assert plain(read_yaml("a: 1\n---\nb: 2\n")) == {"a": "1"}
    assert plain(read_yaml("")) == []


@pytest.mark.parametrize(
    ("text", "message", "offset"),
    [
        ("a: [1,\nb: 2\n", "expected ',' or ']', but got '<stream end>'", 12),
        ("a: b: c\n", "mapping values are not allowed here", 4),
        ("a: *nope\n", "unknown alias `nope`", 3),
        ("&a [*a]", "unknown alias `a`", 4),
        ("a: \x07\n", "character U+0007 is not allowed", 3),
        ("[" * 2_000, "more than 50 nested levels", 50),
        ("- " * 2_000, "more than 50 nested levels", 100),
        ("a: 'x", "found unexpected end of stream", 5),
        ("%YAML 9.9\n---\na: 1\n", "found incompatible YAML document (version 1.* is required)", 0),
        ("a" * 1_000_001, "larger than 1000000 characters", 0),
    ],
)
def test_what_cannot_be_read(text: str, message: str, offset: int) -> None:
    with pytest.raises(YamlProblem) as problem:
        read_yaml(text)
    assert (problem.value.message, problem.value.offset) == (message, offset)


def test_aliases_make_nothing_larger() -> None:
    """Ten times ten times ten …: as copies, these would be 10 to the power of 40 values."""
    lines = ["a0: &a0 lol", *(f"a{at}: &a{at} [{', '.join([f'*a{at - 1}'] * 10)}]" for at in range(1, 41))]
    assert len(read_yaml("\n".join(lines)).entries) == 41


def test_merges_are_bounded() -> None:
    first = ", ".join(f"k{at}: {at}" for at in range(2_000))
    lines = [f"a0: &a0 {{{first}}}", *(f"a{at}: &a{at} {{<<: *a{at - 1}}}" for at in range(1, 41))]
    with pytest.raises(YamlProblem, match="more than 10000 keys by `<<`"):
        read_yaml("\n".join(lines))


@given(st.text(alphabet="ab:-[]{}&*'\"|>#?!%<\n \t\x07é", max_size=60) | st.text(max_size=30))
def test_every_text_gives_values_or_a_problem_in_it(text: str) -> None:
    offset = 0
    try:
        read_yaml(text)
    except YamlProblem as problem:
        offset = problem.offset
    assert 0 <= offset <= len(text)
