"""The options of `btq verify`, which command lines and `btq compare` give, and the formats that it writes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from btq_lang import evidence
from btq_lang.util.record import Record

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
        run: the number of the run to print.
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


def given_options(options: VerifyOptions, names: Sequence[str]) -> list[str]:
    """Those of some options, such as `--label-by`, that have a value."""
    return [name for name in names if getattr(options, name.strip("-").replace("-", "_"))]
