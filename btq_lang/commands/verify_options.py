"""The options of `btq verify`, which command lines and `btq compare` give, and the formats that it writes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from btq_lang import evidence
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.commands.suggesting_parser import SuggestingParser

FORMATS: Final = (*evidence.FORMATS, "html")


class VerifyOptions(Record):
    """The options and their defaults.

    Attributes:
        logs: files and folders; none: the logs of the project, or a store.
        mission: the paths of missions; none: all of the project, and those of side files beside the logs.
        signals: a file of samples.
        events: where to write the violations as a bag.
        live: the address of a running robot.
        summary: where to write the verdicts for an editor.
        run: the number of the run to print, or to write as a scenario.
        show: the requirement whose worst run is written as a scenario.
        force: overwrite another file with it.
        store: where what is found in logs is kept.
        no_store: keep nothing, also where the project names a store.
        by: what the verdicts of a store are grouped by, `label` or `robot`.
        engine: the URL of another engine than DuckDB.
        label, robot: what the runs are called in the store.
        label_by, robot_by: the folder that names them, `folder` or `folder-above`.
        jobs: the number of processes.
        format: as in FORMATS; None: as the output's name ends.
        strict: exit 1 unless every requirement is satisfied.
        exit_zero: exit 0 also if a requirement is violated.
    """

    logs: Sequence[str] = ()
    mission: Sequence[str] = ()
    signals: str | None = None
    events: str | None = None
    live: str | None = None
    summary: str | None = None
    run: int | None = None
    show: str | None = None
    force: bool = False
    store: str | None = None
    no_store: bool = False
    by: Sequence[str] = ()
    engine: str | None = None
    label: str | None = None
    label_by: str | None = None
    robot: str | None = None
    robot_by: str | None = None
    jobs: int = 1
    format: str | None = None
    output: str | None = None
    verbose: bool = False
    strict: bool = False
    exit_zero: bool = False
    color: str = "auto"


def add_verify_options(parser: SuggestingParser) -> None:
    """Add the options to a command, without those that most commands have."""
    parser.add(
        "logs",
        nargs="*",
        metavar="LOG",
        help="files of FileLogger2 (.btlog) or SqliteLogger (.db3), ROS 2 bags (.mcap, .db3, folders), folders;"
        " default: `logs` in [evidence] of btq.toml",
    )
    parser.add(
        "--mission",
        action="append",
        metavar="FILE",
        help="the mission, may be repeated; default: all of the project, and those of side files beside the logs",
    )
    parser.add(
        "--signals",
        metavar="FILE",
        help="samples as CSV or Parquet: seconds since the epoch, then one column for each signal or entry",
    )
    parser.add(
        "--events",
        metavar="FILE",
        help="write the violations as messages of a bag (.mcap), for the timeline of Foxglove and for rqt_console",
    )
    parser.add(
        "--live",
        metavar="ADDRESS",
        help="judge a running robot through its Groot2Publisher, until Ctrl+C, as in tcp://127.0.0.1:1667",
    )
    parser.add(
        "--summary",
        metavar="FILE",
        help="for editors: write the verdicts as JSON with all that was measured, and progress to standard output",
    )
    parser.add(
        "--show",
        metavar="ID",
        help="write the run with the worst violation of this requirement as a scenario, which btq test runs: with -o",
    )
    parser.add(
        "--run",
        type=int,
        metavar="N",
        help="with --show: write the run with this number; without, for editors: print it, as JSON",
    )
    parser.flag("--force", "with --show: overwrite a file that differs")
    kept = parser.add_argument_group("keeping verdicts")
    store = kept.add_mutually_exclusive_group()
    store.add_argument(
        "--store",
        metavar="DIR",
        help="keep what is found in each log in a folder, as Parquet files; without logs: print what is kept there;"
        " default: `store` in [evidence] of btq.toml",
    )
    store.add_argument("--no-store", action="store_true", help="keep nothing, also where btq.toml names a store")
    kept.add_argument(
        "--by",
        action="append",
        choices=("label", "robot"),
        help="without logs: verdicts for each label or robot; may be repeated",
    )
    kept.add_argument("--engine", metavar="URL", help="without logs: ask another engine than DuckDB, through Ibis")
    label, robot = kept.add_mutually_exclusive_group(), kept.add_mutually_exclusive_group()
    label.add_argument("--label", metavar="NAME", help="of these runs, such as a version")
    folders = ("folder", "folder-above")
    label.add_argument(
        "--label-by", choices=folders, help="label each log with the name of its folder, or of the folder above that"
    )
    robot.add_argument("--robot", metavar="NAME", help="whose logs these are; a bag's topics name the robot themselves")
    robot.add_argument("--robot-by", choices=folders, help="name the robot of each log in the same way")
    parser.add("--jobs", type=int, metavar="N", help="judge logs in N processes; default: 1")
    parser.add("--format", choices=FORMATS, help="default: as the file of -o ends, else table")
    parser.add("-o", "--output", metavar="FILE", help="where to write; default: standard output")
    parser.flag("--verbose", "in the table, explain more violations of each clause")
    fails = parser.add_mutually_exclusive_group()
    fails.add_argument("--strict", action="store_true", help="exit 1 unless every requirement is satisfied")
    fails.add_argument("--exit-zero", action="store_true", help="exit 0 also if a requirement is violated")


def given_options(options: VerifyOptions, names: Sequence[str]) -> list[str]:
    """Those of some options, such as `--label-by`, that have a value."""
    return [name for name in names if getattr(options, name.strip("-").replace("-", "_"))]
