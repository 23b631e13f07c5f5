"""`btq check --target`: what many places of a file have in common is one finding."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from in_process import run_btq

DOCK = '<SubTree ID="Dock" pose="target" speed="{}"/>'
DIFFERS = "from 4.0 on `{}` is a text that the SubTree gets, no longer the name of an entry"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Trees for version 3 of the engine that give a tree the same value six times, and other ones."""
    docks = "\n".join(DOCK.format(speed) for speed in (1, 2, 1, 3, 1, 1))
    for name in ("a", "b"):
        (tmp_path / f"{name}.xml").write_text(
            f'<root main_tree_to_execute="Main">\n<BehaviorTree ID="Main">\n<Sequence>\n{docks}\n</Sequence>\n'
            '</BehaviorTree>\n<BehaviorTree ID="Dock">\n<Go pose="{pose}" speed="{speed}"/>\n</BehaviorTree>\n</root>\n'
        )
    (tmp_path / "btq.toml").write_text('engine = "3.8"\n')
    return tmp_path


def test_a_value_is_one_finding_of_a_file(folder: Path) -> None:
    _, out, _ = run_btq("check", "--target", "4.10", "--output-format", "concise", cwd=folder)
    in_file = [
        f"4:26: warning[target-differs] {DIFFERS.format('target')} (here and at 5 other places)",
        f"4:41: warning[target-differs] {DIFFERS.format('1')} (here and at 3 other places)",
        f"5:41: warning[target-differs] {DIFFERS.format('2')}",
        f"7:41: warning[target-differs] {DIFFERS.format('3')}",
    ]
    found = [each for each in out.splitlines() if "SubTree gets" in each]
    assert found == [f"{name}.xml:{each}" for name in "ab" for each in in_file]


def test_its_first_places_are_shown_and_all_are_fixed(folder: Path) -> None:
    _, out, _ = run_btq("check", "a.xml", "--target", "4.10", "--output-format", "json", cwd=folder)
    first = json.loads(out)["diagnostics"][0]
    assert [(each["message"], each["range"]["start"]["line"]) for each in first["related"]] == [
        ("here too", line) for line in (5, 6, 7)
    ]
    (fix,) = first["fixes"]
    assert (fix["title"], len(fix["edits"])) == ("Replace `target` with `{target}`", 6)


def test_a_baseline_knows_each_place(folder: Path) -> None:
    options = ("--target", "4.10", "--baseline", "known.json")
    run_btq("check", "a.xml", *options, "--update-baseline", cwd=folder)
    assert run_btq("check", "a.xml", *options, cwd=folder)[0] == 0
    text = (folder / "a.xml").read_text()
    (folder / "a.xml").write_text(text.replace("<Sequence>", f"<Sequence>\n{DOCK.format(9)}"))
    _, out, _ = run_btq("check", "a.xml", *options, "--output-format", "concise", cwd=folder)
    assert [each.partition("] ")[2] for each in out.splitlines() if "target-differs" in each] == [
        DIFFERS.format("target"),
        DIFFERS.format("9"),
    ]
