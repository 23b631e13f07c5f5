"""What stands in for modules of the standard library, which a small check need not import, does what they do."""

from __future__ import annotations

import copy
import pickle

import pytest

from btq_lang.caches import cache, cache_of, cached_property
from btq_lang.regex import regex
from btq_lang.rules import Severity
from btq_lang.text import Position, Span


def test_an_enumeration_has_its_members_in_order() -> None:
    assert list(Severity) == [Severity.ERROR, Severity.WARNING, Severity.INFO, Severity.HINT]
    assert len(Severity) == 4


def test_a_member_is_found_by_its_value_and_stays_itself_in_copies() -> None:
    hint = Severity("hint")
    assert hint is Severity.HINT
    assert (hint.name, hint.value, str(hint), repr(hint)) == (
        "HINT",
        "hint",
        "Severity.HINT",
        "<Severity.HINT: 'hint'>",
    )
    assert pickle.loads(pickle.dumps(hint)) is copy.deepcopy(hint) is hint


def test_no_member_has_another_value() -> None:
    with pytest.raises(ValueError, match="'fatal' is not a valid Severity"):
        Severity("fatal")


def test_a_cache_asks_once_for_each_of_the_arguments() -> None:
    asked: list[tuple[int, int]] = []

    @cache
    def product(first: int, second: int = 2) -> int:
        """What both make."""
        asked.append((first, second))
        return first * second

    assert [product(3), product(3), product(3, 4), product(3, 4)] == [6, 6, 12, 12]
    assert asked == [(3, 2), (3, 4)]
    assert product.__doc__ == "What both make."


def test_a_full_cache_begins_anew() -> None:
    asked: list[str] = []

    @cache_of(2)
    def length(text: str) -> int:
        asked.append(text)
        return len(text)

    assert [length(text) for text in ("a", "bb", "a", "ccc", "ccc", "a")] == [1, 2, 1, 3, 3, 1]
    assert asked == ["a", "bb", "ccc", "a"]


def test_a_cached_property_is_worked_out_once() -> None:
    class Word:
        """A word."""

        def __init__(self) -> None:
            self.asked = 0

        @cached_property
        def size(self) -> int:
            """How long it is."""
            self.asked += 1
            return 4

    word = Word()
    assert (word.size, word.size, word.asked) == (4, 4, 1)
    assert word.__dict__ == {"asked": 1, "size": 4}
    assert Word.size.__doc__ == "How long it is."


def test_a_pattern_is_used_as_if_it_were_compiled() -> None:
    digits = regex(r"(?x) [0-9]+  # of a number")
    assert digits.findall("4 and 20") == ["4", "20"]
    assert digits.fullmatch("x") is None
    assert digits.sub("#", "4 and 20") == "# and #"


def test_spans_and_positions_are_tuples_with_names() -> None:
    start, end = span = Span(3, 5)
    assert (span.start, span.end, start, end, span) == (3, 5, 3, 5, (3, 5))
    assert repr([span, Position(1, 2)]) == "[Span(start=3, end=5), Position(line=1, column=2)]"
    copied = pickle.loads(pickle.dumps(span))
    assert type(copied) is Span
    assert copied == copy.copy(span) == span
