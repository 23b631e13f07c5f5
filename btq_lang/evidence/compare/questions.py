"""The questions that a comparison asks of a store, in DuckDB's SQL.

`{by}` is the column that names the sides, `{sides}` their names, `{unit}` what is shuffled, `{stratum}` within what,
`{robots}` within what failures are counted, `{clause}` a clause as both sides have it, `{keys}` what is asked about.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.store.tables import quoted

if TYPE_CHECKING:
    from btq_lang.evidence.compare.model import Key
    from btq_lang.evidence.compare.requirements import Edited


def clause_of(edited: Sequence[Edited]) -> str:
    """A clause in the words of the second side: what is measured is the same, whatever the bound."""
    cases = [
        f"WHEN (requirement, clause, node) = ({quoted(edit.requirement)}, {quoted(edit.before)}, {quoted(edit.node)})"
        f" THEN {quoted(edit.after)}"
        for edit in edited
    ]
    return f"CASE {' '.join(cases)} ELSE clause END" if cases else "clause"


def numbered(keys: Iterable[Key]) -> str:
    """Nodes and clauses with their places, as rows."""
    return ", ".join(f"({place}, {', '.join(map(quoted, key))})" for place, key in enumerate(keys))


RUNS: Final = """
    SELECT mission, {by} AS side, COUNT(*) AS runs, list(DISTINCT robot ORDER BY robot) AS robots,
        histogram(label) AS labels, MIN(start_us) AS first_us, MAX(end_us) AS last_us
    FROM runs WHERE {by} IN ({sides}) GROUP BY ALL ORDER BY mission
"""
NAMES: Final = "SELECT DISTINCT {by} AS name FROM runs ORDER BY name"

# Of each unit, a robot or a group of runs that a hash has put together: how many values each measure has, their mean,
# the mean of their ranks among all values of the stratum, equal ones having that of the middle one, and their mean end.
MEASURES: Final = """
    WITH placed AS (
        SELECT log, run, {by} AS side, {stratum} AS stratum, {unit} AS unit
        FROM runs WHERE mission = {mission} AND {by} IN ({sides})
    ),
    measures AS (
        SELECT '' AS requirement, '' AS clause, node, log, run, leaf, end_us, (end_us - start_us) / 1e6 AS value
        FROM activations WHERE mission = {mission} AND timing = 'exact'
            AND (start_us - earliest_us) * 100 <= end_us - start_us AND outcome IN ('succeeded', 'failed')
        UNION ALL
        SELECT requirement, {clause} AS clause, node, log, run, false AS leaf, end_us, measured_si AS value
        FROM verdicts WHERE mission = {mission} AND measured_si IS NOT NULL AND most_si IS NULL
    ),
    ranked AS (
        SELECT measures.*, side, stratum, unit, (RANK() OVER alike + COUNT(*) OVER alike) / 2 AS rank
        FROM measures JOIN placed USING (log, run)
        WINDOW alike AS (PARTITION BY requirement, clause, node, stratum ORDER BY value)
    )
    SELECT requirement, clause, node, side, stratum, unit, bool_or(leaf) AS leaf, COUNT(*) AS number,
        AVG(value) AS mean, AVG(rank) AS rank, AVG(end_us) AS end_us
    FROM ranked GROUP BY ALL ORDER BY requirement, clause, node, side, stratum, unit
"""
BY_RUN: Final = "(ROW_NUMBER() OVER (PARTITION BY {by}, {stratum} ORDER BY md5(log || run), log, run) - 1) // {size}"

_RESULTS: Final = """
    WITH results AS (
        SELECT '' AS requirement, '' AS clause, node, uid, {by} AS side, {robots} AS stratum, log, run,
            outcome = 'failed' AS failed
        FROM activations WHERE mission = {mission} AND {by} IN ({sides}) AND outcome IN ('succeeded', 'failed')
        UNION ALL
        SELECT requirement, clause, node, 0 AS uid, {by} AS side, {robots} AS stratum, log, run,
            verdict = 'violated' AS failed
        FROM verdicts WHERE mission = {mission} AND {by} IN ({sides}) AND verdict IN ('satisfied', 'violated')
    )
"""
# In how many runs a node failed, or a clause was violated, at least once, of those where it had a result; `alike` is
# the same where these are the same runs.  A bit for each run of a log takes a sixth of the memory of a row for each.
FAILURES: Final = (
    _RESULTS
    + """,
    of_logs AS (
        SELECT requirement, clause, node, side, stratum, log, run // 1024 AS part, MAX(uid) AS uid,
            bitstring_agg(run % 1024, 0, 1023) AS had, bitstring_agg(run % 1024, 0, 1023) FILTER (failed) AS lost
        FROM results GROUP BY ALL
    )
    SELECT requirement, clause, node, side, stratum, MAX(uid) AS uid, SUM(bit_count(had))::BIGINT AS number,
        COALESCE(SUM(bit_count(lost)), 0)::BIGINT AS failed, bit_xor(hash(log, part, had, lost)) AS alike
    FROM of_logs GROUP BY ALL ORDER BY requirement, clause, node, stratum, side
"""
)
# In how many runs the same of some nodes and clauses had results, and the same failed.
FAILED_TOGETHER: Final = (
    _RESULTS
    + """,
    wanted AS (SELECT * FROM (VALUES {keys}) AS wanted(place, requirement, clause, node)),
    of_runs AS (
        SELECT side, stratum, log, run, list_sort(list(DISTINCT place)) AS had,
            list_sort(list(DISTINCT place) FILTER (failed)) AS failed
        FROM results JOIN wanted USING (requirement, clause, node) GROUP BY ALL
    )
    SELECT side, stratum, had, failed, COUNT(*) AS number FROM of_runs GROUP BY ALL
"""
)
# Which of some nodes and clauses had results only while which others were active, in a sample of the runs.
INSIDE: Final = """
    WITH wanted AS (SELECT * FROM (VALUES {keys}) AS wanted(place, requirement, clause, node)),
    sampled AS (
        SELECT log, run FROM runs WHERE mission = {mission} AND {by} IN ({sides})
        QUALIFY ROW_NUMBER() OVER (PARTITION BY {by} ORDER BY md5(log || run), log, run) <= {sample}
    ),
    spans AS (
        SELECT place, log, run, start_us, end_us, is_leaf, has_result, ROW_NUMBER() OVER () AS number
        FROM (
            SELECT '' AS requirement, '' AS clause, node, log, run, start_us, end_us, leaf AS is_leaf,
                outcome IN ('succeeded', 'failed') AS has_result
            FROM activations SEMI JOIN sampled USING (log, run) WHERE mission = {mission}
            UNION ALL
            SELECT requirement, {clause} AS clause, node, log, run, start_us, end_us, false AS is_leaf,
                true AS has_result
            FROM verdicts SEMI JOIN sampled USING (log, run) WHERE mission = {mission}
        )
        JOIN wanted USING (requirement, clause, node)
    ),
    pairs AS (
        SELECT one.place AS within, two.place AS around, one.number,
            bool_or(two.start_us <= one.start_us AND one.end_us <= two.end_us) AS holds
        FROM spans AS one JOIN spans AS two ON one.log = two.log AND one.run = two.run AND one.place <> two.place
        WHERE one.has_result AND NOT two.is_leaf GROUP BY ALL
    ),
    numbers AS (SELECT place AS within, COUNT(*) AS number FROM spans WHERE has_result GROUP BY ALL)
    SELECT within, around FROM pairs JOIN numbers USING (within) GROUP BY within, around, numbers.number
    HAVING bool_and(holds) AND COUNT(*) = numbers.number ORDER BY within, around
"""
# The nodes that were active on one side only.
ONE_SIDED: Final = """
    SELECT side, COUNT(*) AS number
    FROM (
        SELECT node, MIN({by}) AS side FROM activations WHERE mission = {mission} AND {by} IN ({sides})
        GROUP BY node HAVING COUNT(DISTINCT {by}) = 1
    )
    GROUP BY side
"""
# What each side adds to failure rates.
RATES: Final = """
    SELECT requirement, {clause} AS clause, node, {by} AS side, {robots} AS stratum, COUNT(*) AS runs,
        SUM(number) AS least, SUM(number_most) AS most, SUM(exposure_s) AS seconds, SUM(exposure_most_s) AS longest
    FROM verdicts WHERE mission = {mission} AND {by} IN ({sides}) AND number IS NOT NULL
    GROUP BY ALL ORDER BY requirement, clause, node, stratum, side
"""
UNITS: Final = """
    SELECT requirement, {clause} AS clause, node, MAX(unit) AS unit, MAX(rate_seconds) AS seconds FROM clauses
    WHERE mission = {mission} AND {by} IN ({sides}) GROUP BY ALL
"""
SAMPLE: Final = 400  # runs of each side
