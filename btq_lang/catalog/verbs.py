"""The verbs of clauses, one row each: what a clause with it demands, how it is judged, enforced, completed and worded.

One invariant: whatever differs from verb to verb is in its row, or in what is found by the row's word: its production
in `grammar/claims`, its function in `evidence/verbs` or `evidence/run_verbs`, and, if it can be enforced, its function
in `btcpp/guards`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.util.record import Record

if TYPE_CHECKING:
    Operand: TypeAlias = Literal[
        "duration",
        "deadline",
        "condition",
        "use",
        "count",
        "rate",
        "failures",
        "reaction",
        "event",
        "answer",
        "stretch",
        "visits",
    ]
    Judged: TypeAlias = Literal["at its start", "while it runs", "at its end", "over the run"]
    Limits: TypeAlias = Literal["", "completion", "success"]
    Enforced: TypeAlias = Literal["", "limit", "refusal", "guard", "check"]


class Verb(Record):
    """A verb.

    Attributes:
        word: one, or the first word of its clauses and what tells them from those of another verb: `ends with`.
        operand: what it is followed by: a bound of a duration, perhaps a deadline, a condition, a bound of the use of a
            signal, a bound of a count, a period or a rate, a bound of a failure rate, a deadline after an event, an
            event, an event or a condition that answers one, a condition and how long it may hold, nodes.
        measures: what is compared with the bound, or evaluated.
        judged: when it is known whether an activation, or a run, satisfies or violates it.
        phrases: for each continuation: its words, an example, what it is about, and when a clause is violated.
        said: a measure in a sentence about one activation; `{}` is the measure.
        forms: how a clause begins, each with what an editor inserts, if that is more; empty: with the word alone.
        limits: which end of an activation a bound of its duration is on: any, or only its success; empty if it bounds
            no duration.  Budgets need one; sums of nodes and times between events take those of any end.
        enforced: how the engine enforces it: a Timeout, a condition before the node that refuses its start, one that is
            evaluated while the node runs, one after it.
        why_monitored: why the engine cannot enforce its clauses.
        is_final: whether a violation stays one, whatever the activation does next.
    """

    word: str
    operand: Operand
    measures: str
    judged: Judged
    phrases: tuple[tuple[str, str, str, str], ...]
    said: str = "{}"
    forms: tuple[tuple[str, str | None], ...] = ()
    limits: Limits = ""
    enforced: Enforced = ""
    why_monitored: str = ""
    is_final: bool = False

    @property
    def is_of_moments(self) -> bool:
        """Whether it demands a condition of each moment, so that it may be limited to a time."""
        return self.operand == "condition" and self.judged == "while it runs"

    @property
    def example(self) -> str:
        """A clause without a subject."""
        return self.phrases[0][1]


def words(
    *, operands: Iterable[Operand] = (), limits: Iterable[Limits] = (), enforced: Enforced = ""
) -> frozenset[str]:
    """The verbs with one of these operands, limits or ways of enforcement."""
    return frozenset(
        [
            verb.word
            for verb in VERBS.values()
            if verb.operand in operands or verb.limits in limits or (enforced and verb.enforced == enforced)
        ]
    )


def measured(line: Sequence[str]) -> str | None:
    """The unit of what follows some words of a line, or one of its dimension; None if they do not determine it."""
    is_after_case = False
    for word in reversed(line):
        if word in ("else", ","):
            is_after_case = True  # `20 s if near, 30 s if slow else …`: the verb precedes all the cases
        elif word in _UNITS and not (word == "if" and is_after_case):
            return _UNITS[word]
    return None


_START: Final = "at its start"
_MEANWHILE: Final = "while it runs"
_END: Final = "at its end"
_RUN: Final = "over the run"
_PERIOD: Final = "a run, or in an activation of the node after `per`"
_LEAST: Final = ("at least", 12, "less")
_MOST: Final = ("at most", 3, "more")
_DURATION: Final[Operand] = "duration"
_USE: Final[Operand] = "use"
_CHECK: Final[Enforced] = "check"
_REFUSAL: Final[Enforced] = "refusal"
_NO_FORM: Final = (("", None),)  # it begins as the clauses of another verb
_NOTHING_STARTS_NODES: Final = "BehaviorTree.CPP has no node that makes another one start in time"

VERBS: Final = {
    verb.word: verb
    for verb in (
        Verb(
            word="takes",
            operand="duration",
            measures="the time from its start to its end",
            judged=_END,
            said="took {}",
            phrases=(("takes", "takes at most 30 s", "duration", "the node takes longer"),),
            forms=(("takes at most", "takes at most ${0:30 s}"), ("takes at least", "takes at least ${0:1 s}")),
            limits="completion",
            enforced="limit",
            is_final=True,
        ),
        Verb(
            word="succeeds",
            operand="deadline",
            measures="its result, and the time",
            judged=_END,
            phrases=(
                (
                    "succeeds",
                    "succeeds within 30 s",
                    "result, and when",
                    "it fails, or succeeds later. A run is kept if all activations in it are. For a success at any "
                    "try, write `from mission starts to X succeeds takes at most 30 s`",
                ),
            ),
            forms=(("succeeds", None), ("succeeds within", "succeeds within ${0:30 s}")),
            limits="success",
            enforced="limit",
            is_final=True,
        ),
        Verb(
            word="needs",
            operand="condition",
            measures="a condition",
            judged=_START,
            said="{} at the start",
            phrases=(
                (
                    "needs",
                    "needs rear_is_clear",
                    "a condition when it starts",
                    "the condition is false when the node starts",
                ),
            ),
            enforced="refusal",
            is_final=True,
        ),
        Verb(
            word="keeps",
            operand="condition",
            measures="a condition",
            judged=_MEANWHILE,
            phrases=(
                (
                    "keeps",
                    "keeps battery >= 15 %",
                    "a condition while it runs",
                    "it is false at any time while the node runs",
                ),
            ),
            enforced="guard",
            is_final=True,
        ),
        Verb(
            word="never",
            operand="condition",
            measures="a condition",
            judged=_MEANWHILE,
            phrases=(
                (
                    "never",
                    "never lamp_on and humans_near",
                    "what must not hold while it runs",
                    "it is true at any time while the node runs",
                ),
            ),
            enforced="guard",
            is_final=True,
        ),
        *(
            Verb(
                word=f"{word} of time",
                operand="condition",
                measures="the share of the time that it runs",
                judged=_RUN,
                said=f"{how} in {{}} of the time",
                phrases=(
                    (
                        f"{word} of time",
                        f"{word} {condition} in at least 95 % of time",
                        "a share of the time",
                        f"in a run it is {truth} for a larger share of the time that the node runs",
                    ),
                ),
                forms=_NO_FORM,
                why_monitored="what share of its time that is, is known only when the run has ended",
            )
            for word, condition, how, truth in (
                ("keeps", "battery >= 15 %", "held", "false"),
                ("never", "humans_near", "did not hold", "true"),
            )
        ),
        Verb(
            word="never for",
            operand="stretch",
            measures="how long a condition holds at a stretch",
            judged=_MEANWHILE,
            said="held for {}",
            phrases=(
                (
                    "never for",
                    "never lamp_on for more than 30 s",
                    "what must not hold for long",
                    "it is true for longer at a stretch while the node runs",
                ),
            ),
            forms=(("never for more than", "never ${1:condition} for more than ${0:30 s}"),),
            why_monitored="a condition in BehaviorTree.CPP cannot tell how long it has held",
            is_final=True,
        ),
        Verb(
            word="leaves",
            operand="condition",
            measures="a condition",
            judged=_END,
            said="{} at the end",
            phrases=(
                (
                    "leaves",
                    "leaves battery >= 3 %",
                    "a condition when it has succeeded",
                    "it is false when the node has succeeded. Activations that fail or are halted are not counted",
                ),
            ),
            enforced="check",
        ),
        Verb(
            word="ends with",
            operand="condition",
            measures="a condition",
            judged=_END,
            said="{} at the end",
            phrases=(
                (
                    "ends with",
                    "ends with gripper_empty",
                    "a condition when it has ended",
                    "it is false when the node has succeeded or failed. Activations that are halted are not counted",
                ),
            ),
            enforced="check",
        ),
        Verb(
            word="uses",
            operand="use",
            measures="the change of a signal",
            judged=_END,
            said="used {}",
            phrases=(("uses", "uses at most 20 Wh of energy", "a resource", "the use while the node runs is higher"),),
            forms=(("uses at most", "uses at most ${1:1 Wh} of ${0:signal}"),),
            enforced="guard",
        ),
        *(
            Verb(
                word=f"{word} on average",
                operand=operand,
                measures=f"the mean of {measures}",
                judged=_RUN,
                phrases=((f"{word} on average", example, "a mean", f"the mean of {measures} is higher"),),
                forms=_NO_FORM,
                why_monitored="a mean is evaluated in the logs of many runs",
            )
            for word, operand, measures, example in (
                (
                    "takes",
                    _DURATION,
                    "the times to its success or failure",
                    "takes at most 30 s on average",
                ),
                ("uses", _USE, "the uses to its success or failure", "uses at most 20 Wh of energy on average"),
            )
        ),
        Verb(
            word="tries",
            operand="count",
            measures="the number of its starts",
            judged=_RUN,
            said="started {}",
            phrases=(
                (
                    "tries",
                    "tries at most 3 per PickTray",
                    "attempts",
                    "the node starts more often within one activation of the other; without `per`, in the whole run",
                ),
            ),
            forms=(("tries at most", "tries at most ${0:3}"),),
            enforced="refusal",
        ),
        *(
            Verb(
                word=f"{word} per",
                operand="count",
                measures=f"how often it {word}",
                judged=_RUN,
                said=f"{past} {{}}",
                phrases=tuple(
                    (f"{word} {bound}", f"{word} {bound} {number} per run", what, f"{event} {how} often in {_PERIOD}")
                    for bound, number, how in bounds
                ),
                forms=tuple(
                    (f"{word} {bound}", f"{word} {bound} ${{1:{number}}} per ${{0:run}}") for bound, number, _ in bounds
                ),
                enforced=enforced,
            )
            for word, past, what, event, enforced, bounds in (
                ("succeeds", "succeeded", "successes", "the node succeeds", _CHECK, (_LEAST, _MOST)),
                ("starts", "started", "starts", "the node starts", _REFUSAL, (_LEAST, _MOST)),
                ("fails", "failed", "failures", "the node fails", _CHECK, (_MOST,)),
                ("finishes", "finished", "results", "the node succeeds or fails", _CHECK, (_LEAST, _MOST)),
            )
        ),
        Verb(
            word="fails per time",
            operand="failures",
            measures="its failures in the time of all runs",
            judged=_RUN,
            phrases=(
                (
                    "fails per",
                    "fails at most 1 per 200 h of Dock",
                    "a failure rate",
                    "the node fails more often, over the time of all runs, or over that of the node after `of`",
                ),
            ),
            forms=_NO_FORM,
            why_monitored="a failure rate is evaluated in the logs of many runs",
        ),
        Verb(
            word="runs",
            operand="rate",
            measures="the time between two starts, or their number in a time",
            judged=_RUN,
            said="ran {}",
            phrases=(
                ("runs every", "runs every 500 ms", "period", "two starts are further apart"),
                ("runs", "runs at least 9 per 10 s", "rate", "any period of that length contains fewer starts"),
            ),
            forms=(("runs every", "runs every ${0:1 s}"), ("runs at least", "runs at least ${1:1} per ${0:1 s}")),
            why_monitored=_NOTHING_STARTS_NODES,
        ),
        *(
            Verb(
                word=word,
                operand="reaction",
                measures="the time since an event",
                judged=_RUN,
                said=f"{past} after {{}}",
                phrases=(
                    (
                        word,
                        f"{word} within 2 s after Batch succeeds",
                        "reaction",
                        f"it {word} later than that, or not at all. {more}",
                    ),
                ),
                forms=((f"{word} within", f"{word} within ${{1:1 s}} after $0"),),
                why_monitored=_NOTHING_STARTS_NODES,
            )
            for word, past, more in (
                ("starts", "started", "A node that is active when the event happens has to start again"),
                ("ends", "ended", "Only a node that is active when the event happens counts"),
            )
        ),
        Verb(
            word="visits",
            operand="visits",
            measures="the successes of other nodes",
            judged=_RUN,
            phrases=(
                (
                    "visits",
                    "visits HallA, HallB, Dock",
                    "nodes that have to succeed",
                    "it ends, but one of the nodes has not succeeded meanwhile; with `in order`, also where their "
                    "first successes come in another order",
                ),
            ),
            forms=(("visits", "visits ${1:A}, ${0:B}"),),
            why_monitored="what was visited is known only at the end",
        ),
        Verb(
            word="follows",
            operand="event",
            measures="an event since its last start",
            judged=_START,
            phrases=(
                (
                    "follows",
                    "follows SlotFree succeeds",
                    "order",
                    "it starts, but the event has not happened since its previous start",
                ),
            ),
            enforced="refusal",
        ),
        Verb(
            word="followed",
            operand="answer",
            measures="the time from an event to another one, or until a condition holds",
            judged=_RUN,
            said="was followed after {}",
            phrases=(
                (
                    "is followed by",
                    "each Pick fails is followed by Recover starts within 5 s",
                    "what comes after an event",
                    "after one of the events the other one does not happen, or the condition does not hold at any "
                    "moment, within that time; without `within`, before the run ends",
                ),
            ),
            forms=(("each", "each ${1:A} fails is followed by ${0:B} starts"),),
            why_monitored=_NOTHING_STARTS_NODES,
        ),
    )
}
_OF_MEANS: Final = [verb for verb in VERBS if verb.endswith(" on average")]
POOLED: Final = words(operands=("failures",)).union(_OF_MEANS)  # judged of all runs together
COUNTING: Final = frozenset([verb.partition(" ")[0] for verb in words(operands=("count",)) if verb.endswith(" per")])
_UNITS: Final[dict[str, str | None]] = {
    **dict.fromkeys((*words(operands=("duration",)), "within", "every", "per", "for"), "s"),
    **dict.fromkeys(("in", "probability", "confidence"), "%"),
    **dict.fromkeys(words(operands=("condition", "use", "count", "rate"))),
    **dict.fromkeys(COUNTING),
    **dict.fromkeys(("while", "when", "assuming", "if", "context", "over", "goal", "initially")),
}
