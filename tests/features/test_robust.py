"""Every feature answers for every text and at every offset: torn examples, and texts that nobody would write."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from feature_asserts import answer_everything
from hypothesis import given, settings
from hypothesis import strategies as st

EXAMPLES = sorted(Path(__file__).resolve().parents[2].joinpath("examples").rglob("*.btq"))
EVERY_FORM = Path(__file__).resolve().parents[1] / "every_form.btq"
PIECES = st.sampled_from(
    (
        *(
            "BehaviorTree ",
            "QualityReq ",
            "satisfies ",
            "satisfices ",
            "Quality = ",
            "(",
            ")",
            "{",
            "}",
            '"',
            "'",
            "->",
        ),
        *(
            "\n",
            "\n    ",
            "\n        ",
            "apply ",
            "signal ",
            "context ",
            "include ",
            ": ",
            "= ",
            ", ",
            ".",
            "/",
            "30 s",
        ),
        *(
            "btq: ignore[",
            "Pick ",
            "SubTree ",
            "takes at most ",
            "every ",
            "to ",
            "@",
            "Root ",
            "Script (code = ",
            "# ",
        ),
        *("R?", "ä🤖", "\r"),
    )
)


@pytest.mark.parametrize("path", [*EXAMPLES, EVERY_FORM], ids=lambda path: path.stem)
def test_torn_examples(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    chance = random.Random(path.name)
    for _ in range(6):
        offset = chance.randrange(len(text))
        answer_everything(text[:offset], offset)
        cut = min(len(text), offset + chance.randrange(1, 12))
        answer_everything(text[:offset] + text[cut:], offset)


@settings(max_examples=60)
@given(st.lists(PIECES, max_size=24).map("".join), st.data())
def test_any_text(text: str, data: st.DataObject) -> None:
    answer_everything(text, data.draw(st.integers(0, len(text))))
