"""The missions that the tests of editors type."""

from __future__ import annotations

import re

from installed import ROOT


def mission(page: str, number: int) -> str:
    """A mission on a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks: list[str] = re.findall(r"^```btq\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return blocks[number]


TEXTS = {
    "readme": mission("README.md", 0),
    # Of comments, which are half of it, two words.
    "laboratory": re.sub(
        r"(# \S+ \S+).*", r"\1", (ROOT / "examples/laboratory/mission.btq").read_text(encoding="utf-8")
    ),
    "tutorial": mission("docs/tutorial.md", -1),
}


def briefly(text: str, *begun: str) -> str:
    """The paragraphs of a mission that begin with these words, and two words of each sentence in quotes."""
    taken = [each.strip("\n") for each in text.split("\n\n") if each.lstrip("\n").startswith(begun)]
    return re.sub(r'"([A-Za-z]\S* [^"\s]+) [^"]*"', r'"\1"', "\n\n".join(taken) + "\n")


def halves(text: str) -> tuple[str, str]:
    """A mission parted below one of its paragraphs."""
    middle = text.index("\n\n", len(text) // 2) + 1
    return text[:middle], text[middle + 1 :]


# For VS Code, where each word takes a tenth of a second of a processor: what the others have not, in pieces.
_LABORATORY = briefly(
    TEXTS["laboratory"],
    *("Root", "signal", "QualityReq rq1", "QualityReq rq3", "Action ReadLabel", "# Charge if", "# The ports"),
)
PIECES = [TEXTS["readme"], *halves(_LABORATORY), *halves(briefly(TEXTS["tutorial"], ""))]
# Milliseconds before Enter, Tab, a blank and a quote that closes: a list has the time to open.
PAUSES = (0, 150, 600)
