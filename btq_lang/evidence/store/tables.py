"""The tables of the store: names and types of their columns.

One invariant: a later version adds columns and changes none, for people ask these tables with their own tools.

Every row says of which log, mission, robot and label it is, so that no question needs a join for that; a column that
has one value in a whole file takes a few bytes there.  Times are in µs since the epoch, values in SI.
"""

from __future__ import annotations

from typing import Final


def files_of(store: str, table: str) -> str:
    """The pattern of the files of a table; what is still being written has other names."""
    return f"{store.rstrip('/')}/{_SETS}/{table}.parquet"


def quoted(text: str) -> str:
    """A text as a string literal of SQL."""
    return "'" + text.replace("'", "''") + "'"


# The columns that all rows of a table in a set have in common; `rows.py` writes the others.
COMMON: Final = {
    "runs": ("log", "label", "source"),
    "activations": ("log", "label"),
    "clauses": ("log", "label"),
    "verdicts": ("log", "label"),
}
_WHOSE: Final = {"mission": "VARCHAR", "robot": "VARCHAR"}

ROWS: Final = {
    # A run: when it was, how it ended, and how much happened in it.  `failure` is the node where a failure began,
    # `tree` a hash of the nodes of the log, `joined` how many of them were found in the mission.
    "runs": {
        **_WHOSE,
        "run": "INTEGER",
        "start_us": "BIGINT",
        "end_us": "BIGINT",
        "outcome": "VARCHAR",
        "activations": "INTEGER",
        "retries": "INTEGER",
        "recoveries": "INTEGER",
        "failure": "VARCHAR",
        "tree": "VARCHAR",
        "nodes": "INTEGER",
        "joined": "INTEGER",
    },
    # An activation of a node.  `path`: as the engine names it; `node`: as in other trees (`rows.node_names`).
    # `timing`: `exact`; `latest`, if it may have ended before; `broken`, if the clock was set
    # back meanwhile; `late`, if it began before; `lost`, if the rest of the run was lost; `part`, if both.
    # `earliest_us`: when it may have begun before `start_us`, equal to that if it is known when it began.
    "activations": {
        **_WHOSE,
        "run": "INTEGER",
        "uid": "INTEGER",
        "path": "VARCHAR",
        "node": "VARCHAR",
        "kind": "VARCHAR",
        "leaf": "BOOLEAN",
        "start_us": "BIGINT",
        "end_us": "BIGINT",
        "outcome": "VARCHAR",
        "timing": "VARCHAR",
        "earliest_us": "BIGINT",
    },
    # A clause at a node, whether something was judged or not.  `node`: all nodes at which it is counted together;
    # `counts`: `activations`, `runs`, or `open` if no log can show it; `unit`: of what is measured; `exercised`:
    # whether its node ran; `cut_off`: activations that the end of the log left undecided; `missing`: why it cannot be
    # judged, or not at all its nodes; `lower_si`, `upper_si`: of a clause with two bounds, unless they vary; `goal_si`:
    # what its requirement aims at; `rate_low` to `rate_high` in `rate_seconds`: the failure rate that it
    # demands, of whose time `unit` is the unit; `rate_strict`: whether the bound itself violates it; `mean_low`,
    # `mean_high` and `mean_strict`: the same of a mean; `fingerprint`: of what its requirement means, as in approvals.
    "clauses": {
        **_WHOSE,
        "clause_index": "INTEGER",
        "requirement": "VARCHAR",
        "title": "VARCHAR",
        "clause": "VARCHAR",
        "node": "VARCHAR",
        "measures": "VARCHAR",
        "counts": "VARCHAR",
        "unit": "VARCHAR",
        "odds": "DOUBLE",
        "relation": "VARCHAR",
        "experiments": "VARCHAR",
        "confidence": "DOUBLE",
        "last_number": "INTEGER",
        "last_of": "VARCHAR",
        "last_seconds": "DOUBLE",
        "exercised": "BOOLEAN",
        "cut_off": "INTEGER",
        "missing": "VARCHAR",
        "lower_si": "DOUBLE",
        "upper_si": "DOUBLE",
        "goal_si": "DOUBLE",
        "rate_low": "DOUBLE",
        "rate_high": "DOUBLE",
        "rate_strict": "DOUBLE",
        "rate_seconds": "DOUBLE",
        "mean_low": "DOUBLE",
        "mean_high": "DOUBLE",
        "mean_strict": "DOUBLE",
        "fingerprint": "VARCHAR",
    },
    # What was judged: an activation, or a run for clauses about runs.  `verdict`: `satisfied`, `violated` or `unknown`;
    # `counted`: whether it counts: where runs are counted, one judgement of each run does; `at_us`: when it was
    # violated; `why`: what happened, with `{}` for what was measured, or why it is unknown; `most_si`: the upper limit
    # of a measure of which `measured_si` is the lower one, if it is not known exactly; `number` to `number_most`
    # failures in `exposure_s` to `exposure_most_s`: what a run adds to a failure rate.
    "verdicts": {
        "clause_index": "INTEGER",
        "run": "INTEGER",
        "path": "VARCHAR",
        "start_us": "BIGINT",
        "end_us": "BIGINT",
        "verdict": "VARCHAR",
        "counted": "BOOLEAN",
        "at_us": "BIGINT",
        "measured_si": "DOUBLE",
        "bound_si": "DOUBLE",
        "why": "VARCHAR",
        "most_si": "DOUBLE",
        "number": "DOUBLE",
        "number_most": "DOUBLE",
        "exposure_s": "DOUBLE",
        "exposure_most_s": "DOUBLE",
    },
}
# Columns that the sets of earlier versions may lack; they are then NULL.
OPTIONAL: Final = {
    "clauses": (
        "lower_si",
        "upper_si",
        "goal_si",
        "rate_low",
        "rate_high",
        "rate_strict",
        "rate_seconds",
        "mean_low",
        "mean_high",
        "mean_strict",
        "fingerprint",
    ),
    "verdicts": ("number", "number_most", "exposure_s", "exposure_most_s"),
}
# The columns that a verdict takes from its clause.
OF_CLAUSE: Final = ("mission", "robot", "requirement", "clause", "node")
_SETS: Final = "[0-9a-f]*"
