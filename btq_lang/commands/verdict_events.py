"""The violations of `btq verify` as a file for Foxglove and rqt_console."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
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


def events_problem(options: Namespace) -> str | None:
    """What is wrong with a command line about the file of the violations."""
    if options.events is None:
        return None
    if os.path.splitext(options.events)[1] != _MCAP:
        return f"--events {options.events}: expected the name of an MCAP file, which ends in {_MCAP}"
    try:
        import rosbags.rosbag2  # noqa: F401  # whether it is installed
    except ImportError:
        return "--events is written with rosbags; install it with pip install 'btq-lang[ros]'"
    return None


def overwrites(path: str, logs: Iterable[str]) -> str | None:
    """Why the file of the violations cannot be there: it is one of the logs, or would be read as one."""
    file = os.path.realpath(path)
    for log in map(os.path.realpath, logs):
        if file == log or file.startswith(os.path.join(log, "")):
            return f"--events {path} is among the logs; choose another place"
    return None


def write_events(path: str, report: VerdictReport, logs: Sequence[str]) -> None:
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
        print(f"btq verify: {path}: {number} left out; it has the first thousand of each clause", file=sys.stderr)
    if events.untimed:
        number = counted(events.untimed, "violation")
        print(f"btq verify: {path}: {number} left out; a ROS message cannot have their times", file=sys.stderr)


def _clocks(report: VerdictReport, logs: Sequence[str]) -> dict[str, Clock]:
    """The clocks of the bags in which something is violated, by source."""
    found: dict[str, Clock] = {}
    broken = {
        each.source
        for mission in report.missions
        for requirement in mission.requirements
        for clause in requirement.clauses
        for each in clause.violations
    }
    for log in logs:
        name = shown(log)
        if any(source == name or source.startswith(f"{name} ") for source in broken):
            for topic, clock in clocks(log).items():
                found[f"{name} {topic}"] = found[name] = clock  # the topic is named if there are several
    return found


_MCAP: Final = ".mcap"
