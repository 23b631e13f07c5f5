"""From a text to the one it was made of, and back."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from btq_lang.btcpp.importing import import_xml
from btq_lang.projects.files import Files
from btq_lang.util.source_map import OriginMap
from btq_lang.util.text import Span

PIECES = ((0, 5, 10, 15), (6, 8, 20, 30), (8, 9, 40, 60), (9, 12, 50, 53))
GOLDEN = sorted((Path(__file__).parents[1] / "btcpp" / "golden").glob("*.xml"))


@pytest.mark.parametrize(
    ("offset", "made", "near"),
    [
        *((9, None, None), (10, 0, 0), (12, 2, 2), (15, 5, 5), (16, None, None), (20, None, 6), (25, None, 6)),
        *((45, None, 8), (51, 10, 10), (53, 12, 12), (60, None, 8)),
    ],
)
def test_back_to_the_text_that_was_made(offset: int, made: int | None, near: int | None) -> None:
    """As far into a piece, if both are as long; else, if that is enough, to its start; the shortest piece counts."""
    places = OriginMap(PIECES, (), lambda pieces, _: pieces)
    assert (places.made(offset), places.made(offset, exact=False)) == (made, near)


def test_nothing_was_made() -> None:
    assert OriginMap().made(0) is None


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_there_and_back(path: Path) -> None:
    groups, problems = Files().groups([str(path)])
    assert problems == ()
    for group in groups:
        for file in group.workspace.files.values():
            if (places := file.places) is not None:
                for start, end, first, last in places.pieces:
                    if end - start == last - first > 0:
                        made = places.made(first)
                        assert made is not None
                        assert places.origin(Span(made, made)).start == first


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_a_span_is_mapped_by_its_lines_as_by_all_pieces(path: Path) -> None:
    xml = path.read_text(encoding="utf-8")
    done = import_xml(xml, for_people=False)
    pieces = import_xml(xml, for_people=False).places.pieces
    whole = OriginMap(pieces, (), lambda pieces, _: pieces)
    draw = random.Random(1)
    for _ in range(300):
        start = draw.randrange(len(done.text) + 1)
        span = Span(start, min(start + draw.choice((0, 0, 1, 5, 40, 400)), len(done.text)))
        assert done.places.origin(span) == whole.origin(span)
        assert [*done.places.containing(span)] == [*whole.containing(span)]
