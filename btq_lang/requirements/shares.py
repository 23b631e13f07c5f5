"""`in at least 95 % of time` makes `keeps` and `never` demand a share of the time.

One invariant: the share is the bound of each claim, so the code that measures, compares and explains bounds needs no
case for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from btq_lang.catalog.units import parse_unit
from btq_lang.requirements import model
from btq_lang.requirements.reader import Reader
from btq_lang.util.record import replace


def of_time(
    reader: Reader, claims: Sequence[model.ResolvedClaim], share: model.ResolvedOdds
) -> tuple[list[model.ResolvedClaim], list[str]]:
    """The claims of a share of the time, and the texts of those that have no share, which is reported."""
    unit = parse_unit("%")
    assert unit is not None, "a unit of the table"
    bound = model.Quantity(f"{share.probability * 100:.12g} %", share.probability, unit)
    demanded: list[model.ResolvedClaim] = []
    others: list[str] = []
    for claim in claims:
        if claim.verb not in _OF_TIME:
            message = f"`of time` is a share of the time in which a condition holds, and `{claim.head}` has none"
            notes = ("write it in a requirement with `keeps` or `never`; runs and activations have odds of their own",)
            reader.complain("impossible-odds", share.place.span, message, notes=notes)
            others.append(claim.text)
            continue
        limit = model.Limit(share.relation, bound)  # type: ignore[arg-type]  # `>=` or `>`
        demanded.append(replace(claim, verb=f"{claim.verb} of time", limit=limit, text=f"{claim.text} {share.text}"))
    return demanded, others


_OF_TIME: Final = ("keeps", "never")
