"""CSV, a line for each clause at each node that it holds for (RFC 4180, lines end with CR LF).

The columns, which later versions add to but do not change:

    requirement, title, mission, clause, path
    verdict         violated | unknown | undecided | satisfied | never exercised | open
    unit            activations | runs
    counted, violated, unknown, cut_off
    worst, worst_si, worst_run
    low, high       limits of the probability
    more            how many more without a violation decide
    result          in words, of an open requirement the reason
    look_at         what to look at, for a violated clause
    limits          which limits low and high are: one look | window | every look
    suspect         yes: the requirement meant something else when it was judged
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.evidence.sentences import headline, result
from btq_lang.evidence.verdicts import VIOLATED, VerdictReport
from btq_lang.render.spreadsheet import table


def render(report: VerdictReport) -> str:
    """The verdicts, with a heading."""
    return table(_COLUMNS, _rows(report))


def _rows(report: VerdictReport) -> Iterator[dict[str, str | float]]:
    for mission in report.missions:
        for requirement in mission.requirements:
            for clause in requirement.clauses:
                worst, (low, high) = clause.worst, clause.interval or ("", "")
                yield {
                    "requirement": requirement.id,
                    "title": requirement.title,
                    "mission": mission.name,
                    "clause": clause.text,
                    "path": clause.path,
                    **{name: getattr(clause, name) for name in _AS_THEY_ARE},
                    "worst": worst.text if worst is not None else "",
                    "worst_si": worst.si if worst is not None else "",
                    "worst_run": worst.run if worst is not None and worst.run is not None else "",
                    "low": low,
                    "high": high,
                    "more": clause.more if clause.more is not None else "",
                    "result": result(clause),
                    "look_at": headline(clause, mission.medians) if clause.verdict == VIOLATED else "",
                    "limits": clause.limits if clause.interval is not None else "",
                    "suspect": "yes" if requirement.is_suspect else "",
                }


_AS_THEY_ARE: Final = ("verdict", "unit", "counted", "violated", "unknown", "cut_off")
_COLUMNS: Final = (
    *("requirement", "title", "mission", "clause", "path", *_AS_THEY_ARE),
    *("worst", "worst_si", "worst_run", "low", "high", "more", "result", "look_at", "limits", "suspect"),
)
