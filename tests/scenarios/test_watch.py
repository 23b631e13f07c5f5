"""`btq test --watch` as a process: it runs again when the file that a scenario includes changes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from running_process import running

MISSION = "BehaviorTree Main\n    ->\n        MoveTo (location = {})\n"
CASES = 'include "mission.btq"\nscenario "to A"\n    expect MoveTo runs "A"\n'


def test_scenarios_run_again_when_their_mission_changes(tmp_path: Path) -> None:
    mission = tmp_path / "mission.btq"
    mission.write_text(MISSION.format('"B"'))
    (tmp_path / "cases.btq").write_text(CASES)
    command = [sys.executable, "-u", "-m", "btq_lang", "test", "cases.btq", "--watch"]
    with running(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
        output = process.stdout
        assert output is not None

        def until(ending: str) -> list[str]:
            lines: list[str] = []
            for line in output:
                lines.append(line.strip())
                if ending in line:
                    return lines
            raise AssertionError(f"no {ending!r} in {lines}")

        assert "1 scenario: 1 failed" in until("Watching for changes")
        stamp = time.time() + 2  # a file system may count whole seconds only
        mission.write_text(MISSION.format('"A"'))
        os.utime(mission, (stamp, stamp))
        until("mission.btq changed")
        assert until("1 scenario: 1 passed")[0] == "passed  to A (cases.btq:2): succeeds after 0 ms"
        process.terminate()  # not SIGINT: a test run in the background has its children ignore that
        assert process.wait(20) == -signal.SIGTERM
