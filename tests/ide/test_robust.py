"""Every feature works for texts that are far from valid, at every offset; `damage.py` does it with damaged missions."""

from __future__ import annotations

from feature_asserts import answer_everything
from hypothesis import given, settings
from hypothesis import strategies as st

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


@settings(max_examples=60)
@given(st.lists(PIECES, max_size=24).map("".join), st.data())
def test_any_text(text: str, data: st.DataObject) -> None:
    answer_everything(text, data.draw(st.integers(0, len(text))))
