"""The clauses of a requirement that demand nothing, resolved."""

from __future__ import annotations

from btq_lang.requirements.definitions import requirement
from btq_lang.requirements.model import ResolvedRequirement, ResolvedWay
from btq_lang.workspace.workspace import Workspace


def resolved(text: str) -> ResolvedRequirement:
    found, problems = Workspace.of({"main.btq": text}).store.ask(requirement, "main.btq", "r")
    assert found is not None
    assert problems == ()
    return found


def test_all_of_them() -> None:
    one = resolved(
        """\
QualityReq r : safety and reliability "R"
    source "S"
    source "T"
    refines a, b
    refines b, "c d"
    mitigates H1
    priority high
    verified by test "TC-12", review
    approved by "Kim" on "2026-11-29" of "1:0"
    approved by "Lee" on "2026-11-30"
"""
    )
    assert (one.qualities, one.sources, one.refines, one.mitigates, one.priority) == (
        ("safety", "reliability"),
        ("S", "T"),
        ("a", "b", "c d"),
        ("H1",),
        "high",
    )
    assert one.ways == (ResolvedWay("test", "TC-12"), ResolvedWay("review", None))
    assert one.verification == 'verified by test "TC-12", review'
    assert [(each.by, each.on, each.fingerprint) for each in one.approvals] == [
        ("Kim", "2026-11-29", "1:0"),
        ("Lee", "2026-11-30", None),
    ]


def test_people_alone_verify_it_where_no_way_is_monitor() -> None:
    verified = {ways: resolved(f"QualityReq r\n    verified by {ways}\n") for ways in ("test, review", "test, monitor")}
    assert [(one.method, one.is_verified_by_people) for one in verified.values()] == [
        ("test", True),
        ("monitor", False),
    ]
    assert not resolved("QualityReq r\n    takes at most 3 s\n").is_verified_by_people


def test_a_constraint_in_a_description_counts_beside_them() -> None:
    classic = 'QualityReq ID = "r" description = "SuccessIf takes at most 30 s"\n'
    for further in ("", '    source "S"\n    approved by "Kim" on "2026-11-29"\n'):
        assert [claim.text for claim in resolved(classic + further).claims] == ["takes at most 30 s"]
    assert resolved(classic + "    takes at most 10 s\n").claims[0].text == "takes at most 10 s"
