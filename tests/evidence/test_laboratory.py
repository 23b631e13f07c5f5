"""The logs of examples are those that laboratory_runs.py makes; `--update` writes them again."""

from __future__ import annotations

from pathlib import Path

import pytest
from laboratory_runs import Inspector, Robot, campaign

from btq_lang.evidence.identity import Candidate
from btq_lang.projects.opening import open_workspace

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.parametrize(("example", "kind"), [("laboratory", Robot), ("paper", Inspector)])
def test_the_log_and_its_samples_come_out_again(example: str, kind: type[Robot], update: bool) -> None:
    folder = EXAMPLES / example
    mission = str(folder / "mission.btq")
    log, samples = campaign(Candidate(open_workspace(mission), mission, "mission", None), kind)
    if update:
        (folder / "runs.btlog").write_bytes(log)
        (folder / "signals.csv").write_text(samples, encoding="utf-8", newline="\n")
    assert (folder / "runs.btlog").read_bytes() == log
    assert (folder / "signals.csv").read_text(encoding="utf-8") == samples
    assert len(log) + len(samples) < 200_000
