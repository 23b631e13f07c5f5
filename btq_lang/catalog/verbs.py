"""The verbs of clauses, one row each: what a clause with it measures, when it is judged, and how that is said.

One invariant: every verb of the grammar has a row, and a row's example is a clause that parses.  What a clause means
for an activation is not known here; `evidence/verbs` has a module for each verb that is judged from logs, found by the
row's word.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.util.record import Record

if TYPE_CHECKING:
    Operand: TypeAlias = Literal["duration", "condition", "use", "count", "rate", "event", "reaction"]
    Judged: TypeAlias = Literal["at its start", "while it runs", "at its end", "over the run"]


class Verb(Record):
    """A verb.

    Attributes:
        operand: what it is followed by.
        measures: what is compared with the bound, or asked.
        judged: when an activation, or a run, is known to keep it or to break it.
        said: a measure in a sentence about one activation; `{}` is the measure.
        example: a clause.
    """

    word: str
    operand: Operand
    measures: str
    judged: Judged
    said: str
    example: str


_START: Final = "at its start"
_MEANWHILE: Final = "while it runs"
_END: Final = "at its end"
_RUN: Final = "over the run"
_SINCE: Final = "the time since an event"

VERBS: Final = {
    verb.word: verb
    for verb in (
        Verb("takes", "duration", "the time from its start to its end", _END, "took {}", "takes at most 30 s"),
        Verb("succeeds", "duration", "its result, and the time", _END, "{}", "succeeds within 30 s"),
        Verb("needs", "condition", "a condition", _START, "{} at the start", "needs battery >= 15 %"),
        Verb("keeps", "condition", "a condition", _MEANWHILE, "{}", "keeps battery >= 15 %"),
        Verb("never", "condition", "a condition", _MEANWHILE, "{}", "never speed > 1 m/s"),
        Verb("leaves", "condition", "a condition", _END, "{} at the end", "leaves battery >= 3 %"),
        Verb("uses", "use", "the change of a signal", _END, "used {}", "uses at most 20 Wh of energy"),
        Verb("tries", "count", "the number of its starts", _RUN, "started {}", "tries at most 3 per PickTray"),
        Verb(
            "runs",
            "rate",
            "the time between two starts, or their number in a time",
            _RUN,
            "ran {}",
            "runs every 500 ms",
        ),
        Verb("starts", "reaction", _SINCE, _RUN, "started after {}", "starts within 2 s after Dock succeeds"),
        Verb("ends", "reaction", _SINCE, _RUN, "ended after {}", "ends within 2 s after Dock succeeds"),
        Verb("follows", "event", "an event since its last start", _START, "{}", "follows Dock succeeds"),
    )
}
