"""The questions that a comparison asks of a store, in DuckDB's SQL.

`{by}` is the column that names the sides, `{sides}` their names, `{unit}` what is shuffled, `{stratum}` within what,
`{robots}` within what
failures are counted, `{clause}` a clause as both sides have it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.store.tables import quoted

if TYPE_CHECKING:
    from btq_lang.evidence.compare.requirements import Edited


def clause_of(edited: Sequence[Edited]) -> str:
    """A clause in the words of the second side: what is measured is the same, whatever the bound."""
    cases = [
        f"WHEN (requirement, clause, node) = ({quoted(each.requirement)}, {quoted(each.before)}, {quoted(each.node)})"
        f" THEN {quoted(each.after)}"
        for each in edited
    ]
    return f"CASE {' '.join(cases)} ELSE clause END" if cases else "clause"


RUNS: Final = """
    SELECT mission, {by} AS side, COUNT(*) AS runs, list(DISTINCT robot ORDER BY robot) AS robots,
        histogram(label) AS labels
    FROM runs WHERE {by} IN ({sides}) GROUP BY ALL ORDER BY mission
"""
NAMES: Final = "SELECT DISTINCT {by} AS name FROM runs ORDER BY name"

# A unit is a robot, or a group of runs that a hash has put together.
_PLACED: Final = """
    WITH placed AS (
        SELECT log, run, {by} AS side, {stratum} AS stratum, {unit} AS unit
        FROM runs WHERE mission = {mission} AND {by} IN ({sides})
    ),
    measures AS (
        SELECT '' AS requirement, '' AS clause, node, log, run, (end_us - start_us) / 1e6 AS value
        FROM activations WHERE mission = {mission} AND timing = 'exact'
            AND (start_us - earliest_us) * 100 <= end_us - start_us AND outcome IN ('succeeded', 'failed')
        UNION ALL
        SELECT requirement, {clause} AS clause, node, log, run, measured_si AS value
        FROM verdicts WHERE mission = {mission} AND measured_si IS NOT NULL AND most_si IS NULL
    ),
    measured AS (SELECT measures.*, side, stratum, unit FROM measures JOIN placed USING (log, run))
"""
BY_RUN: Final = "(ROW_NUMBER() OVER (PARTITION BY {by}, {stratum} ORDER BY md5(log || run), log, run) - 1) // {size}"

# Of each measure, what is in the middle of a side, and what 95 of 100 do not exceed.
QUANTILES: Final = (
    _PLACED
    + """
    SELECT requirement, clause, node, side, COUNT(*) AS number,
        quantile_disc(value, 0.5) AS median, quantile_disc(value, 0.95) AS p95
    FROM measured GROUP BY ALL ORDER BY requirement, clause, node
"""
)
# Of each unit, how many of its measures are above the median and the 95th percentile of both sides of its stratum, less
# how many are below, with the weights that make the sum over all measures nearly 0.
SCORES: Final = (
    _PLACED
    + """,
    pooled AS (
        SELECT requirement, clause, node, stratum,
            quantile_disc(value, 0.5) AS median, quantile_disc(value, 0.95) AS p95
        FROM measured GROUP BY ALL
    )
    SELECT requirement, clause, node, side, stratum, unit, COUNT(*) AS number,
        SUM(CASE WHEN value > median THEN 1 WHEN value < median THEN -1 ELSE 0 END)::BIGINT AS median,
        SUM(CASE WHEN value > p95 THEN 19 WHEN value < p95 THEN -1 ELSE 0 END)::BIGINT AS p95
    FROM measured JOIN pooled USING (requirement, clause, node, stratum) GROUP BY ALL
"""
)
# In how many runs a node failed, or a clause was violated, at least once, of those where it had a result.  A bit for
# each run of a log takes a sixth of the memory that a row for each takes.
FAILURES: Final = """
    WITH results AS (
        SELECT '' AS requirement, '' AS clause, node, {by} AS side, {robots} AS stratum, log, run,
            outcome = 'failed' AS failed
        FROM activations WHERE mission = {mission} AND {by} IN ({sides}) AND outcome IN ('succeeded', 'failed')
        UNION ALL
        SELECT requirement, clause, node, {by} AS side, {robots} AS stratum, log, run, verdict = 'violated' AS failed
        FROM verdicts WHERE mission = {mission} AND {by} IN ({sides}) AND verdict IN ('satisfied', 'violated')
    ),
    of_logs AS (
        SELECT requirement, clause, node, side, stratum, bit_count(bitstring_agg(run % 1024, 0, 1023)) AS number,
            bit_count(bitstring_agg(run % 1024, 0, 1023) FILTER (failed)) AS failed
        FROM results GROUP BY requirement, clause, node, side, stratum, log, run // 1024
    )
    SELECT requirement, clause, node, side, stratum,
        SUM(number)::BIGINT AS number, COALESCE(SUM(failed), 0)::BIGINT AS failed
    FROM of_logs GROUP BY ALL ORDER BY requirement, clause, node, stratum, side
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
UNITS: Final = """
    SELECT requirement, {clause} AS clause, node, MAX(unit) AS unit FROM clauses
    WHERE mission = {mission} AND {by} IN ({sides}) GROUP BY ALL
"""
