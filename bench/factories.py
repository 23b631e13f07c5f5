"""Folders of XML files that one program registers: no file includes another, and SubTrees run trees of any of them."""

from __future__ import annotations

from pathlib import Path
from random import Random

PROJECT = '[[factory]]\nname = "robot"\nload = ["*.xml"]\n'
_TREE = 1_060  # bytes of one, roughly


def write_factory(folder: Path, files: int, size: int) -> None:
    """Write a project file and XML files of a number of bytes, all together."""
    chance = Random(files)
    folder.mkdir()
    (folder / "btq.toml").write_text(PROJECT, encoding="utf-8")
    names = [f"Tree{number}" for number in range(size // _TREE)]
    trees = [_tree(chance, name, names[number + 1 :]) for number, name in enumerate(names)]
    for file in range(files):
        text = "\n".join(['<root BTCPP_format="4">', *trees[file::files], "</root>", ""])
        (folder / f"trees{file:02}.xml").write_text(text, encoding="utf-8")


def _tree(chance: Random, name: str, later: list[str]) -> str:
    """A tree of a dozen nodes that runs some of those after it, so that none runs itself."""
    steps = [
        f'<MoveTo name="step {at}" goal="{{goal_{at}}}" speed="0.5" result="{{result_{at}}}"/>' for at in range(10)
    ]
    called = chance.sample(later, min(3, len(later)))
    steps += [f'<SubTree ID="{each}" goal_1="{{goal_{at}}}" _autoremap="true"/>' for at, each in enumerate(called)]
    body = "\n".join(f"      {step}" for step in steps)
    return f'  <BehaviorTree ID="{name}">\n    <Sequence>\n{body}\n    </Sequence>\n  </BehaviorTree>'
