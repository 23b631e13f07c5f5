"""docs/day-in-the-life.md: its commands, on a log of the real engine, print what it shows.

The log of the second day is made of that of the first: the same runs in the tree with its guards, none of which fires,
with faster drives to the charger.
"""

from __future__ import annotations

import re
import shlex
import shutil
import struct
from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest
from evidence_logs import as_logged, btlog
from random_guards import Guarded

from btq_lang.btcpp.marks import MARK
from btq_lang.cli import main
from btq_lang.evidence.identity import Candidate
from btq_lang.projects.opening import open_workspace

PAGE = (Path(__file__).parents[2] / "docs" / "day-in-the-life.md").read_text(encoding="utf-8")
FASTER = 0.8  # of the time that a drive to the charger took
CHARGER = 4  # MoveToCharger in the log of the first day
DAY = 86_400_000_000  # µs


def test_the_day(
    shared: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(shared / "logs" / "lab.btlog", "laboratory.btlog")
    shutil.copy(shared / "logs" / "lab.battery.csv", "battery.csv")
    mission = Path("laboratory.btq")
    codes = []
    for language, text in re.findall(r"^```(\w+)\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE):
        if language == "btq" and not mission.exists():
            mission.write_text(text, encoding="utf-8")
        elif language == "btq":  # a requirement that changes
            before = mission.read_text(encoding="utf-8")
            Path("first.btq").write_text(before, encoding="utf-8")
            head = text.splitlines(keepends=True)[0]
            old = head + before.partition(head)[2].partition("\n\n")[0] + "\n"
            assert old != text
            mission.write_text(before.replace(old, text), encoding="utf-8")
        elif language == "toml":
            Path("btq.toml").write_text(text, encoding="utf-8")
        else:
            command, _, shown = text.partition("\n")
            prompt, program, *arguments = shlex.split(command)
            assert (language, prompt, program) == ("console", "$", "btq")
            if "second.btlog" in arguments and not Path("second.btlog").exists():
                write_second_day()
            capsys.readouterr()
            codes.append(main(arguments))
            assert capsys.readouterr().out == shown
    # build, verify, diff, build, verify twice: violated, and changed, are findings; then all is well
    assert codes == [0, 1, 1, 0, 1, 1, 0, 0, 0, 0, 0, 0]
    assert "Nothing that chance does not explain got worse" in Path("report.html").read_text(encoding="utf-8")
    assert "held so far in 26 activations" in Path("trace.html").read_text(encoding="utf-8")


def write_second_day() -> None:
    """The log and the samples of the second day, in this folder."""
    data = Path("laboratory.btlog").read_bytes()
    (size,) = struct.unpack_from("<i", data, 19)
    (start,) = struct.unpack_from("<q", data, 23 + size)
    rows = [
        (int.from_bytes(data[at : at + 6], "little"), *struct.unpack_from("<HB", data, at + 6))
        for at in range(31 + size, len(data), 9)
    ]
    when = faster([(time, status) for time, uid, status in rows if uid == CHARGER])
    workspace = open_workspace("laboratory.btq")
    candidate = Candidate(workspace, next(iter(workspace.files)), "laboratory", None)
    build = next(candidate.builds())
    marks = ((uid, each.element.get(MARK)) for uid, (each, _) in enumerate(build.running.all, 1))
    guards = {uid: requirement for uid, requirement in marks if requirement is not None}
    guarded = Guarded(build.tree(), guards, Even()).of([(when(time), uid, status) for time, uid, status in rows])
    tree = as_logged(Path("laboratory.xml").read_text(encoding="utf-8"))
    Path("second.btlog").write_bytes(btlog(tree, guarded, start + DAY))
    head, *lines = Path("battery.csv").read_text(encoding="utf-8").splitlines()
    samples = (line.split(",", 1) for line in lines)
    moved = [f"{(when(round(float(time) * 1e6) - start) + start + DAY) / 1e6:.6f},{rest}" for time, rest in samples]
    Path("second.csv").write_text("\n".join([head, *moved, ""]), encoding="utf-8")


def faster(drives: list[tuple[int, int]]) -> Callable[[int], int]:
    """When something happens on the second day that happened at a time of the first; µs since the logs' starts."""
    periods = []
    begin: int | None = None
    for time, status in drives:
        if status == 1:
            begin = time
        elif begin is not None:
            periods.append((begin, time))
            begin = None

    def when(time: int) -> int:
        saved = sum(max(0, min(time, end) - begin) for begin, end in periods)
        return time - round(saved * (1 - FASTER))

    return when


class Even(Random):
    """No guard fires by chance."""

    def random(self) -> float:
        return 0.5
