"""The number of findings of each rule, most first: where to begin in a project with many.

    12  [*] old-quality-name
     3  [ ] unknown-node
    Found 15 warnings (12 fixable with --fix)

`[*]` marks rules whose findings `btq check --fix` all fixes, `[-]` rules of which it fixes some findings.  As JSON,
with the head and the summary of the format `json`:

    "statistics": [{"rule": NAME, "count": N, "fixable": N}]
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from btq_lang.render.report import Report
from btq_lang.render.summary import is_fixable, last_line

FORMATS = ("full", "concise", "json")


def render(form: str, report: Report) -> Iterator[str]:
    """The statistics in one of FORMATS; `full` and `concise` are the same."""
    counts = Counter(finding.diagnostic.rule for finding in report.findings)
    if form == "json" and report.troubles:
        counts["io-error"] = len(report.troubles)
    fixable = Counter(finding.diagnostic.rule for finding in report.findings if is_fixable(finding))
    rows = sorted(counts.items(), key=lambda row: (-row[1], row[0]))
    if form == "json":
        import json  # which takes longer to import than all of the other formats

        from btq_lang.render.json_format import head, summed_up

        statistics = [{"rule": rule, "count": number, "fixable": fixable[rule]} for rule, number in rows]
        yield json.dumps({**head(), "statistics": statistics, "summary": summed_up(report)}, indent=2) + "\n"
        return
    width = len(str(max(counts.values(), default=0)))
    for rule, number in rows:
        mark = "*" if fixable[rule] == number else "-" if fixable[rule] else " "
        yield f"{number:>{width}}  {f'[{mark}] ' if fixable else ''}{rule}\n"
    yield last_line(report)
