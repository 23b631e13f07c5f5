"""`ends within d after ev`: how soon a node that is active when an event happens ends."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.model import UNKNOWN_END
from btq_lang.evidence.over_run import Happening, OverRun
from btq_lang.evidence.verbs import Judgement
from btq_lang.evidence.verbs.starts import judged

if TYPE_CHECKING:
    from btq_lang.requirements.model import Claim


def judge_run(claim: Claim, run: OverRun) -> Iterator[Judgement | None]:
    """Judge, for each event that happens while the node is active, whether it ends in time."""
    assert claim.event is not None, "the clause names one"
    moments = [each.started for each in run.own]
    for event in run.happenings(claim.event):
        index = bisect_right(moments, event.at) - 1
        if index < 0 or run.own[index].ended < event.at:
            continue
        ended = run.own[index]
        answer = None
        if ended.outcome != "O":
            answer = Happening(ended.ended, ended.ended, UNKNOWN_END if ended.timing == "latest" else "")
        yield from judged(claim, run, event, answer, VERBS["ends"].said, "had not ended after {}")
