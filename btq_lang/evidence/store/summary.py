"""The report of a whole store, or of its parts: the verdicts of all runs, counted by the engine.

One invariant: what is loaded are counts, a few violations of each clause, and what windows such as `over last 200 runs`
cover; and verdicts come from counts as for logs (`tally.py`, `clause.verdict_of`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from operator import itemgetter
from typing import Final

from btq_lang.catalog.units import Unit, parse_unit
from btq_lang.diagnostics.model import Place
from btq_lang.evidence.amounts import Amounts
from btq_lang.evidence.clause_findings import verdict_of
from btq_lang.evidence.conditions import Measure
from btq_lang.evidence.meanings import NO_MEANINGS, Meanings, is_suspect
from btq_lang.evidence.means import Mean
from btq_lang.evidence.odds import Limits
from btq_lang.evidence.rates import PoolBound, Rate
from btq_lang.evidence.store.queries import BY_RUN, QUERIES, Ask, Row
from btq_lang.evidence.tally import MOST_RUNS, Run, Tally
from btq_lang.evidence.verbs import Judgement
from btq_lang.evidence.verdicts import (
    OPEN,
    OUTCOMES,
    SATISFIED,
    UNKNOWN,
    VIOLATED,
    Bounded,
    ClauseVerdict,
    EvidenceFile,
    MissionVerdicts,
    Repeats,
    RequirementVerdict,
    RunValue,
    Verdict,
    VerdictReport,
    Violation,
    Worst,
    worst_of,
)
from btq_lang.evidence.wording import measured, quantity
from btq_lang.requirements.model import Quantity, ResolvedOdds
from btq_lang.util.grouping import grouped
from btq_lang.util.text import Span, counted

_VIOLATIONS: Final = 10  # named of each clause


def summary(
    ask: Ask, store: str, parts: Sequence[str] = (), *, by_run: bool = False, meanings: Meanings = NO_MEANINGS
) -> VerdictReport:
    """The verdicts of all runs in a store.

    Args:
        ask: gives an engine a question.
        store: its name, as people read it.
        parts: `label` and `robot`, as far as those have verdicts of their own.
        by_run, meanings: as in `parted`.
    """
    missions = parted(ask, store, parts, by_run=by_run, meanings=meanings)
    return VerdictReport(tuple(mission for _, mission in missions), (), ())


def parted(
    ask: Ask,
    store: str,
    parts: Sequence[str],
    violations: int = _VIOLATIONS,
    *,
    by_run: bool = False,
    meanings: Meanings = NO_MEANINGS,
) -> Iterator[tuple[Row, MissionVerdicts]]:
    """What happened in the runs of each mission and part, as counts, and their verdicts.

    Args:
        violations: how many of each clause are named.
        by_run: what the last runs show of each clause is asked for, too.
        meanings: of requirements now; the verdicts on those that meant something else are suspect.
    """
    by = ("mission", *parts)
    columns = {"by": ", ".join(by), "by_verdicts": ", ".join(f"verdicts.{column}" for column in by)}
    columns["violations"], columns["most"] = str(violations), str(MOST_RUNS)
    rows_by_question = {name: ask(text.format(**columns)) for name, text in QUERIES.items()}
    part_of, clause_of = itemgetter(*by), itemgetter(*by, "requirement", "clause", "node")
    counts = {clause_of(row): row for row in rows_by_question["verdicts"]}
    broken, recent = (
        grouped((clause_of(row), row) for row in rows_by_question[name]) for name in ("violations", "recent")
    )
    runs = grouped((clause_of(row), row) for row in ask(BY_RUN.format(**columns))) if by_run else {}
    clauses = grouped((part_of(row), row) for row in rows_by_question["clauses"])
    repeated = {part_of(row): row for row in rows_by_question["repeated"]}
    for part in rows_by_question["runs"]:
        judged: dict[str, list[ClauseVerdict]] = {}
        titles = {}
        meant: dict[str, set[str]] = {}
        for row in clauses.get(part_of(part), ()):
            key = clause_of(row)
            verdict = _verdict(row, counts.get(key), broken.get(key, ()), recent.get(key, ()), runs.get(key, ()))
            judged.setdefault(row["requirement"], []).append(verdict)
            titles[row["requirement"]] = row["title"] or ""
            fingerprints = {row["fingerprint"], row["other_fingerprint"]} - {None, ""}
            meant.setdefault(row["requirement"], set()).update(fingerprints)
        requirements = [
            RequirementVerdict(
                name,
                titles[name],
                worst_of(verdict.verdict for verdict in verdicts),
                tuple(verdicts),
                fingerprints=tuple(sorted(meant[name])),
                is_suspect=is_suspect(meant[name], meanings.get((part["mission"], name))),
            )
            for name, verdicts in judged.items()
        ]
        yield part, _mission(part, parts, store, requirements, repeated.get(part_of(part)))


def _mission(
    part: Row, parts: Sequence[str], store: str, requirements: Sequence[RequirementVerdict], repeated: Row | None
) -> MissionVerdicts:
    """A mission in a part of the store; `repeated`: the runs that are not counted."""
    named = [f"{part_name} {part[part_name] or '(none)'}" for part_name in parts]
    identity = [counted(int(part["logs"]), "log")]
    if part["partly_joined"]:
        identity.append(f"{counted(int(part['partly_joined']), 'run')} of another version")
    remarks = []
    if repeated is not None:
        number, logs = counted(int(repeated["runs"]), "run"), counted(int(repeated["logs"]), "log")
        remarks.append(f"{number} of {logs} also in others of the same label, and not counted again")
    source = EvidenceFile(
        file=store,
        runs=int(part["runs"]),
        first_run=1,
        begin=part["start_us"],
        end=part["end_us"],
        identity=", ".join(identity),
        joined=0,
        nodes=0,
        remarks=tuple(remarks),
    )
    return MissionVerdicts(
        name=", ".join([part["mission"], *named]),
        file="",
        sources=(source,),
        requirements=tuple(requirements),
        outcomes=tuple((outcome, int(part[outcome])) for outcome in OUTCOMES.values() if part[outcome]),
        nodes=(),
        contexts=(),
        retries=Repeats(int(part["retries"]), int(part["most_retries"]), None),
        recoveries=Repeats(int(part["recoveries"]), int(part["most_recoveries"]), None),
    )


def _verdict(
    row: Row, counts: Row | None, broken: Sequence[Row], recent: Sequence[Row], runs: Sequence[Row]
) -> ClauseVerdict:
    """The verdict on a clause.

    Args:
        row: of the clause.
        counts: of its judgements; None without any.
        broken: its violations, the worst first.
        recent: the judgements that its window covers.
        runs: what the last runs show of it.
    """
    unit = _unit(row)
    is_windowed = row["last_number"] is not None or row["last_seconds"] is not None
    tally = _recent(row, recent, unit) if is_windowed else _counted(row, counts, broken, unit)
    tally.by_run.extend(RunValue(run["run"], run["run_start_us"], _RANKS[run["worst_rank"]], run["si"]) for run in runs)
    verdict, why = verdict_of(tally, row["missing"] or "", bool(row["exercised"]))
    is_open = row["counts"] == OPEN
    return ClauseVerdict(
        text=row["clause"],
        path=row["node"],
        of=row["measures"] or "",
        verdict=OPEN if is_open else verdict,
        why=why,
        unit="activations" if is_open else row["counts"],
        confidence=row["confidence"],
        histogram=None,
        **tally.fields(),
    )


def _unit(row: Row) -> Unit:
    unit = parse_unit(row["unit"] or "1")
    assert unit is not None, "a unit of the table, as it was written"
    return unit


def _amounts(row: Row) -> Amounts | None:
    """What some runs add to a failure rate."""
    if row["number"] is None:
        return None
    times = (round(row[name] * 1e6) for name in ("exposure_s", "exposure_most_s"))
    return Amounts(int(row["number"]), int(row["number_most"]), *times)


def _counted(row: Row, counts: Row | None, broken: Sequence[Row], unit: Unit) -> Tally:
    """The tally of a clause whose judgements all count."""
    tally = _tally(row)
    if counts is None:
        return tally
    tally.violated, tally.unknown = int(counts["violated"]), int(counts["unclear"])
    tally.counted = int(counts["kept"]) + tally.violated
    tally.why = counts["why"] or ""
    if isinstance(tally.pool, Rate) and (amounts := _amounts(counts)) is not None:
        tally.pool.add(amounts)
    elif isinstance(tally.pool, Mean) and counts["measured"]:
        number, total, squares = counts["measured"], counts["total"], counts["squares"]
        bound = tally.pool.demanded.value
        beyond = total - number * bound, squares - 2 * bound * total + number * bound * bound
        tally.pool.add((number, *beyond, counts["halves"], counts["squared_halves"]))
    tally.violations.extend(_violation(violation, unit) for violation in broken)
    if counts["bounded"]:
        si, bound = counts["bounded_si"], counts["bounded_bound_si"]
        tally.bounded = Bounded(int(counts["bounded"]), si, measured(si, unit, bound))
    worst = broken[0] if broken else None
    if worst is None:
        tally.worst = _closest(counts, unit)
    elif worst["measured_si"] is not None:
        si = worst["measured_si"]
        tally.worst = Worst(si, measured(si, unit, worst["bound_si"]), worst["run"])
    return tally


def _closest(counts: Row, unit: Unit) -> Worst | None:
    """The measure closest to its bound, where all of them hold; None if the bound varies."""
    least, most, lowest, highest = (counts[name] for name in ("least", "most", "lowest", "highest"))
    if most is None or abs((highest - lowest) - (most - least)) > _SAME * max(abs(highest), abs(lowest)):
        return None
    si, beyond = (highest, most) if abs(most) <= abs(least) else (lowest, least)
    return Worst(si, measured(si, unit, si - beyond), None)


def _recent(row: Row, judgements: Sequence[Row], unit: Unit) -> Tally:
    """The tally of a clause of whose judgements only the last ones count."""
    tally = _tally(row)
    for (_, number), rows_of_run in groupby(judgements, key=lambda row: (row["log"], row["run"])):
        of_run = [*rows_of_run]
        for judged in of_run:
            holds = None if judged["verdict"] == UNKNOWN else judged["verdict"] == SATISFIED
            most = _measure({**judged, "measured_si": judged["most_si"]}, unit)
            judgement = Judgement(holds, judged["at_us"] or 0, judged["why"] or "", _measure(judged, unit), most=most)
            judgement = judgement._replace(amounts=_amounts(judged))
            tally.add(judgement, judged["path"], judged["end_us"], ())
        first = of_run[0]
        tally.end_run(Run(number, first["source"], first["run_start_us"], first["run_end_us"]))
    return tally


def _tally(row: Row) -> Tally:
    """An empty tally for a clause."""
    odds = None
    if row["odds"] is not None:
        odds = ResolvedOdds(row["relation"], row["odds"], row["experiments"], "", Place(Span(0, 0)))
    is_of_odds = odds is None or odds.experiments == row["last_of"]
    is_windowed = row["last_number"] is not None or row["last_seconds"] is not None
    limits: Limits = "window" if is_windowed else "every look"  # a store is looked at again when it has grown
    pool: Rate | Mean | None = None
    if row["mean_strict"] is not None:
        bounds = row["mean_low"], row["mean_high"], row["mean_strict"]
        pool = Mean(PoolBound.of_columns(*bounds, 0.0, _unit(row)), row["confidence"])
    if row["rate_seconds"] is not None:
        bounds = row["rate_low"], row["rate_high"], row["rate_strict"]
        pool = Rate(PoolBound.of_columns(*bounds, row["rate_seconds"], _unit(row)), row["confidence"])
    tally = Tally(odds, row["confidence"], limits, row["last_number"] if is_of_odds else None, pool)
    tally.cut_off = int(row["cut_off"])
    return tally


def _violation(row: Row, unit: Unit) -> Violation:
    si, bound = row["measured_si"], row["bound_si"]
    value = measured(si, unit, bound) if si is not None else ""
    return Violation(
        run=row["run"],
        source=row["source"],
        path=row["path"],
        start=row["run_start_us"],
        at=(row["at_us"] - row["run_start_us"]) / 1e6,
        measured=value,
        bound=quantity(bound, unit) if si is not None else "",
        why=(row["why"] or "").replace("{}", value),
        chain=(),
    )


def _measure(row: Row, unit: Unit) -> Measure | None:
    """What was measured, on the side of its bound that the verdict tells."""
    si, bound = row["measured_si"], row["bound_si"]
    if si is None:
        return None
    relation = ">=" if (si > bound) == (row["verdict"] == SATISFIED) else "<="
    return Measure(si, relation, Quantity(quantity(bound, unit), bound, unit), unit)


_RANKS: Final[tuple[Verdict, ...]] = (VIOLATED, UNKNOWN, SATISFIED)  # as in `BY_RUN`
_SAME: Final = 1e-9  # of the larger value: what subtracting and adding a bound may round off
