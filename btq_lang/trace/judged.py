"""The runs by which requirements are judged."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from btq_lang.evidence.wording import timestamp
from btq_lang.trace.overview import JudgedRuns

if TYPE_CHECKING:
    from btq_lang.evidence.json_document import WrittenSource
    from btq_lang.evidence.verdicts import EvidenceFile


def judged_runs(sources: Iterable[EvidenceFile | WrittenSource]) -> Iterator[JudgedRuns]:
    """The runs of each log."""
    for source in sources:
        end = timestamp(source.end) if isinstance(source.end, int) else source.end or ""
        yield JudgedRuns(source.runs, end.partition("T")[0] if "T" in end else "")


def together(runs: Iterable[JudgedRuns]) -> JudgedRuns:
    """The runs of several logs."""
    parts = list(runs)
    return JudgedRuns(sum(part.runs for part in parts), max((part.last for part in parts), default=""))
