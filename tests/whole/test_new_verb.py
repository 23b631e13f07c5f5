"""A new verb is a row of the table, with what is found by the row's word; nothing else changes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from evidence_logs import MAIN, MAIN_XML, btlog, rows

# In a process of its own, before anything has read the table.
SCRIPT = """
import sys
from btq_lang.catalog.verbs import VERBS, Verb

VERBS["rests"] = Verb(
    word="rests",
    operand="duration",
    measures="the time in which nothing below it runs",
    judged="at its end",
    said="rested {}",
    phrases=(("rests", "rests at most 2 s", "idle time", "nothing below the node runs for longer"),),
    forms=(("rests at most", "rests at most ${0:2 s}"),),
    why_monitored="no node of the engine sees that nothing runs",
)

from btq_lang.evidence.verbs import JUDGES, duration, judged

JUDGES["rests"] = lambda claim, activation, observed: judged(
    claim, duration(claim, activation, observed), activation
)

from btq_lang.cli import main

for line in sys.stdin.read().splitlines():
    print(f"$ {line}", flush=True)
    print("exit", main(line.split()), flush=True)

from btq_lang import Workspace
from btq_lang.ide.completion import complete

text = "QualityReq a : safety\\n    re"
found = complete(Workspace.of({"m.btq": text}), "m.btq", len(text))
print([each.label for each in found.proposals if "rest" in each.label])
"""
COMMANDS = """\
check m.btq
build m.btq -o out
explain rests
verify run.btlog --mission m.btq
"""


def test_a_row_and_what_its_word_finds(tmp_path: Path) -> None:
    mission = f"QualityReq idle : safety\n    on violation fail\n    Move rests at most 2 s\n{MAIN}"
    (tmp_path / "m.btq").write_text(mission, encoding="utf-8")
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 3000 2S 3R 3001 3S 1S 2I 3I 1I")))
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], input=COMMANDS, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.stderr.splitlines()[0] == (
        "m.btq:3:5: not enforced, monitored: idle, `Move rests at most 2 s` at `Move`: "
        "no node of the engine sees that nothing runs"
    )
    of_command = dict(part.split("\n", 1) for part in done.stdout.split("$ ")[1:])
    assert of_command["check m.btq"].startswith(
        "warning[not-enforced]: the engine cannot enforce `on violation fail`: no node of the engine sees"
    )
    assert of_command["explain rests"] == (
        "# rests (claim)\n\n    rests at most 2 s\n\nViolated when nothing below the node runs for longer.\nexit 0\n"
    )
    verdicts = of_command["verify run.btlog --mission m.btq"]
    assert "rested 3 s" in verdicts
    assert verdicts.endswith("exit 1\n['rests at most']\n")
