"""`follows ev`: an event between each start of a node and the start before it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement

if TYPE_CHECKING:
    from btq_lang.evidence.over_run import OverRun
    from btq_lang.requirements.model import Claim


def judge_run(claim: Claim, run: OverRun) -> Iterator[Judgement | None]:
    """Judge, for each start, whether the event has happened in the run since the previous start."""
    assert claim.event is not None, "the clause names one"
    events = run.happenings(claim.event)
    name = claim.text.partition(" follows ")[2]
    before = (run.root.begin, -1)  # the beginning of the run
    for start in run.own:
        found = [each for each in events if each.until > before and each.at <= start.started]
        is_sure = any(each.is_certain and before < each.at and each.until <= start.started for each in found)
        since = "since its last start" if before[1] >= 0 else "before it in the run"
        before = start.started
        counts = run.counts_one(start)
        if counts is False:
            continue
        unclear = counts.why if isinstance(counts, Unknown) else found[0].why if found and not is_sure else ""
        if is_sure and start.outcome == "O":
            yield None
        elif unclear:
            yield Judgement(None, start.begin, unclear)
        else:
            sentence = f"followed `{name}`" if is_sure else f"`{name}` did not happen {since}"
            yield Judgement(is_sure, start.begin, VERBS["follows"].said.replace("{}", sentence))
