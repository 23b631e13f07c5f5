"""A parse after an edit gives what a parse of the whole text gives, and keeps what the edit does not touch."""

from __future__ import annotations

import random
from itertools import product
from pathlib import Path

import missions
import pytest
from seeds import seeds, share_of

from btq_lang.parser import Parsed, parse, reparse
from btq_lang.util.text import LineIndex, Position, Span, changed
from btq_lang.workspace.workspace import Workspace

EVERY_FORM = (Path(__file__).parents[1] / "every_form.btq").read_text(encoding="utf-8")
IN_ROOT = (
    "# first\nRoot A\n    BehaviorTree A\n        ->\n            X (a = 1)\n    # between\n    BehaviorTree B\n"
    "        Y satisfies rq1\n\n    QualityReq rq1\n        takes at most 3 s\nBehaviorTree C\n    Z\n"
)
PIECES = (
    *(
        "\n",
        "    ",
        "\t",
        "Pick",
        "rq1",
        '"',
        "'",
        "(",
        ")",
        "{",
        "# ",
        "/*",
        "*/",
        "// ",
        "\\",
        "=",
        ",",
        "\r",
        "\r\n",
    ),
    *(
        "\nBehaviorTree X\n",
        "\nRoot X\n",
        "\n    Root\n",
        'include "x.btq"\n',
        "QualityReq ID = x",
        " satisfies ",
        "->",
    ),
    *("BehaviorTree ", "BehaviourTre ", "\nsignal s : %\n", "\n  ", "30sek", "}", "\ufeff", "\n    BehaviorTree Y\n"),
)


def same(one: Parsed, other: Parsed) -> bool:
    return (one.text, one.entries, one.starts) == (other.text, other.entries, other.starts)


TEXTS = {
    "every form": EVERY_FORM,
    "in a Root": IN_ROOT,
    "classic": missions.mission(60, 3, "classic"),
    "short": missions.mission(60, 3, "short"),
}
SHORTEST = {"empty": "", "Root alone": "Root\n"}


@pytest.mark.parametrize(("seed", "name"), list(product(share_of(seeds(4), 4), TEXTS | SHORTEST)))
def test_after_any_edits_it_is_the_parse_of_the_text(seed: int, name: str) -> None:
    text = (TEXTS | SHORTEST)[name]
    chance = random.Random(f"{seed}{text[:40]}")
    parsed = parse(text)
    for step in range(150):
        at = chance.randrange(len(parsed.text) + 1)
        gone = chance.choice((0, 0, 1, 1, 4, 30))
        after = parsed.text[:at] + chance.choice((*PIECES, "", "")) + parsed.text[at + gone :]
        if chance.random() < 0.2 or len(after) > 2 * len(text) + 100:
            after = text  # mend it all: mistakes that stay would hide what an edit of a sound file does
        parsed = reparse(parsed, after)
        assert same(parsed, parse(after)), (step, after)


@pytest.mark.parametrize(("seed", "name"), list(product(share_of(seeds(4), 4), TEXTS)))
def test_after_edits_of_damaged_brackets_it_is_the_parse_of_the_text(seed: int, name: str) -> None:
    """What ends brackets early is remembered on the lines that follow: a parse may not begin again among these."""
    text = TEXTS[name]
    chance = random.Random(f"{seed}{text[:40]}")
    damaged = text
    for _ in range(chance.randint(1, 6)):
        damaged = with_a_bracket_changed(damaged, chance)
    parsed = parse(damaged)
    for step in range(60):
        after = with_a_bracket_changed(parsed.text, chance)
        if chance.random() < 0.5:
            at = chance.randrange(len(parsed.text) + 1)
            after = parsed.text[:at] + chance.choice(PIECES) + parsed.text[at + chance.choice((0, 1, 4)) :]
        if chance.random() < 0.15:
            after = damaged
        parsed = reparse(parsed, after)
        assert same(parsed, parse(after)), (step, after)


LINES = (
    *(
        "BehaviorTree A\n    X (a = 1\n",
        "    X (a = (b)) c\n",
        "    X satisfies (r) s t\n",
        "        b = 2\n",
        "    )\n",
    ),
    *("signal x (y) z\n", "signal z z\n", "signal s : %\n", "context c : (x\n", "QualityReq r (a : s\n", "Root (\n"),
    *("Action A (b) c\n", "    input x (a = 1\n", "apply r(a = 1 to X\n", "Y\n", ")\n", "\n", "# remark\n"),
)


@pytest.mark.parametrize("seed", share_of(seeds(100), 4))
def test_after_edits_of_wrong_lines_behind_open_brackets_it_is_the_parse_of_the_text(seed: int) -> None:
    chance = random.Random(seed)
    lines = chance.choices(LINES, k=chance.randint(3, 12))
    parsed = parse("".join(lines))
    for _ in range(20):
        at = chance.randrange(len(lines) + 1)
        lines[at : at + chance.randint(0, 1)] = chance.choices(LINES, k=chance.randint(0, 2))
        parsed = reparse(parsed, "".join(lines))
        assert same(parsed, parse(parsed.text)), parsed.text


def with_a_bracket_changed(text: str, chance: random.Random) -> str:
    """A bracket gone, put in, doubled, become the other one, or on a line of its own."""
    there = [at for at, character in enumerate(text) if character in "()"]
    at = chance.choice(there) if there and chance.random() < 0.7 else chance.randrange(len(text) + 1)
    return text[:at] + chance.choice(("", "(", ")", "))", "\n)", "(\n    ", ")\n")) + text[at + (at in there) :]


def test_an_item_that_an_edit_does_not_touch_is_the_same_object() -> None:
    text = missions.mission(200, 1, "short")
    before = parse(text)
    tree = next(entry for entry in before.entries[20:] if "BehaviorTree" in text[entry.start : entry.start + 20])
    at = text.index("\n", tree.start + tree.item.start + 40)
    after = reparse(before, text[:at] + "  # a remark" + text[at:])
    others = [entry for entry in before.entries if entry is not tree]
    assert len(after.entries) == len(before.entries)
    kept = [mine.item is old.item for mine, old in zip(after.entries, before.entries, strict=True)]
    assert kept == [old is not tree for old in before.entries]
    assert len(others) == kept.count(True)
    assert reparse(after, after.text) is after


@pytest.mark.parametrize(
    ("text", "blanks"), [(missions.mission(200, 1, "short"), 3), (IN_ROOT, 7)], ids=["short", "in a Root"]
)
def test_a_line_indented_like_no_other_leaves_the_items_behind_as_they_were(text: str, blanks: int) -> None:
    before = parse(text)
    at = text.index("\n", text.index("    ->"))
    after = reparse(before, f"{text[:at]}\n{blanks * ' '}Pick{text[at:]}")
    assert [problem.rule for problem in after.diagnostics] == ["inconsistent-indentation"]
    kept = [mine.item is old.item for mine, old in zip(after.entries, before.entries, strict=True)]
    assert kept.count(False) <= 2
    mended = reparse(after, text)
    kept = [mine.item is old.item for mine, old in zip(mended.entries, after.entries, strict=True)]
    assert kept.count(False) <= 2
    assert same(mended, before)


def test_behind_an_item_that_is_indented_an_edit_touches_few() -> None:
    text = missions.mission(200, 1, "short")
    at = text.index("\nBehaviorTree") + 1
    before = parse(f"{text[:at]} {text[at:]}")
    assert [problem.rule for problem in before.diagnostics] == ["inconsistent-indentation"]
    at = text.index("\n    ", text.index("\nBehaviorTree", at + 10))
    after = reparse(before, f"{before.text[:at]}\n    Pick{before.text[at:]}")
    assert same(after, parse(after.text))
    kept = [mine.item is old.item for mine, old in zip(after.entries, before.entries, strict=True)]
    assert kept.count(False) <= 3


def test_an_edit_of_an_items_first_line_touches_the_item_before_it_too() -> None:
    text = "signal a : %\nsignal b : %\nsignal c : %\n"
    before = parse(text)
    after = reparse(before, text.replace("b", "bb"))
    kept = [mine.item is old.item for mine, old in zip(after.entries, before.entries, strict=True)]
    assert kept == [False, False, True]


@pytest.mark.parametrize(
    ("before", "after", "span"),
    [
        ("abc", "abc", None),
        ("abc", "abXc", (2, 2)),
        ("abc", "ac", (1, 2)),
        ("aaa", "aaaa", (3, 3)),
        ("aaaa", "aa", (2, 4)),
        ("", "a", (0, 0)),
        ("abcabc", "abc", (3, 6)),
        ("x" * 1000 + "a" + "y" * 999, "x" * 1000 + "b" + "y" * 999, (1000, 1001)),
    ],
)
def test_what_an_edit_replaced(before: str, after: str, span: tuple[int, int] | None) -> None:
    assert changed(before, after) == span


@pytest.mark.parametrize("seed", share_of(seeds(4), 4))
def test_a_line_index_that_is_patched_is_that_of_the_text(seed: int) -> None:
    chance = random.Random(seed)
    text = "ab\ncd\r\nef\r\n\n"
    index = LineIndex(text)
    for _ in range(400):
        at = chance.randrange(len(text) + 1)
        text = (
            text[:at] + chance.choice(("x", "\n", "\r", "\r\n", "", "y\nz")) + text[at + chance.choice((0, 0, 1, 3)) :]
        )
        index = index.edited(text)
        fresh = LineIndex(text)
        offsets = range(len(text) + 1)
        assert [index.position(one) for one in offsets] == [fresh.position(one) for one in offsets]
        assert [index.ends(Span(one, one + 2)) for one in offsets] == [
            fresh.ends(Span(one, one + 2)) for one in offsets
        ]
        lines = range(fresh.line_count)
        assert index.line_count == fresh.line_count
        assert [index.line(one) for one in lines] == [fresh.line(one) for one in lines]
        assert [index.offset(Position(one, 1)) for one in lines] == [fresh.offset(Position(one, 1)) for one in lines]


def test_the_file_after_an_edit_keeps_what_is_known_of_its_items() -> None:
    before = Workspace.of({"/f": "BehaviorTree A\n    X\nBehaviorTree B\n    Y\n"})
    known, _ = before.files["/f"].facts.values()
    after = before.with_file("/f", "BehaviorTree A\n    X\nBehaviorTree B\n    YY\n").files["/f"]
    same, edited = after.facts.values()
    assert same is known
    assert [use.name for use in edited.summary.uses] == ["YY"]
    assert after == Workspace.of({"/f": after.text}).files["/f"]
