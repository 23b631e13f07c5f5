"""All that can happen in a mission when its leaves do anything: `btq explore`.

One invariant: what happens is what the model of the engine in `simulator` does; here is only chosen what nothing
determines: what leaves return and write, when timers go off, and how values compare of which nothing is known.

    choices.py     every way in which a computation can go
    values.py      values of which little is known
    snapshots.py   what a tick depends on and changes, as values
    leaves.py      leaves that may do anything
    opened.py      a tree with such leaves
    running.py     which leaves are to run on
    resuming.py    which nodes can go on in the middle of a tick
    outcomes.py    all that one tick of a node can come to
    search.py      all states between two ticks
    questions.py   questions as they are typed
    watching.py    who watches a search for what was asked
    witness.py     a run that shows an answer
    missions.py    a mission of a workspace as a tree with free leaves
    answers.py     answers to questions
    askable.py     which clauses of requirements can be asked
    clauses.py     clauses of requirements that can be violated
    reasons.py     which nodes are why a tree cannot succeed or fail
    surveys.py     answers to the standard questions
    report.py      both in words, as text and as JSON
"""

from __future__ import annotations

from typing import Final

FORMATS: Final = ("text", "json", "html")
