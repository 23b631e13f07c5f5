"""Where words and blanks end, held against patterns that say the same."""

from __future__ import annotations

import random
import re

import pytest

from btq_lang.syntax.scan import ink_map, is_name, line_opening, name_end, word_map

NAME = re.compile(r"[^\W\d](?:\w|-(?=\w))*(?:[?!](?!=))?")
OPENING = re.compile(r"(?:[ \t]*[\r\n])*")
BLANKS = re.compile(r"[ \t]*")


@pytest.mark.parametrize("seed", range(20))
def test_a_name_ends_where_the_pattern_says(seed: int) -> None:
    draw = random.Random(seed)
    for _ in range(300):
        text = "".join(draw.choices("aaaZ_09-?!= \0é٣→日\n", k=draw.randint(1, 9)))
        words = word_map(text)
        for start in range(len(text)):
            if name := NAME.match(text, start):
                assert name_end(text, words, start) == name.end(), (text, start)
        assert is_name(text) == (NAME.fullmatch(text) is not None), text


@pytest.mark.parametrize("seed", range(20))
def test_a_line_opens_where_the_pattern_says(seed: int) -> None:
    draw = random.Random(seed)
    for _ in range(300):
        text = "".join(draw.choices("  \t\r\n\nx\0é\xa0\x0b#", k=draw.randint(0, 9)))
        for start in range(len(text) + 1):
            lines = OPENING.match(text, start)
            assert lines is not None
            blanks = BLANKS.match(text, lines.end())
            assert blanks is not None
            assert line_opening(text, ink_map(text), start) == (lines.end(), blanks.end()), (text, start)
