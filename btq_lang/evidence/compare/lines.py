"""A comparison in words: what changed, what differs but may be chance, and what was not compared."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf
from typing import Final

from btq_lang.catalog.units import parse_unit
from btq_lang.evidence.compare.chance import LEVEL
from btq_lang.evidence.compare.model import WORSE, ComparedNumber, RunComparison, is_time
from btq_lang.evidence.compare.requirements import Newly
from btq_lang.evidence.verdicts import VIOLATED
from btq_lang.evidence.wording import duration, first_of, measured, period, quantity, share
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record, replace
from btq_lang.util.text import counted


class DifferenceLine(Record):
    """A difference in words.

    Attributes:
        finding: such as `newly violated` or `slower`; empty for a number that differs by chance.
        is_worse: whether it certainly got worse.
        requirement: that it is about; empty where it is about a node alone.
        name: the requirement with its title or clause, or the node.
        text: both sides, and how likely that is by chance.
        more: what is the same change, or follows from it; may be empty.
    """

    finding: str
    is_worse: bool
    requirement: str
    name: str
    text: str
    more: str


def certain(comparison: RunComparison) -> list[DifferenceLine]:
    """The changes that are certain and large enough: first new violations, then what got worse, the largest share
    first, then the rest.

    What another change explains has no line of its own; that of a requirement also says what is measured for it.
    """
    turned = [newly for newly in (*comparison.newly, *comparison.no_longer) if not newly.may_be_chance]
    own = {newly.id for newly in turned}
    changes = [change for change in comparison.changes if change.finding and change.cause is None]
    changes.sort(key=lambda change: -abs(change.difference / change.before) if change.before else -inf)
    measured = grouped(
        (change.requirement, f"and {change.finding}: {_numbers(change, comparison)}, {_chance(change.p)}")
        for change in changes
        if change.failed is None
    )
    of_requirements = [replace(_turned(newly), more="; ".join(measured.get(newly.id, ()))) for newly in turned]
    lines = [
        DifferenceLine(
            finding=change.finding,
            is_worse=change.finding in WORSE,
            requirement=change.requirement,
            name=change.name,
            text=f"{_numbers(change, comparison)}, {_chance(change.p)}",
            more=_folded(change, comparison.changes),
        )
        for change in changes
        if change.requirement not in own
    ]
    violated, no_longer = (
        [line for line in of_requirements if line.is_worse is is_worse] for is_worse in (True, False)
    )
    return [*violated, *sorted(lines, key=lambda line: not line.is_worse), *no_longer]


def by_chance(comparison: RunComparison) -> list[DifferenceLine]:
    """The largest differences that chance may explain: requirements, then the least likely differences."""
    lines = [
        replace(_turned(newly), is_worse=False)
        for newly in (*comparison.newly, *comparison.no_longer)
        if newly.may_be_chance
    ]
    causes = _causes_in_requirements(comparison.changes)
    lines = [
        replace(line, more=_AT_WORK.format(causes[line.requirement])) if line.requirement in causes else line
        for line in lines
    ]
    own = {line.requirement for line in lines}
    quiet = [
        change
        for change in comparison.changes
        if change.p > LEVEL and change.p_alone <= _LIKELY
        if change.cause is None and change.is_at_least(comparison.at_least)
        if not (change.failed is not None and change.requirement in own)
    ]
    quiet.sort(key=lambda change: change.p_alone)
    for change in quiet[:_MOST]:
        text = f"{_numbers(change, comparison)}, {_chance(change.p)}, alone {change.p_alone:.2g}"
        lines.append(DifferenceLine("", False, change.requirement, change.name, text, ""))
    return lines


def percent(change: ComparedNumber) -> str:
    """The difference as a share of the first number; empty if that is 0."""
    return f"{_sign(change.difference)}{share(abs(change.difference / change.before))}" if change.before else ""


def _turned(newly: Newly) -> DifferenceLine:
    """How a requirement became violated, or no longer is."""
    first, second = (f"{k:,} of {n:,}" for k, n in zip(newly.violated, newly.counted, strict=True))
    is_worse = newly.after == VIOLATED
    verdict = f"was {newly.before}" if is_worse else f"is {newly.after}"
    chance = f", {_chance(newly.p)}" if newly.p is not None else ""
    counts = f"violated in {first} → {second}" if newly.pooled is None else " → ".join(newly.pooled)
    name = f"{newly.id} {newly.title}".rstrip()
    finding = "newly violated" if is_worse else "no longer violated"
    return DifferenceLine(finding, is_worse, newly.id, name, f"{verdict}; {counts}{chance}", "")


def _causes_in_requirements(changes: Sequence[ComparedNumber]) -> dict[str, str]:
    """The names of the certain changes that requirements measure too, by requirement."""
    causes = {change.key: change.name for change in changes if change.finding and change.cause is None}
    same = {key.requirement: causes[change.key] for change in changes if change.key in causes for key in change.same}
    explained = {change.requirement: causes[change.cause] for change in changes if change.cause in causes}
    return {**explained, **same}


def _folded(change: ComparedNumber, changes: Sequence[ComparedNumber]) -> str:
    """What is the same change, or follows from it."""
    effects = [effect for effect in changes if effect.cause == change.key and effect.direction == change.direction]
    effects.sort(key=lambda effect: effect.before)  # what is inside takes less time
    keys = [*change.same, *(key for effect in effects for key in (effect.key, *effect.same))]
    nodes = [key.node for key in keys if not key.requirement]
    requirements = sorted({key.requirement for key in keys if key.requirement})
    parts = [f"{counted(len(nodes), 'node')} above it: {first_of(nodes)}"] if nodes else []
    if requirements:
        parts.append(f"in {'requirement' if len(requirements) == 1 else 'requirements'} {first_of(requirements)}")
    return f"and {', and '.join(parts)}" if parts else ""


def _numbers(change: ComparedNumber, comparison: RunComparison) -> str:
    """Both numbers, how they differ, and of how many runs, or what is shuffled in their place."""
    if change.failed is not None and change.exposures is not None and change.period is not None:
        unit, period = parse_unit(change.unit), change.period
        before, after = (
            f"{k:,} in {measured(seconds, unit)}" for k, seconds in zip(change.failed, change.exposures, strict=True)
        )
        rates = " → ".join(f"{rate * period:.3g}" for rate in (change.before, change.after))
        return f"{before} → {after}, {rates} per {measured(period, unit)}"
    if change.failed is not None:
        verb = "violated" if change.requirement else "failed"
        before, after = (f"{k:,} of {n:,}" for k, n in zip(change.failed, change.counts, strict=True))
        return f"{verb} in {before} runs → {after}"
    differs = ", ".join(filter(None, (_signed(change.difference, change), percent(change))))
    if change.interval is not None:
        low, high = (_signed(si, change) for si in change.interval)
        differs += f"; 95 % interval {low} to {high}"
    shuffled = "robots" if comparison.over == "robots" else "groups" if comparison.group > 1 else "runs"
    over = f"over {change.units[0]:,} and {change.units[1]:,} {shuffled}"
    return f"mean {_shown(change.before, change)} → {_shown(change.after, change)} ({differs}) {over}"


def _signed(si: float, change: ComparedNumber) -> str:
    return f"{_sign(si)}{_shown(abs(si), change)}"


def _sign(number: float) -> str:
    return "−" if number < 0 else "+"


def _chance(p: float) -> str:
    return f"p = {p:.2g}" if p >= 0.0001 else "p < 0.0001"


def _shown(si: float, change: ComparedNumber) -> str:
    return duration(si) if is_time(change.unit) else quantity(si, parse_unit(change.unit))


def heading(comparison: RunComparison, sides: tuple[str, str]) -> str:
    """What is compared, and when it was."""
    if not all(comparison.runs):
        ran, other = sides if comparison.runs[0] else sides[::-1]
        return f"{comparison.mission}: {counted(max(comparison.runs), 'run')} of {ran}, none of {other}, not compared"
    over = f"groups of {comparison.group:,} {comparison.over}" if comparison.group > 1 else comparison.over
    if comparison.over == "robots":
        over += f" ({comparison.robots[0]} and {comparison.robots[1]})"
    runs = ", ".join(
        f"{counted(number, 'run')} of {side}" + (f" ({period(*times)})" if times is not None else "")
        for number, side, times in zip(comparison.runs, sides, comparison.times, strict=True)
    )
    return f"{comparison.mission}: {runs}, durations compared by {over}"


def remarks(comparison: RunComparison, sides: tuple[str, str]) -> Iterator[str]:
    """What did not change, what could not be compared, and what has too few runs."""
    if not all(comparison.runs):
        return
    if comparison.labels:
        ran = (
            f"{side} ran {', '.join(f'{label or _NO_LABEL} ({number:,})' for label, number in labels.items())}"
            for side, labels in zip(sides, comparison.labels, strict=True)
        )
        yield f"several labels are compared at once: {'; '.join(ran)}; --label LABEL takes the runs of one"
    changes = comparison.changes
    more = sum(change.p <= LEVEL for change in changes)
    yield f"{more} of {counted(len(changes), 'comparison')} differ by more than chance explains"
    small = [change for change in changes if change.p <= LEVEL and not change.finding]
    if small:
        named = first_of([f"{change.name} ({percent(change)})" for change in small])
        yield f"less than {share(comparison.at_least)}, so no change (--at-least): {named}"
    for edit in comparison.edited:
        whose = f"{edit.requirement} at {edit.node}" if edit.node else edit.requirement
        old, new = (
            f"{text} ({k:,} of {n:,} violated)"
            for text, k, n in zip((edit.before, edit.after), edit.violated, edit.counted, strict=True)
        )
        yield f"the bound of {whose} was changed from {old} to {new}, so this says nothing about the robots"
    alone = zip(comparison.one_sided, sides, strict=True)
    if one_sided := ", ".join(f"{counted(number, 'node')} active only in {side}" for number, side in alone if number):
        yield f"not compared: {one_sided}"
    for names, side in zip(comparison.only, sides, strict=True):
        if names:
            noun = "requirements" if len(names) > 1 else "requirement"
            yield f"not compared: {noun} only in {side}: {', '.join(names)}"
    if comparison.unknown:
        yield f"unknown on both sides, as btq verify explains: {', '.join(comparison.unknown)}"
    if why := untestable(comparison):
        yield f"means: {why}"
    certain = {change.name for change in changes if change.finding}
    few = [name for name in dict.fromkeys(change.name for change in changes if change.too_few) if name not in certain]
    if few:
        yield f"too few to show any change: {', '.join(few)}"


def untestable(comparison: RunComparison) -> str:
    """Why no measure can show a change; empty if one can, or none is compared."""
    measures = [change for change in comparison.changes if change.failed is None]
    if not measures or not all(change.too_few for change in measures):
        return ""
    first, second = comparison.robots if comparison.over == "robots" else comparison.runs
    noun = "robot" if comparison.over == "robots" else "run"
    return f"not testable with {f'{first} and ' if first != second else ''}{counted(second, noun)}"


_AT_WORK: Final = "includes what changed at {}, so more runs may show it"
_MOST: Final = 5  # differences that chance may explain
_LIKELY: Final = 0.5  # p-values of differences that are none
BY_CHANCE: Final = "what differs most where chance may explain it"
_NO_LABEL: Final = "no label"
