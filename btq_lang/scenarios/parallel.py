"""Runs scenarios one after the other, or in several processes; the order of the results is that of the scenarios."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.scenarios.results import ScenarioResult
from btq_lang.scenarios.suite import ScenarioPlace, Suite
from btq_lang.util.processes import pool

_CHUNK = 8  # scenarios sent to a process at a time


def results(
    suites: Sequence[Suite], wanted: Sequence[tuple[int, ScenarioPlace]], is_drawn: bool, jobs: int
) -> Iterator[ScenarioResult]:
    """The results of scenarios, in order.

    Args:
        wanted: each scenario with the index of its suite.
        is_drawn: all runs are drawn.
        jobs: how many processes.
    """
    if jobs > 1 and len(wanted) > 1:
        try:
            processes = pool(min(jobs, len(wanted)), _begin, (suites, is_drawn))
        except NotImplementedError:  # there are no processes in a browser
            pass
        else:
            with processes:
                yield from processes.map(_result, wanted, chunksize=_CHUNK)
            return
    yield from (suites[index].result(place, is_drawn) for index, place in wanted)


def _begin(suites: Sequence[Suite], is_drawn: bool) -> None:
    global _suites, _is_drawn
    _suites, _is_drawn = suites, is_drawn


def _result(wanted: tuple[int, ScenarioPlace]) -> ScenarioResult:
    index, place = wanted
    return _suites[index].result(place, _is_drawn)


_suites: Sequence[Suite] = ()
_is_drawn = False
