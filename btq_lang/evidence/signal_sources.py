"""The sources of samples that a project declares, checked against the signals of missions."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from btq_lang.catalog.units import a_dimension
from btq_lang.evidence.readers.samples import NoSamples, read_sources
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.model import Series
    from btq_lang.requirements.model import Signal
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.project_evidence import SignalSource


def signal_sources(
    project: Project, file: str, missions: Sequence[Candidate], problems: list[str]
) -> tuple[Sequence[SignalSource], dict[str, Series]]:
    """The sources in `[evidence.signals]` of the missions' project, and the samples of those that are files.

    Args:
        file: of the project, as people read it.
        problems: errors are appended.
    """
    if project.evidence is None:
        return (), {}
    sources = project.evidence.signals
    wrong = [problem for source in sources for problem in _wrong(source, missions)]
    problems += [f"{file}: [evidence.signals]: {each}" for each in dict.fromkeys(wrong)]
    try:
        return sources, {} if wrong else read_sources(sources, project.root)
    except NoSamples as error:
        problems.append(str(error))
    except OSError as error:
        problems.append(f"{shown(os.fsdecode(error.filename))}: cannot be read: {error.strerror or error}")
    return sources, {}


def _wrong(source: SignalSource, missions: Sequence[Candidate]) -> Iterator[str]:
    """The errors of a source, given the missions' signals."""
    name = source.signal
    signals = [mission.requirements.signals for mission in missions]
    for each in signals:
        if name in each:
            yield from _wrong_for(source, each[name])
    known = {signal for each in signals for signal in each}
    if known and name not in known and (meant := near(name, known, 1)):
        yield f"no mission has a signal `{name}`{did_you_mean(meant)}"


def _wrong_for(source: SignalSource, signal: Signal) -> Iterator[str]:
    if signal.sort != "number":
        if source.unit is not None or source.scale != 1 or source.offset != 0:
            yield f"`{signal.name}` is a {signal.sort}, so it takes no unit, scale or offset"
    elif source.unit is not None and signal.unit is not None and source.unit.dimension != signal.unit.dimension:
        yield (
            f"`{signal.name}` is in {signal.unit.symbol}, which is {a_dimension(signal.unit)}, and its source in"
            f" {source.unit.symbol}, which is {a_dimension(source.unit)}"
        )
