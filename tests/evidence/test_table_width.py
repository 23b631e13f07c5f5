"""The table of verdicts is as wide as the terminal, where there is one."""

from __future__ import annotations

import sys

import pytest
from evidence_logs import MAIN, MAIN_XML, Verify, btlog, rows

MISSION = f"""
QualityReq swift : reliability "Go there in a time that visitors accept"
    Move takes at most 25 ms
QualityReq charged : reliability
    Pick needs charge > 5 %
signal charge : % from {{charge}}
{MAIN}"""
TABLE = """\
1 run in run.btlog, 2026-11-20 21:22 UTC, mission main (as
built now, 3 of 3 nodes)
  note: samples.csv: column `x` is ignored, because no
  signal or entry has this name

  violated         swift    Go there   Move       1 of 1
                            in a time  takes at   activation
                            that       most 25    , worst 30
                            visitors   ms         ms in run
                            accept                1
                   Move::2: took 30 ms, bound 25 ms; its
                   median is 30 ms (run 1 of run.btlog, 30
                   ms after its start at 2026-11-20
                   21:22:20.000 UTC)
  unknown          charged             Pick       no samples
"""


def test_no_line_is_wider_than_the_terminal(verify: Verify, monkeypatch: pytest.MonkeyPatch) -> None:
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 30 2S 3S 1S")))
    (verify.folder / "samples.csv").write_text("t,x\n1795209740,1\n", encoding="utf-8")
    given = ("run.btlog", "--mission", "main.btq", "--signals", "samples.csv")
    whole = verify.text(*given)
    assert max(map(len, whole.splitlines())) > 120
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    for width in (60, 90, 120):
        monkeypatch.setattr("btq_lang.commands.verdict_report.terminal_width", lambda width=width: width)
        output = verify.text(*given)
        assert max(map(len, output.splitlines())) <= width
        assert sorted("".join(output.split())) == sorted("".join(whole.split()))
    monkeypatch.setattr("btq_lang.commands.verdict_report.terminal_width", lambda: 60)
    assert verify.text(*given).startswith(TABLE)
    monkeypatch.setattr("btq_lang.commands.verdict_report.terminal_width", lambda: 500)
    assert verify.text(*given) == whole
