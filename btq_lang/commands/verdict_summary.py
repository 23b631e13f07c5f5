"""The summary that an editor loads: the verdicts as JSON with what is needed to judge edited bounds, and the progress
of the work as lines on standard output.

One invariant: the work takes the processor only while nothing else wants it, and ends when its reader has gone.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from time import monotonic
from typing import TYPE_CHECKING, Final

from btq_lang.commands.output import write_file
from btq_lang.evidence.json_document import render
from btq_lang.evidence.sentences import worst_violation
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import ClauseVerdict, RequirementVerdict, VerdictReport


def progress_to_editor(logs: int) -> Callable[[int, int], None]:
    """A function that prints how many logs have been read and how many runs have been judged, a JSON object a line:
    `done` of `of` logs, `runs`.
    """
    if hasattr(os, "nice"):
        os.nice(_NICE)
    due = [0.0]

    def reached(files: int, runs: int) -> None:
        if monotonic() >= due[0]:
            due[0] = monotonic() + _PAUSE
            print(json.dumps({"done": files, "of": logs, "runs": runs}), flush=True)

    return reached


def write_summary(path: str, report: VerdictReport) -> None:
    """Write the summary, whole or not at all, with few violations of each clause."""
    missions = (replace(each, requirements=tuple(map(_shortened, each.requirements))) for each in report.missions)
    write_file(path, render(replace(report, missions=tuple(missions))))


def _shortened(requirement: RequirementVerdict) -> RequirementVerdict:
    return replace(requirement, clauses=tuple(map(_with_few_violations, requirement.clauses)))


def _with_few_violations(clause: ClauseVerdict) -> ClauseVerdict:
    if len(clause.violations) <= _VIOLATIONS:
        return clause
    worst = worst_violation(clause)
    others = [each for each in clause.violations if each is not worst]
    return replace(clause, violations=(worst, *others[: _VIOLATIONS - 1]))


_VIOLATIONS: Final = 10
_NICE: Final = 10
_PAUSE: Final = 0.5  # seconds between two lines
