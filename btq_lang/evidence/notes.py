"""Notes printed beside the verdicts of a report."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.evidence.wording import period
from btq_lang.syntax.tree import Signal
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import counted
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.model import SampleSeries
    from btq_lang.evidence.verdicts import VerdictReport


def ignored_columns(path: str, samples: Iterable[str], missions: Sequence[Candidate]) -> Iterator[str]:
    """Reports columns that no mission reads, each with likely intended names."""
    scopes = [mission.workspace.scope(mission.path) for mission in missions]
    entries = [entry for scope in scopes for name in scope.names(Kind.SIGNAL) for entry in scope.all(Kind.SIGNAL, name)]
    signals = [entry.symbol.target for entry in entries if isinstance(entry.symbol.target, Signal)]
    words = [word for signal in signals for word in (signal.name, signal.source) if word is not None]
    read_names = {word.text.strip("{} ").removeprefix("@") for word in words}
    for name in samples:
        if name not in read_names:
            meant = did_you_mean(near(name, read_names))
            yield f"{path}: column `{name}` is ignored, because no signal or entry has this name{meant}"


def other_times(read_from: Iterable[tuple[str, SampleSeries]], report: VerdictReport) -> Iterator[str]:
    """Reports files whose samples are long before or after all runs, as when their times are not seconds since the
    epoch.

    A single sample is exempt: it may be a constant.
    """
    times: dict[str, set[int]] = {}
    for file, series in read_from:
        times.setdefault(file, set()).update(series.times)
    sources = [source for mission in report.missions for source in mission.sources]
    begin = min((source.begin for source in sources if source.begin is not None), default=None)
    end = max((source.end for source in sources if source.end is not None), default=None)
    for file, sample_times in times.items():
        if begin is None or end is None or len(sample_times) < 2:
            continue
        if max(sample_times) < begin - _NEAR or min(sample_times) > end + _NEAR:
            yield (
                f"{file}: its samples are from {period(min(sample_times), max(sample_times))}, and the runs from"
                f" {period(begin, end)}; expected times in seconds since the epoch"
            )


def missions_with_errors(report: VerdictReport, missions: Sequence[Candidate]) -> Iterator[str]:
    """Reports missions with errors, whose clauses may be missing."""
    judged = {mission.file for mission in report.missions}
    for mission in missions:
        if mission.path in judged:
            workspace = mission.workspace
            files = workspace.closure(mission.path)
            diagnostics = (diagnostic for file in files for diagnostic in check(workspace, file))
            if any(diagnostic.effective_severity is Severity.ERROR for diagnostic in diagnostics):
                yield f"{shown(mission.path)} has errors, so clauses may be missing; run btq check"


def missing_verdicts(report: VerdictReport, requested: Sequence[str]) -> Iterator[str]:
    """Explains why there are no verdicts at all; `requested`: the missions on the command line."""
    if not report.missions and not report.problems:
        unlike = [foreign for foreign in report.foreign if foreign.difference]
        differences = dict.fromkeys(foreign.difference for foreign in unlike if requested)
        if differences:
            yield from (f"no log matches {', '.join(requested)}: {difference}" for difference in differences)
        else:
            log = unlike[0].file if unlike else ""
            instead = f"; btq import {log} writes its tree as one" if log else ""
            yield f"no log matches a known mission; name the mission with --mission FILE{instead}"
    elif report.missions and not any(mission.runs for mission in report.missions):
        yield "no run in any log, so there is nothing to judge"


def foreign_runs(report: VerdictReport) -> Iterator[str]:
    """Reports runs that belong to other missions."""
    for foreign in report.foreign:
        yield f"{foreign.file}: {counted(foreign.runs, 'run')} {foreign.of}, not judged"


_NEAR: Final = 60_000_000  # µs: a robot may log a minute before its tree starts, or after it has ended
