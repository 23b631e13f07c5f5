"""The formats of `btq verify`: those of `evidence`, and the page that `trace` draws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from btq_lang import evidence
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.verdicts import VerdictReport

FORMATS: Final = (*evidence.FORMATS, "html")


def write(report: VerdictReport, missions: Sequence[Candidate], form: str, **options: Any) -> str:
    """Write the verdicts in one of FORMATS.

    Args:
        missions: all candidates, including those of the report.
        options: as of `evidence.write`.
    """
    if form != "html":
        return evidence.write(report, form, **options)
    from btq_lang.trace import page
    from btq_lang.trace.missions import trace_tables
    from btq_lang.trace.verdicts import outcomes

    found = report.missions
    files = {mission.file for mission in found}
    parts = [(each.workspace, [each.path]) for each in missions if each.path in files]
    requirements = {mission.file: mission.requirements for mission in found}
    table = trace_tables(parts, details_of=outcomes(found), verdicts_of=requirements.__getitem__)
    # A table of the page has the verdicts, so the requirements need no column of them.
    return page.render(replace(table.overview, has_evidence=False), found)
