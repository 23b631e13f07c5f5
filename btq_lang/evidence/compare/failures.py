"""In how many runs nodes failed and clauses were violated, on both sides."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from btq_lang.evidence.compare.model import Key
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.compare.chance import Failures


class FailedRuns(Record):
    """The failures of a node, or the violations of a clause.

    Attributes:
        strata: of each side, in how many runs, of how many.
        same: what failed in the same runs and had results in the same.
    """

    key: Key
    strata: Sequence[Failures]
    same: tuple[Key, ...]


def failed_runs(rows: Iterable[Mapping[str, Any]], sides: tuple[str, str]) -> list[FailedRuns]:
    """The failures of nodes and clauses that have results on both sides, and failed in some of the runs.

    What failed in no run, or in all, has the p-value 1 for every division of its runs, so there is nothing to correct
    for (Tarone, *Biometrics* 46, 1990).

    Args:
        rows: the answer to `questions.FAILURES`.
    """
    of_keys = grouped((Key(row["requirement"], row["clause"], row["node"]), row) for row in rows)
    alike: dict[object, list[Key]] = {}
    # Of several nodes the last one of the tree leads: it is inside of the others.
    for key in sorted(of_keys, key=lambda key: (bool(key.requirement), -max(row["uid"] for row in of_keys[key]))):
        runs = [(row["stratum"], row["side"], row["number"], row["failed"], row["alike"]) for row in of_keys[key]]
        failed, number = sum(run[3] for run in runs), sum(run[2] for run in runs)
        if {run[1] for run in runs} == {*sides} and 0 < failed < number:
            alike.setdefault(tuple(runs), []).append(key)
    return [FailedRuns(keys[0], _strata(of_keys[keys[0]], sides), tuple(keys[1:])) for keys in alike.values()]


def rest(rows: Iterable[Mapping[str, Any]], place: int, parts: set[int], sides: tuple[str, str]) -> list[Failures]:
    """The failures of one of some nodes and clauses, in runs in which none of its parts failed.

    Args:
        rows: the answer to `questions.FAILED_TOGETHER`.
        place, parts: which they are there.
    """
    unexplained = []
    for row in rows:
        if place in row["had"]:
            failed = {*(row["failed"] or ())}
            unexplained.append({**row, "failed": row["number"] if place in failed and not parts & failed else 0})
    return _strata(unexplained, sides)


def totals(strata: Sequence[Failures]) -> Failures:
    """The failures of all strata."""
    before, after = ([sum(numbers) for numbers in zip(*side, strict=True)] for side in zip(*strata, strict=True))
    return (before[0], before[1]), (after[0], after[1])


def difference(strata: Sequence[Failures]) -> float:
    """By how much the share of failed runs of the second side is larger."""
    (failed, before), (other, after) = totals(strata)
    return other / after - failed / before


def _strata(rows: Iterable[Mapping[str, Any]], sides: tuple[str, str]) -> list[Failures]:
    """The numbers of each stratum; rows of one side and stratum are added up."""
    strata: dict[str, dict[str, tuple[int, int]]] = {}
    for row in rows:
        by_side = strata.setdefault(row["stratum"], dict.fromkeys(sides, (0, 0)))
        failed, number = by_side[row["side"]]
        by_side[row["side"]] = failed + row["failed"], number + row["number"]
    return [(by_side[sides[0]], by_side[sides[1]]) for by_side in strata.values()]
