"""Sentences about a clause: its result, and what to look at."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Final

from btq_lang.evidence.tally import USUAL_CONFIDENCE
from btq_lang.evidence.verdicts import (
    NEVER,
    OPEN,
    SATISFIED,
    UNDECIDED,
    UNKNOWN,
    VIOLATED,
    ClauseVerdict,
    Pooled,
    Violation,
)
from btq_lang.evidence.wording import clock_time, duration, share
from btq_lang.util.text import counted


def result(clause: ClauseVerdict) -> str:
    """The counts, and how far the worst measure is from its bound."""
    parts = [_counted(clause) if clause.pooled is None or clause.verdict == NEVER else _pooled(clause, clause.pooled)]
    if clause.worst is not None and clause.interval is None and clause.verdict != UNKNOWN:
        run = clause.worst.run
        worst = f"worst {clause.worst.text} in run {run}" if run is not None else f"worst {clause.worst.text}"
        known_number = f"{clause.counted - clause.bounded.number} known, " if clause.bounded is not None else ""
        parts.append(f"{known_number}{worst}")
    if clause.cut_off and clause.verdict != NEVER:
        parts.append(f"{clause.cut_off} cut off by the end of a log")
    left_out = [f"{number} that {how}" for number, how in _left_out(clause) if number]
    if left_out and clause.verdict != UNKNOWN:
        number = clause.failed + clause.halted
        parts.append(f"{' and '.join(left_out)} {'was' if number == 1 else 'were'} not counted")
    if clause.not_applicable and clause.verdict != NEVER:
        parts.append(f"{clause.not_applicable} not applicable")
    bounded = f"; {clause.bounded.number} bounded by {clause.bounded.text}" if clause.bounded is not None else ""
    return f"{', '.join(parts)}{bounded}"


def _left_out(clause: ClauseVerdict) -> tuple[tuple[int, str], ...]:
    return (clause.failed, "failed"), (clause.halted, f"{'was' if clause.halted == 1 else 'were'} halted")


def headline(clause: ClauseVerdict, medians: Mapping[str, float]) -> str:
    """What to look at for a violated clause: the node, what happened, why, in which run and when.

    With odds, it sums up all violations.  `medians`: how long nodes take, in seconds by path.
    """
    if clause.pooled is not None:
        return f"{clause.path}: {clause.pooled.text}"
    if clause.interval is None:
        return explained(clause, worst_violation(clause), medians)
    if not clause.violations:
        return f"{clause.of or clause.path}: no share can be as large as the requirement asks"
    first = clause.violations[0]
    line = f"{clause.of or first.path}: {clause.violated} of {clause.counted} {clause.unit} broke it"
    causes = Counter(violation.chain[0].path for violation in clause.violations if violation.chain)
    if causes and (cause := causes.most_common(1)[0])[0] != first.path:
        line += f", {cause[1]} of them at {cause[0]}"
    return f"{line} ({_where(first)}{_others(clause)})"


def explained(clause: ClauseVerdict, violation: Violation, medians: Mapping[str, float]) -> str:
    """Explains one violation: what was measured, the first link of each kind that led to it, and where it is."""
    return f"{clause.of or violation.path}: {reason(violation, medians)} ({_where(violation)})"


def reason(violation: Violation, medians: Mapping[str, float]) -> str:
    """The measure, and the first link of each kind that led to it."""
    bound = f", bound {violation.bound}" if violation.bound else ""
    parts = [f"{violation.why}{bound}"]
    kinds = {link.kind: link for link in reversed(violation.chain)}
    if "origin" in kinds:
        kinds.pop("part", None)
    if "self" in kinds and violation.path in medians:  # its duration is already in the sentence
        parts.append(f"its median is {duration(medians[violation.path])}")
    parts += [link.text for link in violation.chain if kinds.get(link.kind) is link and link.kind != "self"]
    return "; ".join(parts)


def worst_violation(clause: ClauseVerdict) -> Violation:
    """The violation furthest beyond the bound; the first if nothing is measured."""
    worst = clause.worst
    violations = clause.violations
    worst_ones = (each for each in violations if worst and (each.run, each.measured) == (worst.run, worst.text))
    return next(worst_ones, violations[0])


def _others(clause: ClauseVerdict) -> str:
    """The runs that broke a clause beside the first: those of its log by number, then how many others if that is known:
    a store gives only the worst violations.
    """
    first, *others = dict.fromkeys((violation.source, violation.run) for violation in clause.violations)
    named = [str(run) for source, run in others if source == first[0]][:_RUNS]
    runs = clause.violated if clause.unit == "runs" else len(others) + 1
    is_known = clause.unit == "runs" or len(clause.violations) == clause.violated
    more = runs - 1 - len(named) if is_known else 0
    if not named:
        return f"; also {counted(more, 'other run')}" if more else ""
    return f"; also run{'s' if len(named) > 1 else ''} {', '.join(named)}" + (f" and {more} more" if more else "")


def _pooled(clause: ClauseVerdict, pooled: Pooled) -> str:
    unknown = f", {clause.unknown} unknown ({clause.why})" if clause.unknown else ""
    return f"{pooled.text}{unknown}"


def _counted(clause: ClauseVerdict) -> str:
    if clause.verdict == UNKNOWN:
        others = f" ({clause.unknown} of {clause.counted + clause.unknown} {clause.unit})" if clause.unknown else ""
        return f"{clause.why}{others}"
    if clause.verdict in (NEVER, OPEN):
        return clause.why
    why = f" ({clause.why})" if clause.why else ""
    unknown = f", {clause.unknown} unknown{why}" if clause.unknown else ""
    if clause.interval is None:
        number = counted(clause.counted, clause.unit.removesuffix("s"))
        return f"{clause.violated} of {number}{unknown}" if clause.verdict == VIOLATED else f"held so far in {number}"
    held = clause.counted - clause.violated
    counts = f"{held} of {clause.counted}{unknown}"
    if clause.verdict == UNDECIDED:
        decided = f"no number of further {clause.unit} can decide it"
        if clause.more is not None:
            decided = f"{clause.more} more without a violation decide{'s' if clause.more == 1 else ''} it"
        return f"{counts}; {decided}"
    if not clause.counted:
        return counts
    low, high = clause.interval
    looks = _LOOKS[clause.limits]
    if clause.confidence is None:
        each = "" if clause.limits == "every look" else " each"
        limits = f"{share(low)} to {share(high)} with confidence {share(USUAL_CONFIDENCE)}{each}{looks}"
        return f"{counts}, {share(held / clause.counted)}; limits {limits}"
    limit = f"at least {share(low)}" if clause.verdict == SATISFIED else f"at most {share(high)}"
    return f"{counts}, {limit} with confidence {share(clause.confidence)}{looks}"


def _where(violation: Violation) -> str:
    """The run, and the time in it."""
    begun = f" at {clock}" if (clock := clock_time(violation.start)) else ""
    return f"run {violation.run} of {violation.source}, {duration(violation.at)} after its start{begun}"


_LOOKS: Final = {"one look": "", "window": " for one look", "every look": " at every look"}
_RUNS: Final = 4  # named in addition to the first
