"""The violations of `btq verify` as a file for Foxglove and rqt_console."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.commands.output import write_file
from btq_lang.evidence.readers import NotALog, clocks
from btq_lang.projects.options import Refused
from btq_lang.util.text import counted
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.readers.topics import Clock
    from btq_lang.evidence.verdicts import VerdictReport
    from btq_lang.projects.messages import CommandOutput


def events_problem(path: str | None) -> str | None:
    """The usage error for the path of `--events`; None if it can be used."""
    if path is None:
        return None
    if os.path.splitext(path)[1] != _MCAP:
        return f"--events {path}: expected the name of an MCAP file, which ends in {_MCAP}"
    try:
        import rosbags.rosbag2  # noqa: F401  # whether it is installed
    except ImportError:
        return "--events is written with rosbags; install it with pip install 'btq-lang[ros]'"
    return None


def overwrite_problem(path: str, logs: Iterable[str]) -> str | None:
    """The usage error for a path that is one of the logs, or is inside a log's folder; None otherwise."""
    file = os.path.realpath(path)
    for log in map(os.path.realpath, logs):
        if file == log or file.startswith(os.path.join(log, "")):
            return f"--events {path} is among the logs; choose another place"
    return None


def write_events(path: str, report: VerdictReport, logs: Sequence[str], messages: CommandOutput) -> None:
    """Write the violations into a file.

    Args:
        logs: the files that were judged.

    Raises:
        Refused: it cannot be written.
    """
    from btq_lang.evidence.events import render

    try:
        events = render(report, os.path.basename(path).removesuffix(_MCAP), _clocks(report, logs))
    except (NotALog, OSError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or error
        raise Refused(f"{path}: cannot be written: {reason}") from error
    write_file(path, events.data)
    if events.uncounted:
        number = counted(events.uncounted, "violation")
        messages.remark(
            f"btq verify: {path}: left out {number}; the file contains only the first thousand of each clause"
        )
    if events.untimed:
        number = counted(events.untimed, "violation")
        messages.remark(f"btq verify: {path}: left out {number} whose times do not fit in a ROS timestamp")


def _clocks(report: VerdictReport, logs: Sequence[str]) -> dict[str, Clock]:
    """The clocks of the bags that contain a violation, by source."""
    clock_of_source: dict[str, Clock] = {}
    violated_sources = {
        violation.source
        for mission in report.missions
        for requirement in mission.requirements
        for clause in requirement.clauses
        for violation in clause.violations
    }
    for log in logs:
        name = shown(log)
        if any(source == name or source.startswith(f"{name} ") for source in violated_sources):
            for topic, clock in clocks(log).items():
                # a source names its topic only if the bag has several logs
                clock_of_source[f"{name} {topic}"] = clock_of_source[name] = clock
    return clock_of_source


_MCAP: Final = ".mcap"
