"""Violations as messages of a ROS 2 bag, each at the moment when its clause was broken.

One invariant: a message is stamped by the clock of the robot's log, and received by the clock of the bag that has the
log, so that it appears where the bag shows the same moment.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from operator import itemgetter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.sentences import explained
from btq_lang.evidence.verdicts import SATISFIED, VIOLATED
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.readers.topics import Clock
    from btq_lang.evidence.verdicts import ClauseVerdict, MissionVerdicts, RequirementVerdict, VerdictReport, Violation

    _Timed: TypeAlias = tuple[int, MissionVerdicts, RequirementVerdict, ClauseVerdict, Violation]  # the time first


class Events(Record):
    """A bag of violations.

    Attributes:
        data: of an MCAP file.
        untimed: how many violations are left out because a ROS message cannot have their time.
        uncounted: how many are left out because the report only counts them.
    """

    data: bytes
    untimed: int
    uncounted: int


def render(report: VerdictReport, name: str, clocks: Mapping[str, Clock]) -> Events:
    """Write the violations in a report into a bag of this name, in the order of their times.

    Args:
        clocks: of the sources that are bags.

    Raises:
        ImportError: `rosbags` is missing.
    """
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    violations, counted = _timed(report)
    placed = _placed(violations, clocks)
    store = get_typestore(Stores.LATEST)
    log, stamp = store.types[_LOG], store.types["builtin_interfaces/msg/Time"]
    with TemporaryDirectory() as folder:
        with Writer(Path(folder, name), version=9, storage_plugin=StoragePlugin.MCAP) as bag:
            topics = [bag.add_connection(_TOPIC, _LOG, typestore=store)] if placed else []  # else times are wrong
            for received, (time, mission, requirement, clause, violation) in placed:
                seconds, rest = divmod(time, _SECOND)
                message = log(
                    stamp=stamp(sec=seconds, nanosec=rest * 1000),
                    level=_LEVELS.get(clause.verdict, _WARN),
                    name=requirement.id,
                    msg=_plain(_text(mission, requirement, clause, violation)),
                    file=_plain(shown(mission.file)),
                    function=violation.path,
                    line=0,
                )
                bag.write(topics[0], received * 1000, store.serialize_cdr(message, _LOG))
        data = Path(folder, name, f"{name}.mcap").read_bytes()
    return Events(data, len(violations) - len(placed), counted - len(violations))


def _timed(report: VerdictReport) -> tuple[Sequence[_Timed], int]:
    """The violations that a report has, with their times in µs since the epoch, and how many it counts."""
    violations: list[_Timed] = []
    counted = 0
    for mission in report.missions:
        for requirement in mission.requirements:
            for clause in requirement.clauses:
                counted += clause.violated
                for violation in clause.violations:
                    time = violation.start + round(violation.at * _SECOND)
                    violations.append((time, mission, requirement, clause, violation))
    return violations, counted


def _placed(violations: Sequence[_Timed], clocks: Mapping[str, Clock]) -> Sequence[tuple[int, _Timed]]:
    """The violations whose times a message can have, in the order of the times at which the bag receives them."""
    placed: list[tuple[int, _Timed]] = []
    possible = (violation for violation in violations if 0 <= violation[0] < _END)
    for source, of_source in grouped((violation[-1].source, violation) for violation in possible).items():
        times = [time for time, *_ in of_source]
        placed += zip(clocks[source].to_reception(times) if source in clocks else times, of_source, strict=True)
    return sorted((violation for violation in placed if 0 <= violation[0] < _END), key=itemgetter(0))


def _text(
    mission: MissionVerdicts, requirement: RequirementVerdict, clause: ClauseVerdict, violation: Violation
) -> str:
    title = f" {requirement.title}" if requirement.title else ""
    where = explained(clause, violation, mission.medians)
    return f"{requirement.id}{title} ({clause.verdict}): {clause.text}. {where}"


def _plain(text: str) -> str:
    """A text that UTF-8 can have, unlike the names of some files."""
    return text.encode(errors="replace").decode()


_LOG: Final = "rcl_interfaces/msg/Log"
_TOPIC: Final = "/rosout"  # where Foxglove and rqt_console look for logs
_LEVELS: Final = {VIOLATED: 40, SATISFIED: 20}  # ERROR, INFO
_WARN: Final = 30
_SECOND: Final = 1_000_000  # µs
_END: Final = 2**31 * _SECOND  # the first time that a stamp of ROS 2 cannot have
