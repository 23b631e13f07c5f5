"""The answers of `btq explore` to its standard questions: what each means, and what to do then."""

from __future__ import annotations

from typing import Final

from btq_lang.util.record import Record


class StandardAnswer(Record):
    """An answer: what it means, and what to do then."""

    name: str
    meaning: str
    then: str


STANDARD_ANSWERS: Final = {
    each.name: each
    for each in (
        StandardAnswer(
            "never-runs",
            "in none of the states this node runs; of nodes below it nothing more is said",
            "ask which result of a node before it is missing, such as `Check fails`; or take the node out",
        ),
        StandardAnswer(
            "reads-unset",
            "a node can read an entry before it has a value",
            "ask `Grasp reads {cup} unset` for the run; let a node that always runs before write the entry",
        ),
        StandardAnswer(
            "shared-server",
            "two nodes can call one server of Nav2 at the same time, and the later goal ends the earlier one",
            "let one wait for the other, or give one of them a server of its own with `server_name`",
        ),
        StandardAnswer(
            "never-ends",
            "a node never ends, whatever the nodes below it do",
            "nothing, if it is to run until it is halted; else bound the Repeat or Retry below it",
        ),
        StandardAnswer(
            "cannot-succeed",
            "no run of the mission, or of a tree that it calls, succeeds; the answer names the reason",
            "look at the named node: a ForceFailure, an endless loop, or a check that cannot hold where it is",
        ),
        StandardAnswer(
            "cannot-fail",
            "no run of the mission, or of a tree that it calls, fails; the answer names the reason",
            "look at the named node: if what fails below it matters, take out the ForceSuccess, or what "
            "always succeeds at the end of a Fallback",
        ),
        StandardAnswer(
            "cannot-end",
            "no run of the mission ends",
            "nothing, if it is to run until it is stopped; else bound its loop",
        ),
        StandardAnswer(
            "throws",
            "the engine can throw an exception, which ends the program if nothing catches it",
            "read the message and the run below it: most often an entry has no value, or one of another type",
        ),
    )
}
