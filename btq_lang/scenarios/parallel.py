"""Work for each of many scenarios, one after the other or in several processes; results keep the order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from btq_lang.scenarios.results import ScenarioResult
from btq_lang.scenarios.suite import ScenarioPlace, Suite
from btq_lang.util.processes import pool

T = TypeVar("T")
R = TypeVar("R")
_CHUNK = 8  # pieces of work sent to a process at a time


def results(
    suites: Sequence[Suite], work: Callable[[Sequence[Suite], T], R], of: Sequence[T], jobs: int
) -> Iterator[R]:
    """The results of a piece of work for each of some things, in order.

    Args:
        work: a function of a module, or a partial one.
        jobs: how many processes.
    """
    if jobs > 1 and len(of) > 1:
        try:
            processes = pool(min(jobs, len(of)), _begin, (suites, work))
        except NotImplementedError:  # there are no processes in a browser
            pass
        else:
            with processes:
                yield from processes.map(_result, of, chunksize=_CHUNK)
            return
    yield from (work(suites, each) for each in of)


def result_of(is_drawn: bool, suites: Sequence[Suite], wanted: tuple[int, ScenarioPlace]) -> ScenarioResult:
    """Run a scenario; `wanted`: the index of its suite, and its place."""
    return suites[wanted[0]].result(wanted[1], is_drawn)


def _begin(suites: Sequence[Suite], work: Callable[[Sequence[Suite], Any], Any]) -> None:
    global _suites, _work
    _suites, _work = suites, work


def _result(of: object) -> Any:
    assert _work is not None, "the process has begun"
    return _work(_suites, of)


_suites: Sequence[Suite] = ()
_work: Callable[[Sequence[Suite], Any], Any] | None = None
