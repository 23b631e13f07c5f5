"""Where words and blanks end, held against patterns that say the same."""

from __future__ import annotations

import random
import re

import pytest
from seeds import seeds

from btq_lang.syntax.scan import is_name, line_opening, maps_of, name_end

NAME = re.compile(r"[^\W\d](?:\w|-(?=\w))*(?:[?!](?!=))?")
OPENING = re.compile(r"(?:[ \t]*[\r\n])*")
BLANKS = re.compile(r"[ \t]*")


@pytest.mark.parametrize("seed", seeds(20))
def test_a_name_ends_where_the_pattern_says(seed: int) -> None:
    draw = random.Random(seed)
    for _ in range(300):
        text = "".join(draw.choices("aaaZ_09-?!= \0é٣→日\n", k=draw.randint(1, 9)))
        words = maps_of(text).words
        for start in range(len(text)):
            if name := NAME.match(text, start):
                assert name_end(text, words, start) == name.end(), (text, start)
        assert is_name(text) == (NAME.fullmatch(text) is not None), text


@pytest.mark.parametrize("seed", seeds(20))
def test_a_line_opens_where_the_pattern_says(seed: int) -> None:
    draw = random.Random(seed)
    for _ in range(300):
        text = "".join(draw.choices("  \t\r\n\nx\0é\xa0\x0b#", k=draw.randint(0, 9)))
        for start in range(len(text) + 1):
            lines = OPENING.match(text, start)
            assert lines is not None
            blanks = BLANKS.match(text, lines.end())
            assert blanks is not None
            assert line_opening(text, maps_of(text).ink, start) == (lines.end(), blanks.end()), (text, start)


@pytest.mark.parametrize("seed", seeds(20))
def test_maps_after_an_edit_are_those_of_the_new_text(seed: int) -> None:
    draw = random.Random(seed)
    text = ""
    maps = maps_of(text)
    for _ in range(100):
        start = draw.randint(0, len(text))
        end = draw.randint(start, min(len(text), start + 5))
        new = "".join(draw.choices("aé日\U0001f916 \t\n", k=draw.randint(0, 6)))
        text, maps = text[:start] + new + text[end:], maps.edited(start, end, new)
        assert (maps.words, maps.ink) == (maps_of(text).words, maps_of(text).ink)
