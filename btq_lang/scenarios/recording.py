"""A run of a log as a scenario: what its leaves did, in order, what conditions answered, and how signals went.

One invariant: only what the log shows is given; a script that reads an entry which it does not hold makes the scenario
unknown.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby, pairwise
from typing import Final

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.evidence.identity import Joined
from btq_lang.evidence.model import Activation, Outcome, SampleSeries, SampleValue
from btq_lang.requirements.model import ResolvedSignal
from btq_lang.syntax.tree import quote, written
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record


class RecordedRun(Record):
    """A run of a log.

    Attributes:
        activations: all of it, as they ended; that of the root is the last.
        samples: by signal.
    """

    joined: Joined
    activations: Sequence[Activation]
    samples: Mapping[str, SampleSeries]

    @property
    def root(self) -> Activation:
        """The activation of its root."""
        return self.activations[-1]


def as_scenario(run: RecordedRun, title: str, include: str, verdicts: Iterable[tuple[str, str]]) -> str:
    """A file with a scenario in which the nodes do what they did in a run.

    Args:
        include: the path of the mission, seen from the file.
        verdicts: the requirements that the scenario is about, each with its verdict in the run.
    """
    verdicts = tuple(verdicts)
    verifies = f" verifies {', '.join(written(name) for name, _ in verdicts)}" if verdicts else ""
    tree = "" if run.joined.build.is_main else f" of {written(run.joined.build.name)}"
    steps = [
        *_leaves(run),
        *_signals(run),
        *([] if run.root.outcome in "SF" else [f"when {_time(run, run.root.end)} have passed : mission halts"]),
        *([f"expect {_ENDS[run.root.outcome]}"] if run.root.outcome in _ENDS else []),
        *(f"expect {written(name)} {verdict}" for name, verdict in verdicts),
    ]
    lines = "\n".join(f"    {step}" for step in steps)
    built = run.joined.build.how
    note = "# The log is of a build without guards, which btq test --no-enforce runs.\n" if _BARE in built else ""
    return f"{note}include {quote(include)}\n\nscenario {quote(title)}{tree}{verifies}\n{lines}\n"


# ---- what leaves did ----


def _leaves(run: RecordedRun) -> Iterator[str]:
    """What is given of each custom leaf: the activations of all nodes of an ID count together."""
    nodes = run.joined.mission.requirements.nodes.all
    leaves = {
        uid: nodes[index]
        for uid, index in run.joined.written().items()
        if uid in run.joined.tree.leaves and nodes[index].kind is None
    }
    started = sorted(run.activations, key=lambda activation: activation.started)
    by_id = grouped((_id_of(run, each.uid), each) for each in started if each.uid in leaves)
    conditions = {_id_of(run, uid) for uid, node in leaves.items() if node.category == "Condition"}
    for name, activations in by_id.items():
        if name not in conditions:
            yield f"given every {written(name)} {_behaviors(activations)}"
        elif _is_polled(activations) or any(_is_asked_again(run, activation.uid) for activation in activations):
            yield from _answers_by_time(run, name, activations)
        else:
            answers = ", ".join(_answer(activation) for activation in activations)
            yield f"given every {written(name)} answers {answers}"


def _id_of(run: RecordedRun, uid: int) -> str:
    return run.joined.tree.nodes[uid].kind


def _behaviors(activations: Sequence[Activation]) -> str:
    """Results and durations, one activation after the other; equal ones once, with their number."""
    groups = [(behavior, len([*equal])) for behavior, equal in groupby(map(_behavior, activations))]
    *counted, last = groups
    texts = [f"{behavior} {number} times" if number > 1 else behavior for behavior, number in counted]
    return ", then ".join([*texts, last[0]])


def _behavior(activation: Activation) -> str:
    if activation.outcome not in _RESULTS:
        return "does not end"
    took = round((activation.end - activation.begin) / _TICK) * _TICK
    return f"{_RESULTS[activation.outcome]} after {_seconds(took)}" if took else _RESULTS[activation.outcome]


def _is_asked_again(run: RecordedRun, uid: int) -> bool:
    """Whether a condition is asked at every tick, as a child of a reactive node, perhaps through decorators."""
    kinds = (BUILTINS.get(run.joined.tree.nodes[above].kind) for above in run.joined.tree.above(uid))
    control = next((kind for kind in kinds if kind is not None and kind.children != (1, 1)), None)
    return control is not None and control.reactive


def _is_polled(activations: Sequence[Activation]) -> bool:
    """Whether a condition is asked tick after tick, so that the number of answers says less than their times."""
    return any(after.begin - before.end <= _POLLED for before, after in pairwise(activations))


def _answers_by_time(run: RecordedRun, name: str, activations: Sequence[Activation]) -> Iterator[str]:
    answers = [(activation.end, _answer(activation)) for activation in activations]
    yield f"given every {written(name)} answers {answers[0][1]}"
    for (_, before), (time, answer) in pairwise(answers):
        if answer != before:
            yield f"when {_time(run, time)} have passed : every {written(name)} answers {answer}"


def _answer(activation: Activation) -> str:
    return "true" if activation.outcome == "S" else "false"


# ---- how signals went ----


def _signals(run: RecordedRun) -> Iterator[str]:
    """The value of each signal at the start of the run, and its changes."""
    for name, signal in run.joined.mission.requirements.signals.items():
        series = run.samples.get(name)
        if series is None:
            continue
        last = series.at(run.root.begin)
        if last is not None and last[1] is not None:
            yield f"given {written(name)} = {_value(signal, series, last[1])}"
        for time in series.between(run.root.begin, run.root.end):
            sample = series.at(time)
            if sample is not None and sample[1] is not None and (last is None or sample[1] != last[1]):
                yield f"when {_time(run, time)} have passed : {written(name)} = {_value(signal, series, sample[1])}"
            last = sample


def _value(signal: ResolvedSignal, series: SampleSeries, value: SampleValue) -> str:
    if signal.sort == "text":
        return quote(str(value))
    if signal.sort == "bool":
        return "true" if value in (True, "true", "1") else "false"
    unit = series.unit or signal.unit
    number = f"{value:.10g}" if not isinstance(value, str) else value
    return number if unit is None or unit.symbol == "1" else f"{number} {unit.symbol}"


def _time(run: RecordedRun, time: int) -> str:
    """A time since the start of the run."""
    return _seconds(time - run.root.begin)


def _seconds(microseconds: int) -> str:
    return f"{microseconds / 1e6:.3f}".rstrip("0").rstrip(".") + " s"


_RESULTS: Final[dict[Outcome, str]] = {"S": "succeeds", "F": "fails"}
_ENDS: Final[dict[Outcome, str]] = {"S": "mission succeeds", "F": "mission fails at least 1 per run"}
_BARE: Final = "--no-enforce"
_TICK: Final = 10_000  # µs between two ticks of the program
_POLLED: Final = 5 * _TICK
