"""`# btq: ignore[…]`: which comments silence which rules on which lines."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems
from kept_checks import Kept

from btq_lang.workspace.workspace import Workspace

RETY = "warning unknown-node «Rety» unknown node `Rety`; did you mean `Retry`?"


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


def test_a_comment_that_can_silence_nothing_is_told() -> None:
    assert_problems(
        tree("Foo  # btq: ignore[unknown-nod, unknown-node, nonsense]", "Foo  # btq: ignore[unknown-node"),
        "3:28 warning useless-ignore «unknown-nod» unknown rule `unknown-nod`; did you mean `unknown-node`?",
        "3:55 warning useless-ignore «nonsense» unknown rule `nonsense`",
        "4:16 warning useless-ignore «btq: ignore[unknown-node» this comment silences nothing: missing `]`",
    )
    assert_fix(
        tree("Foo  # btq: ignore[unknown-nod]"),
        "Replace `unknown-nod` with `unknown-node`",
        tree("Foo  # btq: ignore[unknown-node]"),
    )
    assert_clean(tree("# btq: ignore[useless-ignore]", "Foo  # btq: ignore[unknown-nod]"))


def test_errors_after_which_a_file_is_not_read_as_it_stands_are_not_silenced() -> None:
    error = "3:13 error syntax-error «)» unexpected `)`: no bracket is open"
    assert_problems(tree("Foo )  # btq: ignore"), error)
    assert_problems(
        tree("Foo )  # btq: ignore[syntax-error]"),
        error,
        "3:30 warning useless-ignore «syntax-error» "
        "`syntax-error` cannot be silenced: after this error btq cannot read the file reliably",
    )


def test_a_comment_counts_as_soon_as_it_is_typed() -> None:
    text = tree("Rety")
    at = text.index("Rety") + len("Rety")
    workspace, answers = Workspace.of({"main.btq": text}), Kept()
    told: list[str] = []
    for letter in "  # btq: ignore":
        told.append(", ".join(each.rule for each in answers.check(workspace, "main.btq").diagnostics))
        text = text[:at] + letter + text[at:]
        at += 1
        workspace = workspace.with_file("main.btq", text)
    assert told == ["unknown-node"] * len(told)
    assert answers.check(workspace, "main.btq").diagnostics == ()
    workspace = workspace.with_file("main.btq", text.replace("btq:", "btq"))
    assert [each.rule for each in answers.check(workspace, "main.btq").diagnostics] == ["unknown-node"]
