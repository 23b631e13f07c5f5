"""What is predicted in words, which all writers share."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.evidence.identity import without_number
from btq_lang.evidence.wording import duration, share
from btq_lang.prediction.report import PredictedClause, PredictedRequirement, Prediction
from btq_lang.util.text import counted
from btq_lang.workspace.loader import shown


def heading(prediction: Prediction) -> str:
    """What ran, how often, and who says what its skills do."""
    built = "as built" if prediction.is_enforced else "without guards"
    runs = number_of(prediction.runs)
    if prediction.runs < prediction.wanted:
        runs += f" of {number_of(prediction.wanted)}"
    kinds = [each.source for each in prediction.sources]
    sources = []
    for source in ("measured", "declared", "ASSUMED"):
        if number := kinds.count(source):
            note = ", ".join(filter(None, (prediction.label, counted(prediction.measured, "run"))))
            sources.append(f"{number} {source}{f' ({note})' if source == 'measured' else ''}")
    skills = f" of {counted(len(kinds), 'skill')}: {', '.join(sources)}" if kinds else ""
    return f"{shown(prediction.file)} {built} for {prediction.engine}, {runs} runs from seed {prediction.seed}{skills}"


def result(clause: PredictedClause, requirement: str, runs: int) -> str:
    """The numbers of a clause, and a run to look at."""
    if clause.word == "unknown":
        return clause.why or "unknown"
    if clause.word == "never run":
        name = clause.of or without_number(clause.path).rpartition("/")[2]
        return f"{name} ran in 0 of {number_of(runs)} runs" if name else clause.why
    parts: list[str] = []
    if clause.pooled:
        parts.append(clause.pooled)
    elif clause.interval is not None and clause.share is not None:
        parts.append(f"{share(clause.share)} ({_between(*clause.interval)})")
    else:
        parts.append(f"{number_of(clause.held)} of {number_of(clause.counted)} {clause.unit}")
    if clause.worst and clause.interval is None and not clause.pooled:
        parts.append(f"worst {clause.worst}")
    if clause.unknown:
        parts.append(f"{number_of(clause.unknown)} unknown ({clause.why})")
    text = ", ".join(parts)
    if clause.worst_run is not None and (clause.worst or clause.word == "will miss"):
        show = f": --show {requirement}" if clause.held < clause.counted else ""
        text += f" (run {number_of(clause.worst_run)}{show})"
    return text


def cause(clause: PredictedClause) -> str:
    """The main cause of misses; empty without one."""
    if clause.cause is None:
        return ""
    of = f"{number_of(clause.cause.looked)} misses" if clause.cause.looked > 1 else "1 miss"
    return f"mostly {clause.cause.text} ({share(clause.cause.share)} of {of})"


def clause_text(clause: PredictedClause, requirement: PredictedRequirement) -> str:
    """The clause, with its node if the requirement has the same clause at another one."""
    is_lone = sum(other.text == clause.text for other in requirement.clauses) == 1
    return clause.text if is_lone or not clause.path else f"{clause.text} at {clause.path}"


def summary(prediction: Prediction) -> Iterator[str]:
    """How runs end and how long they take, what was assumed and what was guessed, a line each."""
    ends = [
        f"{number_of(each.runs)} {_ENDS.get(each.end, each.end)}" + (f" ({each.why})" if each.why else "")
        for each in prediction.ends
    ]
    line = f"runs: {', '.join(ends) or 'none'}"
    if prediction.median is not None and prediction.p95 is not None:
        times = duration(prediction.median), duration(prediction.p95)
        line += f" · those that succeed take {times[0]}, and 95 % of them at most {times[1]}"
    yield line
    assumed = [without_number(each.path) for each in prediction.sources if each.source == "ASSUMED"]
    if assumed:
        yield f"ASSUMED to succeed at once: {', '.join(assumed)}"
    for path, number in prediction.guessed:
        yield f"guessed: {path} ran longer than it was ever measured in {counted(number, 'run')}"


def number_of(number: int) -> str:
    """A number with a blank before each three digits."""
    return f"{number:,}".replace(",", " ")


def _between(low: float, high: float) -> str:
    """Two shares in percent, with one unit."""
    return f"{share(low).removesuffix(' %')} to {share(high).removesuffix(' %')}"


_ENDS: Final = {
    "succeeds": "succeed",
    "fails": "fail",
    "is skipped": "are skipped",
    "does not end": "do not end",
    "throws": "end with an exception",
    "unknown": "are unknown",
}
