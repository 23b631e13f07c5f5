"""What docs/evidence.md shows is what the command prints, on a log made for it."""

from __future__ import annotations

import re
from pathlib import Path

from evidence_logs import START, Verify, as_logged, btlog

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.workspace.workspace import Workspace

PAGE = (Path(__file__).parents[2] / "docs" / "evidence.md").read_text(encoding="utf-8")


def night(folder: Path, xml: str) -> None:
    """Forty runs, one a minute: each drive takes longer than the one before it, one is too long and one run fails."""
    transitions = []
    levels = ["t,battery"]
    for run in range(40):
        begin = 60_000_000 * run
        arrived = begin + (31_500_000 if run == 16 else 16_600_000 + 200_000 * run)
        result = 3 if run == 24 else 2
        done = arrived + 4_000_000
        transitions += [
            (begin, 1, 1),
            (begin, 2, 2),
            (begin, 3, 1),
            (arrived, 3, 2),
            (arrived, 4, 1),
            (done, 4, result),
            (done, 1, result),
        ]
        levels.append(f"{(START + arrived) / 1e6:.6f},{34 - run if run <= 30 else 50}")
    (folder / "night.btlog").write_bytes(btlog(xml, transitions))
    (folder / "battery.csv").write_text("\n".join(levels), encoding="utf-8")


def test_the_table_of_the_page(verify: Verify) -> None:
    (mission,) = re.findall(r"^```btq\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    shown, alone, *_ = re.findall(r"^```text\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    (verify.folder / "charge.btq").write_text(mission, encoding="utf-8")
    xml = write(export(Workspace.of({"charge.btq": mission}), "charge.btq").document)
    night(verify.folder, as_logged(xml))
    assert verify.text("night.btlog", "--signals", "battery.csv") == shown
    assert (verify.code, verify.errors) == (1, "")
    (verify.folder / "charge.btq").unlink()
    assert verify.text("night.btlog") == alone
    assert (verify.code, verify.errors) == (0, "")
