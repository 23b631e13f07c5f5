"""The examples on the pages of the rules."""

from __future__ import annotations

import re
from pathlib import Path

from btq_lang.diagnostics import rules
from btq_lang.diagnostics.rules import RULES

PAGES = Path(rules.__file__).parent


BLOCK = re.compile(r"^```(?P<language>btq|xml|yaml|cpp)\n(?P<text>.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks() -> list[tuple[str, str, str]]:
    found = []
    for rule in RULES:
        path = PAGES / f"{rule}.md"
        if path.exists():
            for match in BLOCK.finditer(path.read_text(encoding="utf-8")):
                found.append((rule, match["language"], match["text"]))
    return found
