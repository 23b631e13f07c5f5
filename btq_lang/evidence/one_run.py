"""One run of a log, step by step, for an editor that draws it."""

from __future__ import annotations

from collections.abc import Sequence

from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.model import ROOT, Activation
from btq_lang.evidence.named_runs import joined_sessions
from btq_lang.evidence.outline import outline
from btq_lang.evidence.readers import read
from btq_lang.evidence.runs import activations
from btq_lang.evidence.verdicts import OUTCOMES
from btq_lang.evidence.wording import timestamp, took
from btq_lang.util.record import Record


class RunStep(Record):
    """Something that happened to a node.

    Attributes:
        at: seconds since the run began.
        node: its number among the mission's written nodes, in the order of their text.
        path: of the node in the engine.
        state: `running`, or the outcome of the activation that ended.
        took: how long that was, in words; empty while it runs, and if the log shows no time.
    """

    at: float
    node: int
    path: str
    state: str
    took: str


class OneRun(Record):
    """A run.

    Attributes:
        start: when it began, in ISO 8601.
        outline: of the mission, as in `outline.py`.
        left_out: how many activations are omitted.
    """

    start: str
    outcome: str
    outline: str
    steps: tuple[RunStep, ...]
    left_out: int


def one_run(log: str, mission: Candidate, number: int) -> OneRun | None:
    """A run of a mission, counted from 1 among its runs in the log; None if there are fewer.

    Raises:
        NotALog, OSError: the log cannot be read.
    """
    for _, session, joined in joined_sessions(read(log), [mission], log):
        if isinstance(joined, str):
            continue
        written = joined.written()
        recorded: list[Activation] = []
        left_out = 0
        for activation in activations(session):
            if number == 1 and activation.uid in written:
                left_out += len(recorded) >= _MOST
                recorded += [activation] if len(recorded) < _MOST else []
            if activation.uid == ROOT:
                number -= 1
                if number == 0:
                    paths = {uid: joined.tree.nodes[uid].path for uid in written}
                    steps = _steps(recorded, activation.begin, written, paths)
                    start_and_outcome = timestamp(activation.begin), OUTCOMES[activation.outcome]
                    return OneRun(*start_and_outcome, outline(mission.requirements), steps, left_out)
    return None


def _steps(
    recorded: Sequence[Activation], start: int, written: dict[int, int], paths: dict[int, str]
) -> tuple[RunStep, ...]:
    """The beginnings and the ends of activations in the order of the log's rows; parents begin before their children,
    and end after them.
    """
    events = [
        (activation.started, activation.uid, False, activation)
        for activation in recorded
        if activation.started != activation.ended
    ]
    events += [(activation.ended, -activation.uid, True, activation) for activation in recorded]
    events.sort(key=lambda event: event[:3])
    return tuple(
        RunStep(
            (moment[0] - start) / 1e6,
            written[activation.uid],
            paths[activation.uid],
            OUTCOMES[activation.outcome] if is_end else "running",
            took(activation) if is_end else "",
        )
        for moment, _, is_end, activation in events
    )


_MOST = 5000
