"""The log of examples/laboratory is the one that laboratory_runs.py makes; `--update` writes it again."""

from __future__ import annotations

from pathlib import Path

from laboratory_runs import campaign

from btq_lang.commands.opening import open_workspace
from btq_lang.evidence.identity import Candidate

FOLDER = Path(__file__).parents[2] / "examples" / "laboratory"


def test_the_log_and_its_samples_come_out_again(update: bool) -> None:
    mission = str(FOLDER / "mission.btq")
    log, samples = campaign(Candidate(open_workspace(mission), mission, "mission", None))
    if update:
        (FOLDER / "runs.btlog").write_bytes(log)
        (FOLDER / "signals.csv").write_text(samples, encoding="utf-8", newline="\n")
    assert (FOLDER / "runs.btlog").read_bytes() == log
    assert (FOLDER / "signals.csv").read_text(encoding="utf-8") == samples
    assert len(log) + len(samples) < 200_000
