"""The questions that a summary asks of a store, as one table of SQL.

One invariant: the questions use the part of SQL that every engine has, in DuckDB's words: aggregates, CASE, joins, and
windows that number rows in one direction, with no NULLS LAST.  So one text runs on DuckDB and, translated word by word,
on other engines.

`{by}` are the columns that part the summary: `mission`, and those that the user names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, TypeAlias

Row: TypeAlias = Mapping[str, Any]
Ask: TypeAlias = Callable[[str], Sequence[Row]]  # the rows of a question, by the names of their columns


# The runs that another log of the label holds as well, at least as completely.  Of two runs of one tree that begin, or
# end, within a millisecond of each other, the one is a part of the other if all results of its nodes are there within a
# millisecond.
REPEATED: Final = """
    WITH logs AS (SELECT log, SUM(end_us - start_us) AS in_log FROM runs GROUP BY log),
    marks AS (
        SELECT runs.*, in_log, 'begin' AS kind, start_us AS at_us FROM runs JOIN logs ON runs.log = logs.log
        UNION ALL
        SELECT runs.*, in_log, 'end' AS kind, end_us AS at_us FROM runs JOIN logs ON runs.log = logs.log
    ),
    near AS (
        SELECT label, mission, tree, kind, log, run, CAST(FLOOR(at_us / 1000.0) AS BIGINT) + step.d AS ms, at_us,
            robot, start_us, end_us, activations, in_log
        FROM marks CROSS JOIN (SELECT -1 AS d UNION ALL SELECT 0 AS d UNION ALL SELECT 1 AS d) AS step
    ),
    pairs AS (
        SELECT DISTINCT one.log AS log, one.run AS run, two.log AS other_log, two.run AS other_run,
            one.activations AS activations, two.activations AS other_activations,
            one.in_log AS in_log, two.in_log AS other_in_log
        FROM marks AS one
        JOIN near AS two
            ON one.label = two.label AND one.mission = two.mission AND one.tree = two.tree AND one.kind = two.kind
            AND CAST(FLOOR(one.at_us / 1000.0) AS BIGINT) = two.ms
        WHERE ABS(one.at_us - two.at_us) <= 1000
            AND (one.robot = two.robot OR one.robot = '' OR two.robot = '')
            AND one.tree <> '' AND (one.log <> two.log OR one.run <> two.run)
            AND (one.log <> two.log OR (one.start_us < two.end_us AND two.start_us < one.end_us))
    ),
    results AS (
        SELECT activations.log AS log, activations.run AS run, uid, outcome, end_us
        FROM activations
        JOIN (SELECT DISTINCT log, run FROM pairs) AS paired
            ON activations.log = paired.log AND activations.run = paired.run
        WHERE outcome = 'succeeded' OR outcome = 'failed'
    ),
    numbers AS (SELECT log, run, COUNT(*) AS number FROM results GROUP BY log, run),
    near_results AS (
        SELECT log, run, uid, outcome, end_us, CAST(FLOOR(end_us / 1000.0) AS BIGINT) + step.d AS ms
        FROM results CROSS JOIN (SELECT -1 AS d UNION ALL SELECT 0 AS d UNION ALL SELECT 1 AS d) AS step
    ),
    held AS (
        SELECT log, run, other_log, other_run, COUNT(*) AS number
        FROM (
            SELECT DISTINCT pairs.log AS log, pairs.run AS run, other_log, other_run, one.uid AS uid,
                one.outcome AS outcome, one.end_us AS end_us
            FROM pairs
            JOIN results AS one ON pairs.log = one.log AND pairs.run = one.run
            JOIN near_results AS two
                ON pairs.other_log = two.log AND pairs.other_run = two.run AND one.uid = two.uid
                AND one.outcome = two.outcome AND CAST(FLOOR(one.end_us / 1000.0) AS BIGINT) = two.ms
            WHERE ABS(one.end_us - two.end_us) <= 1000
        ) AS found
        GROUP BY log, run, other_log, other_run
    ),
    compared AS (
        SELECT pairs.*, COALESCE(own.number, 0) AS number, COALESCE(other.number, 0) AS other_number,
            COALESCE(held.number, 0) AS held
        FROM pairs
        LEFT JOIN numbers AS own ON pairs.log = own.log AND pairs.run = own.run
        LEFT JOIN numbers AS other ON pairs.other_log = other.log AND pairs.other_run = other.run
        LEFT JOIN held
            ON pairs.log = held.log AND pairs.run = held.run
            AND pairs.other_log = held.other_log AND pairs.other_run = held.other_run
    )
    SELECT DISTINCT log, run
    FROM compared
    WHERE held = number AND (
        other_number > number OR (other_number = number AND (
        other_activations > activations OR (other_activations = activations AND (
        other_in_log > in_log OR (other_in_log = in_log AND (
        other_log < log OR (other_log = log AND other_run < run))))))))
    ORDER BY log, run
"""


def only(ask: Ask, condition: str) -> Ask:
    """Asks the same of some of the rows."""
    parts = ", ".join(f"{table} AS (SELECT * FROM main.{table} WHERE {condition})" for table in _OF_RUNS)
    return lambda question: ask(f"WITH {parts} {question}")


QUERIES: Final = {
    "runs": """
        SELECT {by}, COUNT(DISTINCT log) AS logs, COUNT(*) AS runs, COUNT(DISTINCT robot) AS robots,
            COUNT(DISTINCT tree) AS trees, MAX(nodes) AS nodes,
            MIN(start_us) AS start_us, MAX(end_us) AS end_us,
            SUM(CASE WHEN outcome = 'succeeded' THEN 1 ELSE 0 END) AS succeeded,
            SUM(CASE WHEN outcome = 'failed' THEN 1 ELSE 0 END) AS failed,
            SUM(CASE WHEN outcome = 'halted' THEN 1 ELSE 0 END) AS halted,
            SUM(CASE WHEN outcome = 'interrupted' THEN 1 ELSE 0 END) AS interrupted,
            SUM(retries) AS retries, MAX(retries) AS most_retries,
            SUM(recoveries) AS recoveries, MAX(recoveries) AS most_recoveries,
            SUM(CASE WHEN joined < nodes THEN 1 ELSE 0 END) AS partly_joined
        FROM runs
        GROUP BY {by}
        ORDER BY {by}
    """,
    # The runs that are not counted, for another log has them.
    "repeated": """
        SELECT {by}, COUNT(*) AS runs, COUNT(DISTINCT log) AS logs
        FROM repeated
        GROUP BY {by}
    """,
    # A clause at its nodes.  Its columns are the same in all logs, but for what happened in them.
    "clauses": """
        SELECT {by}, requirement, clause, node,
            MIN(clause_index) AS clause_index, MAX(title) AS title, MAX(measures) AS measures, MAX(counts) AS counts,
            MAX(unit) AS unit, MAX(odds) AS odds, MAX(relation) AS relation, MAX(experiments) AS experiments,
            MAX(confidence) AS confidence, MAX(last_number) AS last_number, MAX(last_of) AS last_of,
            MAX(last_seconds) AS last_seconds, MAX(rate_low) AS rate_low, MAX(rate_high) AS rate_high,
            MAX(rate_strict) AS rate_strict, MAX(rate_seconds) AS rate_seconds,
            MAX(mean_low) AS mean_low, MAX(mean_high) AS mean_high, MAX(mean_strict) AS mean_strict,
            MAX(CASE WHEN exercised THEN 1 ELSE 0 END) AS exercised,
            SUM(cut_off) AS cut_off, MIN(missing) AS missing,
            MIN(fingerprint) AS fingerprint, MAX(fingerprint) AS other_fingerprint
        FROM clauses
        GROUP BY {by}, requirement, clause, node
        ORDER BY {by}, clause_index, requirement, clause, node
    """,
    # What was counted of it, how far the measures are from their bounds, and the extreme ones.
    "verdicts": """
        SELECT {by}, requirement, clause, node,
            SUM(CASE WHEN counted AND verdict = 'satisfied' THEN 1 ELSE 0 END) AS kept,
            SUM(CASE WHEN counted AND verdict = 'violated' THEN 1 ELSE 0 END) AS violated,
            SUM(CASE WHEN counted AND verdict = 'unknown' THEN 1 ELSE 0 END) AS unclear,
            MIN(CASE WHEN verdict = 'unknown' THEN why END) AS why,
            MIN(CASE WHEN verdict = 'satisfied' AND most_si IS NULL THEN measured_si - bound_si END) AS least,
            MAX(CASE WHEN verdict = 'satisfied' AND most_si IS NULL THEN measured_si - bound_si END) AS most,
            MIN(CASE WHEN verdict = 'satisfied' AND most_si IS NULL THEN measured_si END) AS lowest,
            MAX(CASE WHEN verdict = 'satisfied' AND most_si IS NULL THEN measured_si END) AS highest,
            SUM(CASE WHEN most_si IS NULL THEN 0 ELSE 1 END) AS bounded, MAX(most_si) AS bounded_si,
            MAX(CASE WHEN most_si IS NOT NULL THEN bound_si END) AS bounded_bound_si,
            COUNT(middle) AS measured, SUM(middle) AS total, SUM(middle * middle) AS squares,
            SUM(half) AS halves, SUM(half * half) AS squared_halves,
            SUM(number) AS number, SUM(number_most) AS number_most,
            SUM(exposure_s) AS exposure_s, SUM(exposure_most_s) AS exposure_most_s
        FROM (
            SELECT *, (measured_si + COALESCE(most_si, measured_si)) / 2 AS middle,
                ABS(COALESCE(most_si, measured_si) - measured_si) / 2 AS half
            FROM verdicts
        ) AS measures
        GROUP BY {by}, requirement, clause, node
    """,
    # The violations furthest beyond their bounds, with their runs.
    "violations": """
        SELECT ranked.*, runs.source AS source, runs.start_us AS run_start_us
        FROM (
            SELECT *, ROW_NUMBER() OVER (
                PARTITION BY {by}, requirement, clause, node
                ORDER BY COALESCE(-ABS(measured_si - bound_si), 1), start_us, log, path
            ) AS place
            FROM verdicts
            WHERE verdict = 'violated' AND counted
        ) AS ranked
        JOIN runs ON ranked.log = runs.log AND ranked.run = runs.run
        WHERE place <= {violations}
        ORDER BY place
    """,
    # The judgements of clauses over the last runs, activations or hours, each with how many came later.
    "recent": """
        SELECT * FROM (
            SELECT {by_verdicts}, verdicts.requirement AS requirement, verdicts.clause AS clause,
                verdicts.node AS node, verdicts.log AS log, verdicts.run AS run, verdicts.path AS path,
                verdicts.end_us AS end_us, verdicts.at_us AS at_us, verdicts.verdict AS verdict,
                verdicts.measured_si AS measured_si, verdicts.bound_si AS bound_si, verdicts.why AS why,
                verdicts.most_si AS most_si, verdicts.number AS number, verdicts.number_most AS number_most,
                verdicts.exposure_s AS exposure_s, verdicts.exposure_most_s AS exposure_most_s,
                runs.source AS source, runs.start_us AS run_start_us, runs.end_us AS run_end_us,
                windows.last_number AS last_number, windows.last_of AS last_of, windows.last_seconds AS last_seconds,
                DENSE_RANK() OVER (
                    PARTITION BY {by_verdicts}, verdicts.requirement, verdicts.clause, verdicts.node
                    ORDER BY runs.start_us DESC, runs.log DESC, runs.run DESC
                ) AS runs_back,
                ROW_NUMBER() OVER (
                    PARTITION BY {by_verdicts}, verdicts.requirement, verdicts.clause, verdicts.node
                    ORDER BY runs.start_us DESC, verdicts.end_us DESC, runs.log DESC, runs.run DESC
                ) AS judgements_back,
                runs.last_us AS last_us
            FROM verdicts
            JOIN (
                SELECT DISTINCT log, mission, robot, requirement, clause, last_number, last_of, last_seconds
                FROM clauses
                WHERE last_number IS NOT NULL OR last_seconds IS NOT NULL
            ) AS windows
                ON verdicts.log = windows.log AND verdicts.mission = windows.mission
                AND verdicts.robot = windows.robot AND verdicts.requirement = windows.requirement
                AND verdicts.clause = windows.clause
            JOIN (SELECT *, MAX(end_us) OVER (PARTITION BY {by}) AS last_us FROM runs) AS runs
                ON verdicts.log = runs.log AND verdicts.run = runs.run
        ) AS placed
        WHERE (last_of = 'runs' AND runs_back <= last_number)
            OR (last_of = 'activations' AND judgements_back <= last_number)
            OR (last_seconds IS NOT NULL AND end_us >= last_us - last_seconds * 1000000)
        ORDER BY {by}, requirement, clause, node, run_start_us, log, run, end_us
    """,
}

# The last runs with a judgement of each clause, among the last thousand of the mission: the worst verdict of each, and
# the measure closest to its bound, or furthest beyond it.
BY_RUN: Final = """
    SELECT * FROM (
        SELECT worst.*, ROW_NUMBER() OVER (
            PARTITION BY {by}, requirement, clause, node ORDER BY run_start_us DESC, log DESC, run DESC
        ) AS back
        FROM (
            SELECT measures.*,
                MIN(rank) OVER (PARTITION BY {by}, requirement, clause, node, log, run) AS worst_rank,
                ROW_NUMBER() OVER (
                    PARTITION BY {by}, requirement, clause, node, log, run
                    ORDER BY CASE WHEN si IS NULL THEN 1 ELSE 0 END, rank,
                        CASE WHEN rank = 0 THEN -ABS(si - bound_si) ELSE ABS(si - bound_si) END
                ) AS place
            FROM (
                SELECT {by_verdicts}, requirement, clause, node, verdicts.log AS log, verdicts.run AS run,
                    recent.start_us AS run_start_us, bound_si,
                    CASE WHEN most_si IS NULL OR verdict = 'violated' THEN measured_si END AS si,
                    CASE WHEN verdict = 'violated' THEN 0 WHEN verdict = 'unknown' THEN 1 ELSE 2 END AS rank
                FROM verdicts
                JOIN (
                    SELECT log, run, start_us, ROW_NUMBER() OVER (
                        PARTITION BY mission ORDER BY start_us DESC, log DESC, run DESC
                    ) AS back
                    FROM runs
                ) AS recent
                    ON verdicts.log = recent.log AND verdicts.run = recent.run
                WHERE recent.back <= 1000
            ) AS measures
        ) AS worst
        WHERE place = 1
    ) AS placed
    WHERE back <= {most}
    ORDER BY back DESC
"""

# What an overview shows beside the verdicts.
OVERVIEW: Final = {
    # The labels in the order of time.
    "labels": """
        SELECT label, MIN(start_us) AS first_us, MAX(start_us) AS last_us
        FROM runs
        GROUP BY label
        ORDER BY first_us, label
    """,
    # What happened in each step of the time.
    "runs": """
        SELECT mission, CAST(FLOOR((start_us - {origin}) / {step}.0) AS BIGINT) AS place, COUNT(*) AS runs,
            SUM(CASE WHEN outcome = 'failed' THEN 1 ELSE 0 END) AS failed,
            SUM(retries) AS retries, SUM(recoveries) AS recoveries
        FROM runs
        GROUP BY mission, place
    """,
    "verdicts": """
        SELECT verdicts.mission AS mission, verdicts.requirement AS requirement,
            CAST(FLOOR((start_us - {origin}) / {step}.0) AS BIGINT) AS place,
            COUNT(*) AS judged, SUM(CASE WHEN verdict = 'violated' THEN 1 ELSE 0 END) AS violated
        FROM verdicts
        LEFT JOIN (
            SELECT DISTINCT mission, requirement, clause, node, 1 AS pooled
            FROM clauses
            WHERE rate_seconds IS NOT NULL OR mean_strict IS NOT NULL
        ) AS pooled
            ON verdicts.mission = pooled.mission AND verdicts.requirement = pooled.requirement
            AND verdicts.clause = pooled.clause AND verdicts.node = pooled.node
        WHERE counted AND verdict <> 'unknown' AND pooled IS NULL
        GROUP BY verdicts.mission, verdicts.requirement, place
    """,
    # The clauses that measured something, in their order, and the extreme bounds.
    "measured": """
        SELECT clauses.mission AS mission, clauses.requirement AS requirement, clauses.clause AS clause,
            clauses.node AS node, MIN(clauses.clause_index) AS clause_index, MAX(clauses.unit) AS unit,
            MIN(bounds.least_si) AS least_si, MAX(bounds.most_si) AS most_si,
            MAX(clauses.lower_si) AS lower_si, MAX(clauses.upper_si) AS upper_si, MAX(clauses.goal_si) AS goal_si,
            MAX(clauses.mean_strict) AS mean_strict
        FROM clauses
        JOIN (
            SELECT mission, requirement, clause, node, MIN(bound_si) AS least_si, MAX(bound_si) AS most_si
            FROM verdicts
            WHERE measured_si IS NOT NULL
            GROUP BY mission, requirement, clause, node
        ) AS bounds
            ON clauses.mission = bounds.mission AND clauses.requirement = bounds.requirement
            AND clauses.clause = bounds.clause AND clauses.node = bounds.node
        GROUP BY clauses.mission, clauses.requirement, clauses.clause, clauses.node
        ORDER BY mission, clause_index, requirement, clause, node
    """,
    # Of those that did in few runs, the value of each run that is the furthest beyond the bound, or the closest to it.
    "measured_runs": """
        SELECT ranked.*, runs.label AS run_label, runs.start_us AS run_start_us
        FROM (
            SELECT verdicts.*, ROW_NUMBER() OVER (
                PARTITION BY verdicts.mission, verdicts.requirement, verdicts.clause, verdicts.node,
                    verdicts.log, verdicts.run
                ORDER BY
                    CASE WHEN verdict = 'violated' THEN -ABS(measured_si - bound_si)
                        ELSE ABS(measured_si - bound_si) END,
                    measured_si
            ) AS place
            FROM verdicts
            JOIN (
                SELECT mission, requirement, clause, node
                FROM (
                    SELECT DISTINCT mission, requirement, clause, node, log, run
                    FROM verdicts
                    WHERE measured_si IS NOT NULL
                ) AS of_runs
                GROUP BY mission, requirement, clause, node
                HAVING COUNT(*) <= {runs}
            ) AS few
                ON verdicts.mission = few.mission AND verdicts.requirement = few.requirement
                AND verdicts.clause = few.clause AND verdicts.node = few.node
            WHERE measured_si IS NOT NULL AND (most_si IS NULL OR verdict = 'violated')
        ) AS ranked
        JOIN runs ON ranked.log = runs.log AND ranked.run = runs.run
        WHERE place = 1
    """,
    # The same of each step of the time, and the median: the smallest value that half of them do not exceed.  Steps are
    # numbered, for to rank values by texts takes twice as long.
    "measured_steps": """
        WITH placed AS (
            SELECT mission, requirement, clause, node, measured_si,
                CAST(FLOOR((start_us - {origin}) / {step}.0) AS BIGINT) AS place,
                CASE WHEN verdict = 'violated' THEN -ABS(measured_si - bound_si)
                    ELSE ABS(measured_si - bound_si) END AS excess
            FROM verdicts
            WHERE measured_si IS NOT NULL AND (most_si IS NULL OR verdict = 'violated')
        ),
        steps AS (
            SELECT of_places.*, ROW_NUMBER() OVER (ORDER BY mission, requirement, clause, node, place) AS id
            FROM (
                SELECT mission, requirement, clause, node, place, COUNT(*) AS number, MIN(excess) AS least
                FROM placed
                GROUP BY mission, requirement, clause, node, place
            ) AS of_places
        ),
        ranked AS (
            SELECT id, number, least, excess, measured_si,
                ROW_NUMBER() OVER (PARTITION BY id ORDER BY measured_si) AS by_size
            FROM placed
            JOIN steps
                ON placed.mission = steps.mission AND placed.requirement = steps.requirement
                AND placed.clause = steps.clause AND placed.node = steps.node AND placed.place = steps.place
        ),
        found AS (
            SELECT id, MIN(CASE WHEN excess = least THEN measured_si END) AS worst_si,
                MIN(CASE WHEN by_size * 2 >= number THEN measured_si END) AS median_si
            FROM ranked
            GROUP BY id
        )
        SELECT mission, requirement, clause, node, place, worst_si, median_si
        FROM steps
        JOIN found ON steps.id = found.id
    """,
    # The means of runs, of clauses about a mean that few runs measured.
    "mean_runs": """
        SELECT means.*, runs.label AS run_label, runs.start_us AS run_start_us
        FROM (
            SELECT verdicts.mission AS mission, verdicts.requirement AS requirement, verdicts.clause AS clause,
                verdicts.node AS node, log, run, AVG((measured_si + COALESCE(most_si, measured_si)) / 2) AS measured_si
            FROM verdicts
            JOIN (
                SELECT mission, requirement, clause, node
                FROM (
                    SELECT DISTINCT verdicts.mission AS mission, verdicts.requirement AS requirement,
                        verdicts.clause AS clause, verdicts.node AS node, verdicts.log AS log, verdicts.run AS run
                    FROM verdicts
                    JOIN clauses
                        ON verdicts.log = clauses.log AND verdicts.mission = clauses.mission
                        AND verdicts.requirement = clauses.requirement AND verdicts.clause = clauses.clause
                        AND verdicts.node = clauses.node
                    WHERE measured_si IS NOT NULL AND mean_strict IS NOT NULL
                ) AS of_runs
                GROUP BY mission, requirement, clause, node
                HAVING COUNT(*) <= {runs}
            ) AS few
                ON verdicts.mission = few.mission AND verdicts.requirement = few.requirement
                AND verdicts.clause = few.clause AND verdicts.node = few.node
            WHERE measured_si IS NOT NULL
            GROUP BY verdicts.mission, verdicts.requirement, verdicts.clause, verdicts.node, log, run
        ) AS means
        JOIN runs ON means.log = runs.log AND means.run = runs.run
    """,
    # Of each step of the time what clauses about a mean or a failure rate come to.
    "pooled_steps": """
        SELECT verdicts.mission AS mission, verdicts.requirement AS requirement, verdicts.clause AS clause,
            verdicts.node AS node, CAST(FLOOR((start_us - {origin}) / {step}.0) AS BIGINT) AS place,
            AVG((measured_si + COALESCE(most_si, measured_si)) / 2) AS mean_si,
            SUM(number) AS number, SUM(exposure_s) AS seconds
        FROM verdicts
        JOIN (
            SELECT DISTINCT mission, requirement, clause, node
            FROM clauses
            WHERE rate_seconds IS NOT NULL OR mean_strict IS NOT NULL
        ) AS pooled
            ON verdicts.mission = pooled.mission AND verdicts.requirement = pooled.requirement
            AND verdicts.clause = pooled.clause AND verdicts.node = pooled.node
        GROUP BY verdicts.mission, verdicts.requirement, verdicts.clause, verdicts.node, place
    """,
    # The clauses about a failure rate.
    "rates": """
        SELECT mission, requirement, clause, node, MIN(clause_index) AS clause_index, MAX(unit) AS unit,
            MAX(rate_low) AS lower_si, MAX(rate_high) AS upper_si, MAX(rate_seconds) AS rate_seconds,
            MAX(goal_si) AS goal_si
        FROM clauses
        WHERE rate_seconds IS NOT NULL
        GROUP BY mission, requirement, clause, node
    """,
    # Where failures began.
    "failures": """
        SELECT mission, label, failure AS node, COUNT(*) AS runs
        FROM runs
        WHERE outcome = 'failed'
        GROUP BY mission, label, failure
    """,
    # In how many runs each node was active, and how many were at all.
    "nodes": """
        SELECT mission, label, node, COUNT(*) AS runs
        FROM (SELECT DISTINCT mission, label, node, log, run FROM activations) AS active
        GROUP BY mission, label, node
    """,
    "exercised": """
        SELECT {by}, COUNT(DISTINCT uid) AS nodes
        FROM activations
        GROUP BY {by}
    """,
}
_OF_RUNS: Final = ("runs", "repeated", "clauses", "verdicts")
