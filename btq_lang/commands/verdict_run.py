"""`btq verify LOG --run N`: a run of a log as JSON, which editors draw."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.evidence.one_run import one_run
from btq_lang.evidence.readers import NotALog
from btq_lang.projects.files import write_stdout
from btq_lang.projects.options import Refused
from btq_lang.util.record import as_dict
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate


def print_run(logs: Sequence[str], missions: Sequence[Candidate], number: int) -> int:
    """Print the first mission's run with a number in the log; returns the exit code."""
    if len(logs) != 1 or len(missions) != 1 or number < 1:
        raise Refused("--run N goes with one log and one --mission")
    (log,), (mission,) = logs, missions
    try:
        found = one_run(log, mission, number)
    except (NotALog, OSError) as error:
        raise Refused(f"{shown(log)}: {error}") from error
    if found is None:
        raise Refused(f"{shown(log)} has no run {number} of {mission.name}")
    write_stdout(json.dumps({**as_dict(found), "steps": [*map(as_dict, found.steps)]}) + "\n")
    return 0
