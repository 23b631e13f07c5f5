"""What `btq explore` says of Nav2's own trees: the tables of docs/what-can-happen.md, which `--update` writes."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from subprocess import run
from typing import Any

import pytest
from in_process import run_btq
from nav2_clone import clone

from btq_lang.catalog.nav2 import DISTRIBUTIONS

PAGE = Path(__file__).resolve().parents[2] / "docs" / "what-can-happen.md"
TABLES = re.compile(r"(?<=<!-- explored -->\n).*?(?=<!-- /explored -->\n)", re.DOTALL)
FOLDERS = ("nav2_bt_navigator/behavior_trees/", "nav2_docking/opennav_docking_bt/behavior_trees/")
HEAD = f"{' | '.join(each.capitalize() for each in DISTRIBUTIONS)} |"
Result = dict[str, Any]


@pytest.mark.scheduled  # a quarter of an hour of a processor
def test_the_page_has_all_trees(tmp_path: Path, update: bool) -> None:
    results = {distribution: dict(explored(distribution, tmp_path / distribution)) for distribution in DISTRIBUTIONS}
    page = PAGE.read_text(encoding="utf-8")
    after = TABLES.sub(lambda _: tables(results), page)
    if update:
        PAGE.write_text(after, encoding="utf-8")
    assert after == (PAGE.read_text(encoding="utf-8") if update else page)


def explored(branch: str, folder: Path) -> Iterator[tuple[str, Result]]:
    """The trees of a branch, each with what the command writes of it."""
    folder.mkdir()
    (folder / "btq.toml").write_text(f'nodes = ["nav2-{branch}"]\n', encoding="utf-8")
    for path in git("ls-tree", "-r", "--name-only", branch).splitlines():
        if path.startswith(FOLDERS) and path.endswith(".xml") and "_rout" not in path:
            name = path.rpartition("/")[2]
            (folder / name).write_text(git("show", f"{branch}:{path}"), encoding="utf-8")
            _, out, _ = run_btq("explore", name, "--format", "json", cwd=folder)
            yield name.removesuffix(".xml"), json.loads(out)["missions"][0] if out else {}


def git(*arguments: str) -> str:
    """What git prints of the clone."""
    return run(["git", "-C", str(clone()), *arguments], capture_output=True, check=True, text=True).stdout


def tables(results: dict[str, dict[str, Result]]) -> str:
    """How many states each tree has, and what was found, with the lines."""
    trees = sorted({tree for of_branch in results.values() for tree in of_branch})
    lines = [f"| tree | {HEAD}", f"|---{'|---' * len(results)}|"]
    lines += [f"| `{tree}` | {' | '.join(states(results[each].get(tree)) for each in results)} |" for tree in trees]
    found: dict[tuple[str, str], dict[str, list[str]]] = {}
    for branch, of_branch in results.items():
        for tree in trees:
            for finding in of_branch.get(tree, {}).get("survey", {}).get("findings", ()):
                text = re.sub(r"([\w/]+)::\d+", r"`\1`", finding["text"]).replace("{", "`{").replace("}", "}`")
                found.setdefault((text, tree), {}).setdefault(branch, []).append(str(finding.get("line", "yes")))
    lines += ["", f"| found, with the lines | tree | {HEAD}", f"|---|---{'|---' * len(results)}|"]
    for (text, tree), places in sorted(found.items()):
        cells = (", ".join(dict.fromkeys(places.get(branch, []))) for branch in results)
        lines.append(f"| {text} | `{tree}` | {' | '.join(cells)} |")
    return "\n".join([*lines, ""])


def states(mission: Result | None) -> str:
    """How many states were seen; `>`: the search was cut off."""
    if mission is None:
        return ""
    survey = mission.get("survey")
    return "not known" if survey is None else f"{'' if survey['closed'] else '> '}{survey['states']}"
