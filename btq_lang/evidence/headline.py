"""The one line that says what to look at: which node, what happened, why, in which run and when."""

from __future__ import annotations

from collections import Counter

from btq_lang.evidence.verdicts import ClauseVerdict, Violation
from btq_lang.evidence.wording import duration, moment

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Final


def headline(clause: ClauseVerdict, medians: Mapping[str, float]) -> str:
    """Of a clause that is violated; with odds, all violations are summed up.

    Args:
        medians: how long nodes take, in seconds by path.
    """
    if clause.interval is None:
        return explained(worst_violation(clause), medians)
    first, *others = clause.violations
    line = f"{first.path}: {clause.violated} of {clause.counted} {clause.unit} broke it"
    causes = Counter(each.chain[0].path for each in clause.violations if each.chain)
    if causes and (cause := causes.most_common(1)[0])[0] != first.path:
        line += f", {cause[1]} of them at {cause[0]}"
    runs = [run for run in dict.fromkeys(str(each.run) for each in others) if run != str(first.run)]
    also = ""
    if runs:
        named = ", ".join(runs[:_RUNS])
        also = f"; also run{'s' if len(runs) > 1 else ''} {named}"
        also += f" and {len(runs) - _RUNS} more" if len(runs) > _RUNS else ""
    return f"{line} ({_where(first)}{also})"


def explained(violation: Violation, medians: Mapping[str, float]) -> str:
    """Of one violation: what was measured, the first link of each kind that led to it, and where to find it."""
    parts = [f"{violation.path}: {violation.why}" + (f", bound {violation.bound}" if violation.bound else "")]
    kinds = {link.kind: link for link in reversed(violation.chain)}
    if "origin" in kinds:
        kinds.pop("part", None)
    parts += [link.text for link in violation.chain if kinds.get(link.kind) is link]
    if not violation.chain and violation.path in medians:
        parts.append(f"its median is {duration(medians[violation.path])}")
    return f"{'; '.join(parts)} ({_where(violation)})"


def worst_violation(clause: ClauseVerdict) -> Violation:
    """The one that went furthest beyond the bound; the first one where nothing is measured."""
    worst = clause.worst
    found = (each for each in clause.violations if worst and (each.run, each.measured) == (worst.run, worst.text))
    return next(found, clause.violations[0])


def _where(violation: Violation) -> str:
    """The run, and the time in it."""
    start = moment(violation.start)
    begun = f" at {start:%Y-%m-%d %H:%M:%S}.{start.microsecond // 1000:03} UTC" if start is not None else ""
    return f"run {violation.run} of {violation.source}, {duration(violation.at)} after its start{begun}"


_RUNS: Final = 4  # named beside the first one
