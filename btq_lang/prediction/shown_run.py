"""A run of a prediction as one of a scenario is, to be drawn, or written as a log or as a scenario."""

from __future__ import annotations

from btq_lang.evidence.model import ROOT, SampleSeries
from btq_lang.evidence.runs import activations
from btq_lang.prediction.prepared import PreparedMission
from btq_lang.prediction.runs import DrawnRun
from btq_lang.scenarios.recording import RecordedRun
from btq_lang.scenarios.running import START, ScenarioRun


def shown_run(prepared: PreparedMission, run: DrawnRun) -> ScenarioRun:
    """A run as one of a scenario is; `prepared`: with all rows."""
    rows = [(START + time * 1000, uid, status) for time, uid, status in run.rows]
    series = _series(run)
    keys = {name: signal.entry for name, signal in prepared.mission.requirements.signals.items()}
    signals = {name: each for name, each in series.items() if not keys.get(name)}
    entries = {keys[name]: each for name, each in series.items() if keys.get(name)}
    assumed = tuple(sorted(each.path for each in prepared.sources if each.source == "ASSUMED"))
    return ScenarioRun(run.end, run.why, run.now, rows, (), signals, entries, assumed, frozenset())


def recorded_run(prepared: PreparedMission, run: DrawnRun) -> RecordedRun:
    """A run as one of a log is; `prepared`: with all rows."""
    shown = shown_run(prepared, run)
    mission = prepared.mission
    in_order = [*activations(shown.session(mission))]
    first = next(place for place, each in enumerate(in_order) if each.uid == ROOT)
    return RecordedRun(mission.joined, in_order[: first + 1], _series(run), shown.rows)


def _series(run: DrawnRun) -> dict[str, SampleSeries]:
    series: dict[str, SampleSeries] = {}
    for name, samples in run.samples.items():
        series[name] = SampleSeries()
        for time, value in samples:
            series[name].add(START + time, value)
    return series


def signals_csv(prepared: PreparedMission, run: DrawnRun) -> str:
    """The samples of signals as `--signals` reads them: a line for each time at which there is one."""
    series = {name: each for name, each in _series(run).items() if each.times}
    times = sorted({time for each in series.values() for time in each.times})
    rows = [",".join(("t", *series))]
    for time in times:
        values = (each.at(time) for each in series.values())
        cells = ["" if value is None or value[1] is None else f"{value[1]}" for value in values]
        rows.append(",".join((f"{time / 1e6:.6f}", *cells)))
    return "\n".join(rows) + "\n" if series else ""
