"""What changed in hazards, and in the clauses of requirements that demand nothing."""

from __future__ import annotations

from test_diff import in_words

OLD = """\
hazard H1 "Collision"
    severity high
QualityReq r : safety and comfort "R"
    takes at most 3 s
    source "S"
    priority high
BehaviorTree Main
    A satisfies r
"""


def test_hazards_and_clauses_that_demand_nothing() -> None:
    new = OLD.replace("severity high", 'severity low\n    because "it is slow"').replace("and comfort", "and usability")
    new = new.replace('source "S"\n    priority high', 'source "T"\n    refines s') + 'hazard H2 "New"\n'
    assert (
        in_words(OLD, new)
        == """\
old.btq -> new.btq
~ requirement r changed  new.btq:4
    ~ quality: safety and comfort -> safety and usability
    - source "S"
    + source "T"
    - priority high
    + refines s
~ hazard H1 changed  new.btq:1
    - severity high
    + severity low
    + because "it is slow"
+ hazard H2 added  new.btq:10
    + title: "New"

1 requirement changed, 1 hazard changed, 1 hazard added
"""
    )


def test_their_order_is_no_change() -> None:
    reordered = OLD.replace('    source "S"\n    priority high\n', '    priority high\n    source "S"\n')
    assert in_words(OLD, reordered.replace("safety and comfort", "comfort and safety")) == ""
