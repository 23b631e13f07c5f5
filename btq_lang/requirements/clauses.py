"""The clauses of a requirement, resolved: what each verb demands, and what applies to all its claims.

One invariant: a claim that could not be understood as a whole is left out, and a problem reports why; what is left can
be checked, enforced and judged without its source.  Scopes, odds and the rest belong to the requirement, so they apply
to all of its claims, wherever they are among them.
"""

from __future__ import annotations

from math import inf
from typing import Final

from btq_lang.catalog.units import Dimension, a_dimension, parse_unit
from btq_lang.catalog.verbs import VERBS
from btq_lang.diagnostics.model import Place, replace_fix
from btq_lang.requirements import model, nodes
from btq_lang.requirements.metadata import metadata_of
from btq_lang.requirements.pooled import judged_together, on_average
from btq_lang.requirements.reader import Reader
from btq_lang.requirements.shares import of_time
from btq_lang.requirements.terms import COUNT, DURATION, PERCENT, SORTS, TIME, Wanted, sort_of
from btq_lang.requirements.visits import visits_of
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tokens import NAME
from btq_lang.util.record import replace
from btq_lang.util.text import Span


def with_clauses(
    reader: Reader, requirement: model.ResolvedRequirement, clauses: tuple[syntax.Clause, ...]
) -> model.ResolvedRequirement:
    """A requirement with these clauses resolved; of clauses that may occur once, the first counts."""
    claims: list[model.ResolvedClaim] = []
    unread: list[str] = []
    scopes: list[model.ResolvedScope] = []
    assumptions: list[model.ResolvedScope] = []
    once: dict[str, object] = {}
    reasons: list[str] = []
    metadata: list[syntax.Clause] = []
    goals: list[syntax.Goal] = []

    def keep(field: str, value: object) -> None:
        if value is not None:
            once.setdefault(field, value)

    for clause in clauses:
        if isinstance(clause, syntax.Claim):
            claim = claim_of(reader, clause)
            if claim is not None:
                claims.append(claim)
            else:
                unread.append(reader.text(clause.start, clause.end))
        elif isinstance(clause, syntax.ScopeClause):
            condition = reader.condition(clause.condition)
            if condition is not None:
                word = "while" if clause.word.raw == "while" else "when"
                scopes.append(model.ResolvedScope(word, condition, reader.text(clause.start, clause.end)))  # type: ignore[arg-type]  # one of the two
        elif isinstance(clause, syntax.Assuming):
            condition = reader.condition(clause.condition)
            if condition is not None:
                text = reader.text(clause.start, clause.end)
                assumptions.append(model.ResolvedScope("assuming", condition, text))
        elif isinstance(clause, syntax.FromUntil):
            keep("span", _span(reader, clause))
        elif isinstance(clause, syntax.Average):
            keep("average", reader.place(Span(clause.start, clause.end)))
        elif isinstance(clause, syntax.Odds):
            keep("share" if clause.is_of_time else "odds", _odds(reader, clause))
        elif isinstance(clause, syntax.Confidence):
            keep("confidence", _confidence(reader, clause))
        elif isinstance(clause, syntax.Window):
            keep("window", _window(reader, clause))
        elif isinstance(clause, syntax.OnViolation) and clause.action is not None:
            keep("action", clause.action.raw)
        elif isinstance(clause, syntax.Goal):
            goals.append(clause)
        elif isinstance(clause, syntax.Because) and clause.text is not None:
            reasons.append(clause.text.text)
        elif isinstance(clause, syntax.How) and clause.ways:
            keep("ways", tuple(_way(way) for way in clause.ways))
        elif type(clause) in syntax.METADATA:
            metadata.append(clause)
    if any(isinstance(clause, syntax.FromUntil) for clause in clauses) and "span" not in once:
        unread += [claim.text for claim in claims]  # at other times they may be violated
        claims.clear()
    if isinstance(share := once.pop("share", None), model.ResolvedOdds):
        claims, not_of_time = of_time(reader, claims, share)
        unread += not_of_time
    if isinstance(average := once.pop("average", None), Place):
        claims, without_mean = on_average(reader, claims, average.span)
        unread += without_mean
    claims, not_together = judged_together(reader, claims, once.get("odds"))
    unread += not_together
    if goals:
        once["goal"] = reader.bounded(goals[0].value, _of_goal(claims, "odds" in once))
    if metadata:
        once |= metadata_of(reader, metadata)
    return replace(
        requirement,
        claims=(*requirement.claims, *claims),
        unread=(*requirement.unread, *unread),
        scopes=(*requirement.scopes, *scopes),
        assumptions=(*requirement.assumptions, *assumptions),
        reasons=(*requirement.reasons, *reasons),
        **once,
    )


def _way(written: syntax.Way) -> model.ResolvedWay:
    return model.ResolvedWay(written.method.raw, written.id.text if written.id is not None else None)  # type: ignore[arg-type]  # the parser's words


def claim_of(reader: Reader, written: syntax.Claim) -> model.ResolvedClaim | None:
    """What a claim demands; None if a part of it was not understood."""
    subject: model.Subject | None = None
    if written.subject is not None:
        subject = _subject(reader, written.subject)
        if subject is None:
            # What follows is read all the same: one mistake does not hide the next.
            _verb(reader, written)
            return None
    claim = _verb(reader, written)
    return claim if claim is None or subject is None else replace(claim, subject=subject)


def _verb(reader: Reader, written: syntax.Claim) -> model.ResolvedClaim | None:
    place = reader.place(Span(written.start, written.end))
    claim = model.ResolvedClaim(written.row, reader.text(written.start, written.end), place)
    operand = VERBS[claim.verb].operand
    if operand == "condition":
        condition = reader.condition(written.condition)
        return replace(claim, condition=condition) if condition is not None else None
    if operand == "stretch":
        condition, limit = reader.condition(written.condition), _limit(reader, written.bound, DURATION)
        return replace(claim, condition=condition, limit=limit) if condition is not None and limit is not None else None
    if operand == "visits":
        visits = visits_of(reader, written.visits)
        return replace(claim, visits=visits, in_order=written.order is not None) if visits is not None else None
    if operand == "event":
        event = _event(reader, written.event)
        return replace(claim, event=event) if event is not None else None
    if operand == "deadline" and written.bound is None:
        return claim
    if operand == "answer":
        return _followed(reader, written, claim)
    signal: model.ResolvedSignal | None = None
    wanted: Wanted | None = DURATION if operand in _TIMED or written.every else _COUNTED
    if operand == "use":
        signal, wanted = _resource(reader, written.resource)
    limit = _limit(reader, written.bound, wanted) if wanted is not None else None
    if limit is None:
        return None
    claim = replace(claim, limit=limit, signal=signal, every=written.every)
    if operand == "reaction":
        event = _event(reader, written.event)
        return replace(claim, event=event) if event is not None else None
    if operand == "count" and isinstance(written.per, syntax.Word):  # `run`
        return claim
    if written.of is not None:
        of = reader.target(written.of)
        if of is None:
            return None
        claim = replace(claim, of=of)
    per = _per(reader, written)
    if per is None and (written.per is not None or written.form or (operand == "rate" and not written.every)):
        return None
    return claim if per is None else replace(claim, per=per)


def _followed(reader: Reader, written: syntax.Claim, claim: model.ResolvedClaim) -> model.ResolvedClaim | None:
    """What follows an event: another one, or a condition that holds, and by when."""
    event = _event(reader, written.event)
    condition = reader.condition(written.condition) if written.condition is not None else None
    limit = _limit(reader, written.bound, DURATION)
    if (event is None and condition is None) or (limit is None and written.bound is not None):
        return None
    return replace(claim, event=event, condition=condition, limit=limit)


def _resource(reader: Reader, word: syntax.Word | None) -> tuple[model.ResolvedSignal | None, Wanted | None]:
    """The signal that is used up, and the kind of its difference over an activation."""
    if word is None:
        return None, None
    signal = reader.signal(word.text)
    if signal is None:
        reader.unknown(word, ("signals",))
        return None, None
    if signal.sort != "number":
        message = f"`uses` requires a number, but `{signal.name}` is {SORTS[signal.sort]}"
        reader.complain("unit-mismatch", word.span, message)
        return None, None
    if signal.unit is None:
        return None, None
    unit = "K" if signal.unit.offset else signal.unit.symbol
    plain = signal.unit.dimension == model.NO_DIMENSION
    what = f"{a_dimension(signal.unit)} (the dimension of `{signal.name}`)"
    return signal, Wanted(what, (signal.unit.dimension,), None if plain else unit, "difference")


def _limit(reader: Reader, written: syntax.Bound | None, wanted: Wanted) -> model.Limit | None:
    if written is None:
        return None
    value = reader.bounded(written.value, wanted)
    upper = reader.bounded(written.upper, wanted)
    if value is None or (written.relation == "between" and upper is None):
        return None
    return model.Limit(written.relation, value, upper)  # type: ignore[arg-type]  # the parser's relations


def _per(reader: Reader, claim: syntax.Claim) -> model.NodeTarget | model.Quantity | None:
    written = claim.per
    if isinstance(written, syntax.Path):
        if (unit := rate_unit(claim)) and not reader.find((unit,)):
            message = f"there is no node `{unit}`; a failure rate is per a time: `per 1 {unit}`"
            fix = replace_fix(f"Write `per 1 {unit}`", written.span, f"1 {unit}", safe=True)
            reader.complain("unmatched-path", written.span, message, fixes=(fix,))
            return None
        is_run = written.names[-1].text.lower() in _RUN
        return reader.target(written, ("write `per run`",) if is_run else ())
    return reader.quantity(written, DURATION) if written is not None else None


def rate_unit(claim: syntax.Claim) -> str:
    """The unit of time in `fails at most 1 per h`, unless it is the name of a node; else empty."""
    names = claim.per.names if isinstance(claim.per, syntax.Path) and claim.verb.raw == "fails" else ()
    unit = parse_unit(names[0].text) if len(names) == 1 and names[0].kind == NAME else None
    return names[0].text if unit is not None and unit.dimension == TIME else ""


_RUN = frozenset(("mission", "run", "execution", "trial", "tree"))


def _event(
    reader: Reader, written: syntax.Event | syntax.AnyEvent | None
) -> model.ResolvedEvent | model.ResolvedAnyEvent | None:
    if not isinstance(written, syntax.AnyEvent):
        return _event_atom(reader, written)
    atoms = [_event_atom(reader, atom) for atom in written.atoms]
    understood = tuple(atom for atom in atoms if atom is not None)
    return model.ResolvedAnyEvent(understood) if len(understood) == len(atoms) else None


def _event_atom(reader: Reader, written: syntax.Event | None) -> model.ResolvedEvent | None:
    if written is None:
        return None
    if written.happening == "when":
        condition = reader.condition(written.condition)
        return model.ResolvedEvent("when", None, condition) if condition is not None else None
    subject: model.NodeTarget | model.MissionRun | None = model.MissionRun(reader.mission)
    if written.path is not None:
        asked = Span(written.start, written.end), f"{{}} {written.happening}"
        subject = reader.target(written.path, asked=asked)
    return model.ResolvedEvent(written.happening, subject) if subject is not None else None  # type: ignore[arg-type]  # the parser's words


def _subject(reader: Reader, written: syntax.Subject) -> model.Subject | None:
    if isinstance(written, syntax.Path):
        return reader.target(written)
    if isinstance(written, syntax.Mission):
        return model.MissionRun(reader.mission)
    if isinstance(written, syntax.Every):
        if not reader.store.ask(nodes.has_any, reader.viewpoint, written.name.text):
            reader.report_unknown_kind(written.name)
            return None
        return model.EveryNode(written.name.text)
    if isinstance(written, syntax.Between):
        first, last = _event(reader, written.first), _event(reader, written.last)
        return model.Interval(first, last) if first is not None and last is not None else None
    if isinstance(written, syntax.EachEvent):
        event = _event(reader, written.event)
        return model.ResolvedEachEvent(event) if event is not None else None
    assert isinstance(written, syntax.Sum), "the last kind of subject"
    targets = [reader.target(path) for path in written.paths]
    nodes_named = tuple(target for target in targets if target is not None)
    return model.DurationSum(nodes_named) if len(nodes_named) == len(targets) else None


def _span(reader: Reader, written: syntax.FromUntil) -> model.ResolvedSpan | None:
    first, last = _event(reader, written.first), _event(reader, written.last)
    if first is None or last is None:
        return None
    return model.ResolvedSpan(first, last, reader.text(written.start, written.end))


def _odds(reader: Reader, written: syntax.Odds) -> model.ResolvedOdds | None:
    share = reader.quantity(written.value, _SHARE)
    if share is None or written.value is None:
        return None
    if not 0.0 < share.si <= 1.0:
        message = f"expected a probability above 0 and up to 100 %, found `{written.value.raw}`"
        reader.complain("impossible-odds", written.value.span, message)
        return None
    experiments = written.experiments.raw if written.experiments is not None else "activations"
    text = reader.text(written.start, written.end)
    place = reader.place(Span(written.start, written.end))
    return model.ResolvedOdds(written.relation, share.si, experiments, text, place)  # type: ignore[arg-type]  # the parser's words


def _confidence(reader: Reader, written: syntax.Confidence) -> float | None:
    share = reader.quantity(written.value, _SHARE)
    if share is None or written.value is None:
        return None
    if not 0.0 < share.si < 1.0:
        message = f"expected a confidence above 0 and below 100 %, found `{written.value.raw}`"
        reader.complain("impossible-odds", written.value.span, message)
        return None
    return share.si


def _window(reader: Reader, written: syntax.Window) -> model.ResolvedWindow | None:
    if written.size is None:
        return None
    text = reader.text(written.start, written.end)
    place = reader.place(Span(written.start, written.end))
    if written.experiments is not None:
        count = float(written.size.raw)
        if not 1 <= count < inf or count != int(count):
            message = f"expected a positive whole number, found `{written.size.raw}`"
            reader.complain("impossible-odds", written.size.span, message)
            return None
        of_runs = written.experiments.raw == "runs"
        return model.ResolvedWindow(int(count), "runs" if of_runs else "activations", None, text, place)
    duration = reader.quantity(written.size, DURATION)
    return model.ResolvedWindow(None, "activations", duration.si, text, place) if duration is not None else None


def _of_goal(claims: list[model.ResolvedClaim], has_odds: bool) -> Wanted | None:
    """What a goal measures: the same as the bounds, with odds perhaps a probability; None: anything."""
    dimensions: dict[Dimension, str | None] = {PERCENT: "%"} if has_odds else {}
    for claim in claims:
        if claim.limit is None:
            return None
        if VERBS[claim.verb].operand in _TIMED or claim.every:
            dimensions[TIME] = "s"
        elif claim.condition is not None:  # a share of time
            dimensions[PERCENT] = "%"
        elif claim.signal is not None and claim.signal.unit is not None:
            dimensions[claim.signal.unit.dimension] = claim.signal.unit.symbol
        else:
            dimensions |= {model.NO_DIMENSION: None, COUNT: None}
    unit = next(iter(dimensions.values())) if len(dimensions) == 1 else None
    return Wanted("a goal of the same dimension as the bound", tuple(dimensions), unit) if claims else None


def parameter_of(reader: Reader, written: syntax.Parameter) -> model.ResolvedParameter:
    """A parameter with its default."""
    sort, unit = sort_of(written.unit)
    parameter = model.ResolvedParameter(written.name.text, sort, unit, None)
    default = reader.argument(parameter, written.default) if written.default is not None else None
    return replace(parameter, default=default)


_TIMED: Final = ("duration", "deadline", "reaction", "answer", "stretch")
_COUNTED: Final = Wanted("a number", (model.NO_DIMENSION, COUNT), None)
_SHARE: Final = Wanted("a percentage", (PERCENT,), "%")
