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
    rows = []
    for node in nodes:
        ended = [node.succeeded, node.failed, node.halted]
        counts = [sum(ended) + node.interrupted, *ended, *([node.interrupted] if has_open else [])]
        times = (node.p50, node.p95, node.tick_p95, node.tick_worst)
        rows.append([node.path, *map(str, counts), *("" if each is None else duration(each) for each in times)])
    return [*heads, "p50", "p95", "tick p95", "tick max"], rows
