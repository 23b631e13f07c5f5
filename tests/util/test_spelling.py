"""Near names: distances, order, cutoff."""

from __future__ import annotations

from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.util.spelling import distance, near

WORDS = st.text(alphabet="abC-", max_size=8)


@pytest.mark.parametrize(
    ("word", "candidates", "expected"),
    [
        ("Rety", ["Repeat", "Retry", "Delay"], ("Retry",)),
        ("Sequnce", ["Sequence", "AsyncSequence"], ("Sequence",)),
        ("Timoeut", ["Timeout", "Timers"], ("Timeout",)),
        ("kw", ["km", "kg", "W", "kW", "mW"], ("kW",)),
        ("Mw", ["MW", "mW", "mm"], ("MW", "mW")),
        ("retryuntilsuccessful", ["RetryUntilSuccessful", "retryuntilsuccesful"], ("RetryUntilSuccessful",)),
        ("battery", ["batery", "battery", "batterie"], ("batery", "batterie")),
        ("rq", ["rx", "r", "rqs"], ()),
        ("", ["a", ""], ()),
        ("lattency", [], ()),
        ("relaibility", ["flexibility", "legibility", "reliability"], ("reliability",)),
        ("performance-and-efficiency", ["performance-efficiency"], ()),
    ],
)
def test_near(word: str, candidates: list[str], expected: tuple[str, ...]) -> None:
    assert near(word, candidates) == expected


def test_the_nearest_comes_first_and_limit_cuts() -> None:
    names = ["PickPlace", "PickPlaces", "PickPlacXY", "PickPlaceXYZ"]
    assert near("PickPlac", names) == ("PickPlace", "PickPlacXY", "PickPlaces")
    assert near("PickPlac", names, limit=1) == ("PickPlace",)


def test_order_of_candidates_is_nothing() -> None:
    assert {near("abcdef", order) for order in permutations(["abcdeX", "abcdeY", "abcdeZ", "abXdef"])} == {
        ("abXdef", "abcdeX", "abcdeY")
    }


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [("", "", 0), ("", "abc", 3), ("abc", "abc", 0), ("ab", "ba", 1), ("ca", "abc", 3), ("kitten", "sitting", 3)],
)
def test_distance(a: str, b: str, expected: int) -> None:
    assert distance(a, b) == distance(b, a) == expected


@given(WORDS, WORDS, st.integers(0, 5))
def test_stopping_early_changes_no_decision(a: str, b: str, enough: int) -> None:
    assert min(distance(a, b, enough), enough + 1) == min(distance(a, b), enough + 1)


@given(WORDS, st.lists(WORDS))
def test_near_answers_are_candidates_within_the_cutoff(word: str, candidates: list[str]) -> None:
    answers = near(word, candidates)
    assert len(set(answers)) == len(answers) <= 3
    for answer in answers:
        assert answer in candidates
        assert answer != word
        assert distance(word.casefold(), answer.casefold()) <= len(word) // 3


@given(WORDS, st.lists(WORDS, max_size=20))
def test_near_leaves_nothing_out_that_is_near(word: str, candidates: list[str]) -> None:
    others = {candidate for candidate in candidates if candidate != word}
    same = {other for other in others if other.casefold() == word.casefold()}
    edits = {other: distance(other.casefold(), word.casefold()) for other in others}
    most = min(len(word) // 3, 3, 1 + min(edits.values(), default=0))
    assert set(near(word, candidates, limit=99)) == (same or {other for other in others if edits[other] <= most})
