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
from btq_lang.evidence.model import Activation, LogSession, Outcome, SampleSeries, SampleValue, Transition
from btq_lang.evidence.verdicts import VIOLATED
from btq_lang.requirements.model import ResolvedSignal
from btq_lang.scenarios.recorded_nodes import words_for
from btq_lang.syntax.tree import quote, written
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record


class RecordedRun(Record):
    """A run of a log.

    Attributes:
        activations: all of it, as they ended; that of the root is the last.
        samples: by signal.
        rows: each change of a status in it.
    """

    joined: Joined
    activations: Sequence[Activation]
    samples: Mapping[str, SampleSeries]
    rows: Sequence[Transition]

    @property
    def is_bare(self) -> bool:
        """Whether it is of a build without guards."""
        return _BARE in self.joined.build.how

    def session(self) -> LogSession:
        """The run as a log of its own."""
        return LogSession(self.joined.tree, iter(self.rows))

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
        *(f"expect {written(name)} {verdict}{_hint(name, verdict)}" for name, verdict in verdicts),
    ]
    lines = "\n".join(f"    {step}" for step in steps)
    note = "# The log is of a build without guards, which btq test --no-enforce runs.\n" if run.is_bare else ""
    return f"{note}include {quote(include)}\n\nscenario {quote(title)}{tree}{verifies}\n{lines}\n"


def _hint(name: str, verdict: str) -> str:
    return f"  # once this is mended: expect {written(name)}" if verdict == VIOLATED else ""


# ---- what leaves did ----


def _leaves(run: RecordedRun) -> Iterator[str]:
    """What is given of each custom leaf: of each node by itself, unless all of an ID did the same all the time."""
    nodes = run.joined.mission.requirements.nodes.all
    leaves = {
        uid: nodes[index]
        for uid, index in run.joined.written().items()
        if uid in run.joined.tree.leaves and nodes[index].kind is None
    }
    started = sorted(run.activations, key=lambda activation: activation.started)
    by_id = grouped((_id_of(run, each.uid), each) for each in started if each.uid in leaves)
    for name, activations in by_id.items():
        uids = [uid for uid in leaves if _id_of(run, uid) == name]
        of_id = f"every {written(name)}"
        told = _answers if leaves[uids[0]].category == "Condition" else _does
        by_node = grouped((activation.uid, activation) for activation in activations)
        if len(by_node) == len(uids) > 1 and len({_behavior(activation) for activation in activations}) == 1:
            yield from told(run, of_id, activations)
            continue
        words = {uid: words_for(run.joined, uid) for uid in by_node}
        if None in words.values():  # the lines below are more specific
            yield from told(run, of_id, activations)
        for uid, of_node in words.items():
            yield from told(run, of_node, by_node[uid]) if of_node is not None else ()


def _id_of(run: RecordedRun, uid: int) -> str:
    return run.joined.tree.nodes[uid].kind


def _does(run: RecordedRun, nodes: str, activations: Sequence[Activation]) -> Iterator[str]:
    """What an action does, one activation after the other; equal ones once, with their number."""
    groups = [(behavior, len([*equal])) for behavior, equal in groupby(map(_behavior, activations))]
    *counted, last = groups
    texts = [f"{behavior} {number} times" if number > 1 else behavior for behavior, number in counted]
    yield f"given {nodes} {', then '.join([*texts, last[0]])}"


def _behavior(activation: Activation) -> str:
    if activation.outcome not in _RESULTS:
        return "does not end"
    took = round((activation.end - activation.begin) / _TICK) * _TICK
    return f"{_RESULTS[activation.outcome]} after {_seconds(took)}" if took else _RESULTS[activation.outcome]


def _answers(run: RecordedRun, nodes: str, activations: Sequence[Activation]) -> Iterator[str]:
    """What a condition answers; if it is asked at every tick, when that changes."""
    answers = [(activation.end, _answer(activation)) for activation in activations]
    if not (_is_polled(activations) or any(_is_asked_again(run, activation.uid) for activation in activations)):
        texts = [answer for _, answer in answers]
        while texts[-2:-1] == texts[-1:]:
            texts.pop()  # the last answer repeats
        yield f"given {nodes} answers {', '.join(texts)}"
        return
    yield f"given {nodes} answers {answers[0][1]}"
    for (_, before), (time, answer) in pairwise(answers):
        if answer != before:
            yield f"when {_time(run, time)} have passed : {nodes} answers {answer}"


def _is_asked_again(run: RecordedRun, uid: int) -> bool:
    """Whether a condition is asked at every tick, as a child of a reactive node, perhaps through decorators."""
    kinds = (BUILTINS.get(run.joined.tree.nodes[above].kind) for above in run.joined.tree.above(uid))
    control = next((kind for kind in kinds if kind is not None and kind.children != (1, 1)), None)
    return control is not None and control.reactive


def _is_polled(activations: Sequence[Activation]) -> bool:
    """Whether a condition is asked tick after tick, so that the number of answers says less than their times."""
    return any(after.begin - before.end <= _POLLED for before, after in pairwise(activations))


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
_ENDS: Final[dict[Outcome, str]] = {"S": "mission succeeds", "F": "mission fails", "H": "mission halts"}
_BARE: Final = "--no-enforce"
_TICK: Final = 10_000  # µs between two ticks of the program
_POLLED: Final = 5 * _TICK
