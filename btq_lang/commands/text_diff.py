"""Two texts as a unified diff, which `git apply -p0` and `patch` can apply."""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import unified_diff

from btq_lang.render.colour import painter


def text_diff(path: str, old: str, new: str, *, is_coloured: bool = False) -> Iterator[str]:
    """The lines of the diff of a file, each with its end; none if the texts are the same.

    Lines end at `\\n` alone, so a change of line ends shows and the diff has the bytes of the files.
    """
    paint = painter(is_coloured)
    for line in unified_diff(_lines(old), _lines(new), path, path):
        body = line.removesuffix("\n")
        yield (paint(body[:1], body) if body[:1] in ("+", "-") else body) + "\n"
        if body == line:
            yield "\\ No newline at end of file\n"


def _lines(text: str) -> list[str]:
    return re.findall(r"[^\n]*\n|[^\n]+", text)
