"""`btq init`: create a project without findings."""

from __future__ import annotations

import json
import os
import shlex

from btq_lang.catalog.versions import VERSIONS
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.util.record import Record
from btq_lang.workspace.loader import write_whole

_PROJECT = f"""\
# What holds for all missions of this project
engine = {json.dumps(VERSIONS)}  # the versions of BehaviorTree.CPP that must load them
qualities = "iso25010-2023"
include-paths = ["."]

[rules]
# unknown-node = "error"

# Logs of what the robots did: `btq verify` gives each requirement a verdict.  What is demanded of a signal is unknown
# without samples of it: from a topic of a bag, from a file as in {{ file = "battery.csv", time = "t", column = "%" }},
# or from `btq verify --signals battery.csv`.
# [evidence]
# logs = ["logs/**/*.btlog"]
#
# [evidence.signals]
# battery = {{ topic = "/battery_state", field = "percentage", scale = 100, unit = "%" }}
"""

_SKILLS = """\
# What the robot can do: the interfaces of its nodes.

Action MoveBase "Drive the base to a named station"
    input station : string

Action Charge "Charge until the battery is full"

Condition BatteryGood "True above the level that the way home needs"
    output level : double "charge of the battery, 0 to 100"
"""

_MISSION = """\
include "skills.btq"

# `initially` is what a guard reads before the first sample; a verdict needs samples (btq.toml: [evidence.signals]).
signal battery : % from {battery_level} initially 100 %

# Late design: measurable, and checked or enforced.
QualityReq in_time : performance-efficiency.time-behaviour "Reach a station in time"
    takes at most 30 s

QualityReq way_home : performance-efficiency.resource-utilization "Arrive with some battery left"
    leaves battery >= 20 %

BehaviorTree Mission
    ->
        ?
            BatteryGood (level = {@battery_level})
            -> Recharge
                MoveBase (station = "charger") satisfies in_time
                Charge
        MoveBase (station = "bench")
            satisfices reliability  # early design: a concern, not yet measured
            satisfies in_time, way_home
"""

_SCENARIOS = """\
include "mission.btq"

given battery = 80 %
given MoveBase takes 20 s

# What should happen in cases that are rare on the robot: `btq test` runs it.
scenario "The battery is low" verifies in_time
    given BatteryGood answers false
    expect mission succeeds
    expect MoveBase runs "charger", "bench"
    expect in_time

scenario "The bench cannot be reached"
    given BatteryGood answers true
    given MoveBase (station = "bench") fails
    expect mission fails
    expect never node Charge
"""

FILES = {"btq.toml": _PROJECT, "skills.btq": _SKILLS, "mission.btq": _MISSION, "scenarios.btq": _SCENARIOS}


class InitOptions(Record):
    """The options of `btq init`.

    Attributes:
        from_xml: write only a project file, for existing XML.
        convert: write .btq files beside the XML, too.
    """

    folder: str
    from_xml: bool
    convert: bool


def run(options: InitOptions, messages: CommandOutput) -> int:
    """Write the files, or none if one already exists."""
    if options.from_xml:
        from btq_lang.commands.init_from_xml import init_from_xml  # it needs much more

        return init_from_xml(options.folder, options.convert, messages)
    if options.convert:
        raise Refused("--convert goes with --from-xml")
    folder = options.folder
    existing = [name for name in FILES if os.path.lexists(os.path.join(folder, name))]
    if existing:
        raise Refused(f"{folder} already contains {', '.join(existing)}; nothing was written")
    try:
        os.makedirs(folder, exist_ok=True)
        for name, text in FILES.items():
            write_whole(os.path.join(folder, name), text)
    except OSError as error:
        raise Refused(f"{error.filename or folder}: {error.strerror}") from error
    messages.result(f"Wrote {', '.join(FILES)}. Next: btq check {shlex.quote(folder)}")
    return 0
