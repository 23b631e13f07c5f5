"""The place of the cursor: how much is read for it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from btq_lang.ide import place
from btq_lang.ide.completion import complete
from btq_lang.lexer import tokens as all_tokens
from btq_lang.syntax.tokens import Token
from btq_lang.util.text import Span
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace

EXAMPLES = Path(__file__).parents[2] / "examples"
MISSIONS = [str(path.relative_to(EXAMPLES)) for path in sorted(EXAMPLES.rglob("*.btq"))]


def whole_item(file: File, offset: int) -> list[Span]:
    starts = [entry.start for entry in file.parsed.entries]
    start = max((one for one in starts if one <= offset), default=0)
    return [Span(start, min((one for one in starts if one > offset), default=len(file.text)))]


@pytest.mark.parametrize("name", MISSIONS)
def test_a_place_depends_on_no_more_of_its_tree_than_is_cut(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (EXAMPLES / name).read_text(encoding="utf-8")
    workspace = Workspace.of({"main.btq": text})
    offsets = range(0, len(text) + 1, 3)
    found = [place.place_at(workspace, "main.btq", offset) for offset in offsets]
    monkeypatch.setattr(place, "_stretches", whole_item)
    assert found == [place.place_at(workspace, "main.btq", offset) for offset in offsets]


@pytest.mark.parametrize("typed", ["Char", "Charge", "Pick", "Pick (level = 3) satis"])
def test_a_completion_does_not_look_through_the_whole_tree(typed: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def cut(nodes: int) -> int:
        """How many characters are cut into tokens for a completion in the middle of a flat tree."""
        lines = ["        Pick (level = 3)\n        Charge\n"] * (nodes // 2)
        before = "BehaviorTree Main\n    ->\n" + "".join(lines)
        text = f"{before}        {typed}\n" + "".join(lines)
        workspace = Workspace.of({"main.btq": text})
        lengths.clear()
        assert complete(workspace, "main.btq", len(before) + 8 + len(typed)).proposals
        (facts,) = workspace.files["main.btq"].facts.values()
        assert "mentions" not in facts.__dict__
        return sum(lengths)

    def counted(text: str) -> Sequence[Token]:
        lengths.append(len(text))
        return all_tokens(text)

    lengths: list[int] = []
    monkeypatch.setattr(place, "tokens_of", counted)
    assert cut(20) == cut(2_000)


def test_a_name_that_is_typed_in_one_place_alone_is_not_offered_there() -> None:
    def labels(text: str) -> set[str]:
        workspace = Workspace.of({"main.btq": text.replace("$0", "")})
        return {one.label for one in complete(workspace, "main.btq", text.index("$0")).proposals}

    for elsewhere in ("", "    # Grasp\n", "    /* Grasp */\n", '    Say (text = "Grasp")\n', "    Grasped\n"):
        assert "Grasp" not in labels(f"BehaviorTree Main\n  ->\n{elsewhere}    Grasp$0\n"), elsewhere
    for elsewhere in ("    Grasp\n", '    "Grasp"\n', "    SubTree Other (x = 1)\n    Pick Grasp\n"):
        assert "Grasp" in labels(f"BehaviorTree Main\n  ->\n{elsewhere}    Grasp$0\n"), elsewhere
