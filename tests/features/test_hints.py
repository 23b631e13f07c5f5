"""Inlay hints and code lenses."""

from __future__ import annotations

from feature_asserts import check_hints, check_lenses


def test_the_quality_of_a_requirement_that_is_only_named() -> None:
    check_hints("""
        //- main.btq
        include "lib.btq"
        QualityReq own "no quality"
        apply rq1<hint>: time-behaviour</hint> to Place
        BehaviorTree Main
            ->
                Pick satisfies rq1<hint>: time-behaviour</hint>, own
                Place satisfies unknown
        //- lib.btq
        QualityReq rq1 : performance-efficiency.time-behaviour "In time"
        """)


def test_the_quality_that_encloses_a_classic_requirement() -> None:
    check_hints("""
        BehaviorTree Main
            ->
                Pick (satisfices Quality = performance (QualityReq ID = "rq1" description = "In time"))
                Place (satisfies QualityReq ID = "rq1"<hint>: performance</hint>)
        """)


def test_what_is_written_to_the_port() -> None:
    check_hints("""
        BehaviorTree Main
            ->
                Timeout (msec = 2 min<hint>= 120000</hint>)
                    Delay (delay_msec = 30 ms)
                        Pick (speed = 3 m/s)
        """)


def test_lenses() -> None:
    check_lenses(
        """
        //- lib.btq
        QualityReq rq1 "shared"
        QualityReq rq2 "unused"
        BehaviorTree Dock
            Pick satisfies rq1
        //- main.btq
        include "lib.btq"
        Root Main
        BehaviorTree Main
            ->
                SubTree Dock satisfies rq1
                SubTree Dock
        """,
        "rq1: 2 uses",
        "rq2: 0 uses",
        "Dock: 2 calls",
    )


def test_classic_repeats_have_one_lens() -> None:
    check_lenses(
        "BehaviorTree Main\n    ->\n        A (satisfies QualityReq ID = x description = y)\n"
        "        B (satisfies QualityReq ID = x description = y)\n",
        "Main: 0 calls",
        "x: 1 use",
    )


def test_requirements_that_name_their_own_subjects() -> None:
    check_lenses(
        """
        Root Main
        QualityReq soon "Soon"
            MoveBase takes at most 3 s
        QualityReq all_of_them "All"
            every MoveBase takes at most 3 s
            ToA succeeds
        QualityReq run "Run"
            mission takes at most 1 min
        QualityReq between "Between"
            from ToA starts to Pick succeeds takes at most 20 s
        QualityReq added "Added"
            sum of ToA, Pick takes at most 20 s
        QualityReq both "Both"
            takes at most 1 s
            ToA takes at most 1 s
        QualityReq nothing "Nothing"
            Unknown takes at most 3 s
        BehaviorTree Main
            ->
                MoveBase ToA satisfies both
                MoveBase ToB
                Pick
        """,
        "soon: 0 uses",
        "all_of_them: holds for 2 nodes",
        "run: holds for 1 node",
        "between: holds for 2 nodes",
        "added: holds for 2 nodes",
        "both: 1 use, holds for 1 node",
        "nothing: 0 uses",
        "Main: 1 call",
    )


def test_a_library_holds_for_nodes_of_its_missions() -> None:
    check_lenses(
        """
        //- lib.btq
        QualityReq rq "Soon"
            Pick takes at most 3 s
        //- a.btq
        include "lib.btq"
        BehaviorTree A
            Pick
        //- b.btq
        include "lib.btq"
        BehaviorTree B
            Pick
        """,
        "rq: holds for 2 nodes",
    )
