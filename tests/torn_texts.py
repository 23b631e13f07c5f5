"""Texts that are torn by chance: pieces and lines missing, doubled, exchanged or replaced."""

from __future__ import annotations

import random
import re
from pathlib import Path

from missions import mission

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = sorted(path for path in (ROOT / "examples").rglob("*") if path.suffix in (".btq", ".qualitybtcpp"))
CLASSIC, SHORT = mission(30, 7, "classic"), mission(30, 7, "short")

PIECE = re.compile(r"\r\n|\n|[ \t]+|\"[^\"]*\"|[\w-]+|.")
STRANGE = (
    *(
        " ",
        "  ",
        "\t",
        "\n",
        "\r\n",
        "\r",
        "\n\n",
        "\n    ",
        "\n  ",
        "\x0b",
        "\xa0",
        "\ufeff",
        "\\",
        "\n#\n",
        " // c\n",
    ),
    *("(", ")", "=", "==", " = ", ",", ", ", "{", "}", "{x}", '"', "'", '""', "'a b'", "-", "?", "!", "#", "//", "/*"),
    *("*/", "/* c */", "->", "R?", "M->", "All||", "→", "ä", "é1", "٣", "x", "1", "-1", "0.5", "1e3", "30 s", "6 m/s"),
    *("A?", "Foo-bar", "Ready?", "done!", "a.b", "Quality", "Quality = ", "QualityReq", "QualityReq ID = ", "ID"),
    *(
        "satisfices ",
        "satisfies ",
        "tags ",
        "satisficesx",
        "parameters ",
        "description = ",
        "xml ",
        "input ",
        "Action ",
    ),
    *("SubTree ", "BehaviorTree ", "Root", "TreeNodesModel", "takes ", "mission ", 'a = "b"', "a = b,", "(a = 1)"),
)


def torn(text: str, draw: random.Random) -> str:
    """The text with one to three pieces or lines missing, doubled, exchanged or replaced by something strange."""
    for _ in range(draw.randint(1, 3)):
        pieces = PIECE.findall(text) if draw.random() < 0.7 else text.splitlines(keepends=True)
        if not pieces:
            return text
        at = draw.randrange(len(pieces))
        kind = draw.randrange(6)
        if kind == 0:
            del pieces[at]
        elif kind == 1:
            pieces.insert(at, pieces[at])
        elif kind == 2:
            pieces.insert(at, draw.choice(STRANGE))
        elif kind == 3:
            pieces[at] = draw.choice(STRANGE)
        elif kind == 4:
            other = draw.randrange(len(pieces))
            pieces[at], pieces[other] = pieces[other], pieces[at]
        else:
            pieces[at] = pieces[at].replace("    ", draw.choice(("\t", "  ", "   ", "     ")))
        text = "".join(pieces)
    return text
