"""What each node did, as rows of texts: the report on a log without requirements to judge."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from btq_lang.evidence.wording import duration
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import NodeSummary


class Column(Record):
    """A column: of each node a number, durations in seconds, None where there is nothing to say, and that as a text."""

    head: str
    values: tuple[float | None, ...]
    texts: tuple[str, ...]


def node_columns(nodes: Sequence[NodeSummary]) -> Sequence[Column]:
    """The columns beside the nodes' paths; the seldom ones only if a node has a number there."""
    columns = [
        _counts("starts", nodes, lambda node: node.succeeded + node.failed + node.halted + node.interrupted),
        _counts("succeeded", nodes, lambda node: node.succeeded),
        _counts("failed", nodes, lambda node: node.failed),
        _counts("halted", nodes, lambda node: node.halted),
    ]
    if any(node.interrupted for node in nodes):
        columns.append(_counts("interrupted", nodes, lambda node: node.interrupted))
    columns += [_times("p50", nodes, lambda node: node.p50), _times("p95", nodes, lambda node: node.p95)]
    if any(node.bounded for node in nodes):
        longest = tuple(node.longest if node.bounded else None for node in nodes)
        columns.append(Column("not exact", longest, tuple(map(_bounded, nodes))))
    ticks = (
        _times("tick p95", nodes, lambda node: node.tick_p95),
        _times("tick max", nodes, lambda node: node.tick_worst),
    )
    return [*columns, *ticks]


def node_rows(nodes: Sequence[NodeSummary]) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """The heads of the columns, and a row for each node; all but the first column are numbers."""
    columns = node_columns(nodes)
    paths = tuple(node.path for node in nodes)
    rows = zip(paths, *(column.texts for column in columns), strict=True)
    return ["node", *(column.head for column in columns)], [[*row] for row in rows]


def _counts(head: str, nodes: Sequence[NodeSummary], value: Callable[[NodeSummary], int]) -> Column:
    numbers = tuple(map(value, nodes))
    return Column(head, numbers, tuple(map(str, numbers)))


def _times(head: str, nodes: Sequence[NodeSummary], value: Callable[[NodeSummary], float | None]) -> Column:
    times = tuple(map(value, nodes))
    return Column(head, times, tuple("" if time is None else duration(time) for time in times))


def _bounded(node: NodeSummary) -> str:
    """How many durations have only a known upper limit, and that limit."""
    if not node.bounded:
        return ""
    return f"{node.bounded}, at most {duration(node.longest)}" if node.longest is not None else str(node.bounded)
