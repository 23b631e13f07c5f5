"""A change in words, for people."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.units import parse_unit
from btq_lang.evidence.compare.comparison import Change, Comparison, is_time
from btq_lang.evidence.compare.requirements import Newly
from btq_lang.evidence.verdicts import VIOLATED
from btq_lang.evidence.wording import duration, quantity
from btq_lang.util.text import counted


def heading(comparison: Comparison, sides: tuple[str, str]) -> str:
    """What is compared."""
    if not all(comparison.runs):
        ran, other = sides if comparison.runs[0] else sides[::-1]
        return f"{comparison.mission}: {counted(max(comparison.runs), 'run')} of {ran}, none of {other}, not compared"
    (first, second), (one, other) = comparison.runs, sides
    over = f"groups of {comparison.group:,} {comparison.over}" if comparison.group > 1 else comparison.over
    if comparison.over == "robots":
        over += f" ({comparison.robots[0]} and {comparison.robots[1]})"
    runs = f"{counted(first, 'run')} of {one}, {counted(second, 'run')} of {other}"
    return f"{comparison.mission}: {runs}, durations compared by {over}"


def subject(change: Change) -> str:
    """The node, or the clause with its node."""
    if not change.requirement:
        return change.node
    return f"{change.requirement}: {change.clause}" + (f" at {change.node}" if change.node else "")


def difference(change: Change) -> str:
    """Both numbers, and how likely they are by chance."""
    if change.failed is not None:
        verb = "violated" if change.requirement else "failed"
        before, after = (f"{k} of {n}" for k, n in zip(change.failed, change.counts, strict=True))
        return f"{verb} in {before} runs → {after}, {_chance(change.p)}"
    return f"{change.what} {_shown(change.before, change)} → {_shown(change.after, change)}, {_chance(change.p)}"


def turn(newly: Newly) -> str:
    """How a requirement came to be violated, or no longer."""
    first, second = (f"{k:,} of {n:,}" for k, n in zip(newly.violated, newly.counted, strict=True))
    chance = ", which chance may explain" if newly.may_be_chance else ""
    verdict = f"was {newly.before}" if newly.after == VIOLATED else f"is {newly.after}"
    return f"{verdict}, {first} → {second}{chance}"


def remarks(comparison: Comparison, sides: tuple[str, str]) -> Iterator[str]:
    """What was compared and not found to have changed, what could not be compared, and what has too few runs."""
    if not all(comparison.runs):
        return
    if comparison.labels:
        ran = (
            f"{side} ran {', '.join(f'{label or _NO_LABEL} ({number:,})' for label, number in labels.items())}"
            for side, labels in zip(sides, comparison.labels, strict=True)
        )
        yield f"several labels are compared at once: {'; '.join(ran)}; --label LABEL takes the runs of one"
    changes = comparison.changes
    same = sum(not each.finding for each in changes)
    least = f" (p of medians and p95 is at least {comparison.least_p:.2g})"
    is_shuffled = any(each.failed is None for each in changes)
    of_all = f"{same} of {counted(len(changes), 'comparison')} without a change that chance does not explain"
    yield of_all + (least if is_shuffled else "")
    for each in comparison.edited:
        whose = f"{each.requirement} at {each.node}" if each.node else each.requirement
        old, new = (
            f"{text} ({k:,} of {n:,} violated)"
            for text, k, n in zip((each.before, each.after), each.violated, each.counted, strict=True)
        )
        yield f"the bound of {whose} was changed from {old} to {new}, so this says nothing about the robots"
    alone = zip(comparison.one_sided, sides, strict=True)
    if found := ", ".join(f"{counted(number, 'node')} active only in {side}" for number, side in alone if number):
        yield f"not compared: {found}"
    for names, side in zip(comparison.only, sides, strict=True):
        if names:
            what = "requirements" if len(names) > 1 else "requirement"
            yield f"not compared: {what} only in {side}: {', '.join(names)}"
    if found := untestable(comparison):
        yield f"medians and p95: {found}"
    certain = {subject(each) for each in changes if each.finding}
    few = [each for each in dict.fromkeys(subject(each) for each in changes if each.too_few) if each not in certain]
    if few:
        yield f"too few to show any change: {', '.join(few)}"


def untestable(comparison: Comparison) -> str:
    """Why no measure can show a change; empty if one can, or none is compared."""
    measures = [each for each in comparison.changes if each.failed is None]
    if not measures or not all(each.too_few for each in measures):
        return ""
    first, second = comparison.robots if comparison.over == "robots" else comparison.runs
    what = "robot" if comparison.over == "robots" else "run"
    return f"not testable with {f'{first} and ' if first != second else ''}{counted(second, what)}"


def _chance(p: float) -> str:
    return f"p = {p:.2g}" if p >= 0.0001 else "p < 0.0001"


def _shown(si: float, change: Change) -> str:
    return duration(si) if is_time(change.unit) else quantity(si, parse_unit(change.unit))


_NO_LABEL: Final = "no label"
