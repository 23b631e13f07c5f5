"""What `btq check` finds in Nav2's own repository: exactly what the documentation lists."""

from __future__ import annotations

import re
import tarfile
from io import BytesIO
from pathlib import Path
from subprocess import run

import pytest
from in_process import run_btq
from nav2_clone import clone

from btq_lang.catalog.nav2 import DISTRIBUTIONS

PAGE = Path(__file__).parents[2] / "docs" / "nav2-findings.md"
TREES = "nav2_bt_navigator/behavior_trees"


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_the_documentation_lists_every_finding(distribution: str, tmp_path: Path) -> None:
    extract(distribution, tmp_path)
    (tmp_path / "btq.toml").write_text(f'nodes = ["nav2-{distribution}"]\n')
    _, out, err = run_btq("check", "--output-format", "concise", cwd=tmp_path)
    assert err == ""
    found = re.findall(r"^(.+?):(\d+):\d+: \w+\[([\w-]+)\]", out, re.MULTILINE)
    assert sorted(found) == sorted(listed(distribution))
    assert " error" not in out


def extract(branch: str, folder: Path) -> None:
    """Write the XML files of a branch into a folder, without manifests of packages."""
    git = ["git", "-C", str(clone())]
    names = run([*git, "ls-tree", "-r", "--name-only", branch], capture_output=True, check=True, text=True).stdout
    files = [name for name in names.splitlines() if name.endswith(".xml") and not name.endswith("package.xml")]
    archive = run([*git, "archive", branch, "--", *files], capture_output=True, check=True).stdout
    with tarfile.open(fileobj=BytesIO(archive)) as packed:
        for member in packed:
            content = packed.extractfile(member)
            if content is not None:
                path = folder / member.name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content.read())


def listed(distribution: str) -> list[tuple[str, str, str]]:
    """File, line and rule of each finding that the page lists for a distribution."""
    rows = [line.strip("|").split("|") for line in PAGE.read_text(encoding="utf-8").splitlines() if line[:1] == "|"]
    column = 2 + DISTRIBUTIONS.index(distribution)
    found: list[tuple[str, str, str]] = []
    for cells in rows:
        rule, *_ = (cell.strip() for cell in cells)
        if len(cells) == 7 and cells[1].strip().startswith("`"):
            file = cells[1].strip(" `")
            path = file if "/" in file else f"{TREES}/{file}"
            found += [(path, line.strip(), rule) for line in cells[column].split(",") if line.strip()]
    return found
