"""What each node did, as rows of texts: the report on a log of which no requirement is judged."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.evidence.wording import duration

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import NodeSummary


def node_rows(nodes: Sequence[NodeSummary]) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """The heads of the columns, and a row for each node; all but the first column are numbers."""
    heads = ["node", "starts", "succeeded", "failed", "halted"]
    has_open = any(node.interrupted for node in nodes)
    heads += ["interrupted"] if has_open else []
    has_bounded = any(node.bounded for node in nodes)
    rows = []
    for node in nodes:
        ended = [node.succeeded, node.failed, node.halted]
        counts = [sum(ended) + node.interrupted, *ended, *([node.interrupted] if has_open else [])]
        p50, p95, *ticks = ("" if each is None else duration(each) for each in _times(node))
        bounded = [_bounded(node)] if has_bounded else []
        rows.append([node.path, *map(str, counts), p50, p95, *bounded, *ticks])
    return [*heads, "p50", "p95", *(["not exact"] if has_bounded else []), "tick p95", "tick max"], rows


def _times(node: NodeSummary) -> Sequence[float | None]:
    return node.p50, node.p95, node.tick_p95, node.tick_worst


def _bounded(node: NodeSummary) -> str:
    """How many durations are known only to lie below a limit, and that limit."""
    if not node.bounded:
        return ""
    return f"{node.bounded}, at most {duration(node.longest)}" if node.longest is not None else str(node.bounded)
