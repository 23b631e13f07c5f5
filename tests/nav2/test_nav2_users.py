"""Public packages of Nav2's users, under their distribution and the next ones: what the documentation says of them."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from in_process import run_btq
from public_clones import texts_of

DEMONSTRATIONS = "open-navigation+opennav_amd_demonstrations"
COVERAGE = "open-navigation+opennav_coverage"


@pytest.mark.parametrize(
    ("repository", "commit", "distribution", "own", "next_ones"),
    [
        (
            *(DEMONSTRATIONS, "5199ff2", "humble"),
            {"memory-lost": 3, "trailing-text-in-number": 3, "duplicate-instance-name": 6},
            {"iron": {}, "jazzy": {}},
        ),
        (COVERAGE, "ad914562", "humble", {"unknown-node": 2}, {"iron": {}}),
        (COVERAGE, "19425050", "jazzy", {"unknown-node": 3}, {"kilted": {}}),
        (
            *("iamtony-ca+nav2-examples", "3154823", "jazzy"),
            {
                **{"unknown-node": 53, "memory-lost": 24, "error-code-not-collected": 18, "literal-for-output": 6},
                **{"duplicate-instance-name": 2, "unknown-port": 2, "duplicate-definition": 1, "missing-port": 1},
                "xml-ignored": 1,
            },
            {"kilted": {"target-differs": 17}},
        ),
    ],
)
def test_what_is_found(
    repository: str,
    commit: str,
    distribution: str,
    own: dict[str, int],
    next_ones: dict[str, dict[str, int]],
    tmp_path: Path,
) -> None:
    for name, text in texts_of(repository, commit, (".xml",)).items():
        if not name.endswith("package.xml"):
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "btq.toml").write_text(f'nodes = ["nav2-{distribution}"]\n')

    def found(*options: str) -> dict[str, int]:
        _, out, _ = run_btq("check", "--output-format", "concise", *options, cwd=tmp_path)
        return dict(Counter(re.findall(r"^.+?:\d+:\d+: \w+\[([\w-]+)\]", out, re.MULTILINE)))

    assert found() == own
    for target, expected in next_ones.items():
        assert found("--target", f"nav2-{target}", "--select", "target-breaks,target-differs") == expected
