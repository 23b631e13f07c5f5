"""Document symbols and workspace symbols."""

from __future__ import annotations

from feature_asserts import check_outline, check_search

FILES = """
    //- main.btq
    include "lib.btq"
    Root Main
    signal speed : m/s
    context fast : speed > 1 m/s
    quality gentleness : safety "soft"
    QualityReq rq1 : safety "Keep
                             calm"
        takes at most 1 s
    apply rq1 to Pick
    BehaviorTree Main
        input shelf : string
        satisfies rq1
        R-> First
            Pick Near (from = {shelf}) satisfices performance satisfies rq1 tags heavy
            Retry (num_attempts = 3)
                SubTree Dock
            Unknown
    //- lib.btq
    Action Pick "takes it"
        input from : string
    BehaviorTree Dock
        Pick
    """


def test_outline() -> None:
    check_outline(
        FILES,
        "include lib.btq",
        "mission Main",
        "signal speed | m/s",
        "context fast",
        "quality gentleness | safety",
        "requirement rq1 | safety: Keep calm",
        "apply apply rq1",
        "tree Main | satisfies rq1",
        "  port shelf | input : string",
        "  control R-> First",
        "    action Pick Near | satisfices performance; satisfies rq1; tags heavy",
        "    decorator Retry",
        "      subtree Dock",
        "    node Unknown",
    )


def test_outline_of_models() -> None:
    check_outline(
        "TreeNodesModel\n    Action Pick\n        input from : string\nCondition Near\n",
        "action Pick",
        "  port from | input : string",
        "condition Near",
    )


def test_outline_of_words_of_older_engines() -> None:
    check_outline(
        """
        BehaviorTree Main
            SequenceStar
                SubTreePlus (ID = Dock)
                BlackboardCheckInt
                    Pick
        BehaviorTree Other
            FallbackStar
        Decorator FallbackStar
        """,
        "tree Main",
        "  control SequenceStar",
        "    subtree SubTreePlus",
        "    decorator BlackboardCheckInt",
        "      node Pick",
        "tree Other",
        "  decorator FallbackStar",
        "decorator FallbackStar",
    )


def test_items_in_a_root_are_its_children() -> None:
    check_outline(
        "Root Main\n    BehaviorTree Main\n        Pick\n    BehaviorTree Dock\n        Pick\n",
        "mission Main",
        "  tree Main",
        "    node Pick",
        "  tree Dock",
        "    node Pick",
    )


def test_outline_of_what_is_half_typed() -> None:
    check_outline("BehaviorTree\nQualityReq\n    Pick (", "tree BehaviorTree", "requirement requirement")
    check_outline("")


def test_search() -> None:
    check_search(FILES, "pk", "model Pick (lib.btq)")
    check_search(FILES, "NEAR", "action Near (Main)")
    check_search(FILES, "d", "tree Dock (lib.btq)", "signal speed (main.btq)")
    check_search(FILES, "nothing")
