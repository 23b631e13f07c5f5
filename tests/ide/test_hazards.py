"""Hazards in an editor, and requirements that others refine: one space of IDs."""

from __future__ import annotations

from feature_asserts import (
    check_accept,
    check_completion,
    check_documentation,
    check_goto,
    check_hover,
    check_no_rename,
    check_offers,
    check_outline,
    check_references,
    check_rename,
    check_search,
)

HAZARDS = """\
hazard H1 "Collision with a person"
    source "FMEA-12"
    severity high
hazard H2 "Crushing"
QualityReq gentle : safety and comfort "Gentle"
    mission takes at most 1 h
"""


def test_the_definition_of_a_hazard() -> None:
    check_goto('hazard <def>H1</def> "Collision"\nQualityReq r "R"\n    mitigates H2, H$01\n')


def test_the_definition_of_a_refined_requirement() -> None:
    check_goto('QualityReq <def>a</def> "A"\nQualityReq r "R"\n    refines $0a\n')


def test_references() -> None:
    check_references(
        'hazard <def>$0H1</def> "Collision"\nQualityReq r "R"\n    mitigates <ref>H1</ref>\n'
        'BehaviorTree T\n    A satisfies QualityReq s mitigates <ref>"H1"</ref>\n'
    )
    check_references(
        'QualityReq <def>$0a</def> "A"\nQualityReq b "B"\n    refines <ref>a</ref>\n'
        "BehaviorTree T\n    X satisfies <ref>a</ref>\n"
    )


def test_rename() -> None:
    check_rename(
        'hazard H$01 "Collision"\nQualityReq r "R"\n    mitigates H2, H1\nhazard H2\n',
        "collision",
        'hazard collision "Collision"\nQualityReq r "R"\n    mitigates H2, collision\nhazard H2\n',
    )
    check_rename(
        'QualityReq a "A"\nQualityReq r "R"\n    refines $0a\nBehaviorTree T\n    X satisfies a\n',
        "REQ.1",
        'QualityReq "REQ.1" "A"\nQualityReq r "R"\n    refines "REQ.1"\nBehaviorTree T\n    X satisfies "REQ.1"\n',
    )


def test_a_hazard_cannot_have_the_id_of_a_requirement() -> None:
    check_no_rename('hazard H$01\nQualityReq a "A"\n', "`a` is already a requirement: main.btq, line 2", "a")
    check_no_rename('hazard H1\nQualityReq $0a "A"\n', "`H1` is already a hazard: main.btq, line 1", "H1")


def test_hover() -> None:
    check_hover(
        HAZARDS + "    mitigates <hover>H$01</hover>\n",
        """
        **H1** · hazard

        Collision with a person

        ```btq
        source "FMEA-12"
        severity high
        ```

        Mitigated by:
        - `gentle` (main.btq)
        """,
    )


def test_outline_and_search() -> None:
    check_outline(
        HAZARDS,
        "hazard H1 | Collision with a person",
        "hazard H2 | Crushing",
        "requirement gentle | safety and comfort: Gentle",
    )
    check_search(HAZARDS, "h1", "hazard H1 (main.btq)")


def test_completion() -> None:
    check_completion(HAZARDS + "    mitigates $0\n", "H1", "H2")
    check_completion(HAZARDS + "    mitigates H1, $0\n", "H1", "H2")
    check_completion(HAZARDS + 'QualityReq other "Other"\n    refines $0\n', "gentle")
    check_completion("hazard H1\n    $0\n", "source", "because", "severity")
    check_completion('QualityReq r "R"\n    mitigates H9\nhazard $0\n', "H9")
    check_completion('QualityReq r "R"\n    approved $0\n', "by")
    check_completion('QualityReq r "R"\n    approved by $0\n', '""')
    check_completion('QualityReq r "R"\n    approved by "Kim" $0\n', "on")
    check_offers('QualityReq r "R"\n    approved by "Kim" on "2026-11-29" $0\n', "of", "while")
    check_offers('QualityReq r "R"\n    verified by test $0\n', '""')
    check_offers('QualityReq r "R"\n    verified by test "TC-1", $0\n', "monitor", "review")
    check_offers("QualityReq r : safety and $0\n", "reliability")
    check_offers("QualityReq r\n    $0\n", "source", "refines", "mitigates", "priority", "approved by")
    check_accept("$0\n", "hazard", 'hazard ${1:H1} "$0"\n')


def test_documentation_of_a_proposal() -> None:
    check_documentation(
        HAZARDS + "    mitigates $0\n",
        "H2",
        """
        **H2** · hazard

        Crushing
        """,
    )


def test_hover_over_a_refined_requirement() -> None:
    check_hover(
        'QualityReq <hover>$0a</hover> : safety and comfort "A"\nQualityReq b "B"\n    refines a\n'
        "BehaviorTree T\n    X satisfies QualityReq c refines a\n",
        """
        **a** · safety and comfort

        A

        Refined by:
        - `b` (main.btq)
        - `c` (main.btq)
        """,
    )
