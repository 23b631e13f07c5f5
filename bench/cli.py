"""How long the command line takes, over an interpreter that does nothing.

One invariant: commands take turns, one run each, and what counts is their distance from `python -c pass` of the same
run.  A command is only measured after it has shown that it works, and each run must end as that one did: a crash is
fast, and its exit code is that of a check with findings.  The interpreter is called by its own path
(`sys.executable`), since shims in front of it cost more than btq may.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import sysconfig
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import missions
from btcpp_xml import built
from factories import write_factory
from report import ENVIRONMENT, Goal, as_data, machine, options, shown

from btq_lang.btcpp.document import write

FILES, NODES_A_FILE = 1_000, 50
# Of two factories, files and bytes: what takes five times the text may take eight times the time.
FACTORIES = {"36 XML files of 107 kB": (36, 107_000), "43 XML files of 537 kB": (43, 537_000)}
OTHERS = 5_000  # XML files that are not the engine's
PACKAGE = """<?xml version="1.0"?>
<package format="3">
  <name>robot_{0}</name>
  <version>1.2.{0}</version>
  <description>Drivers of the robot</description>
  <maintainer email="robot@example.com">Robot</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
</package>
"""
URDF = """<?xml version="1.0"?>
<!-- made for measuring -->
<robot name="robot_{0}">
  <link name="base"/>
  <joint name="wheel" type="continuous"><parent link="base"/><child link="wheel"/></joint>
  <link name="wheel"/>
</robot>
"""


@dataclass
class Command:
    """A command, and what each run of it took: `wall` and `cpu` (its own and its children's) in seconds.

    Attributes:
        many: it takes seconds, so fewer rounds are enough.
        failure: why it cannot be measured.
    """

    name: str
    argv: tuple[str, ...]
    many: bool = False
    wall: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)
    failure: str = ""
    exit_code: int = 0


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print; the exit code says nothing about speed."""
    given = _options(arguments)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _write_missions(folder, given.spelling)
        measured = [each for each in commands(folder, _btq()) if given.many_rounds or not each.many]
        run(measured, given.rounds, given.many_rounds)
    goals = compare(measured)
    if given.json:
        print(json.dumps(as_data({"commands": [_data(command) for command in measured]}, goals), indent=2))
    else:
        print(as_text(measured, goals))


def commands(folder: Path, btq: tuple[str, ...]) -> list[Command]:
    """What is measured; the first is what the others are compared with."""
    large = str(folder / "large" / "mission.btq")
    made = [
        Command("python -c pass", (sys.executable, "-c", "pass")),
        Command("btq --version", (*btq, "--version")),
        Command("btq check, 100 nodes", (*btq, "check", str(folder / "one" / "mission.btq"))),
        Command("btq check, 1 000 files", (*btq, "check", str(folder / "many")), many=True),
        Command("btq check, 1 000 XML files, 1 job", (*btq, "check", "--jobs", "1", str(folder / "xml")), many=True),
        Command("btq check, 1 file", (*btq, "check", str(folder / "alone")), many=True),
        Command("btq check, 1 file and 5 000 of other XML", (*btq, "check", str(folder / "others")), many=True),
        *(
            Command(f"btq check, a factory of {name}", (*btq, "check", "--jobs", "1", str(folder / name)), many=True)
            for name in FACTORIES
        ),
        Command("btq trace, 10 000 nodes, HTML", (*btq, "trace", "--format", "html", large), many=True),
        Command("btq graph, 10 000 nodes, SVG", (*btq, "graph", "--qualities", large), many=True),
    ]
    usage = subprocess.run([*btq, "check", "--help"], capture_output=True, text=True, check=False)
    if "--jobs" in usage.stdout:
        for jobs in ("1", "2"):
            argv = (*btq, "check", "--jobs", jobs, str(folder / "many"))
            made.append(Command(f"btq check, 1 000 files, {jobs} jobs", argv, many=True))
    if failure := _blindness(folder, btq):
        for command in made:
            if "check" in command.argv:
                command.failure = failure
    return made


def _blindness(folder: Path, btq: tuple[str, ...]) -> str:
    """Why `btq check` is not to be believed, or nothing: it must find a bracket that is missing."""
    (folder / "broken").mkdir()
    file = folder / "broken" / "broken.btq"
    file.write_text('BehaviorTree broken\n    -> (name = "x"\n', encoding="utf-8")
    argv = (*btq, "check", str(file))
    _, failure = _first_run(argv)
    if failure:
        return failure
    done = subprocess.run(argv, capture_output=True, text=True, check=False)
    return "" if done.returncode == 1 and "broken.btq" in done.stdout + done.stderr else "it finds no missing bracket"


def run(measured: Sequence[Command], rounds: int, many_rounds: int) -> None:
    """Fill in the times, after a first run of each that shows it works and writes the .pyc files."""
    for command in measured:
        command.exit_code, failure = _first_run(command.argv)
        command.failure = command.failure or failure
    for turn in range(rounds):
        for command in measured:
            if command.failure or (command.many and turn >= many_rounds):
                continue
            wall, cpu, exit_code = _spawn(command.argv)
            if exit_code != command.exit_code:
                raise SystemExit(
                    f"{command.name} ended with {exit_code}, before with {command.exit_code}: was it edited?"
                )
            command.wall.append(wall)
            command.cpu.append(cpu)


def _first_run(argv: Sequence[str]) -> tuple[int, str]:
    """The exit code, and why the command does not work, or nothing: 1 is a check with findings, and also a crash."""
    done = subprocess.run(argv, capture_output=True, text=True, check=False, env=ENVIRONMENT)
    if "Traceback" in done.stderr or done.returncode not in (0, 1):
        last = done.stderr.strip().splitlines()[-1:] or [f"exit code {done.returncode}"]
        return done.returncode, last[0]
    return done.returncode, ""


def _spawn(argv: tuple[str, ...]) -> tuple[float, float, int]:
    """Run a command, its output thrown away: seconds by the clock, seconds of processor, exit code."""
    silent = [(os.POSIX_SPAWN_OPEN, number, os.devnull, os.O_RDWR, 0) for number in (0, 1, 2)]
    start = time.perf_counter()
    process = os.posix_spawn(argv[0], argv, ENVIRONMENT, file_actions=silent)
    _, status, usage = os.wait4(process, 0)
    wall = time.perf_counter() - start
    return wall, usage.ru_utime + usage.ru_stime, os.waitstatus_to_exitcode(status)


def _write_missions(folder: Path, spelling: missions.Spelling) -> None:
    (folder / "one").mkdir()
    (folder / "one" / "mission.btq").write_text(missions.mission(100, missions.SEED, spelling), encoding="utf-8")
    (folder / "large").mkdir()
    (folder / "large" / "mission.btq").write_text(
        missions.mission(missions.NODES, missions.SEED, spelling), encoding="utf-8"
    )
    (folder / "many").mkdir()
    (folder / "xml").mkdir()
    for number in range(FILES):
        text = missions.mission(NODES_A_FILE, number, spelling)
        (folder / "many" / f"mission{number:04}.btq").write_text(text, encoding="utf-8")
        (folder / "xml" / f"mission{number:04}.xml").write_text(write(built(text)), encoding="utf-8")
    for name in ("alone", "others"):
        (folder / name).mkdir()
        (folder / name / "mission.btq").write_text(text, encoding="utf-8")
    for name, (files, size) in FACTORIES.items():
        write_factory(folder / name, files, size)
    for number in range(OTHERS):
        package = folder / "others" / f"package{number // 50}"
        package.mkdir(exist_ok=True)
        text = (PACKAGE, URDF)[number % 2].format(number)
        (package / f"robot{number}.xml").write_text(text, encoding="utf-8")


def _btq() -> tuple[str, ...]:
    script = Path(sysconfig.get_path("scripts")) / "btq"
    if not script.exists():
        raise SystemExit(f"{script} does not exist: install btq for {sys.executable} first")
    return (sys.executable, str(script))


def _notes() -> Iterator[str]:
    """What to know of the script itself, which whoever installs btq writes."""
    if "import re\n" in Path(_btq()[1]).read_text(encoding="utf-8"):
        yield "The script `btq` imports `re`, which a small check does not need: pip before 25.1 has written it."


def is_compiled() -> bool:
    """Whether the btq that is measured has a compiled parser."""
    import btq_lang.parser

    return not str(btq_lang.parser.__file__).endswith(".py")


def compare(measured: Sequence[Command]) -> list[Goal]:
    """The goals of docs/performance.md that this run can say something about."""
    took = {command.name: statistics.median(command.wall) for command in measured if not command.failure}
    base = took["python -c pass"]
    goals = []
    for name, allowed in (("btq --version", 0.015), ("btq check, 100 nodes", 0.080)):
        if name in took:
            over = took[name] - base
            goals.append(Goal(f"{name}: ms over python -c pass <= {1000 * allowed:.0f}", 1000 * over, over <= allowed))
    one = took.get("btq check, 1 000 files, 1 jobs", took.get("btq check, 1 000 files"))
    two = took.get("btq check, 1 000 files, 2 jobs")
    if one is not None:
        allowed = 5 if is_compiled() else 8
        goals.append(Goal(f"1 000 files of 50 nodes, one process: s <= {allowed}", one, one <= allowed))
    cpu = {command.name: statistics.median(command.cpu) for command in measured if not command.failure}
    xml = cpu.get("btq check, 1 000 XML files, 1 job")
    if xml is not None:
        goals.append(Goal("1 000 XML files of 50 nodes, one process: s of processor <= 8", xml, xml <= 8))
    alone, others = cpu.get("btq check, 1 file"), cpu.get("btq check, 1 file and 5 000 of other XML")
    if alone is not None and others is not None:
        rate = OTHERS / (others - alone)
        goals.append(Goal("other XML passed over: files a second of processor >= 5 000", rate, rate >= 5_000))
    few, many = (cpu.get(f"btq check, a factory of {name}") for name in FACTORIES)
    if few is not None and many is not None:
        goals.append(Goal("five times the XML of a factory, in times of it <= 8", many / few, many / few <= 8))
    if one is not None and two is not None:
        goals.append(Goal("the same, 2 jobs, in times of one <= 0.6", two / one, two / one <= 0.6))
    return goals


def as_text(measured: Sequence[Command], goals: Sequence[Goal]) -> str:
    """A table in Markdown."""
    base = statistics.median(measured[0].wall)
    lines = [
        machine(),
        *_notes(),
        "",
        "| command | median ms | fastest | over `python -c pass` | processor ms | runs |",
        "|---|---|---|---|---|---|",
    ]
    for command in measured:
        if command.failure:
            lines.append(f"| {command.name} | does not work: {command.failure} | | | | |")
            continue
        wall = statistics.median(command.wall)
        figures = (wall, min(command.wall), wall - base, statistics.median(command.cpu))
        cells = " | ".join(f"{1000 * figure:.1f}" for figure in figures)
        lines.append(f"| {command.name} | {cells} | {len(command.wall)} |")
    return "\n".join([*lines, "", *shown(goals)])


def _data(command: Command) -> dict[str, object]:
    return {
        "name": command.name,
        "failure": command.failure,
        "wall_seconds": command.wall,
        "cpu_seconds": command.cpu,
    }


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = options(__doc__)
    parser.add_argument("--rounds", type=int, default=40, help="runs of each short command (default 40)")
    parser.add_argument(
        "--many-rounds", type=int, default=5, help="runs of each long one (default 5; 0 leaves them out)"
    )
    return parser.parse_args(arguments)


if __name__ == "__main__":
    main()
