"""`# btq: ignore[…]`: which comments silence which rules on which lines."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_problems

RETY = "warning unknown-node «Rety» unknown node `Rety`"


def tree(*lines: str) -> str:
    return "".join(f"{line}\n" for line in ("BehaviorTree Main", "    ->", *(f"        {line}" for line in lines)))


@pytest.mark.parametrize(
    "comment",
    [
        "# btq: ignore",
        "# btq:ignore[unknown-node]",
        "# btq: ignore[unknown-port, unknown-node]",
        "// btq: ignore [unknown-node]",
        "/* btq: ignore[unknown-node] */",
        "# it is ours. btq: ignore[unknown-node]",
    ],
)
def test_on_its_line_and_above_it(comment: str) -> None:
    assert_clean(tree(f"Rety  {comment}"))
    assert_clean(tree(comment, "Rety"))


@pytest.mark.parametrize(
    "comment",
    [
        "# btq: ignore[unknown-port]",
        "# btq: ignore[]",
        "# btq: ignore[unknown-node",  # not closed
        "# btq: ignored",
        "# btq: ignore-me",
        "# ignore[unknown-node]",
    ],
)
def test_comments_that_silence_nothing_here(comment: str) -> None:
    assert_problems(tree(f"Rety  {comment}"), f"3:9 {RETY}")


def test_only_one_line() -> None:
    assert_problems(tree("Rety  # btq: ignore", "Rety"), f"4:9 {RETY}")
    assert_problems(tree("# btq: ignore", "X", "Rety"), f"5:9 {RETY}")
    assert_problems(tree("# btq: ignore", "", "Rety"), f"5:9 {RETY}")


def test_comments_in_a_row_mean_the_first_line_behind_them() -> None:
    assert_clean(
        tree("# btq: ignore[unknown-node]", "# which is ours", "# btq: ignore[unknown-attribute]", "Rety (_a = 1)")
    )
    assert_clean(tree("/* btq: ignore[unknown-node]", "   over lines */", "Rety"))
    assert_clean(tree("# btq: ignore[unknown-attribute]", "Rety (_a = 1)  # btq: ignore[unknown-node]"))


def test_in_brackets() -> None:
    assert_clean(tree("Rety (  # btq: ignore[unknown-node]", "    # btq: ignore[unknown-attribute]", "    _a = 1", ")"))


def test_a_string_is_no_comment() -> None:
    assert_problems(tree('Rety (a = "# btq: ignore")'), f"3:9 {RETY}")
