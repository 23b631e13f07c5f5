"""What changes make of demands, as rows of words, which all writers share."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.evidence.wording import duration, share
from btq_lang.prediction.report import WORST_FIRST, Alternative, DemandChange, Prediction
from btq_lang.prediction.sentences import number_of
from btq_lang.util.record import Record


class ChangeTable(Record):
    """A change with all demands, or a demand with all changes.

    Attributes:
        title: which one it is.
        rows: a word, what the row is about in two cells, the shares, and their difference.
        last: lines below; there may be none.
    """

    title: str
    rows: tuple[tuple[str, str, str, str, str], ...]
    last: tuple[str, ...] = ()


def tables(prediction: Prediction) -> Iterator[ChangeTable]:
    """Those of the alternatives: by change, or by demand where skills improve."""
    if prediction.improves:
        yield from _by_demand(prediction)
        return
    for each in prediction.alternatives:
        rows = sorted(each.differences, key=lambda row: WORST_FIRST.index(row.word))
        cells = tuple((_words(row), row.requirement, _clause(row, each), _shares(row), difference(row)) for row in rows)
        yield ChangeTable(f"what if {each.what}", cells, (_runs(prediction, each.prediction),))


def _by_demand(prediction: Prediction) -> Iterator[ChangeTable]:
    """What each improvement does for a demand, the best first, and those that change nothing."""
    places = range(max((len(each.differences) for each in prediction.alternatives), default=0))
    for place in places:
        pairs = [(each, each.differences[place]) for each in prediction.alternatives]
        pairs.sort(key=lambda pair: -(pair[1].difference or 0.0))
        first = pairs[0][1]
        differing = [(each, row) for each, row in pairs if row.difference or row.word != row.before]
        rows = tuple((_words(row), each.what, "", _shares(row), difference(row)) for each, row in differing)
        same = ", ".join(each.what for each, row in pairs if not (row.difference or row.word != row.before))
        same = f"the same with: {same}" if rows else f"none of {len(pairs)} improvements changes this"
        title = f"what helps {first.requirement}: {_clause(first, pairs[0][0])}"
        yield ChangeTable(title, rows, (same,) if len(rows) < len(pairs) else ())


def difference(row: DemandChange) -> str:
    """In percentage points, with its interval."""
    if row.difference is None:
        return ""
    points = f"{_points(row.difference)} points"
    if row.interval is None:
        return points
    low, high = map(_points, row.interval)
    return f"{points} ({low} to {high})"


def _points(number: float) -> str:
    text = f"{number * 100:+.3g}"
    return "0" if float(text) == 0 else text.replace("-", "−")


def _words(row: DemandChange) -> str:
    return row.word if row.word == row.before else f"{row.before} → {row.word}"


def _shares(row: DemandChange) -> str:
    if row.share is None or row.share_before is None:
        return ""
    return f"{share(row.share_before)} → {share(row.share)}"


def _clause(row: DemandChange, alternative: Alternative) -> str:
    is_lone = sum((row.requirement, row.text) == (each.requirement, each.text) for each in alternative.differences) == 1
    return row.text if is_lone or not row.path else f"{row.text} at {row.path}"


def _runs(before: Prediction, after: Prediction) -> str:
    """How many runs succeed, and how long they take, without the change and with it."""
    numbers = [sum(end.runs for end in each.ends if end.end == "succeeds") for each in (before, after)]
    text = f"runs that succeed: {number_of(numbers[0])} → {number_of(numbers[1])} of {number_of(after.runs)}"
    for name, old, new in (("they take", before.median, after.median), ("95 % of them at most", before.p95, after.p95)):
        if old is not None and new is not None:
            text += f" · {name} {duration(old)} → {duration(new)}"
    return text


HEADS: Final = ("Prediction", "Requirement", "Clause", "Share", "Difference")
HEADS_OF_DEMAND: Final = ("Prediction", "Change", "", "Share", "Difference")
