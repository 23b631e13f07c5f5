"""What is compared, in words, and what a comparison does not say."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.evidence.compare.chance import LEVEL
from btq_lang.evidence.compare.lines import percent
from btq_lang.evidence.compare.model import RunComparison
from btq_lang.evidence.wording import first_of, period, share
from btq_lang.util.text import counted


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
    more = sum(each.p <= LEVEL for each in changes)
    yield f"{more} of {counted(len(changes), 'comparison')} differ by more than chance explains"
    small = [each for each in changes if each.p <= LEVEL and not each.finding]
    if small:
        named = first_of([f"{each.name} ({percent(each)})" for each in small])
        yield f"less than {share(comparison.at_least)}, so no change (--at-least): {named}"
    for edit in comparison.edited:
        whose = f"{edit.requirement} at {edit.node}" if edit.node else edit.requirement
        old, new = (
            f"{text} ({k:,} of {n:,} violated)"
            for text, k, n in zip((edit.before, edit.after), edit.violated, edit.counted, strict=True)
        )
        yield f"the bound of {whose} was changed from {old} to {new}, so this says nothing about the robots"
    alone = zip(comparison.one_sided, sides, strict=True)
    if found := ", ".join(f"{counted(number, 'node')} active only in {side}" for number, side in alone if number):
        yield f"not compared: {found}"
    for names, side in zip(comparison.only, sides, strict=True):
        if names:
            what = "requirements" if len(names) > 1 else "requirement"
            yield f"not compared: {what} only in {side}: {', '.join(names)}"
    if comparison.unknown:
        yield f"unknown on both sides, as btq verify explains: {', '.join(comparison.unknown)}"
    if found := untestable(comparison):
        yield f"means: {found}"
    certain = {each.name for each in changes if each.finding}
    few = [each for each in dict.fromkeys(each.name for each in changes if each.too_few) if each not in certain]
    if few:
        yield f"too few to show any change: {', '.join(few)}"


def untestable(comparison: RunComparison) -> str:
    """Why no measure can show a change; empty if one can, or none is compared."""
    measures = [each for each in comparison.changes if each.failed is None]
    if not measures or not all(each.too_few for each in measures):
        return ""
    first, second = comparison.robots if comparison.over == "robots" else comparison.runs
    what = "robot" if comparison.over == "robots" else "run"
    return f"not testable with {f'{first} and ' if first != second else ''}{counted(second, what)}"


BY_CHANCE: Final = "what differs most where chance may explain it"
_NO_LABEL: Final = "no label"
