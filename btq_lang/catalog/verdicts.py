"""The verdicts of `btq verify`: what each means, when a requirement gets it, and what to do then."""

from __future__ import annotations

from typing import Final

from btq_lang.util.record import Record


class Verdict(Record):
    """A verdict: what it means in short, when a clause gets it, and what to do then."""

    name: str
    brief: str
    when: str
    then: str


VERDICTS: Final = {
    each.name: each
    for each in (
        Verdict(
            "violated",
            "the robot did what the requirement forbids",
            """\
At least one activation breaks the clause, even if the log ends soon after. With odds, too many do: with
`confidence`, the upper limit of the probability is below the one that is asked for; without, the share is. What
the requirement's own guard stops, or does not let start, is violated.""",
            """\
Read the line below: it names the node, what was measured, what led to it, the run and the time in it.
`--verbose` explains more violations, `--format html` draws the run, `--format json` has all of it.""",
        ),
        Verdict(
            "unknown",
            "the logs do not say whether it holds",
            """\
Something is missing, and the table says what: samples of a signal, a node in a log of another version of the
mission, or the time of a halt that the log does not have. One unknown activation is enough, unless another one
breaks the clause; with odds, it matters only where it could change the verdict.""",
            """\
Give samples with `--signals FILE` or `[evidence.signals]`; `initially` gives none. Verify with
the mission that was built, whose side file is beside the log. Let the logger write changes to IDLE.""",
        ),
        Verdict(
            "undecided",
            "there are too few runs to say",
            """\
The requirement asks for a `confidence`, and the exact limits of the probability (Clopper and Pearson) are on
both sides of what is asked for.""",
            """\
Run the robot or the simulation more often: the table says how many more runs decide, if none of them is a
violation.""",
        ),
        Verdict(
            "satisfied",
            "it held in all that was logged",
            "All activations that count keep the clause. With odds, enough of them do.",
            """\
Nothing. Without odds, it says only that it held so far; `in at least 95 % of runs confidence 95 %` says how
sure that is.""",
        ),
        Verdict(
            "never exercised",
            "nothing that it is about happened",
            """\
Its node did not start in any run, or was halted before the clause could be judged. Of several nodes, this holds
for all.""",
            """\
Look whether the logs are of the right mission, and whether a run can lead to the node. `--strict` makes it a
failure.""",
        ),
        Verdict(
            "open",
            "no log can show it",
            """\
People verify it (`verified by review`, `test` or `analysis`), or it has no clause that can be measured, only a
title. No log changes that.""",
            """\
Keep the record of the review beside the report, or write a clause that logs can show. `--strict` makes it a
failure.""",
        ),
    )
}
