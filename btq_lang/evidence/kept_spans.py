"""Judges `keeps φ from e until f` and `never φ from e until f` over a run: in each span from an e until the next f or
the end of the run, inside the activations of its node.

One invariant: a span begins when a condition becomes true, or just after what a node does, and does not have its end.
Where it is unknown whether a span has begun, or has ended,
only what holds in both cases is known.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.model import UNKNOWN_END, Activation, Moment
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.over_run import Happening, OverRun, is_never_at_once
from btq_lang.evidence.signals import UnknownValue
from btq_lang.evidence.verbs import OUT, Judgement, keeps
from btq_lang.evidence.wording import duration
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.requirements.model import ResolvedClaim, ResolvedSpan


class KeptTime(Record):
    """A time in which something has to be kept.

    Attributes:
        begin: None: it may not have begun at all.
        maybe_from: from then on it may have lasted.
        end: the moment before its end; None: the run ended before.
        sure_until: from the next moment on it may have ended; None: it had not.
        why: why that is unknown; empty if nothing is.
    """

    begin: Moment | None
    maybe_from: Moment
    end: Moment | None = None
    sure_until: Moment | None = None
    why: str = ""


def kept_in_spans(claim: ResolvedClaim, run: OverRun) -> Iterator[Judgement | None]:
    """The judgement of each span inside each activation."""
    spans = _spans(run)
    for activation in run.own:
        is_stopped = any(stopped.ended == activation.ended for stopped in run.stopped)
        for span in spans:
            judgement, reaches_end = _kept(claim, run, activation, span)
            if is_stopped and reaches_end:
                is_stopped = False
                judgement = _stopped(activation)
            yield judgement
        if is_stopped:
            yield _stopped(activation)


def broken_spans(claim: ResolvedClaim, run: OverRun, since: Moment) -> Iterator[Judgement]:
    """The violations in an open run that stay such, whatever comes later, in spans that were open after a moment."""
    is_end_seen = ends_by_row(run.span)
    spans = [span for span in _spans(run) if (is_end_seen if span.end is None else span.end > since)]
    for activation in run.own:
        for span in spans if activation.ended > since else ():
            judgement, _ = _kept(claim, run, activation, span)
            if judgement is not None and judgement.holds is False:
                yield judgement


def ends_by_row(span: ResolvedSpan | None) -> bool:
    """Whether a span ends only when a row says so; a node may have started, or been halted, before its next row."""
    assert span is not None, "it holds from an event until another one"
    return all(atom.happening not in _SEEN_LATER for atom in span.last.atoms)


def _stopped(activation: Activation) -> Judgement:
    sentence = f"stopped by its own guard after {duration(activation.seconds)}"
    return Judgement(False, activation.end, sentence, since=activation.begin)


def _spans(run: OverRun) -> list[KeptTime]:
    """The spans of a run, in order."""
    assert run.span is not None, "it holds from an event until another one"
    first, last = run.span.first, run.span.last
    is_by_row = first.condition is None and last.condition is None
    firsts = run.happenings(first, is_by_row=is_by_row)
    lasts = run.happenings(last, is_by_row=is_by_row)
    is_empty_at_once = not is_never_at_once(first, last)
    spans: list[KeptTime] = []
    span: KeptTime | None = None
    for moment, event, is_first, is_certain in _changes(firsts, lasts):
        if is_first:
            if is_empty_at_once and any(each.is_certain and not each.why and each.first == moment for each in lasts):
                continue
            if is_certain and (span is None or span.begin is None or span.sure_until is not None):
                begin = (event.read[0], event.read[1] + 1) if event.uid else event.read
                early = span.maybe_from if span is not None and span.begin is None else begin
                why = span.why if span is not None and span.begin is None else ""
                if span is not None and span.begin is not None:
                    spans.append(replace(span, end=_just_before(begin)))
                span = KeptTime(begin, early, why=why)
                unclear = _around(lasts, moment)
                if unclear is not None:
                    span = replace(span, sure_until=_just_before(begin), why=unclear.why)
            elif not is_certain and span is None:
                span = KeptTime(None, event.at, why=event.why)
        elif is_certain and span is not None:
            spans.append(replace(span, end=_just_before(event.read)))
            unclear = _around(firsts, moment)
            span = KeptTime(None, event.read, why=unclear.why) if unclear is not None else None
        elif span is not None and span.begin is not None and span.sure_until is None:
            span = replace(span, sure_until=_just_before(event.at), why=event.why)
    return [*spans, span] if span is not None else spans


def _changes(firsts: Sequence[Happening], lasts: Sequence[Happening]) -> list[tuple[Moment, Happening, bool, bool]]:
    """The moments at which a span begins or ends, or may do so, in order; of one moment, ends come first.

    What happens at an unknown time may do so from its earliest on, and has by its latest, unless the order of a begin
    and an end is unknown.
    """
    changes: list[tuple[Moment, Happening, bool, bool]] = []
    for is_first, events, others in ((False, lasts, firsts), (True, firsts, lasts)):
        for event in events:
            if event.why:
                changes.append((event.at, event, is_first, False))
            if event.is_certain and not (event.why and any(_may_be_at_once(event, other) for other in others)):
                changes.append((event.until if event.why else event.first, event, is_first, True))
    return sorted(changes, key=lambda change: change[0])


def _may_be_at_once(event: Happening, other: Happening) -> bool:
    return event.at <= other.until and other.at <= event.until


def _around(events: Sequence[Happening], moment: Moment) -> Happening | None:
    """What may happen after a moment, if it has not happened before."""
    return next((event for event in events if event.why and event.at <= moment < event.until), None)


def _kept(claim: ResolvedClaim, run: OverRun, activation: Activation, span: KeptTime) -> tuple[Judgement | None, bool]:
    """The judgement of a span inside an activation, `OUT` if there is none, None if the log cuts it off; and whether
    the span lasts until the end of the activation."""
    begun, ended = activation.begun(run.observed.is_early), activation.ended
    until = ended if span.end is None else min(span.end, ended)
    whole = max(span.maybe_from, begun), until
    sure_until = until if span.sure_until is None else min(span.sure_until, until)
    if whole[0] > whole[1]:
        return OUT, False
    reaches_end = until == ended
    if span.begin is None or max(span.begin, begun) > sure_until:
        return Judgement(None, until[0], span.why), reaches_end
    sure = max(span.begin, begun), sure_until
    if activation.timing == "latest" and sure[0] > (begun[0], begun[1] + 1):
        return Judgement(None, until[0], UNKNOWN_END), reaches_end
    counts = run.counts(*sure)
    if counts is False:
        return OUT, reaches_end
    judgement = _keeps(claim, run, activation, sure)
    if whole != sure or activation.timing != "exact":
        run.unsettled.append(sure[0])
    if whole != sure:
        wider = _keeps(claim, run, activation, whole)
        if wider.holds is not judgement.holds:
            judgement = Judgement(None, until[0], span.why)
    if judgement.holds is not False:
        judgement = judgement._replace(at=until[0])
    if judgement.holds and activation.outcome == "O" and reaches_end:
        return None, reaches_end
    if isinstance(counts, UnknownValue):
        judgement = Judgement(None, judgement.at, counts.why)
    return judgement._replace(since=sure[0][0]), reaches_end


def _keeps(claim: ResolvedClaim, run: OverRun, activation: Activation, time: tuple[Moment, Moment]) -> Judgement:
    observed = run.observed
    is_end_known = activation.timing != "latest"
    of_time = Observed(observed.signals, observed.nodes, *time, is_end_known, is_early=observed.is_early)
    part = Activation(activation.uid, *time, activation.outcome, activation.timing)
    return keeps(claim, part, of_time)


def _just_before(moment: Moment) -> Moment:
    """The last moment before another one."""
    return (moment[0], moment[1] - 1) if moment[1] else (moment[0] - 1, _LAST)


_SEEN_LATER: Final = ("starts", "halts")
_LAST: Final = 1 << 62  # after all rows of a time
